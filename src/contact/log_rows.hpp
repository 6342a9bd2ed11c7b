#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "contact/log_columns.hpp"
#include "contact/log_table.hpp"
#include "rollfix/contact/log.hpp"

namespace rollfix {

/// A sum that keeps what rounding drops (Neumaier 1974): a million increments add up to one rounding.
class ExactSum {
 public:
  double add(double term);

 private:
  double sum_ = 0;
  double rest_ = 0;
};

/// A number and half a unit of its last digit, 0 where it counts as exact.
struct WrittenValue {
  double value = 0;
  double half_unit = 0;

  /// The half unit of the most precise of several, of which this is another.
  void sharpen(double& rounding) const {
    if (half_unit > 0 && (rounding == 0 || half_unit < rounding)) rounding = half_unit;
  }
};

/// What the cells of a row say of one finger that touches.
struct LogRow {
  std::size_t line = 0;
  WrittenValue place;  // u, length or distance
  WrittenValue angle;  // psi, turn or dturn
  double x = 0;        // where the log has them
  double y = 0;
};

/// Reads one finger's cells of the rows of a table.
class RowParser {
 public:
  /// `log`: its name, for messages.
  RowParser(std::string log, const Columns& columns) : name_(std::move(log)), columns_(columns) {}

  /// Whether the finger touches the part in this row; it does where nothing is said.
  bool touches(const TableRow& row) const;

  /// The row's time, nothing where the log has none. Throws InputError unless it is after that of the last `keep`.
  std::optional<double> time(const TableRow& row) const;
  void keep(const std::optional<double>& time, std::size_t line);

  /// What a row says in which there is contact.
  LogRow parse(const TableRow& row) const;

  /// Throws InputError when the row has more cells than the table has columns.
  void require_width(const TableRow& row) const;

  const Columns& columns() const { return columns_; }

 private:
  [[noreturn]] void refuse(const TableRow& row, Column column, std::string_view cell, const char* why) const;
  std::string_view cell(const TableRow& row, Column column) const;
  double number(const TableRow& row, Column column) const;
  WrittenValue written(const TableRow& row, Column column) const;

  std::string name_;
  Columns columns_;
  double time_ = 0;
  std::size_t time_line_ = 0;  // 0: there was none
};

/// How the rows of a log without u and psi are measured from the first contact of their roll. That lies before the
/// log's first row. A later roll's first row is its own first contact: what was counted while the finger was off the
/// part does not count.
class Odometer {
 public:
  Odometer(LogKind kind, bool is_later_roll) : kind_(kind), starts_here_(is_later_roll) {}

  /// Length and turn up to this row, lengths along the outline as the user gave it.
  Reading add(const LogRow& row);

 private:
  LogKind kind_;
  bool starts_here_;
  Reading start_;
  ExactSum length_;
  ExactSum turn_;
};

/// One finger's rows of one roll.
class LogRows {
 public:
  LogRows(const std::string& name, const Columns& columns, bool is_later_roll);

  /// Takes a row in which there is contact.
  void add(const LogRow& row, const std::optional<double>& time);

  Log& log() { return log_; }

 private:
  bool has_centre_;
  Log log_;
  Odometer odometer_;
};

}  // namespace rollfix
