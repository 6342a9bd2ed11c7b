#include "log/header/column_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "rollfix/error.hpp"
#include "text/text.hpp"

namespace rollfix {
namespace {

/// The name without this end; nothing where it has another.
std::optional<std::string_view> stem_of(std::string_view name, std::string_view suffix) {
  if (name.size() <= suffix.size() || name.substr(name.size() - suffix.size()) != suffix) return std::nullopt;
  return name.substr(0, name.size() - suffix.size());
}

}  // namespace

bool is_known(std::string_view name) {
  return std::find(kColumnNames.begin(), kColumnNames.end(), name) != kColumnNames.end();
}

bool says_where(std::string_view name) {
  return std::any_of(kColumnPairs.begin(), kColumnPairs.end(), [&](const ColumnPair& pair) {
    return name == name_of(pair.place) || name == name_of(pair.angle);
  });
}

bool says_where_of_one_of_two(std::string_view name) {
  return std::any_of(kFingerSuffixes.begin(), kFingerSuffixes.end(), [&](const char* suffix) {
    const auto stem = stem_of(name, suffix);
    return stem && says_where(*stem);
  });
}

std::optional<Column> column_named(std::string_view name, const std::string& suffix) {
  for (std::size_t k = 0; k < kColumnCount; ++k) {
    const auto column = static_cast<Column>(k);
    const bool is_common = column == Column::time || column == Column::contact;
    if (name == kColumnNames[k] + suffix && (suffix.empty() || column != Column::time)) return column;
    if (is_common && name == kColumnNames[k]) return column;
  }
  return std::nullopt;
}

std::optional<bool> take_wrapping(std::string_view& unit) {
  const std::size_t colon = unit.rfind(':');
  const std::string_view last = colon == std::string_view::npos ? unit : trimmed(unit.substr(colon + 1));
  if (last != "wrapped" && last != "unwrapped") return std::nullopt;
  unit = colon == std::string_view::npos ? std::string_view() : trimmed(unit.substr(0, colon));
  return last == "wrapped";
}

bool takes(Column column, Dimension dimension) {
  switch (column) {
    case Column::time:
      return dimension == Dimension::time;
    case Column::u:
      return dimension != Dimension::time;
    case Column::contact:
      return false;
    default:
      return dimension == (is_angle(column) ? Dimension::angle : Dimension::length);
  }
}

std::string what_it_takes(Column column) {
  std::vector<std::string> taken;
  for (const Dimension dimension : {Dimension::angle, Dimension::length, Dimension::time}) {
    if (takes(column, dimension)) taken.push_back(fmt::format("{} ({})", name_of(dimension), unit_names(dimension)));
  }
  return taken.empty() ? "0 or 1, without a unit" : fmt::format("{}", fmt::join(taken, " or "));
}

namespace {

/// Throws InputError; `what` begins the message.
ColumnSource parse_source(std::string_view field, const std::string& what) {
  const std::size_t mark = field.find('=');
  if (mark == std::string_view::npos || mark == 0 || mark + 1 == field.size()) {
    throw InputError(
        fmt::format("{}: '{}' is not COLUMN=NAME or COLUMN=NAME:UNIT, as in u=contact_deg:deg", what, shown(field)));
  }
  ColumnSource source{std::string(trimmed(field.substr(0, mark))), std::string(trimmed(field.substr(mark + 1)))};
  std::optional<Column> column;
  for (const char* const suffix : {"", kFingerSuffixes[0], kFingerSuffixes[1]}) {
    if (!column) column = column_named(source.column, suffix);
  }
  if (!column) {
    throw InputError(fmt::format("{}: there is no column '{}'; {}; of two fingers with _a and _b behind them", what,
                                 shown(source.column),
                                 known_names(source.column, {kColumnNames.begin(), kColumnNames.end()})));
  }
  std::string wrapping;
  std::string_view before = source.name;
  const bool may_wrap = column == Column::u || column == Column::psi;
  if (may_wrap && before.find(':') != std::string_view::npos && take_wrapping(before)) {
    wrapping = trimmed(std::string_view(source.name).substr(source.name.rfind(':') + 1));
    source.name = before;
  }
  source.unit = wrapping;
  const std::size_t colon = source.name.rfind(':');
  if (colon == std::string::npos) return source;
  const std::optional<Unit> unit = unit_named(trimmed(std::string_view(source.name).substr(colon + 1)));
  if (!unit || !takes(*column, unit->dimension)) {
    throw InputError(
        fmt::format("{}: '{}' of {} is not in a unit of it, expected {}; behind a name with a colon in it "
                    "goes another colon and the unit",
                    what, shown(source.name), source.column, what_it_takes(*column)));
  }
  source.unit = fmt::format("{}{}{}", unit->name, wrapping.empty() ? "" : ":", wrapping);
  source.name = trimmed(std::string_view(source.name).substr(0, colon));
  return source;
}

}  // namespace

std::vector<ColumnSource> parse_columns(std::string_view text) {
  const std::string what = fmt::format("`columns` {}", shown(text));
  std::vector<ColumnSource> sources;
  for (const std::string_view field : split(text, ',')) {
    sources.push_back(parse_source(field, what));
    const auto is_same = [&](const ColumnSource& one) { return one.column == sources.back().column; };
    if (std::find_if(sources.begin(), sources.end(), is_same) != sources.end() - 1) {
      throw InputError(fmt::format("{}: {} is given twice", what, sources.back().column));
    }
  }
  return sources;
}

}  // namespace rollfix
