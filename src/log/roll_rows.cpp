#include "log/roll_rows.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "rollfix/error.hpp"

// Notation:
//   length, turn    of a row from the first contact of its roll: Odometer adds increments up, or takes off the first
//                   row
//   u, psi          of a row of contacts, unwrapped as they grow: OngoingRoll, GrowingAngle
//   before, now     the row before this one as it is understood by now, and this one: Steps
// Follows docs/rolling.md, "Logs" and "A log that grows". Sums keep what rounding drops: A. Neumaier,
// "Rundungsfehleranalyse einiger Verfahren zur Summation endlicher Summen" (1974).
// Idea: each row is measured as it comes, bit by bit as all of the log would be. A jump begins a new roll; of a robust
// reader it is a stray row first, and all is as it was before it.
namespace rollfix {

double Odometer::ExactSum::add(double term) {
  // What the addition rounds off is found without error, starting from the larger of both.
  const double next = sum_ + term;
  rest_ += std::abs(sum_) >= std::abs(term) ? (sum_ - next) + term : (term - next) + sum_;
  sum_ = next;
  return sum_ + rest_;
}

Reading Odometer::add(const FingerCells& row) {
  const bool is_first_contact = starts_here_;
  starts_here_ = false;
  // The increment of a later roll's first row was made in the air: the sum starts behind it.
  if (kind_ == LogKind::increments) {
    return is_first_contact ? Reading{} : Reading{length_.add(row.place.value), turn_.add(row.angle.value)};
  }
  // Counters run on between rolls: a later roll is measured from its own first row.
  if (is_first_contact) start_ = row;
  return {row.place.value - start_.place.value, row.angle.value - start_.angle.value};
}

namespace {

/// Whether a reader of these increments would add them up to the rows' length and turn, to the bit.
bool add_up(const std::vector<double>& distance, const std::vector<double>& dturn, const FingerRows& rows) {
  // Rows were added, taken out or made without increments.
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
    // `before`: what a reader has added up so far, so that errors of rounding don't add up.
    steps.push_back(sum - before);
    before = odometer.add({{steps.back(), 0}, {}}).length[0];  // what rounding took comes back with the next step
  }
  return steps;
}

}  // namespace

/// A log of increments that is written has to give the same rows when it is read: to the bit where the increments are
/// those that were read, else to the rounding of a step.
Increments increments_of(const FingerRows& rows) {
  if (add_up(rows.distance, rows.dturn, rows)) return {rows.distance, rows.dturn};
  return {steps_to(rows.length), steps_to(rows.turn)};  // rows made or changed without them
}

LogOptions in_unit_of(const Part& part, LogOptions options) {
  if (options.unit.empty()) options.unit = part.unit();
  return options;
}

RollRows::OngoingRoll::OngoingRoll(const Columns& columns, const Finger* finger, bool is_later_roll)
    : u(finger != nullptr ? finger->period() : 2 * std::numbers::pi, columns.u_wrapped),
      psi(2 * std::numbers::pi, columns.psi_wrapped),
      odometer(columns.kind, is_later_roll) {}

RollRows::RollRows(const Part& part, std::vector<Finger> fingers, const Noise& noise, bool robust, bool any_part,
                   const std::string& name)
    : part_(part), fingers_(std::move(fingers)), noise_(noise), robust_(robust), any_part_(any_part) {
  require_fingers(fingers_, 2, false, name);
}

/// Checks fingers, units and columns against each other. May be called again with the same kind of columns.
void RollRows::start(const std::vector<Columns>& columns, const std::vector<std::string>& names) {
  columns_ = columns;
  names_ = names;
  require_fingers(fingers_, with_skin(), kind() == LogKind::contact, names.front());
  for (std::size_t k = 0; k < with_skin(); ++k) {
    require_unit_of_u(columns[k].u_dimension, finger_of(fingers_, k), names[k]);
  }
  // Once: what steps are usual is kept where a header comes again.
  if (!check_) check_.emplace(part_, kind(), fingers_, with_skin(), noise_);
}

/// "run.csv:12" of this finger's log, for messages.
std::string RollRows::place_of(std::size_t finger, const PerFinger<std::size_t>& lines) const {
  return where(names_[finger], lines[finger]);
}

