#include "rollfix/contact/pose.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "contact/felt_part.hpp"
#include "outline/turn.hpp"
#include "part/angle.hpp"

namespace rollfix {

namespace {

double clamped(double value, const Interval& interval) { return std::clamp(value, interval.lo, interval.hi); }

Pose pose_with(double heading, const Vec2& on_part, const Vec2& in_world) {
  Pose pose{0, 0, heading};
  const Vec2 origin = in_world - pose.turned(on_part);
  pose.x = origin.x();
  pose.y = origin.y();
  return pose;
}

/// Whole turns that bring the heading at the first contact into (-pi, pi].
double turns_to_near(double first_heading) { return nearest_angle(first_heading) - first_heading; }

/// The heading of a part at rest: from a row off the corners if there is one, since all rows have the same.
double resting_heading(const FeltPart& felt) {
  Interval common = felt.heading(0);
  for (std::size_t row = 0; row < felt.rows(); ++row) {
    const Interval heading = felt.heading(row);
    if (heading.width() == 0) return heading.lo;
    common = {std::max(common.lo, heading.lo), std::min(common.hi, heading.hi)};
  }
  return common.middle();
}

/// The heading for which both fingers feel the right normals, and by how much they miss it.
struct Agreed {
  double heading = 0;
  double gap = 0;
};

/// The direction of the vector between the contacts tells what two pivots leave open.
double chord_heading(const FeltPart& a, const FeltPart& b, std::size_t row) {
  return angle_between(b.on_part(row) - a.on_part(row), b.in_world(row) - a.in_world(row));
}

Agreed agreed_heading(const FeltPart& a, const FeltPart& b, std::size_t row) {
  const Interval of_a = a.heading(row);
  Interval of_b = b.heading(row);
  const double turns = kFullTurn * std::round((of_a.middle() - of_b.middle()) / kFullTurn);
  of_b = {of_b.lo + turns, of_b.hi + turns};
  const Interval common{std::max(of_a.lo, of_b.lo), std::min(of_a.hi, of_b.hi)};
  if (common.width() <= 0) return {common.middle(), std::abs(common.width())};
  const double chord = chord_heading(a, b, row);
  const double nearest = chord + kFullTurn * std::round((common.middle() - chord) / kFullTurn);
  return {clamped(nearest, common), 0};
}

}  // namespace

std::optional<Poses> poses(const Part& part, const Finger& finger, const Log& log, double s,
                           const std::vector<std::size_t>& rows) {
  if (!FeltPart::is_in(log)) return std::nullopt;
  const FeltPart felt(part, finger, log, s);
  const double resting = resting_heading(felt);
  const double first = clamped(resting, felt.heading(0));
  const double turns = turns_to_near(first);
  Poses result;
  for (const std::size_t row : rows) {
    const double heading = clamped(resting, felt.heading(row));
    result.pose.push_back(pose_with(heading + turns, felt.on_part(row), felt.in_world(row)));
    result.residual.push_back((result.pose.back().world(felt.on_part(0)) - felt.in_world(0)).norm());
    result.turn_residual.push_back(std::abs(heading - first));
  }
  return result;
}

std::optional<Poses> poses(const Part& part, const FingerPair& fingers, const PairLog& log,
                           const std::array<double, 2>& start, const std::vector<std::size_t>& rows) {
  if (!FeltPart::is_in(log.a) || !FeltPart::is_in(log.b)) return std::nullopt;
  const FeltPart a(part, fingers[0], log.a, start[0]);
  const FeltPart b(part, fingers[1], log.b, start[1]);
  const double turns = turns_to_near(agreed_heading(a, b, 0).heading);
  Poses result;
  for (const std::size_t row : rows) {
    const auto [heading, gap] = agreed_heading(a, b, row);
    const Pose of_a = pose_with(heading + turns, a.on_part(row), a.in_world(row));
    const Pose of_b = pose_with(heading + turns, b.on_part(row), b.in_world(row));
    result.pose.push_back({(of_a.x + of_b.x) / 2, (of_a.y + of_b.y) / 2, heading + turns});
    result.residual.push_back(std::hypot(of_a.x - of_b.x, of_a.y - of_b.y));
    result.turn_residual.push_back(gap);
  }
  return result;
}

}  // namespace rollfix
