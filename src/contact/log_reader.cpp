#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

#include "contact/log_columns.hpp"
#include "contact/log_table.hpp"
#include "outline/number.hpp"
#include "outline/text_file.hpp"
#include "rollfix/contact/log.hpp"
#include "rollfix/contact/written_number.hpp"
#include "rollfix/error.hpp"

namespace rollfix {

namespace {

/// A sum that keeps what rounding drops (Neumaier 1974): a million increments add up to one rounding.
class ExactSum {
 public:
  double add(double term) {
    const double next = sum_ + term;
    rest_ += std::abs(sum_) >= std::abs(term) ? (sum_ - next) + term : (term - next) + sum_;
    sum_ = next;
    return sum_ + rest_;
  }

 private:
  double sum_ = 0;
  double rest_ = 0;
};

/// Goes through the rows after the header.
class LogReader {
 public:
  LogReader(TableReader& reader, const Columns& columns) : reader_(reader), columns_(columns) {
    log_.name = reader.name();
    log_.kind = columns.kind;
  }

  void take(const TableRow& row) {
    require_width(row);
    const bool touches = !columns_.has(Column::contact) || contact(row);
    if (columns_.has(Column::time)) require_growing(row);
    if (!touches) {
      if (log_.rows() > 0 && lost_line_ == 0) lost_line_ = row.line;
      return;
    }
    if (lost_line_ != 0) {
      throw InputError(fmt::format(
          "{}: contact is lost here and found again in line {}, expected one unbroken roll; split the log there",
          reader_.where(lost_line_), row.line));
    }
    add(row);
  }

  Log finish() {
    const std::size_t least = log_.kind == LogKind::contact ? 2 : 1;
    if (log_.rows() < least) {
      throw InputError(fmt::format("{}: holds {} row{} of a roll{}, expected at least {}", reader_.name(), log_.rows(),
                                   log_.rows() == 1 ? "" : "s", log_.rows() == 0 && any_row_ ? " in contact" : "",
                                   least == 2 ? "2: the first contact and where it went from there" : "1"));
    }
    return std::move(log_);
  }

 private:
  void require_width(const TableRow& row) {
    any_row_ = true;
    for (std::size_t k = columns_.count; k < row.cells.size(); ++k) {
      if (row.cells[k].empty()) continue;
      throw InputError(fmt::format(
          "{}: '{}' has {} cells, expected {} as in the first row; numbers take a decimal point, not a comma",
          reader_.where(row.line), shown(row.text), row.cells.size(), columns_.count));
    }
  }

  [[noreturn]] void refuse(const TableRow& row, Column column, std::string_view cell, const char* why) const {
    throw InputError(fmt::format("{}: {} is '{}', {}{}", reader_.where(row.line), name_of(column), shown(cell), why,
                                 is_angle(column) ? " such as 1.25 (radians) or 73deg" : " such as 1.25"));
  }

  std::string_view cell(const TableRow& row, Column column) const {
    const std::size_t k = columns_[column];
    if (k < row.cells.size() && !row.cells[k].empty()) return row.cells[k];
    throw InputError(fmt::format("{}: '{}' has no {}, expected a number in column {}", reader_.where(row.line),
                                 shown(row.text), name_of(column), k + 1));
  }

  double number(const TableRow& row, Column column) const {
    const std::string_view text = cell(row, column);
    const auto value = is_angle(column) ? parse_angle(text) : parse_number(text);
    if (!value) refuse(row, column, text, "expected a number");
    if (!std::isfinite(*value)) refuse(row, column, text, "expected a finite number");
    return *value;
  }

  bool contact(const TableRow& row) const {
    const std::string_view text = cell(row, Column::contact);
    const auto value = parse_number(text);
    if (value && (*value == 0 || *value == 1)) return *value == 1;
    throw InputError(fmt::format("{}: contact is '{}', expected 0 or 1", reader_.where(row.line), shown(text)));
  }

  void require_growing(const TableRow& row) {
    const double time = number(row, Column::time);
    if (time_line_ != 0 && !(time > time_)) {
      throw InputError(fmt::format("{}: time is '{}', expected more than {} in line {}: time must grow",
                                   reader_.where(row.line), shown(cell(row, Column::time)), time_, time_line_));
    }
    time_ = time;
    time_line_ = row.line;
  }

  /// The number, and half a unit of its last digit where that is less than all before.
  double precise(const TableRow& row, Column column, double& rounding) const {
    const double half_unit = rounding_of(cell(row, column));
    if (half_unit > 0 && (rounding == 0 || half_unit < rounding)) rounding = half_unit;
    return number(row, column);
  }

  void add(const TableRow& row) {
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
    if (columns_.has(Column::time)) log_.time.push_back(time_);
    if (columns_.has(Column::x)) {
      log_.x.push_back(number(row, Column::x));
      log_.y.push_back(number(row, Column::y));
    }
    log_.line.push_back(row.line);
  }

  TableReader& reader_;
  const Columns& columns_;
  Log log_;
  ExactSum length_;
  ExactSum turn_;
  double time_ = 0;
  std::size_t time_line_ = 0;  // 0: there was none
  std::size_t lost_line_ = 0;
  bool any_row_ = false;
};

}  // namespace

Log parse_log(std::string_view text, const std::string& name) {
  TableReader reader(text, name);
  TableRow row;
  if (!reader.next(row)) {
    throw InputError(fmt::format("{}: is empty, expected a log with a header such as 'time,u,psi'", name));
  }
  const bool is_bare = is_data(row);
  const Columns columns = is_bare ? bare_columns(row, reader) : columns_of(row, reader);
  LogReader log(reader, columns);
  if (is_bare) log.take(row);
  while (reader.next(row)) log.take(row);
  return log.finish();
}

Log read_log(const std::string& path) { return parse_log(read_text(path), path == "-" ? "standard input" : path); }

}  // namespace rollfix
