#include "log/log_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "log/header/log_header.hpp"
#include "rollfix/error.hpp"
#include "text/number.hpp"

namespace rollfix {

namespace {

/// The first of several numbers that is not finite, by its column.
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
    const auto add = [&](Column column) { columns.cell[static_cast<std::size_t>(column)] = columns.count++; };
    if (time) add(Column::time);
    add(Column::u);
    add(Column::psi);
    if (fingers[k].x) add(Column::x);
    if (fingers[k].y) add(Column::y);
  }
  return result;
}

// A wrapped column can seem this much wider than its period: the rounding of its own 2 pi, in periods.
constexpr double kWrapSlack = 2e-10;

/// `range`: of all angles, of which there are so many.
bool may_be_wrapped(const Interval& range, std::size_t count, double rounding, double period) {
  if (count < 2 || !std::isfinite(period)) return false;
  const double slack = 2 * rounding + kWrapSlack * period;
  if (!(range.width() <= period + slack)) return false;
  if (count > 2) return true;
  const bool is_symmetric = range.lo >= -period / 2 - slack && range.hi <= period / 2 + slack;
  const bool is_positive = range.lo >= -slack && range.hi <= period + slack;
  return is_symmetric || is_positive;
}

// Rows this near together, as a share of a turn, show by their steps where a column is wrapped ...
constexpr double kNearRows = 1.0 / 6;
// ... and these show it where it is wrapped twice, which no angle within a turn would look like.
constexpr double kFarRows = 0.4;
// A step that is shorter than this share of the longest of the others belongs to them: one that only seems to be taken
// back, on the way through less than a turn, is longer than all of them.
constexpr double kShortStep = 0.8;
// One no longer than this many times as long belongs to them where it goes on as its neighbours do.
constexpr double kLikeStep = 2;

/// The whole turns that such a step takes back.
double turns_in(double step, double period) { return std::abs(step) > period / 2 ? std::round(step / period) : 0; }

}  // namespace

void ColumnRounding::add(const WrittenValue& written) {
  if (!(written.half_unit > 0)) return;
  if (finest_ == 0 || written.half_unit < finest_) finest_ = written.half_unit;
  if (written.value == 0) return;
  const double first = std::floor(std::log10(std::abs(written.value)));
  const double last = std::round(std::log10(2 * written.half_unit));
  digits_ = std::max(digits_, first - last + 1);
  largest_ = is_empty_ ? first : std::max(largest_, first);
  is_empty_ = false;
}

double ColumnRounding::value() const {
  if (is_empty_) return finest_;
  return std::max(finest_, 0.5 * std::pow(10.0, largest_ + 1 - digits_));
}

void RowReader::come_from(Source source) {
  if (source_ == Source::unknown) source_ = source;
  if (source_ == source) return;
  throw InputError(fmt::format("{}: rows came as {} so far, expected that to go on", name_,
                               source_ == Source::lines ? "lines of text" : "numbers"));
}

RowKind RowReader::read(std::string_view line, LogRow& row) {
  come_from(Source::lines);
  if (++lines_ == 1) line = plain_beginning(line, name_);
  if (!line.empty() && line.back() == '\n') line.remove_suffix(1);
  if (header_may_come_) cutter_.forget();
  if (!cutter_.cut(line, lines_, table_row_)) return RowKind::none;
  if (take_header()) return RowKind::none;
  require_width();
  row.line = lines_;
  const auto touching =
      std::count_if(columns_.begin(), columns_.end(), [&](const Columns& columns) { return touches(columns); });
  row.time = time();
  if (static_cast<std::size_t>(touching) < columns_.size()) return RowKind::off;
  row.fingers = PerFinger<FingerCells>::of(columns_.size());
  for (std::size_t k = 0; k < columns_.size(); ++k) row.fingers[k] = cells(columns_[k]);
  return RowKind::touching;
}