/// A new roll of each finger, which no row was taken into yet. The first row of the next one has no row before it that
/// it could jump from.
void RollRows::begin_roll() {
  rolls_.clear();
  strays_ = 0;
  for (std::size_t k = 0; k < columns_.size(); ++k) {
    rolls_.emplace_back(columns_[k], finger_of(fingers_, k), is_later_roll_);
  }
  is_later_roll_ = true;
  check_->restart();
}

void RollRows::require_on_finger(const LogRow& row, const PerFinger<std::size_t>& lines) const {
  for (std::size_t k = 0; k < with_skin() && kind() == LogKind::contact; ++k) {
    const WrittenValue& u = row.fingers[k].place;
    const auto why = check_->off_finger(k, u.value, u.half_unit);
    if (why) throw InputError(fmt::format("{}: {}", place_of(k, lines), *why));
  }
}

/// The reading of this row from the roll's first contact; `before`: that of the row before, with its angles as they are
/// understood by now. Fills the finger's contact and curvature in the sample.
Reading RollRows::measure_contact(const FingerCells& cells, std::size_t which, Sample& sample, Reading& before) {
  OngoingRoll& roll = rolls_[which];
  const Finger& finger = *finger_of(fingers_, which);
  // Digits first: how angles are unwrapped depends on how precise the column is by now.
  roll.rounding.place.add(cells.place);
  roll.rounding.angle.add(cells.angle);
  const Contact contact{roll.u.add(cells.place.value, roll.rounding.place.value()),
                        roll.psi.add(cells.angle.value, roll.rounding.angle.value())};
  if (!roll.has_first) roll.first = contact;
  roll.has_first = true;
  (*sample.contact)[which] = contact;
  const double within = reach_of_corners(roll.rounding.place.value(), noise_);
  // On a corner the finger's curvature is infinite: it pivots there.
  const bool is_on_corner = finger.has_corners() && finger.is_on_corner(contact.u, within);
  sample.finger_curvature[which] = is_on_corner ? std::numeric_limits<double>::infinity() : finger.curvature(contact.u);
  before = reading_between(finger, roll.first, {roll.u.before(), roll.psi.before()}, within);
  return reading_between(finger, roll.first, contact, within);
}

/// A wheel's contact is not known, and without an encoder neither is how it is turned.
void RollRows::add_pin(const FingerCells& cells, std::size_t which, Sample& sample) {
  OngoingRoll& roll = rolls_[which];
  roll.rounding.angle.add(cells.angle);
  const bool has_encoder = columns_[which].has(Column::psi);
  (*sample.contact)[which] = {0, has_encoder ? roll.psi.add(cells.angle.value, roll.rounding.angle.value())
                                             : std::numeric_limits<double>::quiet_NaN()};
}

/// Measures the row from the first contacts of its roll, each finger by itself; in the sample both together.
RollRows::Steps RollRows::measure(const LogRow& row, Sample& sample) {
  Steps steps{PerFinger<Reading>::of(with_skin()), PerFinger<Reading>::of(with_skin())};
  for (std::size_t k = 0; k < with_skin(); ++k) {
    // Of a log without u and psi; with these measure_contact says it anew, because a wrap may be undone.
    steps.before[k] = rolls_[k].last;
    steps.now[k] = kind() == LogKind::contact ? measure_contact(row.fingers[k], k, sample, steps.before[k])
                                              : in_stored_direction(rolls_[k].odometer.add(row.fingers[k]), part_);
    rolls_[k].last = steps.now[k];
  }
  // A pin has no reading of its own.
  for (std::size_t k = with_skin(); k < fingers(); ++k) add_pin(row.fingers[k], k, sample);
  sample.reading = together(steps.now);
  return steps;
}

/// Where rows so far apart don't show whether an angle is wrapped.
std::optional<std::string> RollRows::unclear_angle(const PerFinger<std::size_t>& lines) const {
  for (std::size_t k = 0; k < rolls_.size(); ++k) {
    const OngoingRoll& roll = rolls_[k];
    const bool is_u = roll.u.is_unclear(roll.rounding.place.value());
    if (!is_u && !roll.psi.is_unclear(roll.rounding.angle.value())) continue;
    return fmt::format(
        "{}: whether {} is wrapped can't be told, because the rows are far apart: the roll begins anew; say it with "
        "`wrapped` no, or `wrapped` yes",
        place_of(k, lines), name_of(is_u ? Column::u : Column::psi));
  }
  return std::nullopt;
}

