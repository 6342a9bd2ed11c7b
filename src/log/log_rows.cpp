#include "log/log_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "log/header/log_header.hpp"
#include "rollfix/error.hpp"
#include "text/number.hpp"
#include "text/text.hpp"

// Notation:
//   written         a number and half a unit of its last digit, in radians, seconds or the part's unit: WrittenValue
//   place, angle    u and psi, length and turn, or distance and dturn of one finger's row: FingerCells
//   off, touching   a row in which not every finger touches, and one in which all do: RowKind
// Follows docs/rolling.md, "Logs", "Digits".
// Idea: a line is cut into cells, the first one that is no comment is a header or shows that there is none, all others
// are rows. A row changes nothing before accept(): what is refused leaves the reader as it was.
namespace rollfix {

namespace {

/// Throws InputError that names the first of the finger's numbers that is not finite by its column.
void require_finite(const std::string& log, std::size_t line, const Columns& columns, const Touch& touch) {
  const auto require = [&](Column column, double value) {
    if (std::isfinite(value)) return;
    throw InputError(
        fmt::format("{}: {} is {}, expected a finite number", where(log, line), columns.called(column), value));
  };
  require(Column::u, touch.u);
  require(Column::psi, touch.psi);
  require(Column::x, touch.x.value_or(0));
  require(Column::y, touch.y.value_or(0));
}

/// The columns of rows of numbers, in the order of a file.
std::vector<Columns> columns_of(const std::optional<double>& time, const PerFinger<Touch>& fingers) {
  std::vector<Columns> result;
  for (std::size_t k = 0; k < fingers.size(); ++k) {
    Columns& columns = result.emplace_back();
    if (fingers.size() > 1) columns.suffix = kFingerSuffixes[k];
    // Cells are counted from 0 as they are added.
    const auto add = [&](Column column) { columns.cell[static_cast<std::size_t>(column)] = columns.count++; };
    if (time) add(Column::time);
    add(Column::u);
    add(Column::psi);
    if (fingers[k].x) add(Column::x);
    if (fingers[k].y) add(Column::y);
  }
  return result;
}

}  // namespace

void ColumnRounding::add(const WrittenValue& written) {
  // Whole numbers and zeros count as exact.
  if (!(written.half_unit > 0)) return;
  if (finest_ == 0 || written.half_unit < finest_) finest_ = written.half_unit;
  if (written.value == 0) return;
  // Powers of ten of the first and of the last digit that is written: between them lie the significant digits.
  const double first = std::floor(std::log10(std::abs(written.value)));
  const double last = std::round(std::log10(2 * written.half_unit));
  digits_ = std::max(digits_, first - last + 1);
  largest_ = is_empty_ ? first : std::max(largest_, first);
  is_empty_ = false;
}

double ColumnRounding::value() const {
  // All numbers are 0: only decimals say how precise they are.
  if (is_empty_) return finest_;
  // Half a unit of the last digit that the largest number would have with `digits_` significant ones.
  return std::max(finest_, 0.5 * std::pow(10.0, largest_ + 1 - digits_));
}

/// Throws InputError: rows come as lines and as numbers by turns.
void RowReader::come_from(Source source) {
  // The first row decides.
  if (source_ == Source::unknown) source_ = source;
  if (source_ == source) return;
  throw InputError(fmt::format("{}: rows came as {} so far, expected that to go on", name_,
                               source_ == Source::lines ? "lines of text" : "numbers"));
}

/// Order matters: what the line is, then its width, whether the fingers touch, its time, and the cells only of a row in
/// which all touch. So a row without contact may hold anything in the others.
RowKind RowReader::read(std::string_view line, LogRow& row) {
  come_from(Source::lines);
  if (++lines_ == 1) line = plain_beginning(line, name_);
  if (!line.empty() && line.back() == '\n') line.remove_suffix(1);
  // After a dropped connection the table may be separated otherwise.
  if (header_may_come_) cutter_.forget();
  if (!cutter_.cut(line, lines_, table_row_)) return RowKind::none;
  if (take_header()) return RowKind::none;
  require_width();
  row.line = lines_;
  // Every finger's own column `contact`; without one it touches.
  const auto touching =
      std::count_if(columns_.begin(), columns_.end(), [&](const Columns& columns) { return touches(columns); });
  row.time = time();
  // Not all of them touch: no finger is measured.
  if (static_cast<std::size_t>(touching) < columns_.size()) return RowKind::off;
  row.fingers = PerFinger<FingerCells>::of(columns_.size());
  for (std::size_t k = 0; k < columns_.size(); ++k) row.fingers[k] = cells(columns_[k]);
  return RowKind::touching;
}

/// Whether the row says what the columns are, rather than what is in them. Takes the columns of the first row, and of a
/// header that comes again, whose kind of log has to be the same.
bool RowReader::take_header() {
  const bool may_come = columns_.empty() || header_may_come_;
  if (!may_come) return false;
  // A wheel's log begins with a header, and goes on without one.
  const bool may_be_bare = !of_pin_ || !columns_.empty();
  if (may_be_bare && is_data(table_row_)) {
    // Numbers first: two columns without a header. The row itself is data.
    if (columns_.empty()) columns_ = {bare_columns(table_row_, name_, options_)};
    return false;
  }
  // A header that comes again may have its columns in another order, but has to be of the same kind of log.
  std::vector<Columns> found = of_pin_ ? std::vector{pin_columns_of(table_row_, name_, options_)}
                                       : rollfix::columns_of(table_row_, name_, options_);
  if (!columns_.empty() && (found.size() != columns_.size() || found.front().kind != kind())) {
    throw InputError(fmt::format("{}: the header '{}' is of another kind of log than the one before it",
                                 where(name_, table_row_.line), shown(table_row_.text)));
  }
  columns_ = std::move(found);
  header_may_come_ = false;
  // A header that comes again may have another clock: the next time need not be later.
  time_line_ = 0;
  return true;
}

RowKind RowReader::read(const std::optional<double>& time, const std::optional<PerFinger<Touch>>& fingers,
                        LogRow& row) {
  come_from(Source::numbers);
  ++lines_;
  // The first row of numbers plays the header's part: it says which columns there are.
  require_same_columns(time, fingers);
  if (time && !std::isfinite(*time)) {
    throw InputError(fmt::format("{}: time is {}, expected a finite number", where(name_, lines_), *time));
  }
  if (time) require_later(*time, fmt::format("{}", *time), lines_);
  row.line = lines_;
  row.time = time;
  if (!fingers) return RowKind::off;
  row.fingers = PerFinger<FingerCells>::of(fingers->size());
  for (std::size_t k = 0; k < fingers->size(); ++k) {
    const Touch& touch = (*fingers)[k];
    require_finite(name_, lines_, columns_[k], touch);
    // Numbers have no digits: they count as exact.
    row.fingers[k] = {{touch.u, 0}, {touch.psi, 0}, touch.x.value_or(0), touch.y.value_or(0)};
    turn_to_part(row.fingers[k]);
  }
  return RowKind::touching;
}

/// Throws InputError unless the row has what the first one had, which says what all have.
void RowReader::require_same_columns(const std::optional<double>& time,
                                     const std::optional<PerFinger<Touch>>& fingers) {
  // Before the first contact nothing is known of the columns.
  if (!fingers && columns_.empty()) return;
  // A row without contact has no columns but its time: those that are known.
  const std::vector<Columns> found = fingers ? columns_of(time, *fingers) : columns_;
  for (const Columns& columns : found) {
    // A centre has both coordinates.
    if (columns.has(Column::x) == columns.has(Column::y)) continue;
    throw InputError(fmt::format("{}: found only one of x and y, expected both or neither", where(name_, lines_)));
  }
  if (columns_.empty()) columns_ = found;
  const bool has_time = columns_.front().has(Column::time);
  if (time.has_value() != has_time) {
    throw InputError(fmt::format("{}: found a row {} time, expected one {}, as the first row", where(name_, lines_),
                                 has_time ? "without" : "with", has_time ? "with" : "without"));
  }
  const bool is_same = found.size() == columns_.size() &&
                       std::equal(found.begin(), found.end(), columns_.begin(),
                                  [](const Columns& a, const Columns& b) { return a.cell == b.cell; });
  if (is_same) return;
  throw InputError(
      fmt::format("{}: expected a row of as many fingers as the first row, with x and y where that has them",
                  where(name_, lines_)));
}

/// Only from here on the row counts for the rows after it.
void RowReader::accept(const LogRow& row) {
  header_may_come_ = false;
  if (!row.time) return;
  time_ = *row.time;
  time_line_ = row.line;
}

bool RowReader::has_centre() const {
  return std::all_of(columns_.begin(), columns_.end(), [](const Columns& columns) { return columns.has(Column::x); });
}

/// The cell's text. Throws InputError: it is missing or empty.
std::string_view RowReader::cell(const Columns& columns, Column column) const {
  const std::size_t k = columns[column];
  if (k < table_row_.cells.size() && !table_row_.cells[k].empty()) return table_row_.cells[k];
  throw InputError(fmt::format("{}: '{}' has no {}, expected a number in column {}", where(name_, lines_),
                               shown(table_row_.text), columns.called(column), k + 1));
}

/// The number in a cell and half a unit of its last digit, both converted. Angles may be written as in 73deg, which
/// goes before the column's unit. Throws InputError: no finite number.
WrittenValue RowReader::written(const Columns& columns, Column column) const {
  const std::string_view text = cell(columns, column);
  const Conversion& convert = columns.conversion_of(column);
  const bool is_length = column == Column::u && columns.u_dimension == Dimension::length;
  const bool may_say_degrees = is_angle(column) && !is_length;
  // A plain number is in the column's unit; with a unit of its own it is an angle.
  const auto number = parse_number(text);
  const auto value = number ? convert(*number) : may_say_degrees ? parse_angle(text) : std::nullopt;
  if (value && std::isfinite(*value)) return {*value, number ? convert(rounding_of(text)) : rounding_of(text)};
  // 1,5: the message says how decimal commas are read.
  const std::string comma = decimal_comma_hint(text);
  throw InputError(fmt::format("{}: {} is '{}', expected a {}number{}{}{}", where(name_, lines_),
                               columns.called(column), shown(text), value ? "finite " : "",
                               may_say_degrees ? " such as 1.25 (radians) or 73deg" : " such as 1.25", comma,
                               comma.empty() ? "" : "; `decimal_comma` takes them"));
}

/// Whether the finger touches by its column `contact`; without that column it always does.
bool RowReader::touches(const Columns& columns) const {
  if (!columns.has(Column::contact)) return true;
  const std::string_view text = cell(columns, Column::contact);
  const auto value = parse_number(text);
  if (value && (*value == 0 || *value == 1)) return *value == 1;
  throw InputError(fmt::format("{}: {} is '{}', expected 0 or 1", where(name_, lines_), columns.called(Column::contact),
                               shown(text)));
}

/// Seconds; nothing in a log without times. Throws NotLater: not after the last row that was accepted.
std::optional<double> RowReader::time() const {
  const Columns& columns = columns_.front();
  if (!columns.has(Column::time)) return std::nullopt;
  const double time = number(columns, Column::time);
  require_later(time, cell(columns, Column::time), lines_);
  return time;
}

/// Times have to grow strictly. `written`: as it stands in the log.
void RowReader::require_later(double time, std::string_view written, std::size_t line) const {
  if (time_line_ == 0 || time > time_) return;
  throw NotLater(fmt::format("{}: time is '{}', expected more than {} in line {}: time must grow", where(name_, line),
                             shown(written), time_, time_line_));
}

/// What the row says of one finger. A pin has no place of contact, and without an encoder no angle: these stay 0.
FingerCells RowReader::cells(const Columns& columns) const {
  // The pair that this kind of log has.
  const auto [place, angle] = kColumnPairs[static_cast<std::size_t>(columns.kind)];
  FingerCells result;
  if (!columns.of_pin) result.place = written(columns, place);
  if (columns.has(angle)) result.angle = written(columns, angle);
  if (columns.has(Column::x)) {
    result.x = number(columns, Column::x);
    result.y = number(columns, Column::y);
  }
  turn_to_part(result);
  return result;
}

/// The row as it would be on the part as it was drawn: see LogOptions::mirrored and `clockwise`. Angles u and psi say
/// themselves which way the finger rolled.
void RowReader::turn_to_part(FingerCells& cells) const {
  if (options_.mirrored) {
    cells.place.value = -cells.place.value;
    cells.angle.value =
        (kind() == LogKind::contact ? std::numbers::pi : 0) - cells.angle.value;  // a direction or a turn
    cells.x = -cells.x;
  }
  // Of lengths only: a turn has its sign by itself.
  if (options_.clockwise && kind() != LogKind::contact) cells.place.value = -cells.place.value;
}

/// Throws InputError when the row has more cells than the table has columns.
void RowReader::require_width() const {
  const std::size_t count = columns_.front().count;
  // Empty cells at the end are no cells.
  for (std::size_t k = count; k < table_row_.cells.size(); ++k) {
    if (table_row_.cells[k].empty()) continue;
    throw InputError(fmt::format("{}: '{}' has {} cells, expected {} as in the first row; {}", where(name_, lines_),
                                 shown(table_row_.text), table_row_.cells.size(), count,
                                 options_.decimal_comma == true
                                     ? "beside decimal commas cells are separated by semicolons, tabs or blanks"
                                     : "numbers take a decimal point, not a comma"));
  }
}

std::string where(const Log& log, std::size_t finger, std::size_t row) {
  const FingerRows& rows = log.fingers[finger];
  const std::string& name = rows.name.empty() ? log.name : rows.name;
  return row < rows.line.size() ? where(name, rows.line[row]) : fmt::format("{}, row {}", name, row + 1);
}

void require_unit_of_u(const std::optional<Dimension>& dimension, const Finger* finger, const std::string& log) {
  if (!dimension || finger == nullptr || finger->is_disk() == (*dimension == Dimension::angle)) return;
  // Of a disk u is an angle, of a jaw or an outline a length: the message says how to convert.
  if (finger->is_disk()) {
    throw InputError(fmt::format(
        "{}: u is in a unit of length, and of a disk it is the contact's angle: expected radians or degrees, which is "
        "the length on the skin divided by the radius; or give the finger as an outline",
        log));
  }
  throw InputError(fmt::format(
      "{}: u is in a unit of an angle, and of a jaw or an outline it is the place along it: expected a length", log));
}

}  // namespace rollfix
