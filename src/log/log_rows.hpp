#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "log/log_table.hpp"
#include "rollfix/curve.hpp"
#include "rollfix/error.hpp"
#include "rollfix/log.hpp"

namespace rollfix {

/// The columns with a number of each row: what takes rows out of a log or chooses some goes through these.
inline constexpr std::array<std::vector<double> FingerRows::*, 8> kRowColumns = {
    &FingerRows::u, &FingerRows::psi, &FingerRows::length,   &FingerRows::turn,
    &FingerRows::x, &FingerRows::y,   &FingerRows::distance, &FingerRows::dturn};

/// A number and half a unit of its last digit, 0 where it counts as exact.
struct WrittenValue {
  double value = 0;
  double half_unit = 0;
};

/// How far the digits of a column may be off, as it grows. Trailing zeros are often left off, so all numbers are taken
/// to be written alike: with as many decimals as the one that shows most of them, or, where that one is small and the
/// large ones don't show them, with as many significant digits as any.
class ColumnRounding {
 public:
  void add(const WrittenValue& written);
  /// Half a unit of the last digit of the largest; 0 where all are exact.
  double value() const;

 private:
  double finest_ = 0;     // half a unit of the finest last digit so far; 0: all numbers are exact
  double digits_ = 0;     // significant ones, of the number that has most
  double largest_ = 0;    // power of ten of the largest number's first digit
  bool is_empty_ = true;  // of numbers that are not 0 and show digits
};

/// Of one finger.
struct FingerRounding {
  ColumnRounding place;  // of u, length or distance
  ColumnRounding angle;  // of psi, turn or dturn
};

/// What a row says of one finger that touches.
struct FingerCells {
  WrittenValue place;  // u, length or distance
  WrittenValue angle;  // psi, turn or dturn
  double x = 0;        // where the log has them
  double y = 0;
};

/// What a line of a log is.
enum class RowKind {
  none,     // a comment, a blank line, a header
  off,      // a row in which not every finger touches
  touching  // one in which all do
};

/// A row of all fingers.
struct LogRow {
  std::size_t line = 0;            // of the log, from 1
  std::optional<double> time;      // seconds, where the log has times
  PerFinger<FingerCells> fingers;  // of a row that touches
};

/// A row's time is not after that of the row before.
class NotLater : public InputError {
 public:
  using InputError::InputError;
};

/// Reads the rows of a log of one finger or of two, from its lines or as numbers: the one place in which headers, cells
/// and times are judged, of a file as of a stream.
class RowReader {
 public:
  /// `name`: of the log, for messages.
  /// `of_pin`: the log of a wheel without skin.
  explicit RowReader(std::string name, LogOptions options = {}, bool of_pin = false)
      : name_(std::move(name)), options_(std::move(options)), of_pin_(of_pin), cutter_(options_.decimal_comma) {}

  /// The next line. Throws InputError: before the columns are known because they can't be, later because of this line
  /// only. A row leaves no trace before it is accepted.
  RowKind read(std::string_view line, LogRow& row);

  /// The next row as numbers: `fingers` is nothing where not every finger touches. Throws InputError likewise.
  RowKind read(const std::optional<double>& time, const std::optional<PerFinger<Touch>>& fingers, LogRow& row);

  /// This row counts: the next one has to be later, and no header comes any more.
  void accept(const LogRow& row);

  /// A header may come again, of the same kind of log; with it a clock that was set anew.
  void resume() { header_may_come_ = knows_columns(); }

  bool knows_columns() const { return !columns_.empty(); }
  const std::vector<Columns>& columns() const { return columns_; }  // of each finger; they must be known
  LogKind kind() const { return columns_.front().kind; }
  bool has_centre() const;
  std::size_t lines() const { return lines_; }
  /// As it was read last.
  const TableRow& row() const { return table_row_; }
  const std::string& name() const { return name_; }
  const std::string& unit() const { return options_.unit; }  // of lengths; empty: not known

 private:
  enum class Source { unknown, lines, numbers };

  /// What is wrong with a row throws InputError, with the log's name.
  void come_from(Source source);
  bool take_header();
  void require_same_columns(const std::optional<double>& time, const std::optional<PerFinger<Touch>>& fingers);
  void require_width() const;
  bool touches(const Columns& columns) const;
  std::optional<double> time() const;
  std::string_view cell(const Columns& columns, Column column) const;
  double number(const Columns& columns, Column column) const { return written(columns, column).value; }
  WrittenValue written(const Columns& columns, Column column) const;
  FingerCells cells(const Columns& columns) const;
  void turn_to_part(FingerCells& cells) const;
  void require_later(double time, std::string_view written, std::size_t line) const;

  std::string name_;
  LogOptions options_;
  bool of_pin_ = false;
  Source source_ = Source::unknown;
  TableCutter cutter_;
  TableRow table_row_;
  std::vector<Columns> columns_;  // of each finger; none before they are known
  std::size_t lines_ = 0;         // seen so far
  bool header_may_come_ = false;  // a connection dropped: until the next row that is accepted
  double time_ = 0;               // of the last row that was accepted, seconds
  std::size_t time_line_ = 0;     // 0: there was none
};

/// A row for messages: "run.csv:12". Simulated rows have no lines: "the roll on cam, row 12".
std::string where(const Log& log, std::size_t finger, std::size_t row);

/// What the options say of one of two files.
LogOptions options_for_finger(const LogOptions& options, std::size_t finger);

// Two clocks' readings of one instant may differ by this share of the roll's duration: rounding, not a delay.
inline constexpr double kSameInstant = 1e-9;

/// Throws InputError where a log says that u is an angle, or a length, and of this finger it is the other.
void require_unit_of_u(const std::optional<Dimension>& dimension, const Finger* finger, const std::string& log);

/// Throws InputError where rows of a log of u and psi are so far apart that a column may be wrapped or not, and nobody
/// said which.
void require_clear(const Log& log, std::size_t which, const Finger& finger);

/// How near to a corner of its finger the contact of such a row may be on it, length: by its digits, or by the noise.
double reach_of_corners(double place_rounding, const Noise& noise);

}  // namespace rollfix