/// Whether the row says what the columns are, rather than what is in them.
bool RowReader::take_header() {
  const bool may_come = columns_.empty() || header_may_come_;
  if (!may_come) return false;
  if (of_pin_ && !columns_.empty() && is_data(table_row_)) return false;
  if (of_pin_) {
    columns_ = {pin_columns_of(table_row_, name_, options_)};
    return true;
  }
  if (is_data(table_row_)) {
    if (columns_.empty()) columns_ = {bare_columns(table_row_, name_, options_)};
    return false;
  }
  std::vector<Columns> found = rollfix::columns_of(table_row_, name_, options_);
  if (!columns_.empty() && (found.size() != columns_.size() || found.front().kind != kind())) {
    throw InputError(fmt::format("{}: the header '{}' is of another kind of log than the one before it",
                                 where(name_, table_row_.line), shown(table_row_.text)));
  }
  columns_ = std::move(found);
  header_may_come_ = false;
  time_line_ = 0;
  return true;
}

RowKind RowReader::read(const std::optional<double>& time, const std::optional<PerFinger<Touch>>& fingers,
                        LogRow& row) {
  come_from(Source::numbers);
  ++lines_;
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
    row.fingers[k] = {{touch.u, 0}, {touch.psi, 0}, touch.x.value_or(0), touch.y.value_or(0)};
    turn_to_part(row.fingers[k]);
  }
  return RowKind::touching;
}

