#include <fmt/format.h>

#include <numbers>
#include <utility>
#include <vector>

#include "contact/log_rows.hpp"
#include "contact/roll_check.hpp"
#include "rollfix/contact/log.hpp"
#include "rollfix/error.hpp"

namespace rollfix {

namespace {

/// What a finger's roll is measured by while it lasts.
struct OngoingRoll {
  OngoingRoll(const Columns& columns, const Finger* finger, bool is_later_roll)
      : u(finger != nullptr ? finger->period() : 2 * std::numbers::pi, columns.u_wrapped),
        psi(2 * std::numbers::pi, columns.psi_wrapped),
        odometer(columns.kind, is_later_roll) {}

  bool has_first = false;
  Contact first;  // of u and psi
  GrowingAngle u;
  GrowingAngle psi;
  FingerRounding rounding;
  Odometer odometer;  // of everything else
  Reading last;
};

/// Lengths of a stream come out in the part's unit, unless another is asked for.
LogOptions in_unit_of(const Part& part, LogOptions options) {
  if (options.unit.empty()) options.unit = part.unit();
  return options;
}

/// Each finger's reading of a row, and what the row before it says by now.
struct Steps {
  PerFinger<Reading> before;
  PerFinger<Reading> now;
};

}  // namespace

struct LogStream::State {
  State(std::string name, const Part& on, std::vector<Finger> by, const Noise& noise_of, LogOptions options,
        bool is_robust)
      : any_part(options.any_part),
        reader(std::move(name), in_unit_of(on, std::move(options))),
        part(on),
        fingers(std::move(by)),
        noise(noise_of),
        robust(is_robust) {
    require_fingers(fingers, 2, false, reader.name());
    require_no_corners(fingers, reader.name() + ", as a stream");
  }

  /// What the reader makes of a row, judged and measured.
  template <class Read>
  LogLine push(const Read& read);
  void resume();

  bool any_part;
  RowReader reader;
  Part part;
  std::vector<Finger> fingers;
  Noise noise;
  bool robust;
  std::size_t malformed = 0;

 private:
  std::size_t count() const { return reader.columns().size(); }
  LogKind kind() const { return reader.kind(); }
  void start();
  LogLine take();
  void begin_roll();
  LogLine skip(const InputError& error);
  void require_on_finger() const;
  Steps measure(Sample& sample);
  Reading measure_contact(std::size_t which, Sample& sample, Reading& before);

