#include "wheels_apart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "finger/convex_body.hpp"
#include "held_rows.hpp"
#include "hold_facts.hpp"
#include "rollfix/error.hpp"

namespace rollfix::hold {
namespace {

/// A finger, or behind all of them a wheel, as its log has it in the world.
struct Body {
  Finger finger;
  const Log* log = nullptr;
  double place = 0;  // how far x and y may be off, and a wheel's radius
  double angle = 0;  // how far its orientation may be off, radians; of what is round 0
  std::string name{};

  Pose pose(std::size_t row) const {
    const FingerRows& rows = log->fingers.front();
    return {rows.x[row], rows.y[row], finger.is_disk() ? 0 : rows.psi[row]};
  }
};

std::vector<Body> bodies_of(const HoldProblem& problem, const HeldRows& rows, const std::vector<Log>& logs) {
  std::vector<Body> bodies;
  for (std::size_t k = 0; k < logs.size(); ++k) {
    const char letter = static_cast<char>('a' + k);
    if (k < problem.logs.size()) {
      const HeldErrors& errors = rows.errors[k];
      const Finger& finger = finger_of_log(problem, k);
      bodies.push_back(
          {finger, &logs[k], errors.place, finger.is_disk() ? 0 : errors.angle, fmt::format("finger {}", letter)});
      continue;
    }
    const std::size_t wheel = k - problem.logs.size();
    const HeldWheel& errors = rows.wheels[wheel];
    bodies.push_back({disk(problem.wheels[wheel].radius), &logs[k], std::hypot(errors.place, errors.radius), 0,
                      fmt::format("wheel {}", letter)});
  }
  return bodies;
}

double depth_of(const Finger& finger, const Pose& pose, const Finger& wheel, const Pose& pin) {
  if (finger.is_jaw()) return depth_of_overlap(pose, ConvexBody(wheel, pin));
  if (!finger.is_disk()) return depth_of_overlap(ConvexBody(finger, pose), ConvexBody(wheel, pin), 0);
  return finger.length_per_u() + wheel.length_per_u() - std::hypot(pose.x - pin.x, pose.y - pin.y);
}

/// How far off the depth can be: where the pin is seen from the finger's frame turns with that.
double slack_of(const Body& finger, const Body& wheel, std::size_t row, bool has_noise) {
  const Pose at = finger.pose(row);
  const Pose pin = wheel.pose(row);
  const double turned = finger.angle * std::hypot(at.x - pin.x, at.y - pin.y);
  if (!has_noise) return finger.place + wheel.place + turned;
  return kTouchSigmas * std::hypot(finger.place, wheel.place, turned);
}

/// `wheel` is the second of them.
void require_apart(const Body& finger, const Body& wheel, bool has_noise) {
  std::size_t rows = 0;
  std::size_t deepest = 0;
  double most = 0;
  for (std::size_t row = 0; row < wheel.log->rows(); ++row) {
    const double depth = depth_of(finger.finger, finger.pose(row), wheel.finger, wheel.pose(row));
    if (depth <= slack_of(finger, wheel, row, has_noise)) continue;
    ++rows;
    if (depth > most) deepest = row;
    most = std::max(most, depth);
  }
  if (rows == 0) return;
  const std::vector<std::size_t>& lines = wheel.log->fingers.front().line;
  const std::string where = deepest < lines.size() ? fmt::format("{}:{}", wheel.log->name, lines[deepest])
                                                   : fmt::format("{}, row {}", wheel.log->name, deepest + 1);
  throw InputError(fmt::format(
      "{}: expected x and y at which {} and {} are apart, found them {:.4g} deep in each other, in {} of {} rows, "
      "whatever the part does; check the radius and the unit of x and y{}; if they are at different heights, or the "
      "jaw ends before the wheel, say that they may overlap",
      where, finger.name, wheel.name, most, rows, wheel.log->rows(),
      finger.finger.is_disk() ? "" : ", and the unit and the direction of psi"));
}

}  // namespace

void require_wheels_apart(const HoldProblem& problem, const std::vector<Log>& logs) {
  if (problem.may_overlap || problem.wheels.empty()) return;
  const HeldRows rows = held_rows(problem, logs);
  const std::vector<Body> bodies = bodies_of(problem, rows, logs);
  for (std::size_t wheel = problem.logs.size(); wheel < bodies.size(); ++wheel) {
    for (std::size_t other = 0; other < wheel; ++other) require_apart(bodies[other], bodies[wheel], rows.has_noise);
  }
}

}  // namespace rollfix::hold
