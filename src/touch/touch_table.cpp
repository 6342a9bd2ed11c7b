#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "log/header/log_header.hpp"
#include "log/log_table.hpp"
#include "rollfix/error.hpp"
#include "rollfix/touch.hpp"
#include "text/number.hpp"
#include "text/table.hpp"
#include "text/text.hpp"
#include "text/units.hpp"

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

/// In the order of kTouchColumns.
enum class TouchColumn : std::size_t { x, y, normal, position_sd, normal_sd, contact };
constexpr std::size_t kTouchColumnCount = 6;
constexpr std::array<const char*, kTouchColumnCount> kTouchColumns = {"x",           "y",         "normal",
                                                                      "position_sd", "normal_sd", "contact"};

const char* name_of(TouchColumn column) { return kTouchColumns[static_cast<std::size_t>(column)]; }
/// Else it is a length, or `contact`, which has no unit.
bool is_of_angle(TouchColumn column) { return column == TouchColumn::normal || column == TouchColumn::normal_sd; }
Dimension dimension_of(TouchColumn column) { return is_of_angle(column) ? Dimension::angle : Dimension::length; }

/// What a name in a header, or in `columns`, stands for.
struct KnownColumn {
  TouchColumn column = TouchColumn::x;
  std::string unit{};  // of the header: "x [mm]", "x_mm"; empty: it names none
};

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

/// Which cell of a row holds which column, and in what.
class TouchHeader {
 public:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  /// Throws InputError: no x or y, a column twice, one of `columns` that is not there, a unit that is not the column's.
  /// Columns of the options first: they take precedence over known names.
  TouchHeader(const TableRow& row, const std::string& name, const TouchTableOptions& options)
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
    throw InputError(fmt::format(
        "{}: expected a header with x and y, as in x,y,normal, found '{}'; `columns` x=NAME,y=NAME says what "
        "it calls them",
        start_, shown(row.text)));
  }

  /// Of cells in the header.
  std::size_t count() const { return count_; }
  bool has(TouchColumn column) const { return cell(column) != kNone; }
  /// kNone: the table does not have it.
  std::size_t cell(TouchColumn column) const { return cell_[static_cast<std::size_t>(column)]; }
  /// To the part's unit, or to radians.
  const Conversion& conversion(TouchColumn column) const { return conversion_[static_cast<std::size_t>(column)]; }
  /// The names of columns that are not used.
  const std::vector<std::string>& ignored() const { return ignored_; }

 private:
  /// Those that the options name.
  void add_named(const std::vector<HeaderName>& names, const TouchTableOptions& options) {
    for (const ColumnSource& source : options.columns) {
      const std::size_t cell = find(names, source);
      // The option's unit, or that of the header.
      const std::string unit = source.unit.empty() ? std::string(names[cell].unit) : source.unit;
      set(*column_called(source.column), cell, unit, options.unit);
    }
  }

  /// Those that have a known name, where the options do not name another.
  void add_known(const std::vector<HeaderName>& names, const std::string& part_unit) {
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
  void set(TouchColumn column, std::size_t cell, const std::string& unit, const std::string& part_unit) {
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
      throw InputError(
          fmt::format("{} is in {}, and the part's unit is not known: state it with `unit`, as in `unit` {}", what,
                      known->name, known->name));
    }
  }

  /// A column by its whole text or by its name without the unit.
  std::size_t find(const std::vector<HeaderName>& names, const ColumnSource& source) const {
    std::vector<std::string> all;
    for (std::size_t k = 0; k < names.size(); ++k) {
      if (names[k].text == source.name || names[k].name == source.name) return k;
      all.emplace_back(names[k].name);
    }
    throw InputError(fmt::format("{}: expected a column '{}' for {} (`columns`), found none; {}", start_,
                                 shown(source.name), source.column, known_names(source.name, all)));
  }

  std::string start_;  // of messages
  std::size_t count_ = 0;
  std::array<std::size_t, kTouchColumnCount> cell_{};
  std::array<Conversion, kTouchColumnCount> conversion_{};
  std::vector<std::string> ignored_;
};

}  // namespace
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

