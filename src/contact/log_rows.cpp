#include "contact/log_rows.hpp"

#include <fmt/format.h>

#include <cmath>

#include "outline/number.hpp"
#include "rollfix/contact/written_number.hpp"
#include "rollfix/error.hpp"

namespace rollfix {

double ExactSum::add(double term) {
  const double next = sum_ + term;
  rest_ += std::abs(sum_) >= std::abs(term) ? (sum_ - next) + term : (term - next) + sum_;
  sum_ = next;
  return sum_ + rest_;
}

LogRows::LogRows(const TableReader& reader, const Columns& columns) : reader_(&reader), columns_(columns) {
  log_.name = reader.name();
  log_.kind = columns.kind;
}

void LogRows::refuse(const TableRow& row, Column column, std::string_view cell, const char* why) const {
  throw InputError(fmt::format("{}: {} is '{}', {}{}", reader_->where(row.line), columns_.called(column), shown(cell),
                               why, is_angle(column) ? " such as 1.25 (radians) or 73deg" : " such as 1.25"));
}

std::string_view LogRows::cell(const TableRow& row, Column column) const {
  const std::size_t k = columns_[column];
  if (k < row.cells.size() && !row.cells[k].empty()) return row.cells[k];
  throw InputError(fmt::format("{}: '{}' has no {}, expected a number in column {}", reader_->where(row.line),
                               shown(row.text), columns_.called(column), k + 1));
}

double LogRows::number(const TableRow& row, Column column) const {
  const std::string_view text = cell(row, column);
  const auto value = is_angle(column) ? parse_angle(text) : parse_number(text);
  if (!value) refuse(row, column, text, "expected a number");
  if (!std::isfinite(*value)) refuse(row, column, text, "expected a finite number");
  return *value;
}

bool LogRows::touches(const TableRow& row) const {
  if (!columns_.has(Column::contact)) return true;
  const std::string_view text = cell(row, Column::contact);
  const auto value = parse_number(text);
  if (value && (*value == 0 || *value == 1)) return *value == 1;
  throw InputError(fmt::format("{}: {} is '{}', expected 0 or 1", reader_->where(row.line),
                               columns_.called(Column::contact), shown(text)));
}

std::optional<double> LogRows::time(const TableRow& row) {
  if (!columns_.has(Column::time)) return std::nullopt;
  const double time = number(row, Column::time);
  if (time_line_ != 0 && !(time > time_)) {
    throw InputError(fmt::format("{}: time is '{}', expected more than {} in line {}: time must grow",
                                 reader_->where(row.line), shown(cell(row, Column::time)), time_, time_line_));
  }
  time_ = time;
  time_line_ = row.line;
  return time;
}

/// The number, and half a unit of its last digit where that is less than all before.
double LogRows::precise(const TableRow& row, Column column, double& rounding) const {
  const double half_unit = rounding_of(cell(row, column));
  if (half_unit > 0 && (rounding == 0 || half_unit < rounding)) rounding = half_unit;
  return number(row, column);
}

void LogRows::add(const TableRow& row, const std::optional<double>& time) {
  switch (log_.kind) {
    case LogKind::contact:
      log_.u.push_back(precise(row, Column::u, log_.place_rounding));
      log_.psi.push_back(precise(row, Column::psi, log_.angle_rounding));
      break;
    case LogKind::travelled:
      log_.length.push_back(precise(row, Column::length, log_.place_rounding));
      log_.turn.push_back(precise(row, Column::turn, log_.angle_rounding));
      break;
    case LogKind::increments:
      log_.length.push_back(length_.add(precise(row, Column::distance, log_.place_rounding)));
      log_.turn.push_back(turn_.add(precise(row, Column::dturn, log_.angle_rounding)));
      break;
  }
  if (time) log_.time.push_back(*time);
  if (columns_.has(Column::x)) {
    log_.x.push_back(number(row, Column::x));
    log_.y.push_back(number(row, Column::y));
  }
  log_.line.push_back(row.line);
}

}  // namespace rollfix
