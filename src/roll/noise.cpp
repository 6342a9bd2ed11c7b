#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "log/roll_rows.hpp"
#include "log/wrapping.hpp"
#include "part/part_data.hpp"
#include "roll/noise.hpp"
#include "rollfix/error.hpp"
#include "rollfix/rolling.hpp"

// Notation, with a standard deviation for each kind of noise: Noise
//   slip, dr        of a whole roll: a finger is rolled off by L / (1 + slip), and its radius is off by dr: RollError
//   u, psi          each row's are off by `contact` / (length per u) and `angle`
//   scale, bias, w  of a gyroscope: psi has (1 + scale) of its change, bias (t - t_0) and a random walk of variance
//                   walk^2 per second more
// Follows docs/rolling.md and docs/belief.md; the belief weighs the same errors, src/belief/error_model.cpp.
// Idea: the true fingers roll in closed form, and what sensors would say of them is drawn afterwards, from a seed.
namespace rollfix {

namespace {

/// Slip e of one finger, the same for the whole roll. It has to be above -1: at -1 the contact would not move on the
/// part. Throws InputError if it is not.
double draw_slip(const Noise& noise, rolling::NormalNumbers& normal) {
  const double slip = normal.next(noise.slip);
  if (slip > -1) return slip;
  throw InputError(fmt::format("expected a slip that leaves some roll, found {:.6g}; take less noise", slip));
}

/// Slip and radius error of one finger, drawn in this order. Throws InputError for a radius's noise without a disk.
RollError draw_error(const Finger& finger, const Noise& noise, rolling::NormalNumbers& normal) {
  RollError error;
  error.slip = draw_slip(noise, normal);
  if (noise.radius == 0) return error;
  if (!finger.is_disk()) {
    throw InputError(fmt::format("expected a disk for a noise of the radius, found the finger {}; leave the radius out",
                                 finger.name()));
  }
  error.radius = normal.next(noise.radius);
  return error;
}

/// The finger as it really is. That its radius has come out below 0 the roll will say.
Finger true_finger(const Finger& finger, const RollError& error) {
  return finger.is_disk() ? Finger(DiskFinger{finger.length_per_u() + error.radius}) : finger;
}

/// A curve scaled about the origin: the point and all derivatives by the same factor.
struct Enlarged {
  Interval domain() const { return curve.domain(); }
  Jet jet(double u) const {
    Jet jet = curve.jet(u);
    for (Vec2* vector : {&jet.position, &jet.first, &jet.second, &jet.third}) *vector *= factor;
    return jet;
  }
  Curve curve;
  double factor;
};

/// A finger that slips rolls like one that is so much larger and does not.
Finger enlarged(const Finger& finger, double factor) {
  Outline outline = finger.outline()->outline();
  for (Curve& curve : outline.curves) curve = Enlarged{curve, factor};
  outline.gallery.clear();
  return Finger::outlined(outline);
}

/// The roll of a finger with corners: what slips before a corner leaves the part elsewhere when the finger pivots.
Roll slipping_roll(const Part& part, const Finger& finger, RollPlan plan, double slip) {
  if (slip == 0) return roll(part, finger, plan);
  // u of the enlarged finger is (1 + e) times u of the true one.
  const double factor = 1 + slip;
  // the first contact of the plan, or the default: 0, of an open finger its middle
  const Interval ends = finger.ends();
  plan.u = factor * plan.u.value_or(std::isfinite(ends.hi) ? ends.middle() : 0);
  Roll result = roll(part, enlarged(finger, factor), plan);
  FingerRows& rows = result.log.fingers[0];
  for (std::size_t row = 0; row < rows.u.size(); ++row) {
    rows.u[row] /= factor;
    const Vec2 centre = centre_of(finger, part.point(result.s[0][row]), {rows.u[row], rows.psi[row]});
    rows.x[row] = centre.x();
    rows.y[row] = centre.y();
  }
  // the true finger's, not the enlarged one's
  rows.u_period = finger.period();
  return result;
}

/// What slips leaves the part where it is, and how the normals lie: the finger is rolled off by less, and turned.
/// For fingers without corners, after the roll: s and the part's heading stay. The finger is rolled off by L / (1 + e).
/// psi changes so that N + psi stays, because the normals still meet.
void let_slip(FingerRows& rows, const Finger& finger, double slip) {
  for (std::size_t row = 0; row < rows.u.size(); ++row) {
    const Contact before{rows.u[row], rows.psi[row]};
    const double u = rows.u.front() + (before.u - rows.u.front()) / (1 + slip);
    const Contact after{u, before.psi + (finger.normal(before.u) - finger.normal(u))};
    // The contact in the world stays; the arm from it to the finger's centre has turned.
    const Vec2 moved = centre_of(finger, Vec2::Zero(), after) - centre_of(finger, Vec2::Zero(), before);
    rows.u[row] = after.u;
    rows.psi[row] = after.psi;
    rows.x[row] += moved.x();
    rows.y[row] += moved.y();
  }
}

/// A gyroscope that tells psi has a scale of its own.
void let_scale(FingerRows& rows, double scale) {
  const double first = rows.psi.front();
  for (double& psi : rows.psi) psi += scale * (psi - first);
}

/// It drifts with time.
void let_drift(FingerRows& rows, const std::vector<double>& time, const Noise& noise, rolling::NormalNumbers& normal) {
  if (noise.drift == 0 && noise.walk == 0) return;
  // rad/s too high, the same for the whole roll; `walked` is a random walk, whose steps are independent.
  const double bias = normal.next(noise.drift);
  double walked = 0;
  for (std::size_t row = 1; row < rows.psi.size(); ++row) {
    walked += normal.next(noise.walk * std::sqrt(time[row] - time[row - 1]));
    rows.psi[row] += bias * (time[row] - time.front()) + walked;
  }
}

/// What rows are off by in one coordinate: independent of each other, or alike over `correlation`, length. Then the
/// errors of two rows that are x of roll apart have the correlation exp(-x / `correlation`).
class RowErrors {
 public:
  RowErrors(double sd, double correlation, rolling::NormalNumbers& normal)
      : sd_(sd), correlation_(correlation), normal_(normal) {}