// ---- rows
// Notation:
//   x, y, normal     of a touch: MeasuredTouch; what is empty was not measured, NaN or none
//   contact          1: a touch, 0: a place on a way that was free; without the column all rows are touches
//   report           what a milling controller writes of its probe: ProbeReport
//   clear            straight ways from a row with contact 0 to the row after it
// Follows docs/touch.md, "What to give".
// Idea: a text is first looked at for a probe's report, which has no header. Else its first row is the header, which
// says which cell is what and in which unit (above); below it each row is a touch or a free place.
namespace rollfix::touch {
namespace {

/// How a milling controller reports where its probe has touched.
enum class ProbeReport {
  grbl,       // lines "[PRB:12.300,4.500,-1.000:1]" among others; 1: it touched, 0: it did not
  linux_cnc,  // rows "x y z a b c u v w", between PROBEOPEN and PROBECLOSE
};

constexpr std::string_view kGrblStart = "[PRB:";
// x y z a b c u v w.
constexpr std::size_t kLinuxCncNumbers = 9;

/// Where a report of GRBL begins, in capitals or not, as senders that log in small letters write it.
std::size_t grbl_start(std::string_view text) {
  const auto alike = [](char one, char other) { return std::toupper(static_cast<unsigned char>(one)) == other; };
  const auto at = std::search(text.begin(), text.end(), kGrblStart.begin(), kGrblStart.end(), alike);
  return at == text.end() ? std::string_view::npos : static_cast<std::size_t>(at - text.begin());
}

/// Whether it is a row of that many plain numbers, with blanks between.
bool is_linux_cnc_row(std::string_view line) {
  std::size_t count = 0;
  for (std::string_view rest = trimmed(line); !rest.empty(); ++count) {
    const std::size_t end = std::min(rest.find_first_of(" \t"), rest.size());
    if (!parse_number(rest.substr(0, end))) return false;
    rest = trimmed(rest.substr(end));
  }
  return count == kLinuxCncNumbers;
}

/// Throws InputError; `place`: file and line.
double finite_number(std::string_view text, const char* column, const std::string& place) {
  const std::optional<double> value = parse_number(trimmed(text));
  if (value && std::isfinite(*value)) return *value;
  throw InputError(fmt::format("{}: {}: expected a number, found '{}'", place, column, shown(text)));
}

/// The place in "[PRB:x,y,z:1]"; none where the probe did not touch.
std::optional<Vec2> grbl_place(std::string_view line, const std::string& place) {
  const std::string_view report = line.substr(grbl_start(line));
  const std::size_t end = report.find(']');
  const std::size_t colon = report.find(':', kGrblStart.size());
  // The flag stands between the colon and the closing bracket.
  const std::string_view flag = colon < end ? trimmed(report.substr(colon + 1, end - colon - 1)) : std::string_view();
  std::vector<std::string_view> numbers;
  if (flag == "0" || flag == "1") {
    numbers = split(report.substr(kGrblStart.size(), colon - kGrblStart.size()), ',');
  }
  if (end == std::string_view::npos || numbers.size() < 2) {
    throw InputError(fmt::format("{}: expected a probe's report, as in [PRB:12.300,4.500,-1.000:1], found '{}'", place,
                                 shown(report)));
  }
  const Vec2 at(finite_number(numbers[0], "x", place), finite_number(numbers[1], "y", place));
  return flag == "1" ? std::optional<Vec2>(at) : std::nullopt;
}

/// Reports among any other lines of a console. Coordinates are millimetres if the part's unit is known, else taken as
/// they are.
TouchTable parse_grbl(std::string_view text, const std::string& name, const TouchTableOptions& options) {
  const bool knows_unit = !options.unit.empty();
  const Conversion own = knows_unit ? length_conversion("mm", options.unit, name) : Conversion{};
  TouchTable table;
  std::size_t missed = 0;
  TextLines lines(text, name);
  std::string_view line;
  for (std::size_t number = 1; lines.next(line); ++number) {
    if (grbl_start(line) == std::string_view::npos) continue;
    const std::optional<Vec2> at = grbl_place(line, where(name, number));
    if (!at) {
      ++missed;
      continue;
    }
    table.touches.push_back({{own(at->x()), own(at->y())}});
    table.lines.push_back(number);
  }
  // What was taken for granted is told: the unit, and that z does not count.
  table.notes.push_back(fmt::format("{}: GRBL's probe reports, {}: machine coordinates, taken as {}; z is not used",
                                    name, counted(table.touches.size(), "touch", "touches"),
                                    knows_unit ? "mm, which they are unless $13=1" : "in the part's unit"));
  if (missed > 0) {
    table.notes.push_back(
        fmt::format("{}: {} left out: the probe did not touch (:0)", name, counted(missed, "report", "reports")));
  }
  return table;
}

/// All rows have nine numbers; x and y are in the machine's unit, which is taken as the part's.
TouchTable parse_linux_cnc(std::string_view text, const std::string& name) {
  TouchTable table;
  TextLines lines(text, name);
  TableCutter cutter(false);
  std::string_view line;
  TableRow row;
  for (std::size_t number = 1; lines.next(line); ++number) {
    if (!cutter.cut(line, number, row)) continue;
    if (row.cells.size() != kLinuxCncNumbers) {
      throw InputError(fmt::format("{}: expected {} numbers as in the rows above, found {}", where(name, number),
                                   kLinuxCncNumbers, row.cells.size()));
    }
    const std::string place = where(name, number);
    table.touches.push_back({{finite_number(row.cells[0], "x", place), finite_number(row.cells[1], "y", place)}});
    table.lines.push_back(number);
  }
  table.notes.push_back(
      fmt::format("{}: nine numbers in a row, as LinuxCNC's PROBEOPEN writes them: x and y are the first two", name));
  return table;
}

/// What of it a text is; none: something else.
/// GRBL by a report anywhere, LinuxCNC by the first row that is no comment.
std::optional<ProbeReport> probe_report(std::string_view text) {
  if (grbl_start(text) != std::string_view::npos) return ProbeReport::grbl;
  TextLines lines(text, "");
  std::string_view line;
  while (lines.next(line)) {
    const std::string_view data = trimmed(line.substr(0, line.find('#')));
    if (!data.empty()) return is_linux_cnc_row(data) ? std::optional(ProbeReport::linux_cnc) : std::nullopt;
  }
  return std::nullopt;
}

/// A touch for each place. Throws InputError, naming the line.
TouchTable parse_probe_report(ProbeReport report, std::string_view text, const std::string& name,
                              const TouchTableOptions& options) {
  if (!options.columns.empty()) {
    throw InputError(fmt::format("{}: is a probe's report, which has no header; leave `columns` out", name));
  }
  TouchTable table = report == ProbeReport::grbl ? parse_grbl(text, name, options) : parse_linux_cnc(text, name);
  if (!table.touches.empty() || options.may_be_empty) return table;
  throw InputError(fmt::format("{}: expected a touch, found only reports of a probe that did not touch (:0)", name));
}

}  // namespace

}  // namespace rollfix::touch

