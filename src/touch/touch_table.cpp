#include "rollfix/touch/touch_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "contact/header/log_header.hpp"
#include "contact/log_table.hpp"
#include "rollfix/error.hpp"
#include "rollfix/units.hpp"
#include "text/number.hpp"
#include "text/text.hpp"

namespace rollfix {
namespace touch {
namespace {

// Their places in the list below.
constexpr std::size_t kX = 0, kY = 1, kNormal = 2, kPositionSd = 3, kNormalSd = 4;
constexpr std::array<const char*, 5> kTouchColumns = {"x", "y", "normal", "position_sd", "normal_sd"};
constexpr std::size_t kNoCell = static_cast<std::size_t>(-1);

/// Calls `row` with each row of the table.
template <class Row>
void each_row(std::string_view text, const std::string& name, std::optional<bool> decimal_comma, const Row& row) {
  LogLines lines(text, name);
  TableCutter cutter(decimal_comma);
  std::string_view line;
  TableRow cut;
  for (std::size_t number = 1; lines.next(line); ++number) {
    if (cutter.cut(line, number, cut) && !row(cut)) return;
  }
}

class TouchReader {
 public:
  TouchReader(const std::string& name, const TouchTableOptions& options) : name_(name), options_(options) {
    cell_.fill(kNoCell);
  }

  void read_header(const TableRow& row) {
    for (const HeaderName& header : names_in(row)) {
      const std::string name = lower_case(header.name);
      const auto known = std::find(kTouchColumns.begin(), kTouchColumns.end(), name);
      if (known != kTouchColumns.end()) {
        const auto column = static_cast<std::size_t>(known - kTouchColumns.begin());
        if (cell_[column] != kNoCell) {
          throw InputError(fmt::format("{}: expected one column {}, found two", where(name_, row.line), name));
        }
        cell_[column] = count_;
        if (!header.unit.empty()) conversion_[column] = conversion_of(column, header, row.line);
      }
      ++count_;
    }
    if (cell_[kX] != kNoCell && cell_[kY] != kNoCell) return;
    throw InputError(fmt::format("{}: expected a header with x and y, as in x,y,normal, found '{}'",
                                 where(name_, row.line), shown(row.text)));
  }

  MeasuredTouch read(const TableRow& row) const {
    if (row.cells.size() != count_) {
      throw InputError(fmt::format("{}: expected {} as in the header, found {}", where(name_, row.line),
                                   counted(count_, "cell", "cells"), row.cells.size()));
    }
    MeasuredTouch touch;
    touch.at = {number(row, kX).value(), number(row, kY).value()};
    touch.normal = number(row, kNormal);
    touch.position_sd = number(row, kPositionSd);
    touch.normal_sd = number(row, kNormalSd);
    return touch;
  }

 private:
  static bool is_of_angle(std::size_t column) { return column == kNormal || column == kNormalSd; }

  Conversion conversion_of(std::size_t column, const HeaderName& header, std::size_t line) const {
    const Dimension wanted = is_of_angle(column) ? Dimension::angle : Dimension::length;
    const std::optional<Unit> unit = unit_named(header.unit);
    if (!unit || unit->dimension != wanted) {
      throw InputError(fmt::format("{}: column {}: expected {}, one of {}, found '{}'", where(name_, line),
                                   kTouchColumns[column], name_of(wanted), unit_names(wanted), shown(header.unit)));
    }
    if (is_of_angle(column)) return conversion_to_plain(*unit);
    return length_conversion(unit->name, options_.unit,
                             fmt::format("{}: {}", where(name_, line), kTouchColumns[column]));
  }

  /// Nothing of an empty cell, unless it is a coordinate.
  std::optional<double> number(const TableRow& row, std::size_t column) const {
    if (cell_[column] == kNoCell) return std::nullopt;
    const std::string_view cell = row.cells[cell_[column]];
    if (cell.empty() && column > kY) return std::nullopt;
    const std::optional<double> plain = parse_number(cell);
    const std::optional<double> value = plain || !is_of_angle(column) ? plain : parse_angle(cell);
    if (!value || !std::isfinite(*value)) {
      throw InputError(fmt::format("{}: column {}: expected a number, found '{}'{}", where(name_, row.line),
                                   kTouchColumns[column], shown(cell), decimal_comma_hint(cell)));
    }
    return plain ? conversion_[column](*value) : *value;
  }

  const std::string& name_;
  const TouchTableOptions& options_;
  std::array<std::size_t, kTouchColumns.size()> cell_{};
  std::array<Conversion, kTouchColumns.size()> conversion_{};
  std::size_t count_ = 0;
};

/// Whether a name stands for what only a roll has; of two fingers with _a or _b behind it.
bool is_of_roll(std::string name) {
  for (const char* suffix : kFingerSuffixes) {
    if (name.size() > 2 && name.ends_with(suffix)) name.resize(name.size() - 2);
  }
  const auto same = [&](const ColumnPair& pair) { return name == name_of(pair.place) || name == name_of(pair.angle); };
  return std::any_of(kColumnPairs.begin(), kColumnPairs.end(), same);
}

}  // namespace
}  // namespace touch

bool is_touch_table(std::string_view text, const TouchTableOptions& options) {
  bool has_x = false, has_y = false, has_roll = false, has_more = false, has_unknown = false;
  const auto look = [&](const TableRow& row) {
    for (const HeaderName& header : names_in(row)) {
      const std::string name = lower_case(header.name);
      has_x = has_x || name == "x";
      has_y = has_y || name == "y";
      has_roll = has_roll || touch::is_of_roll(name);
      const bool is_known =
          std::find(touch::kTouchColumns.begin(), touch::kTouchColumns.end(), name) != touch::kTouchColumns.end();
      has_more = has_more || (is_known && name != "x" && name != "y");
      has_unknown = has_unknown || (!is_known && name != name_of(Column::time) && name != name_of(Column::contact));
    }
    return false;  // the header is enough
  };
  try {
    touch::each_row(text, "", options.decimal_comma, look);
  } catch (const InputError&) {
    return false;  // it is no table at all: whoever reads it says so
  }
  // Columns by other names, beside x and y, may be those of a roll.
  return has_x && has_y && !has_roll && (has_more || !has_unknown);
}

TouchTable parse_touches(std::string_view text, const std::string& name, const TouchTableOptions& options) {
  TouchTable table;
  touch::TouchReader reader(name, options);
  bool has_header = false;
  touch::each_row(text, name, options.decimal_comma, [&](const TableRow& row) {
    if (!has_header) {
      reader.read_header(row);
      has_header = true;
    } else {
      table.touches.push_back(reader.read(row));
      table.lines.push_back(row.line);
    }
    return true;
  });
  if (table.touches.empty()) throw InputError(fmt::format("{}: expected a touch in each row, found no row", name));
  return table;
}

}  // namespace rollfix
