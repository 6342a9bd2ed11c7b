#include "touch_header.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "rollfix/error.hpp"
#include "text/text.hpp"

// Notation:
//   column           what a number of a touch is: TouchColumn
//   name             what a header calls it: "x", "X [mm]", "x_mm"; or another one that `columns` states
//   source           COLUMN=NAME or COLUMN=NAME:UNIT of `columns`: ColumnSource
//   conversion       from the column's unit to the part's, of angles to radians
// Follows docs/touch.md, "What to give".
// Idea: columns that the options name are taken first, then known names fill what is left. What is not used is told.
namespace rollfix {
namespace touch {
namespace {

/// By its exact name, in small letters.
std::optional<TouchColumn> column_called(std::string_view name) {
  const auto known = std::find(kTouchColumns.begin(), kTouchColumns.end(), name);
  if (known == kTouchColumns.end()) return std::nullopt;
  return static_cast<TouchColumn>(known - kTouchColumns.begin());
}

std::vector<std::string> column_names() { return {kTouchColumns.begin(), kTouchColumns.end()}; }

/// "COLUMN=NAME:UNIT".
/// `what`: the start of messages. The unit is behind the last colon, so a column's own name may hold others.
ColumnSource parse_source(std::string_view field, const std::string& what) {
  const std::size_t equals = field.find('=');
  if (equals == std::string_view::npos || trimmed(field.substr(equals + 1)).empty()) {
    throw InputError(fmt::format("{}: expected COLUMN=NAME or COLUMN=NAME:UNIT, as in x=px:mm,normal=n:deg, found '{}'",
                                 what, shown(field)));
  }
  ColumnSource source{std::string(trimmed(field.substr(0, equals))), std::string(trimmed(field.substr(equals + 1)))};
  const std::optional<TouchColumn> column = column_called(source.column);
  if (!column) {
    throw InputError(fmt::format("{}: touches have no column '{}'; {}", what, shown(source.column),
                                 known_names(source.column, column_names())));
  }
  const std::size_t colon = source.name.rfind(':');
  if (colon == std::string::npos) return source;
  const std::optional<Unit> unit = unit_named(trimmed(std::string_view(source.name).substr(colon + 1)));
  // `contact` is a flag: it has no unit.
  const bool takes_none = *column == TouchColumn::contact;
  if (takes_none || !unit || unit->dimension != dimension_of(*column)) {
    throw InputError(fmt::format("{}: expected of {} {}, found '{}'", what, source.column,
                                 takes_none ? "0 or 1, without a unit" : unit_names(dimension_of(*column)),
                                 shown(source.name.substr(colon + 1))));
  }
  source.unit = unit->name;
  source.name = trimmed(std::string_view(source.name).substr(0, colon));
  return source;
}

}  // namespace

/// "x", "X [mm]", "x_mm" or "x mm": capitals do not matter, a unit is in brackets or behind the last "_" or blank.
/// None: another column.
std::optional<KnownColumn> touch_column(const HeaderName& header) {
  const std::string name = lower_case(header.name);
  if (const auto column = column_called(name)) return KnownColumn{*column, std::string(header.unit)};
  // position_sd and normal_sd were found above: their "sd" is no unit.
  const std::size_t last = name.find_last_of("_ ");
  if (last == std::string::npos || !header.unit.empty()) return std::nullopt;
  const auto column = column_called(std::string_view(name).substr(0, last));
  const std::optional<Unit> unit = unit_named(std::string_view(name).substr(last + 1));
  if (!column || *column == TouchColumn::contact || !unit || unit->dimension != dimension_of(*column)) {
    return std::nullopt;
  }
  return KnownColumn{*column, std::string(unit->name)};
}

/// Columns of the options first: they take precedence over known names.
TouchHeader::TouchHeader(const TableRow& row, const std::string& name, const TouchTableOptions& options)
    : start_(where(name, row.line)) {
  const std::vector<HeaderName> names = names_in(row);
  count_ = names.size();
  cell_.fill(kNone);
  add_named(names, options);
  add_known(names, options.unit);
  for (std::size_t k = 0; k < names.size(); ++k) {
    const bool is_used = std::find(cell_.begin(), cell_.end(), k) != cell_.end();
    if (!is_used && !names[k].text.empty()) ignored_.push_back(shown(names[k].text));
  }
  if (has(TouchColumn::x) && has(TouchColumn::y)) return;
  throw InputError(
      fmt::format("{}: expected a header with x and y, as in x,y,normal, found '{}'; `columns` x=NAME,y=NAME says what "
                  "it calls them",
                  start_, shown(row.text)));
}

/// Those that the options name.
void TouchHeader::add_named(const std::vector<HeaderName>& names, const TouchTableOptions& options) {
  for (const ColumnSource& source : options.columns) {
    const std::size_t cell = find(names, source);
    // The option's unit, or that of the header.
    const std::string unit = source.unit.empty() ? std::string(names[cell].unit) : source.unit;
    set(*column_called(source.column), cell, unit, options.unit);
  }
}

/// Those that have a known name, where the options do not name another.
void TouchHeader::add_known(const std::vector<HeaderName>& names, const std::string& part_unit) {
  // As the options left it: a known name twice is still refused by `set`.
  const auto named = cell_;
  for (std::size_t k = 0; k < names.size(); ++k) {
    const std::optional<KnownColumn> known = touch_column(names[k]);
    const bool is_taken = std::find(named.begin(), named.end(), k) != named.end();
    if (known && !is_taken && named[static_cast<std::size_t>(known->column)] == kNone) {
      set(known->column, k, known->unit, part_unit);
    }
  }
}

/// Throws InputError: a second one, or a unit of the wrong dimension. Angles become radians, lengths the part's unit.
void TouchHeader::set(TouchColumn column, std::size_t cell, const std::string& unit, const std::string& part_unit) {
  const auto which = static_cast<std::size_t>(column);
  if (cell_[which] != kNone) {
    throw InputError(fmt::format("{}: expected one column {}, found two", start_, touch::name_of(column)));
  }
  cell_[which] = cell;
  if (unit.empty()) return;
  const std::optional<Unit> as_written = unit_named(unit);
  // Units are taken as written first, since capitals can tell units apart, then in small letters.
  const std::optional<Unit> known = as_written ? as_written : unit_named(lower_case(unit));
  if (column == TouchColumn::contact || !known || known->dimension != dimension_of(column)) {
    throw InputError(fmt::format("{}: column {}: expected {}, one of {}, found '{}'", start_, touch::name_of(column),
                                 rollfix::name_of(dimension_of(column)), unit_names(dimension_of(column)),
                                 shown(unit)));
  }
  const std::string what = fmt::format("{}: column {}", start_, touch::name_of(column));
  if (is_of_angle(column)) {
    conversion_[which] = conversion_to_plain(*known);
  } else if (!part_unit.empty()) {
    conversion_[which] = length_conversion(known->name, part_unit, what);
  } else {
    throw InputError(fmt::format("{} is in {}, and the part's unit is not known: state it with `unit`, as in `unit` {}",
                                 what, known->name, known->name));
  }
}

/// A column by its whole text or by its name without the unit.
std::size_t TouchHeader::find(const std::vector<HeaderName>& names, const ColumnSource& source) const {
  std::vector<std::string> all;
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (names[k].text == source.name || names[k].name == source.name) return k;
    all.emplace_back(names[k].name);
  }
  throw InputError(fmt::format("{}: expected a column '{}' for {} (`columns`), found none; {}", start_,
                               shown(source.name), source.column, known_names(source.name, all)));
}

}  // namespace touch

std::vector<ColumnSource> parse_touch_columns(std::string_view text) {
  const std::string what = fmt::format("`columns` {}", shown(text));
  std::vector<ColumnSource> sources;
  for (const std::string_view field : split(text, ',')) {
    ColumnSource source = touch::parse_source(field, what);
    for (const ColumnSource& one : sources) {
      if (one.column == source.column) {
        throw InputError(fmt::format("{}: {} is given twice; leave one out", what, one.column));
      }
    }
    sources.push_back(std::move(source));
  }
  return sources;
}

bool names_touch_columns(std::string_view text) {
  // Columns that logs of rolls do not have.
  const auto is_own = [](std::string_view field) {
    const auto column = touch::column_called(trimmed(field.substr(0, field.find('='))));
    return column == touch::TouchColumn::normal || column == touch::TouchColumn::position_sd ||
           column == touch::TouchColumn::normal_sd;
  };
  const std::vector<std::string_view> fields = split(text, ',');
  return std::any_of(fields.begin(), fields.end(), is_own);
}

}  // namespace rollfix