namespace rollfix {

namespace touch {
namespace {

/// Calls `row` with each row of the table.
template <class Row>
void each_row(std::string_view text, const std::string& name, std::optional<bool> decimal_comma, const Row& row) {
  TextLines lines(text, name);
  TableCutter cutter(decimal_comma);
  std::string_view line;
  TableRow cut;
  for (std::size_t number = 1; lines.next(line); ++number) {
    // `row` says whether it wants more.
    if (cutter.cut(line, number, cut) && !row(cut)) return;
  }
}

/// Reads rows below a header.
class TouchReader {
 public:
  /// `row`: the header. `name` outlives this.
  TouchReader(const TableRow& row, const std::string& name, const TouchTableOptions& options)
      : header_(row, name, options), name_(name) {}

  const TouchHeader& header() const { return header_; }

  /// Throws InputError where the row has not as many cells as the header.
  void require_whole(const TableRow& row) const {
    if (row.cells.size() == header_.count()) return;
    throw InputError(fmt::format("{}: expected {} as in the header, found {}", where(name_, row.line),
                                 counted(header_.count(), "cell", "cells"), row.cells.size()));
  }

  /// A place that was not measured is NaN.
  MeasuredTouch read(const TableRow& row) const {
    MeasuredTouch touch;
    constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    touch.at = {number(row, TouchColumn::x).value_or(kUnknown), number(row, TouchColumn::y).value_or(kUnknown)};
    touch.normal = number(row, TouchColumn::normal);
    touch.position_sd = number(row, TouchColumn::position_sd);
    touch.normal_sd = number(row, TouchColumn::normal_sd);
    if (!touch.has_place()) require_normal_alone(row, touch);
    return touch;
  }

