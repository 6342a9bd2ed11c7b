#include "rollfix/contact/noisy.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "contact/normal_numbers.hpp"
#include "contact/unwrap.hpp"
#include "rollfix/error.hpp"

namespace rollfix {

namespace {

double draw_slip(const Noise& noise, NormalNumbers& normal) {
  const double slip = normal.next(noise.slip);
  if (slip > -1) return slip;
  throw InputError(fmt::format("expected a slip that leaves some roll, found {:.6g}; take less noise", slip));
}

RollError draw_error(const Finger& finger, const Noise& noise, NormalNumbers& normal) {
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

/// What slips leaves the part where it is, and how the normals lie: the finger is rolled off by less, and turned.
void let_slip(Log& log, const Finger& finger, double slip) {
  for (std::size_t row = 0; row < log.rows(); ++row) {
    const Contact before{log.u[row], log.psi[row]};
    const double u = log.u.front() + (before.u - log.u.front()) / (1 + slip);
    const Contact after{u, before.psi + (finger.normal(before.u) - finger.normal(u))};
    const Vec2 moved = centre_of(finger, Vec2::Zero(), after) - centre_of(finger, Vec2::Zero(), before);
    log.u[row] = after.u;
    log.psi[row] = after.psi;
    log.x[row] += moved.x();
    log.y[row] += moved.y();
  }
}

void add_noise(Log& log, const Finger& finger, const Noise& noise, NormalNumbers& normal) {
  for (std::size_t row = 0; row < log.rows(); ++row) {
    log.u[row] += normal.next(noise.contact) / finger.length_per_u();
    log.psi[row] += normal.next(noise.angle);
  }
}

/// What the sensors say of this roll of the true finger.
Log sensed(const Log& truth, const Finger& finger, const RollError& error, const Noise& noise, NormalNumbers& normal) {
  Log log = truth;
  if (error.slip != 0) let_slip(log, finger, error.slip);
  add_noise(log, finger, noise, normal);
  require_readable(log);
  return log;
}

}  // namespace

NoisyRoll noisy_roll(const Part& part, const Finger& finger, const RollPlan& plan, const Noise& noise,
                     std::uint64_t seed) {
  require_valid(noise);
  NormalNumbers normal(seed);
  NoisyRoll result;
  result.error = draw_error(finger, noise, normal);
  const Finger real = true_finger(finger, result.error);
  result.truth = roll_in_closed_form(part, real, plan);
  result.log = sensed(result.truth.log, real, result.error, noise, normal);
  return result;
}

NoisyFreeRoll noisy_roll_free(const Part& part, const FreePlan& plan, const Noise& noise, std::uint64_t seed) {
  require_valid(noise);
  NormalNumbers normal(seed);
  NoisyFreeRoll result;
  FreePlan real = plan;
  const std::array<FreeFinger*, 2> fingers = {&real.a, &real.b};
  for (std::size_t k = 0; k < 2; ++k) {
    result.error[k] = draw_error(fingers[k]->disk, noise, normal);
    fingers[k]->disk.radius += result.error[k].radius;
  }
  result.truth = roll_free_in_closed_form(part, real);
  result.log.a = sensed(result.truth.log.a, real.a.disk, result.error[0], noise, normal);
  result.log.b = sensed(result.truth.log.b, real.b.disk, result.error[1], noise, normal);
  return result;
}

NoisyIncrements noisy_increments(const Part& part, double start, double length, std::size_t rows, const Noise& noise,
                                 std::uint64_t seed) {
  require_valid(noise);
  if (rows == 0) throw InputError("expected at least 1 row of a log, found 0");
  if (!std::isfinite(start) || !std::isfinite(length)) {
    throw InputError(fmt::format("expected a finite start and length of a roll, found {} and {}", start, length));
  }
  const double end = start + length;
  if (!part.closed() && !(std::min(start, end) >= 0 && std::max(start, end) <= part.perimeter())) {
    throw InputError(fmt::format("expected a roll that stays in 0 <= s <= {:.9g}, found one from {:.9g} to {:.9g}",
                                 part.perimeter(), start, end));
  }
  NormalNumbers normal(seed);
  NoisyIncrements result;
  result.error.slip = draw_slip(noise, normal);
  result.log.name = "the increments on " + part.name();
  result.log.kind = LogKind::increments;
  Reading sum;
  double angle = part.turning().angle(start);
  for (std::size_t row = 1; row <= rows; ++row) {
    const double s = start + length * (static_cast<double>(row) / static_cast<double>(rows));
    const double next = part.turning().angle(s);
    sum.length[0] += length / static_cast<double>(rows) / (1 + result.error.slip) + normal.next(noise.contact);
    sum.turn += (next - angle) + normal.next(noise.angle);
    angle = next;
    result.s.push_back(s);
    // Along the outline as the user gave it, as everything that is not of u and psi.
    const Reading as_given = in_stored_direction(sum, part);
    result.log.length.push_back(as_given.length[0]);
    result.log.turn.push_back(as_given.turn);
  }
  return result;
}

}  // namespace rollfix
