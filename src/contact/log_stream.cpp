#include "rollfix/contact/log_stream.hpp"

#include <fmt/format.h>

#include <numbers>
#include <utility>
#include <vector>

#include "contact/jump.hpp"
#include "contact/log_columns.hpp"
#include "contact/log_lines.hpp"
#include "contact/log_rows.hpp"
#include "contact/log_table.hpp"
#include "contact/unwrap.hpp"
#include "rollfix/error.hpp"

namespace rollfix {

namespace {

/// What a roll is measured by while it lasts.
struct OngoingRoll {
  OngoingRoll(LogKind kind, double period_of_u, bool is_later_roll) : u(period_of_u), odometer(kind, is_later_roll) {}

  bool has_first = false;
  Contact first;  // of u and psi
  GrowingAngle u;
  GrowingAngle psi{2 * std::numbers::pi};
  double place_rounding = 0;
  double angle_rounding = 0;
  Odometer odometer;  // of everything else
  Reading last;
};

/// A row's reading, and what the row before it says by now.
struct Steps {
  Reading before;
  Reading now;
};

}  // namespace

struct LogStream::State {
  State(std::string log_name, const Part& on, std::optional<Finger> by, const Noise& noise_of)
      : name(std::move(log_name)), part(on), finger(std::move(by)), noise(noise_of) {
    if (finger) require_valid(*finger);
  }

  LogLine push(std::string_view line);
  void resume();

  std::string name;
  Part part;
  std::optional<Finger> finger;
  Noise noise;
  std::size_t lines = 0;
  std::size_t malformed = 0;
  TableCutter cutter;
  TableRow row;
  std::optional<RowParser> parser;  // none before the header
  std::optional<JumpWatch> watch;
  std::optional<OngoingRoll> roll;  // none while there is no contact
  bool is_later_roll = false;
  bool header_may_come = false;  // once more

