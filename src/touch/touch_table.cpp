#include "rollfix/touch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "log/header/log_header.hpp"
#include "log/log_table.hpp"
#include "probe_report.hpp"
#include "rollfix/error.hpp"
#include "text/number.hpp"
#include "text/text.hpp"
#include "touch_header.hpp"

namespace rollfix {
namespace touch {
namespace {

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

/// Reads rows below a header.
class TouchReader {
 public:
  TouchReader(const TableRow& row, const std::string& name, const TouchTableOptions& options)
      : header_(row, name, options), name_(name) {}

  const TouchHeader& header() const { return header_; }

  /// Throws InputError where the row has not as many cells as the header.
  void require_whole(const TableRow& row) const {
    if (row.cells.size() == header_.count()) return;
    throw InputError(fmt::format("{}: expected {} as in the header, found {}", where(name_, row.line),
                                 counted(header_.count(), "cell", "cells"), row.cells.size()));
  }

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

  bool has_contact(const TableRow& row) const {
    if (!header_.has(TouchColumn::contact)) return true;
    const std::string_view cell = row.cells[header_.cell(TouchColumn::contact)];
    const std::optional<double> value = parse_number(cell);
    if (value == 0.0 || value == 1.0) return value == 1.0;
    throw InputError(
        fmt::format("{}: column contact: expected 0 or 1, found '{}'", where(name_, row.line), shown(cell)));
  }

 private:
  /// Nothing of an empty cell, unless it is a coordinate.
  /// Without a place only a normal that was felt says something.
  void require_normal_alone(const TableRow& row, const MeasuredTouch& touch) const {
    const bool is_half = !std::isnan(touch.at.x()) || !std::isnan(touch.at.y());
    if (!is_half && touch.normal && has_contact(row)) return;
    throw InputError(fmt::format("{}: column {}: expected a number, found ''{}", where(name_, row.line),
                                 touch::name_of(std::isnan(touch.at.x()) ? TouchColumn::x : TouchColumn::y),
                                 is_half ? "" : "; a touch whose normal alone was measured has a normal"));
  }

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
    has_more = has_more || (known && known->column >= TouchColumn::normal && known->column != TouchColumn::contact);
    if (!known && lower_case(header.name) != rollfix::name_of(rollfix::Column::time)) unknown.push_back(header);
  }
  const bool may_be_of_roll = holds_columns_of(unknown, 0) || holds_columns_of(unknown, 1);
  return has_x && has_y && !has_roll && (has_more || !may_be_of_roll);
}

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
  std::optional<Vec2> last;
  bool last_has_contact = false;
  touch::each_row(text, name, options.decimal_comma, [&](const TableRow& row) {
    if (!reader) {
      reader.emplace(row, name, options);
      return true;
    }
    reader->require_whole(row);
    const MeasuredTouch touch = reader->read(row);
    const bool has_contact = reader->has_contact(row);
    if (last && !last_has_contact) table.clear.push_back({*last, touch.at});
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
  if (!reader) return table;
  touch::add_notes(table, reader->header(), free_rows, name);
  return table;
}

}  // namespace rollfix