  /// Without the column each row is a touch.
  bool has_contact(const TableRow& row) const {
    if (!header_.has(TouchColumn::contact)) return true;
    const std::string_view cell = row.cells[header_.cell(TouchColumn::contact)];
    const std::optional<double> value = parse_number(cell);
    if (value == 0.0 || value == 1.0) return value == 1.0;
    throw InputError(
        fmt::format("{}: column contact: expected 0 or 1, found '{}'", where(name_, row.line), shown(cell)));
  }

 private:
  /// Without a place only a measured normal of a touch says something; half a place says nothing.
  void require_normal_alone(const TableRow& row, const MeasuredTouch& touch) const {
    const bool is_half = !std::isnan(touch.at.x()) || !std::isnan(touch.at.y());
    if (!is_half && touch.normal && has_contact(row)) return;
    throw InputError(fmt::format("{}: column {}: expected a number, found ''{}", where(name_, row.line),
                                 touch::name_of(std::isnan(touch.at.x()) ? TouchColumn::x : TouchColumn::y),
                                 is_half ? "" : "; a touch whose normal alone was measured has a normal"));
  }

  /// None: no such column, or an empty cell. Bare numbers are in the header's unit, an angle with its own unit is in
  /// radians already.
  std::optional<double> number(const TableRow& row, TouchColumn column) const {
    if (!header_.has(column)) return std::nullopt;
    const std::string_view cell = row.cells[header_.cell(column)];
    if (cell.empty()) return std::nullopt;
    const std::optional<double> plain = parse_number(cell);
    const std::optional<double> value = plain || !is_of_angle(column) ? plain : parse_angle(cell);
    if (!value || !std::isfinite(*value)) {
      throw InputError(fmt::format("{}: column {}: expected a number, found '{}'{}", where(name_, row.line),
                                   touch::name_of(column), shown(cell), decimal_comma_hint(cell)));
    }
    return plain ? header_.conversion(column)(*value) : *value;
  }