 private:
  LogKind kind() const { return parser->columns().kind; }
  void start(const Columns& columns);
  bool starts_again();
  LogLine take();
  void begin_roll();
  LogLine skip(const InputError& error);
  void require_on_finger(const LogRow& found) const;
  Steps measure(const LogRow& found, Sample& sample);
};

void LogStream::State::start(const Columns& columns) {
  if (columns.kind == LogKind::contact && !finger) {
    throw InputError(
        fmt::format("{}: u says where on the finger the contact is, expected the finger's shape as well, as in "
                    "--finger disk,r=0.01",
                    name));
  }
  parser.emplace(name, columns);
  watch.emplace(part, StepError(columns.kind, finger, noise));
}

/// Whether the row is a header that came again.
bool LogStream::State::starts_again() {
  if (!header_may_come || is_data(row)) return false;
  const std::vector<Columns> found = columns_of(row, name);
  if (found.size() != 1 || found.front().kind != kind()) {
    throw InputError(fmt::format("{}: the header '{}' is of another kind of log than the one before it",
                                 where(name, row.line), shown(row.text)));
  }
  parser.emplace(name, found.front());
  return true;
}

LogLine LogStream::State::push(std::string_view line) {
  ++lines;
  if (lines == 1) line = plain_beginning(line, name);
  if (!line.empty() && line.back() == '\n') line.remove_suffix(1);
  if (header_may_come) cutter.forget();
  if (!cutter.cut(line, lines, row)) return {};
  if (!parser) {
    if (!is_data(row)) {
      const std::vector<Columns> found = columns_of(row, name);
      if (found.size() > 1) {
        throw InputError(
            fmt::format("{}: this log is of two fingers, expected one with columns 'u' and 'psi'", where(name, lines)));
      }
      start(found.front());
      return {};
    }
    start(bare_columns(row, name));
  }
  try {
    if (starts_again()) {
      header_may_come = false;
      return {};
    }
    return take();
  } catch (const InputError& error) {
    return skip(error);
  }
}

LogLine LogStream::State::skip(const InputError& error) {
  ++malformed;
  LogLine result;
  result.kind = LineKind::malformed;
  result.message = error.what();
  return result;
}

void LogStream::State::begin_roll() {
  roll.emplace(kind(), finger ? finger->period() : 2 * std::numbers::pi, is_later_roll);
  is_later_roll = true;
  watch->restart();
}

/// Throws InputError where u is beyond the ends of an open finger.
void LogStream::State::require_on_finger(const LogRow& found) const {
  if (kind() != LogKind::contact) return;
  const Interval ends = finger->ends();
  const double slack = end_slack(*finger, found.place.half_unit, noise);
  const double u = found.place.value;
  if (u < ends.lo - slack || u > ends.hi + slack) {
    throw InputError(fmt::format("{}: {}", where(name, row.line), off_finger(*finger, u)));
  }
}

Steps LogStream::State::measure(const LogRow& found, Sample& sample) {
  const Reading before = roll->last;
  if (kind() != LogKind::contact) {
    const Reading as_given = roll->odometer.add(found);
    return {before, in_stored_direction(as_given, part)};
  }
  found.place.sharpen(roll->place_rounding);
  found.angle.sharpen(roll->angle_rounding);
  const double u = roll->u.add(found.place.value, roll->place_rounding);
  const double psi = roll->psi.add(found.angle.value, roll->angle_rounding);
  if (!roll->has_first) roll->first = {u, psi};
  roll->has_first = true;
  sample.contact = {u, psi};
  sample.finger_curvature = finger->curvature(u);
  return {reading_between(*finger, roll->first, {roll->u.before(), roll->psi.before()}),
          reading_between(*finger, roll->first, {u, psi})};
}

LogLine LogStream::State::take() {
  parser->require_width(row);
  const bool touches = parser->touches(row);
  const std::optional<double> time = parser->time(row);
  LogLine result;
  if (!touches) {
    parser->keep(time, row.line);
    header_may_come = false;
    if (roll) result.kind = LineKind::lost;
    roll.reset();
    return result;
  }
  const LogRow found = parser->parse(row);
  require_on_finger(found);
  parser->keep(time, row.line);
  header_may_come = false;

  Sample& sample = result.sample;
  sample.line = row.line;
  sample.time = time;
  if (finger && finger->is_disk()) sample.finger_curvature = finger->curvature(0);
  if (parser->columns().has(Column::x)) sample.centre = Vec2(found.x, found.y);
  result.kind = roll ? LineKind::sample : LineKind::first;
  if (!roll) begin_roll();
  Steps steps = measure(found, sample);
  if (const auto why = watch->look(row.line, steps.before, steps.now, time)) {
    result.kind = LineKind::jump;
    result.message = fmt::format("{}: expected a roll that goes on, found a jump: {}", where(name, row.line), *why);
    begin_roll();
    steps = measure(found, sample);
    watch->look(row.line, steps.before, steps.now, time);  // the next row is compared with this one
  }
  roll->last = steps.now;
  sample.reading = steps.now;
  return result;
}

void LogStream::State::resume() {
  if (!parser) return;
  header_may_come = true;
  watch->skip();
}

LogStream::LogStream(std::string name, const Part& part, std::optional<Finger> finger, const Noise& noise)
    : state_(std::make_unique<State>(std::move(name), part, std::move(finger), noise)) {}
LogStream::~LogStream() = default;
LogStream::LogStream(LogStream&&) noexcept = default;
LogStream& LogStream::operator=(LogStream&&) noexcept = default;

LogLine LogStream::push(std::string_view line) { return state_->push(line); }

void LogStream::resume() { state_->resume(); }

LogKind LogStream::kind() const { return state_->parser ? state_->parser->columns().kind : LogKind::contact; }

std::size_t LogStream::lines() const { return state_->lines; }

std::size_t LogStream::malformed() const { return state_->malformed; }

}  // namespace rollfix