/// All of it but what is measured.
Sample RollRows::sample_of(const LogRow& row, const PerFinger<std::size_t>& lines) const {
  Sample sample;
  sample.line = lines[0];
  sample.time = row.time;
  sample.finger_curvature = PerFinger<double>::of(fingers());
  if (kind() == LogKind::contact) sample.contact = PerFinger<Contact>::of(fingers());
  // Where the log has the centres of all fingers, a pin's included.
  bool has_centre = true;
  for (const Columns& columns : columns_) has_centre = has_centre && columns.has(Column::x);
  if (has_centre) sample.centre = PerFinger<Vec2>::of(fingers(), Vec2::Zero());
  for (std::size_t k = 0; k < fingers(); ++k) {
    const Finger* const finger = k < with_skin() ? finger_of(fingers_, k) : nullptr;
    // A disk's curvature is the same everywhere: known without u.
    if (finger != nullptr && finger->is_disk()) sample.finger_curvature[k] = finger->curvature(0);
    if (sample.centre) (*sample.centre)[k] = Vec2(row.fingers[k].x, row.fingers[k].y);
  }
  return sample;
}

LogLine RollRows::off() {
  LogLine result;
  // Before the first contact there is nothing to lose.
  if (!rolls_.empty()) result.kind = LineKind::lost;
  rolls_.clear();
  return result;
}

/// In this order: is there a roll, what does the row measure, can it be, and is it stray or a jump.
LogLine RollRows::take(const LogRow& row, const PerFinger<std::size_t>& lines) {
  LogLine result;
  Sample& sample = result.sample;
  sample = sample_of(row, lines);
  result.kind = rolls_.empty() ? LineKind::first : LineKind::sample;
  if (rolls_.empty()) begin_roll();
  // To take a stray row back; only a robust reader needs it.
  const std::vector<OngoingRoll> as_it_was = robust_ ? rolls_ : std::vector<OngoingRoll>{};
  Steps steps = measure(row, sample);
  // Beside a wheel one finger's steps alone can be any: the part turns as it likes.
  const bool can_jump = with_skin() == fingers() && !any_part_;
  // Rows too far apart to see a wrap: the roll ends, this row begins another one.
  if (kind() == LogKind::contact) {
    if (const auto why = unclear_angle(lines)) {
      result.kind = LineKind::jump;
      result.message = *why;
      begin_roll();
      steps = measure(row, sample);
      if (can_jump) check_->jump(lines, steps.before, steps.now, row.time);  // the next row is compared with this one
      return result;
    }
  }
  // Of a part that is not known, or beside a wheel, no step is a jump.
  if (!can_jump) return result;
  const auto jump = check_->jump(lines, steps.before, steps.now, row.time);
  // Stray until shown otherwise: all is as it was before the row. After kMostStrays of them the next one that is away
  // is a jump.
  if (jump && robust_ && strays_ < kMostStrays) {
    ++strays_;
    rolls_ = as_it_was;
    check_->disregard();
    result.kind = LineKind::stray;
    result.message = fmt::format("{}: a stray row: {}", place_of(jump->finger, lines), jump->why);
    return result;
  }
  strays_ = 0;
  // The roll is over. The row is measured again, as the first contact of the next one.
  if (jump) {
    result.kind = LineKind::jump;
    result.message =
        fmt::format("{}: expected a roll that goes on, found a jump: {}", place_of(jump->finger, lines), jump->why);
    begin_roll();
    steps = measure(row, sample);
    check_->jump(lines, steps.before, steps.now, row.time);  // the next row is compared with this one
  }
  return result;
}

void RollRows::skip() {
  if (check_) check_->skip();
}

/// Another log: its columns and its usual steps may be others, and its increments count from its first row on.
void RollRows::restart() {
  rolls_.clear();
  columns_.clear();
  check_.reset();
  is_later_roll_ = false;
  strays_ = 0;
}

}  // namespace rollfix
