#include "contact/log_rows.hpp"

#include <fmt/format.h>

#include <cmath>

#include "rollfix/contact/written_number.hpp"
#include "rollfix/error.hpp"
#include "text/number.hpp"

namespace rollfix {

double ExactSum::add(double term) {
  const double next = sum_ + term;
  rest_ += std::abs(sum_) >= std::abs(term) ? (sum_ - next) + term : (term - next) + sum_;
  sum_ = next;
  return sum_ + rest_;
}

void RowParser::refuse(const TableRow& row, Column column, std::string_view cell, const char* why) const {
  throw InputError(fmt::format("{}: {} is '{}', {}{}", where(name_, row.line), columns_.called(column), shown(cell),
                               why, is_angle(column) ? " such as 1.25 (radians) or 73deg" : " such as 1.25"));
}

std::string_view RowParser::cell(const TableRow& row, Column column) const {
  const std::size_t k = columns_[column];
  if (k < row.cells.size() && !row.cells[k].empty()) return row.cells[k];
  throw InputError(fmt::format("{}: '{}' has no {}, expected a number in column {}", where(name_, row.line),
                               shown(row.text), columns_.called(column), k + 1));
}

double RowParser::number(const TableRow& row, Column column) const {
  const std::string_view text = cell(row, column);
  const auto value = is_angle(column) ? parse_angle(text) : parse_number(text);
  if (!value) refuse(row, column, text, "expected a number");
  if (!std::isfinite(*value)) refuse(row, column, text, "expected a finite number");
  return *value;
}

bool RowParser::touches(const TableRow& row) const {
  if (!columns_.has(Column::contact)) return true;
  const std::string_view text = cell(row, Column::contact);
  const auto value = parse_number(text);
  if (value && (*value == 0 || *value == 1)) return *value == 1;
  throw InputError(fmt::format("{}: {} is '{}', expected 0 or 1", where(name_, row.line),
                               columns_.called(Column::contact), shown(text)));
}

std::optional<double> RowParser::time(const TableRow& row) const {
  if (!columns_.has(Column::time)) return std::nullopt;
  const double time = number(row, Column::time);
  if (time_line_ != 0 && !(time > time_)) {
    throw InputError(fmt::format("{}: time is '{}', expected more than {} in line {}: time must grow",
                                 where(name_, row.line), shown(cell(row, Column::time)), time_, time_line_));
  }
  return time;
}

void RowParser::keep(const std::optional<double>& time, std::size_t line) {
  if (!time) return;
  time_ = *time;
  time_line_ = line;
}

WrittenValue RowParser::written(const TableRow& row, Column column) const {
  return {number(row, column), rounding_of(cell(row, column))};
}

LogRow RowParser::parse(const TableRow& row) const {
  LogRow result;
  result.line = row.line;
  switch (columns_.kind) {
    case LogKind::contact:
      result.place = written(row, Column::u);
      result.angle = written(row, Column::psi);
      break;
    case LogKind::travelled:
      result.place = written(row, Column::length);
      result.angle = written(row, Column::turn);
      break;
    case LogKind::increments:
      result.place = written(row, Column::distance);
      result.angle = written(row, Column::dturn);
      break;
  }
  if (columns_.has(Column::x)) {
    result.x = number(row, Column::x);
    result.y = number(row, Column::y);
  }
  return result;
}

void RowParser::require_width(const TableRow& row) const {
  for (std::size_t k = columns_.count; k < row.cells.size(); ++k) {
    if (row.cells[k].empty()) continue;
    throw InputError(
        fmt::format("{}: '{}' has {} cells, expected {} as in the first row; numbers take a decimal point, not a comma",
                    where(name_, row.line), shown(row.text), row.cells.size(), columns_.count));
  }
}

Reading Odometer::add(const LogRow& row) {
  const bool is_first_contact = starts_here_;
  starts_here_ = false;
  if (kind_ == LogKind::increments) {
    return is_first_contact ? Reading{} : Reading{length_.add(row.place.value), turn_.add(row.angle.value)};
  }
  if (is_first_contact) start_ = {row.place.value, row.angle.value};
  return {row.place.value - start_.length[0], row.angle.value - start_.turn};
}

LogRows::LogRows(const std::string& name, const Columns& columns, bool is_later_roll)
    : has_centre_(columns.has(Column::x)), odometer_(columns.kind, is_later_roll) {
  log_.name = name;
  log_.kind = columns.kind;
}

void LogRows::add(const LogRow& row, const std::optional<double>& time) {
  row.place.sharpen(log_.place_rounding);
  row.angle.sharpen(log_.angle_rounding);
  if (log_.kind == LogKind::contact) {
    log_.u.push_back(row.place.value);
    log_.psi.push_back(row.angle.value);
  } else {
    const Reading reading = odometer_.add(row);
    log_.length.push_back(reading.length[0]);
    log_.turn.push_back(reading.turn);
  }
  if (time) log_.time.push_back(*time);
  if (has_centre_) {
    log_.x.push_back(row.x);
    log_.y.push_back(row.y);
  }
  log_.line.push_back(row.line);
}

}  // namespace rollfix