  LogRow row_;
  std::optional<RollCheck> check_;  // none before the columns are known
  std::vector<OngoingRoll> rolls_;  // of each finger; none while there is no contact
  bool is_later_roll_ = false;
  std::size_t strays_ = 0;  // since the last row of the roll
};

void LogStream::State::start() {
  require_fingers(fingers, count(), kind() == LogKind::contact, reader.name());
  for (std::size_t k = 0; k < count(); ++k) {
    require_unit_of_u(reader.columns()[k].u_dimension, finger_of(fingers, k), reader.name());
  }
  check_.emplace(part, kind(), fingers, count(), noise);
}

template <class Read>
LogLine LogStream::State::push(const Read& read) {
  RowKind found = RowKind::none;
  try {
    found = read(reader, row_);
  } catch (const InputError& error) {
    if (!reader.knows_columns()) throw;
    return skip(error);
  }
  if (!check_ && reader.knows_columns()) start();
  LogLine result;
  if (found == RowKind::none) return result;
  if (found == RowKind::off) {
    reader.accept(row_);
    if (!rolls_.empty()) result.kind = LineKind::lost;
    rolls_.clear();
    return result;
  }
  try {
    require_on_finger();
  } catch (const InputError& error) {
    return skip(error);
  }
  reader.accept(row_);
  return take();
}

LogLine LogStream::State::skip(const InputError& error) {
  ++malformed;
  LogLine result;
  result.kind = LineKind::malformed;
  result.message = error.what();
  result.goes_back = dynamic_cast<const NotLater*>(&error) != nullptr;
  return result;
}

void LogStream::State::begin_roll() {
  rolls_.clear();
  strays_ = 0;
  for (std::size_t k = 0; k < count(); ++k) {
    rolls_.emplace_back(reader.columns()[k], finger_of(fingers, k), is_later_roll_);
  }
  is_later_roll_ = true;
  check_->restart();
}

void LogStream::State::require_on_finger() const {
  for (std::size_t k = 0; k < count() && kind() == LogKind::contact; ++k) {
    const WrittenValue& u = row_.fingers[k].place;
    const auto why = check_->off_finger(k, u.value, u.half_unit);
    if (why) throw InputError(fmt::format("{}: {}", where(reader.name(), row_.line), *why));
  }
}

Reading LogStream::State::measure_contact(std::size_t which, Sample& sample, Reading& before) {
  OngoingRoll& roll = rolls_[which];
  const FingerCells& cells = row_.fingers[which];
  const Finger& finger = *finger_of(fingers, which);
  roll.rounding.place.add(cells.place);
  roll.rounding.angle.add(cells.angle);
  const Contact contact{roll.u.add(cells.place.value, roll.rounding.place.value()),
                        roll.psi.add(cells.angle.value, roll.rounding.angle.value())};
  if (!roll.has_first) roll.first = contact;
  roll.has_first = true;
  (*sample.contact)[which] = contact;
  sample.finger_curvature[which] = finger.curvature(contact.u);
  before = reading_between(finger, roll.first, {roll.u.before(), roll.psi.before()});
  return reading_between(finger, roll.first, contact);
}

Steps LogStream::State::measure(Sample& sample) {
  Steps steps{PerFinger<Reading>::of(count()), PerFinger<Reading>::of(count())};
  for (std::size_t k = 0; k < count(); ++k) {
    steps.before[k] = rolls_[k].last;
    steps.now[k] = kind() == LogKind::contact ? measure_contact(k, sample, steps.before[k])
                                              : in_stored_direction(rolls_[k].odometer.add(row_.fingers[k]), part);
    rolls_[k].last = steps.now[k];
  }
  sample.reading = together(steps.now);
  return steps;
}

LogLine LogStream::State::take() {
  LogLine result;
  Sample& sample = result.sample;
  sample.line = row_.line;
  sample.time = row_.time;
  sample.finger_curvature = PerFinger<double>::of(count());
  if (kind() == LogKind::contact) sample.contact = PerFinger<Contact>::of(count());
  if (reader.has_centre()) sample.centre = PerFinger<Vec2>::of(count(), Vec2::Zero());
  for (std::size_t k = 0; k < count(); ++k) {
    const Finger* const finger = finger_of(fingers, k);
    if (finger != nullptr && finger->is_disk()) sample.finger_curvature[k] = finger->curvature(0);
    if (sample.centre) (*sample.centre)[k] = Vec2(row_.fingers[k].x, row_.fingers[k].y);
  }
  const auto lines = PerFinger<std::size_t>::of(count(), row_.line);
  result.kind = rolls_.empty() ? LineKind::first : LineKind::sample;
  if (rolls_.empty()) begin_roll();
  const std::vector<OngoingRoll> as_it_was = robust ? rolls_ : std::vector<OngoingRoll>{};
  Steps steps = measure(sample);
  if (any_part) return result;
  const auto jump = check_->jump(lines, steps.before, steps.now, row_.time);
  if (jump && robust && strays_ < kMostStrays) {
    ++strays_;
    rolls_ = as_it_was;
    check_->disregard();
    result.kind = LineKind::stray;
    result.message = fmt::format("{}: a stray row: {}", where(reader.name(), row_.line), jump->why);
    return result;
  }
  strays_ = 0;
  if (jump) {
    result.kind = LineKind::jump;
    result.message =
        fmt::format("{}: expected a roll that goes on, found a jump: {}", where(reader.name(), row_.line), jump->why);
    begin_roll();
    steps = measure(sample);
    check_->jump(lines, steps.before, steps.now, row_.time);  // the next row is compared with this one
  }
  return result;
}

void LogStream::State::resume() {
  reader.resume();
  if (check_) check_->skip();
}

LogStream::LogStream(std::string name, const Part& part, std::vector<Finger> fingers, const Noise& noise,
                     LogOptions options, bool robust)
    : state_(std::make_unique<State>(std::move(name), part, std::move(fingers), noise, std::move(options), robust)) {}
LogStream::~LogStream() = default;
LogStream::LogStream(LogStream&&) noexcept = default;
LogStream& LogStream::operator=(LogStream&&) noexcept = default;

LogLine LogStream::push(std::string_view line) {
  return state_->push([&](RowReader& reader, LogRow& row) { return reader.read(line, row); });
}

LogLine LogStream::push(std::optional<double> time, double u, double psi, std::optional<double> x,
                        std::optional<double> y) {
  return push(time, Touch{u, psi, x, y});
}

LogLine LogStream::push(std::optional<double> time, const PerFinger<Touch>& fingers) {
  return state_->push([&](RowReader& reader, LogRow& row) { return reader.read(time, fingers, row); });
}

LogLine LogStream::push_off(std::optional<double> time) {
  return state_->push([&](RowReader& reader, LogRow& row) { return reader.read(time, std::nullopt, row); });
}

void LogStream::resume() { state_->resume(); }

LogKind LogStream::kind() const { return state_->reader.knows_columns() ? state_->reader.kind() : LogKind::contact; }

std::size_t LogStream::fingers() const { return state_->reader.columns().size(); }

std::size_t LogStream::lines() const { return state_->reader.lines(); }

std::size_t LogStream::malformed() const { return state_->malformed; }

}  // namespace rollfix
