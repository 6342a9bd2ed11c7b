#include "contact/motion.hpp"

#include <fmt/format.h>

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <vector>

#include "rollfix/error.hpp"

namespace rollfix {

namespace {

// Beyond this a log holds more laps than anybody rolls, and too few digits of each.
constexpr double kMostLaps = 1e5;

void require_finite(double value, const char* what) {
  if (!std::isfinite(value)) throw InputError(fmt::format("expected a finite {} of a roll, found {}", what, value));
}

void require_not_zero(double value, const char* what) {
  require_finite(value, what);
  if (value == 0) throw InputError(fmt::format("expected a {} of a roll other than 0: nothing would move", what));
}

void require_positive(double value, const char* what) {
  if (value > 0 && std::isfinite(value)) return;
  throw InputError(fmt::format("expected a {} of a roll above 0, found {}", what, value));
}

void require_consistent(const RollPlan& plan) {
  const int ends = (plan.distance ? 1 : 0) + (plan.rotation ? 1 : 0) + (plan.duration ? 1 : 0);
  if (ends != 1) {
    throw InputError(
        fmt::format("expected exactly one of distance, rotation and duration of a roll, found {} of them", ends));
  }
  if (plan.duration.has_value() != static_cast<bool>(plan.omega)) {
    throw InputError(
        "expected an angular velocity by time together with the duration of a roll, and neither with a distance or a "
        "rotation: those take a constant speed");
  }
  if (plan.distance) require_not_zero(*plan.distance, "distance");
  if (plan.rotation) require_not_zero(*plan.rotation, "rotation");
  if (plan.duration) require_positive(*plan.duration, "duration");
  require_positive(plan.speed, "speed");
  require_finite(plan.start, "start");
  require_finite(plan.psi, "orientation psi at the start");
  if (plan.rows < 2) throw InputError(fmt::format("expected at least 2 rows of a log, found {}", plan.rows));
}

double turn_per_length(const Finger& finger) { return finger.turn_per_u() / finger.length_per_u(); }

/// Where the roll sets off to, +1 or -1. A profile may begin at rest.
int direction_of(const RollPlan& plan) {
  if (plan.distance) return *plan.distance < 0 ? -1 : 1;
  if (plan.rotation) return *plan.rotation < 0 ? -1 : 1;
  constexpr int kLooks = 64;
  double omega = 0;
  for (int k = 0; k <= kLooks && omega == 0; ++k) omega = plan.omega(*plan.duration * k / kLooks);
  return omega < 0 ? -1 : 1;
}

/// How far the finger turns on the way.
double rotation_of(const Track& track, const RollPlan& plan, const TrackPlace& start, double start_angle) {
  if (plan.rotation) return *plan.rotation;
  const TrackPlace stop = track.place(start.s + *plan.distance, *plan.distance > 0 ? -1 : 1);  // as it arrives
  const double stop_angle = track.turning(track.stretch(stop.index), stop.s).angle;
  return track.rotation(track.stretch(stop.index), stop.s, stop_angle) -
         track.rotation(track.stretch(start.index), start.s, start_angle) - track.fall_between(start.index, stop.index);
}

}  // namespace

Motion plan_motion(const Track& track, const RollPlan& plan) {
  require_consistent(plan);
  const double perimeter = track.part().perimeter();
  if (plan.distance && std::abs(*plan.distance) > kMostLaps * perimeter) {
    throw InputError(fmt::format("expected a roll of at most {:g} times the perimeter, found {:.9g}", kMostLaps,
                                 std::abs(*plan.distance) / perimeter));
  }
  Motion motion;
  const double start = track.part().closed() ? wrap(plan.start, perimeter).base : plan.start;
  if (plan.distance) track.require_way(start, start + *plan.distance);
  motion.start = track.place(start, direction_of(plan));
  motion.start_angle = track.turning(track.stretch(motion.start.index), motion.start.s).angle;
  motion.first = track.first_contact(motion.start_angle, plan.psi);
  if (plan.omega) {
    motion.duration = *plan.duration;
    motion.omega = plan.omega;
    return motion;
  }
  const double rotation = rotation_of(track, plan, motion.start, motion.start_angle);
  const double most = kMostLaps * (perimeter * turn_per_length(track.finger()) + 2 * std::numbers::pi);
  if (!(std::abs(rotation) <= most)) {
    throw InputError(
        fmt::format("expected a roll that turns the finger by at most {:g} rad, {:g} times around the "
                    "part, found {:.9g}",
                    most, kMostLaps, rotation));
  }
  motion.duration = std::abs(rotation) / plan.speed;
  motion.velocity = std::copysign(plan.speed, rotation);
  return motion;
}

std::vector<double> times_of(const Motion& motion, std::size_t rows) {
  std::vector<double> times(rows);
  const auto last = static_cast<double>(rows - 1);
  for (std::size_t k = 0; k < rows; ++k) times[k] = motion.duration * (static_cast<double>(k) / last);
  return times;
}

std::vector<double> integrals(const std::function<double(double)>& rate, const std::vector<double>& times) {
  constexpr unsigned kMostHalvings = 10;
  constexpr double kRelative = 1e-12;
  using Quadrature = boost::math::quadrature::gauss_kronrod<double, 15>;
  std::vector<double> sums(times.size());
  for (std::size_t k = 1; k < times.size(); ++k) {
    const double step = times[k] - times[k - 1];
    // Over [0, 1]: over a short interval it would take its own rounding for an error and halve on and on.
    const auto share = [&](double x) { return step * rate(times[k - 1] + x * step); };
    sums[k] = sums[k - 1] + Quadrature::integrate(share, 0.0, 1.0, kMostHalvings, kRelative);
  }
  return sums;
}

}  // namespace rollfix