  TouchHeader header_;
  const std::string& name_;
};

/// Whether a name stands for what only a roll has; of two fingers with _a or _b behind it.
bool is_of_roll(std::string name) {
  for (const char* suffix : kFingerSuffixes) {
    if (name.size() > 2 && name.ends_with(suffix)) name.resize(name.size() - 2);
  }
  const auto same = [&](const ColumnPair& pair) {
    return name == rollfix::name_of(pair.place) || name == rollfix::name_of(pair.angle);
  };
  return std::any_of(kColumnPairs.begin(), kColumnPairs.end(), same);
}

/// Whether a header is one of touches; `columns`: what the options say of it.
/// x and y, and nothing of a roll. An unknown name that sounds like a roll's is let pass where the options name
/// columns, or where a column of touches alone is there.
bool is_touch_header(const TableRow& row, const std::vector<ColumnSource>& columns) {
  const auto is_said = [&](const char* name) {
    return std::any_of(columns.begin(), columns.end(), [&](const ColumnSource& one) { return one.column == name; });
  };
  bool has_x = is_said("x"), has_y = is_said("y"), has_roll = false, has_more = !columns.empty();
  std::vector<HeaderName> unknown;
  for (const HeaderName& header : names_in(row)) {
    const std::optional<KnownColumn> known = touch_column(header);
    has_x = has_x || (known && known->column == TouchColumn::x);
    has_y = has_y || (known && known->column == TouchColumn::y);
    has_roll = has_roll || is_of_roll(lower_case(header.name));
    // normal, position_sd and normal_sd: a log of a roll has none of them.
    has_more = has_more || (known && known->column >= TouchColumn::normal && known->column != TouchColumn::contact);
    if (!known && lower_case(header.name) != rollfix::name_of(rollfix::Column::time)) unknown.push_back(header);
  }
  const bool may_be_of_roll = holds_columns_of(unknown, 0) || holds_columns_of(unknown, 1);
  return has_x && has_y && !has_roll && (has_more || !may_be_of_roll);
}

/// Which columns were not used, and how many rows are free space.
void add_notes(TouchTable& table, const TouchHeader& header, std::size_t free_rows, const std::string& name) {
  const std::vector<std::string>& ignored = header.ignored();
  if (!ignored.empty()) {
    table.notes.push_back(fmt::format("{}: {} not used: {}; known are {}", name,
                                      ignored.size() == 1 ? "this column is" : "these columns are",
                                      fmt::join(ignored, ", "), fmt::join(kTouchColumns, ", ")));
  }
  if (free_rows == 0) return;
  table.notes.push_back(fmt::format("{}: {} with contact 0 {}; `clear` rows takes {} as free space", name,
                                    counted(free_rows, "row", "rows"),
                                    free_rows == 1 ? "is no touch" : "are no touches", free_rows == 1 ? "it" : "them"));
}

}  // namespace
}  // namespace touch

bool is_touch_table(std::string_view text, const TouchTableOptions& options) {
  bool is_one = false;
  try {
    if (touch::probe_report(text)) return true;
    touch::each_row(text, "", options.decimal_comma, [&](const TableRow& row) {
      is_one = touch::is_touch_header(row, options.columns);
      return false;  // the header is enough
    });
  } catch (const InputError&) {
    return false;  // it is no table at all: whoever reads it says so
  }
  return is_one;
}

TouchTable parse_touches(std::string_view text, const std::string& name, const TouchTableOptions& options) {
  if (const auto report = touch::probe_report(text)) {
    return touch::parse_probe_report(*report, text, name, options);
  }
  TouchTable table;
  std::optional<std::string> header_text;
  std::optional<touch::TouchReader> reader;
  std::size_t free_rows = 0;
  // Of the row before: its place, and whether it has contact.
  std::optional<Vec2> last;
  bool last_has_contact = false;
  touch::each_row(text, name, options.decimal_comma, [&](const TableRow& row) {
    // The first row is the header.
    if (!reader) {
      reader.emplace(row, name, options);
      return true;
    }
    reader->require_whole(row);
    const MeasuredTouch touch = reader->read(row);
    const bool has_contact = reader->has_contact(row);
    // The way from a row without contact to the next row, contact or not; the way back from a touch is no path, nor is
    // one to a touch whose place is unknown.
    if (last && !last_has_contact && touch.has_place()) table.clear.push_back({*last, touch.at});
    last = touch.at;
    last_has_contact = has_contact;
    if (!has_contact) {
      ++free_rows;
      return true;
    }
    table.touches.push_back(touch);
    table.lines.push_back(row.line);
    return true;
  });
  if (table.touches.empty() && !options.may_be_empty) {
    throw InputError(
        fmt::format("{}: expected a touch in each row, found no row{}", name, free_rows > 0 ? " with contact 1" : ""));
  }
  // An empty table that may be empty.
  if (!reader) return table;
  touch::add_notes(table, reader->header(), free_rows, name);
  return table;
}

}  // namespace rollfix