  /// Of the next row, after `rolled`, length, since the one before.
  double next(double rolled) {
    const double fresh = normal_.next(sd_);
    if (correlation_ == 0) return fresh;
    const double alike = is_first_ ? 0 : std::exp(-std::abs(rolled) / correlation_);
    is_first_ = false;
    return last_ = alike * last_ + std::sqrt(1 - alike * alike) * fresh;
  }

 private:
  double sd_;
  double correlation_;
  rolling::NormalNumbers& normal_;
  double last_ = 0;
  bool is_first_ = true;
};

/// How far the finger rolls from each row to the next, length; 0 at the first.
std::vector<double> rolled_between(const FingerRows& rows, const Finger& finger) {
  std::vector<double> rolled(rows.u.size());
  for (std::size_t row = 1; row < rows.u.size(); ++row) {
    rolled[row] = (rows.u[row] - rows.u[row - 1]) * finger.length_per_u();
  }
  return rolled;
}

/// In each row u by `contact`, a length along the finger, and psi by `angle`, radians.
void add_noise(FingerRows& rows, const Finger& finger, const Noise& noise, rolling::NormalNumbers& normal) {
  const std::vector<double> rolled = rolled_between(rows, finger);
  RowErrors contact(noise.contact, noise.correlation, normal);
  RowErrors angle(noise.angle, noise.correlation, normal);
  for (std::size_t row = 0; row < rows.u.size(); ++row) {
    rows.u[row] += contact.next(rolled[row]) / finger.length_per_u();
    rows.psi[row] += angle.next(rolled[row]);
  }
}

/// In each row both coordinates of the finger's centre, or of a wheel's pin.
void add_noise_of_centres(FingerRows& rows, const std::vector<double>& rolled, const Noise& noise,
                          rolling::NormalNumbers& normal) {
  if (noise.position == 0) return;
  RowErrors x(noise.position, noise.correlation, normal);
  RowErrors y(noise.position, noise.correlation, normal);
  for (std::size_t row = 0; row < rows.x.size(); ++row) {
    rows.x[row] += x.next(rolled[row]);
    rows.y[row] += y.next(rolled[row]);
  }
}

/// What the sensors say of this roll of the true fingers.
void let_sense(NoisyRoll& roll, const std::vector<Finger>& fingers, const Noise& noise,
               rolling::NormalNumbers& normal) {
  roll.log = roll.truth.log;
  for (std::size_t k = 0; k < fingers.size(); ++k) {
    // Slip first: the other errors are of what the sensors say of the finger that has slipped. Fingers with corners
    // have slipped while they rolled (slipping_roll).
    FingerRows& rows = roll.log.fingers[k];
    if (roll.error[k].slip != 0 && !fingers[k].has_corners()) let_slip(rows, fingers[k], roll.error[k].slip);
    add_noise(rows, fingers[k], noise, normal);
    require_times(noise, !roll.log.time.empty(), roll.log.name);
    if (noise.gyro > 0) let_scale(rows, normal.next(noise.gyro));
    let_drift(rows, roll.log.time, noise, normal);
    require_readable(rows, roll.log.name);
  }
}

}  // namespace

void require_valid(const Noise& noise) {
  for (const NoiseKind& kind : kNoiseKinds) {
    const double sd = noise.*kind.sd;
    if (sd >= 0 && std::isfinite(sd)) continue;
    throw InputError(fmt::format("{} noise of {}: expected finite standard deviations of at least 0", kind.name, sd));
  }
}

void require_kinds(const Noise& noise, std::initializer_list<double Noise::*> known, std::string_view of_what) {
  std::vector<std::string_view> names;
  for (double Noise::*const sd : known) {
    const auto is_it = [sd](const NoiseKind& kind) { return kind.sd == sd; };
    names.emplace_back(std::find_if(kNoiseKinds.begin(), kNoiseKinds.end(), is_it)->name);
  }
  for (const NoiseKind& kind : kNoiseKinds) {
    const bool is_known = std::find(known.begin(), known.end(), kind.sd) != known.end();
    if (is_known || noise.*kind.sd == 0) continue;
    throw InputError(fmt::format("noise of {} is {} and {}, found {}={}; leave it out", of_what,
                                 fmt::join(names.begin(), names.end() - 1, ", "), names.back(), kind.name,
                                 noise.*kind.sd));
  }
}

Noise with_rows_as_noisy(const Noise& noise, double times) {
  Noise noisier = noise;
  for (double Noise::*const sd : {&Noise::contact, &Noise::angle, &Noise::position}) noisier.*sd *= times;
  return noisier;
}

/// By how much the variance of the turn grows between two instants, radians squared. If drift and walk are both 0, the
/// rows of a log of lengths and turns (LogKind::travelled) gather angle^2 in each lap, others nothing.
double drift_variance(const Noise& noise, LogKind kind, double laps, const Interval& seconds) {
  if (noise.drift > 0 || noise.walk > 0) {
    // A bias turns by as much in every second: its variance grows with the square of the time.
    return noise.walk * noise.walk * seconds.width() +
           noise.drift * noise.drift * (seconds.hi * seconds.hi - seconds.lo * seconds.lo);
  }
  return kind == LogKind::travelled ? noise.angle * noise.angle * laps : 0;
}

namespace {

/// What a kind of noise may be at most on such a part, and what that is.
double most_of(const NoiseKind& kind, double perimeter) {
  // Contacts and radii are bounded by a lap; a centre, or a length of correlation, may be more.
  switch (kind.unit) {
    case NoiseKind::Unit::length: {
      const bool is_of_rows = kind.sd == &Noise::contact || kind.sd == &Noise::radius;
      return (is_of_rows ? kMostLengthNoise : kMostPlaceNoise) * perimeter;
    }
    case NoiseKind::Unit::share:
      return kMostSlip;
    case NoiseKind::Unit::rate:
    case NoiseKind::Unit::walk:
      return kMostRate;
    case NoiseKind::Unit::angle:
      break;
  }
  return std::numeric_limits<double>::infinity();  // of angles the belief has a bound of its own
}

/// Throws InputError for a standard deviation so large that a number was probably meant in another unit.
void require_sensible(const Part& part, const Noise& noise) {
  if (noise.position > 0) require_not_lost(part, noise.position, "a noise of the position", "");
  for (const NoiseKind& kind : kNoiseKinds) {
    const double sd = noise.*kind.sd;
    const double most = most_of(kind, part.perimeter());
    if (!(sd > most)) continue;
    const bool is_length = kind.unit == NoiseKind::Unit::length;
    throw InputError(fmt::format("noise: {} of {:.6g} says nothing on {}{}, expected at most {:.6g}{}", kind.name, sd,
                                 part.name(), is_length ? fmt::format(", {:.6g} around", part.perimeter()) : "", most,
                                 is_length ? ": give it in the outline's unit" : ""));
  }
}

}  // namespace

/// The sensors' noise, and with it how far the part may be off its outline.
Noise noise_on(const Part& part, const Noise& sensors) {
  require_sensible(part, sensors);
  Noise noise = sensors;
  noise.part = part.outline().accuracy;
  return noise;
}

void require_times(const Noise& noise, bool has_times, const std::string& what) {
  if (has_times || (noise.drift == 0 && noise.walk == 0)) return;
  throw InputError(fmt::format(
      "{}: has no times, and the noise's {} gathers with time: give a log with a column 'time', or leave {} out", what,
      noise.drift > 0 ? "drift" : "walk", noise.drift > 0 && noise.walk > 0 ? "drift and walk" : "it"));
}

namespace {

/// What there is of it for one of two fingers: that of the radius is of the disks among them.
Noise noise_of(const Finger& finger, const Finger& other, const Noise& noise) {
  Noise own = noise;
  if (!finger.is_disk() && other.is_disk()) own.radius = 0;
  return own;
}

}  // namespace

/// One finger: the truth is rolled with the true radius, and with the slip where corners make it matter; the rest of
/// the noise is added to what the sensors say.
NoisyRoll noisy_roll(const Part& part, const Finger& finger, const RollPlan& plan, const Noise& noise,
                     std::uint64_t seed) {
  require_valid(noise);
  rolling::NormalNumbers normal(seed);
  NoisyRoll result;
  result.error[0] = draw_error(finger, noise, normal);
  // What rolls is the finger with its true radius; the log's reader takes the nominal one.
  const Finger real = true_finger(finger, result.error[0]);
  result.truth = real.has_corners() ? slipping_roll(part, real, plan, result.error[0].slip) : roll(part, real, plan);
  let_sense(result, {real}, noise, normal);
  add_noise_of_centres(result.log.fingers[0], rolled_between(result.truth.log.fingers[0], real), noise, normal);
  return result;
}

/// Two fingers, each with errors of its own. Slip of a finger with corners is refused.
NoisyRoll noisy_roll_free(const Part& part, const FreePlan& plan, const Noise& noise, std::uint64_t seed) {
  require_valid(noise);
  rolling::NormalNumbers normal(seed);
  NoisyRoll result;
  result.error = PerFinger<RollError>::of(2);
  FreePlan real = plan;
  for (std::size_t k = 0; k < 2; ++k) {
    const Finger& finger = plan.fingers[k].finger;
    result.error[k] = draw_error(finger, noise_of(finger, plan.fingers[1 - k].finger, noise), normal);
    if (finger.has_corners() && result.error[k].slip != 0) {
      throw InputError(
          fmt::format("the finger {} has corners: two fingers' slip is not simulated with them; leave slip "
                      "out, or take a finger with rounded corners",
                      finger.name()));
    }
    // The truth is rolled with the true radius; the log's reader takes the planned one.
    real.fingers[k].finger = true_finger(finger, result.error[k]);
  }
  result.truth = roll_free(part, real);
  let_sense(result, {real.fingers[0].finger, real.fingers[1].finger}, noise, normal);
  for (std::size_t k = 0; k < 2; ++k) {
    add_noise_of_centres(result.log.fingers[k], rolled_between(result.truth.log.fingers[k], real.fingers[k].finger),
                         noise, normal);
  }
  return result;
}

/// The pin goes the planned way, with a wheel of the true radius.
NoisyRoll noisy_roll_rig(const Part& part, const RigPlan& plan, const Noise& noise, std::uint64_t seed) {
  require_valid(noise);
  rolling::NormalNumbers normal(seed);
  NoisyRoll result;
  const Finger wheel = disk(plan.radius);
  result.error = {draw_error(jaw(), noise_of(jaw(), wheel, noise), normal), draw_error(wheel, noise, normal)};
  RigPlan real = plan;
  real.radius += result.error[1].radius;
  result.truth = roll_rig(part, real);
  let_sense(result, {jaw(), disk(real.radius)}, noise, normal);
  // Only the wheel's x and y are noisy: `position` is of the pin.
  add_noise_of_centres(result.log.fingers[1], rolled_between(result.truth.log.fingers[1], disk(real.radius)), noise,
                       normal);
  return result;
}

/// Equal true steps of s, and what an encoder and a gyroscope say of each.
NoisyIncrements noisy_increments(const Part& part, double start, double length, std::size_t rows, const Noise& noise,
                                 std::uint64_t seed, double seconds) {
  require_valid(noise);
  require_kinds(noise, {&Noise::contact, &Noise::angle, &Noise::slip, &Noise::drift, &Noise::walk, &Noise::gyro},
                "simulated increments");
  require_times(noise, seconds > 0, "the increments on " + part.name());
  if (rows == 0) throw InputError("expected at least 1 row of a log, found 0");
  if (!std::isfinite(start) || !std::isfinite(length)) {
    throw InputError(fmt::format("expected a finite start and length of a roll, found {} and {}", start, length));
  }
  const double end = start + length;
  if (!part.closed() && !(std::min(start, end) >= 0 && std::max(start, end) <= part.perimeter())) {
    throw InputError(fmt::format("expected a roll that stays in 0 <= s <= {:.9g}, found one from {:.9g} to {:.9g}",
                                 part.perimeter(), start, end));
  }
  rolling::NormalNumbers normal(seed);
  NoisyIncrements result;
  result.error.slip = draw_slip(noise, normal);
  result.log.name = "the increments on " + part.name();
  result.log.unit = part.unit();
  result.log.kind = LogKind::increments;
  const double scale = noise.gyro > 0 ? normal.next(noise.gyro) : 0;
  const double bias = noise.drift > 0 ? normal.next(noise.drift) : 0;
  // as the answer has it: the true turn is so many times the measured one
  result.turn_scale = 1 / (1 + scale);
  result.turn_bias = bias;
  const double interval = seconds > 0 ? seconds / static_cast<double>(rows) : 0;
  Odometer odometer(LogKind::increments, false);  // adds up as a reader does
  FingerRows& felt = result.log.fingers[0];
  // Theta before this row's step
  double angle = part.turning().angle(start);
  for (std::size_t row = 1; row <= rows; ++row) {
    const double s = start + length * (static_cast<double>(row) / static_cast<double>(rows));
    const double next = part.turning().angle(s);
    Reading step;
    // Measured is the length rolled off, L / (1 + e); the turn with the gyroscope's scale, bias and walk over one
    // interval.
    step.length[0] = length / static_cast<double>(rows) / (1 + result.error.slip) + normal.next(noise.contact);
    step.turn = (1 + scale) * (next - angle) + bias * interval + normal.next(noise.angle);
    if (noise.walk > 0) step.turn += normal.next(noise.walk * std::sqrt(interval));
    if (seconds > 0) result.log.time.push_back(interval * static_cast<double>(row));
    angle = next;
    result.s.push_back(s);
    // Along the outline as the user gave it, as everything that is not of u and psi.
    step = in_stored_direction(step, part);
    const Reading sum = odometer.add({{step.length[0], 0}, {step.turn, 0}});
    // One row: its own increment, and the sum up to it.
    felt.distance.push_back(step.length[0]);
    felt.dturn.push_back(step.turn);
    felt.length.push_back(sum.length[0]);
    felt.turn.push_back(sum.turn);
  }
  return result;
}

}  // namespace rollfix
