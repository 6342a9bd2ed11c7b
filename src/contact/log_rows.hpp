#pragma once

#include <cstddef>
#include <optional>
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

/// One finger's part of a table, cell by cell. The reader must stay.
class LogRows {
 public:
  LogRows(const TableReader& reader, const Columns& columns);

  /// Whether the finger touches the part in this row; it does where nothing is said.
  bool touches(const TableRow& row) const;

  /// The row's time, nothing where the log has none. Throws InputError unless times grow.
  std::optional<double> time(const TableRow& row);

  /// Takes a row in which there is contact.
  void add(const TableRow& row, const std::optional<double>& time);

  const Columns& columns() const { return columns_; }
  Log& log() { return log_; }

 private:
  [[noreturn]] void refuse(const TableRow& row, Column column, std::string_view cell, const char* why) const;
  std::string_view cell(const TableRow& row, Column column) const;
  double number(const TableRow& row, Column column) const;
  double precise(const TableRow& row, Column column, double& rounding) const;

  const TableReader* reader_;
  Columns columns_;
  Log log_;
  ExactSum length_;
  ExactSum turn_;
  double time_ = 0;
  std::size_t time_line_ = 0;  // 0: there was none
};

}  // namespace rollfix