/// Throws InputError unless the row has what the first one had, which says what all have.
void RowReader::require_same_columns(const std::optional<double>& time,
                                     const std::optional<PerFinger<Touch>>& fingers) {
  if (!fingers && columns_.empty()) return;
  const std::vector<Columns> found = fingers ? columns_of(time, *fingers) : columns_;
  for (const Columns& columns : found) {
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

void RowReader::accept(const LogRow& row) {
  header_may_come_ = false;
  if (!row.time) return;
  time_ = *row.time;
  time_line_ = row.line;
}

bool RowReader::has_centre() const {
  return std::all_of(columns_.begin(), columns_.end(), [](const Columns& columns) { return columns.has(Column::x); });
}

std::string_view RowReader::cell(const Columns& columns, Column column) const {
  const std::size_t k = columns[column];
  if (k < table_row_.cells.size() && !table_row_.cells[k].empty()) return table_row_.cells[k];
  throw InputError(fmt::format("{}: '{}' has no {}, expected a number in column {}", where(name_, lines_),
                               shown(table_row_.text), columns.called(column), k + 1));
}

WrittenValue RowReader::written(const Columns& columns, Column column) const {
  const std::string_view text = cell(columns, column);
  const Conversion& convert = columns.conversion_of(column);
  const bool is_length = column == Column::u && columns.u_dimension == Dimension::length;
  const bool may_say_degrees = is_angle(column) && !is_length;
  const auto number = parse_number(text);
  const auto value = number ? convert(*number) : may_say_degrees ? parse_angle(text) : std::nullopt;
  if (value && std::isfinite(*value)) return {*value, number ? convert(rounding_of(text)) : rounding_of(text)};
  const std::string comma = decimal_comma_hint(text);
  throw InputError(fmt::format("{}: {} is '{}', expected a {}number{}{}{}", where(name_, lines_),
                               columns.called(column), shown(text), value ? "finite " : "",
                               may_say_degrees ? " such as 1.25 (radians) or 73deg" : " such as 1.25", comma,
                               comma.empty() ? "" : "; `decimal_comma` takes them"));
}

bool RowReader::touches(const Columns& columns) const {
  if (!columns.has(Column::contact)) return true;
  const std::string_view text = cell(columns, Column::contact);
  const auto value = parse_number(text);
  if (value && (*value == 0 || *value == 1)) return *value == 1;
  throw InputError(fmt::format("{}: {} is '{}', expected 0 or 1", where(name_, lines_), columns.called(Column::contact),
                               shown(text)));
}

std::optional<double> RowReader::time() const {
  const Columns& columns = columns_.front();
  if (!columns.has(Column::time)) return std::nullopt;
  const double time = number(columns, Column::time);
  require_later(time, cell(columns, Column::time), lines_);
  return time;
}

void RowReader::require_later(double time, std::string_view written, std::size_t line) const {
  if (time_line_ == 0 || time > time_) return;
  throw NotLater(fmt::format("{}: time is '{}', expected more than {} in line {}: time must grow", where(name_, line),
                             shown(written), time_, time_line_));
}

FingerCells RowReader::cells(const Columns& columns) const {
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

void RowReader::turn_to_part(FingerCells& cells) const {
  if (options_.mirrored) {
    cells.place.value = -cells.place.value;
    cells.angle.value =
        (kind() == LogKind::contact ? std::numbers::pi : 0) - cells.angle.value;  // a direction or a turn
    cells.x = -cells.x;
  }
  if (options_.clockwise && kind() != LogKind::contact) cells.place.value = -cells.place.value;
}

/// Throws InputError when the row has more cells than the table has columns.
void RowReader::require_width() const {
  const std::size_t count = columns_.front().count;
  for (std::size_t k = count; k < table_row_.cells.size(); ++k) {
    if (table_row_.cells[k].empty()) continue;
    throw InputError(fmt::format("{}: '{}' has {} cells, expected {} as in the first row; {}", where(name_, lines_),
                                 shown(table_row_.text), table_row_.cells.size(), count,
                                 options_.decimal_comma == true
                                     ? "beside decimal commas cells are separated by semicolons, tabs or blanks"
                                     : "numbers take a decimal point, not a comma"));
  }
}

double Odometer::ExactSum::add(double term) {
  const double next = sum_ + term;
  rest_ += std::abs(sum_) >= std::abs(term) ? (sum_ - next) + term : (term - next) + sum_;
  sum_ = next;
  return sum_ + rest_;
}

Reading Odometer::add(const FingerCells& row) {
  const bool is_first_contact = starts_here_;
  starts_here_ = false;
  if (kind_ == LogKind::increments) {
    return is_first_contact ? Reading{} : Reading{length_.add(row.place.value), turn_.add(row.angle.value)};
  }
  if (is_first_contact) start_ = row;
  return {row.place.value - start_.place.value, row.angle.value - start_.angle.value};
}

namespace {

/// Whether a reader of these increments would add them up to the rows' length and turn, to the bit.
bool add_up(const std::vector<double>& distance, const std::vector<double>& dturn, const FingerRows& rows) {
  if (distance.size() != rows.length.size() || dturn.size() != rows.turn.size()) return false;
  Odometer odometer(LogKind::increments, false);
  for (std::size_t row = 0; row < distance.size(); ++row) {
    const Reading sum = odometer.add({{distance[row], 0}, {dturn[row], 0}});
    if (sum.length[0] != rows.length[row] || sum.turn != rows.turn[row]) return false;
  }
  return true;
}

/// Steps that a reader adds up to these sums, to the rounding of a step.
std::vector<double> steps_to(const std::vector<double>& sums) {
  std::vector<double> steps;
  Odometer odometer(LogKind::increments, false);
  double before = 0;
  for (const double sum : sums) {
    steps.push_back(sum - before);
    before = odometer.add({{steps.back(), 0}, {}}).length[0];  // what rounding took comes back with the next step
  }
  return steps;
}

}  // namespace

Increments increments_of(const FingerRows& rows) {
  if (add_up(rows.distance, rows.dturn, rows)) return {rows.distance, rows.dturn};
  return {steps_to(rows.length), steps_to(rows.turn)};  // rows made or changed without them
}

std::vector<double> unwrapped(const std::vector<double>& angles, double rounding, double period) {
  std::vector<double> result = angles;
  if (angles.empty()) return result;
  const auto [least, most] = std::minmax_element(angles.begin(), angles.end());
  if (!may_be_wrapped({*least, *most}, angles.size(), rounding, period)) return result;
  double turns = 0;
  for (std::size_t k = 1; k < angles.size(); ++k) {
    turns -= turns_in(angles[k] - angles[k - 1], period);
    if (turns != 0) result[k] = angles[k] + turns * period;
  }
  return result;
}

std::vector<double> unwrapped_as_said(const std::vector<double>& angles, double rounding, double period,
                                      const std::optional<bool>& is_wrapped) {
  if (!is_wrapped) return unwrapped(angles, rounding, period);
  std::vector<double> result = angles;
  if (!*is_wrapped || !std::isfinite(period)) return result;
  double turns = 0;
  for (std::size_t k = 1; k < angles.size(); ++k) {
    turns -= turns_in(angles[k] - angles[k - 1], period);
    result[k] = angles[k] + turns * period;
  }
  return result;
}

std::optional<std::size_t> unclear_step(const std::vector<double>& angles, double rounding, double period,
                                        const std::optional<bool>& is_wrapped) {
  if (is_wrapped || angles.empty()) return std::nullopt;
  const auto [least, most] = std::minmax_element(angles.begin(), angles.end());
  if (!may_be_wrapped({*least, *most}, angles.size(), rounding, period)) return std::nullopt;
  std::vector<double> steps;                            // as they are if the column is wrapped
  std::vector<std::size_t> far;                         // of those that are others if it is not
  double longest = 2 * rounding + kWrapSlack * period;  // of those that are the same
  double turns = 0;
  for (std::size_t k = 1; k < angles.size(); ++k) {
    const double step = angles[k] - angles[k - 1];
    const double whole = turns_in(step, period);
    steps.push_back(step - whole * period);
    turns += whole;
    if (whole != 0) far.push_back(k - 1);
    if (whole == 0) longest = std::max(longest, std::abs(step));
  }
  const bool is_wrapped_often = far.size() > 2 || std::abs(turns) > 1;
  if (far.empty() || (is_wrapped_often && longest <= kFarRows * period)) return std::nullopt;
  for (const std::size_t k : far) {
    const double size = std::abs(steps[k]);
    const bool goes_on =
        (k > 0 && steps[k - 1] * steps[k] > 0) || (k + 1 < steps.size() && steps[k + 1] * steps[k] > 0);
    const bool belongs = size <= kShortStep * longest || (goes_on && size <= kLikeStep * longest);
    if (!belongs || longest > kNearRows * period) return k + 1;
  }
  return std::nullopt;
}

bool GrowingAngle::is_wrapped(double rounding) const {
  return said_ ? *said_ && std::isfinite(period_) : may_be_wrapped(range_, count_, rounding, period_);
}

double GrowingAngle::add(double angle, double rounding) {
  const double last = last_;
  const double turns = turns_;
  range_ = count_ == 0 ? Interval{angle, angle} : Interval{std::min(range_.lo, angle), std::max(range_.hi, angle)};
  if (count_ > 0) {
    const double whole = turns_in(angle - last, period_);
    turns_ -= whole;
    was_far_ = was_far_ || (whole != 0 && std::abs(angle - last - whole * period_) > kNearRows * period_);
  }
  last_ = angle;
  ++count_;
  const bool wraps = (turns != 0 || turns_ != 0) && is_wrapped(rounding);
  before_ = wraps ? last + turns * period_ : last;
  return wraps && turns_ != 0 ? angle + turns_ * period_ : angle;
}

void require_unit_of_u(const std::optional<Dimension>& dimension, const Finger* finger, const std::string& log) {
  if (!dimension || finger == nullptr || finger->is_disk() == (*dimension == Dimension::angle)) return;
  if (finger->is_disk()) {
    throw InputError(fmt::format(
        "{}: u is in a unit of length, and of a disk it is the contact's angle: expected radians or degrees, which is "
        "the length on the skin divided by the radius; or give the finger as an outline",
        log));
  }
  throw InputError(fmt::format(
      "{}: u is in a unit of an angle, and of a jaw or an outline it is the place along it: expected a length", log));
}

namespace {

/// The first row in which two columns differ; if none does, how many rows there are.
std::size_t first_change(const std::vector<double>& one, const std::vector<double>& other) {
  return static_cast<std::size_t>(std::mismatch(one.begin(), one.end(), other.begin()).first - one.begin());
}

}  // namespace

void require_readable(const FingerRows& rows, const std::string& log) {
  const auto is_finite = [](double value) { return std::isfinite(value); };
  if (!std::all_of(rows.u.begin(), rows.u.end(), is_finite) ||
      !std::all_of(rows.psi.begin(), rows.psi.end(), is_finite)) {
    throw InputError(
        fmt::format("{}: its rows would hold numbers beyond any double: check the units, and the noise", log));
  }
  const std::size_t row = std::min(first_change(rows.u, unwrapped(rows.u, rows.place_rounding, rows.u_period)),
                                   first_change(rows.psi, unwrapped(rows.psi, rows.angle_rounding)));
  if (row == rows.u.size()) return;
  throw InputError(fmt::format(
      "{}: its {} rows are more than half a turn apart, rows {} and {}, so that a reader would take the angles as "
      "wrapped: take more rows, unless they are many and the motion jumps there",
      log, rows.u.size(), row, row + 1));
}

}  // namespace rollfix
