#include "rollfix/rolling.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "log/log_rows.hpp"
#include "log/wrapping.hpp"
#include "outline/turn.hpp"
#include "rollfix/turning_function.hpp"
#include "work/pulse.hpp"

// Notation, at a row:
//   s               the contact on the part: start - (u - u_0), of a disk r times that: `place`
//   u + psi         direction of the contact's normal, of a disk; phi + Theta(s) + pi / 2, phi being the part's heading
//   [lo, hi]        phi where Theta is a pivot's or the finger's own normal a corner's: `heading`
//   q               the contact in the world, the centre less its arm: `in_world`; the part's origin is q - R(phi) p(s)
//   residual        how far the first contact, of two fingers both contacts, miss each other with these poses
// Follows eqs. (1) to (3) of the paper, which leave the length r (u_0 - u), and docs/rolling.md. A part at rest has one
// heading; two fingers tell it in every row, by the chord of their contacts where both of them pivot.
namespace rollfix {

namespace {

// A contact so near to a corner, in perimeters, may be on it: a placement is known to 1e-9.
constexpr double kOnCorner = 1e-8;
// Nor may what digits leave open of a length take it off: so often, as where rows are held against places.
constexpr double kOverDigits = 10;

/// What one finger says of the part at each row, when its first contact is at a given place of the boundary.
class FeltPart {
 public:
  /// All have to stay. The rows have u, psi, x and y.
  FeltPart(const Part& part, const Finger& finger, const FingerRows& rows, double start, const Noise& noise,
           double start_error)
      : part_(part),
        finger_(finger),
        rows_(rows),
        start_(start),
        within_(reach_of_corners(rows.place_rounding, noise)),
        on_corner_(kOnCorner * part.perimeter() + start_error +
                   kOverDigits * finger.length_per_u() * rows.place_rounding),
        u_(unwrapped_as_said(rows.u, rows.place_rounding, finger.period(), rows.u_wrapped)),
        psi_(unwrapped_as_said(rows.psi, rows.angle_rounding, 2 * std::numbers::pi, rows.psi_wrapped)) {}

  /// The part's heading that the contact's normal asks for: u + psi = heading + Theta(s) + pi / 2. At a convex corner
  /// the tangent may have any direction of the pivot, and at a corner of the finger N may, so that this is an interval;
  /// unwrapped over the rows.
  Interval heading(std::size_t row) const;

  /// The contact, in the part's frame and in the world's.
  Vec2 on_part(std::size_t row) const { return part_.point(place(row)); }
  Vec2 in_world(std::size_t row) const;

  std::size_t rows() const { return u_.size(); }

 private:
  /// s = start - (arc length on the finger since the first row): both cover the same length.
  double place(std::size_t row) const { return start_ - finger_.length_per_u() * (u_[row] - u_[0]); }
  Contact contact(std::size_t row) const { return {u_[row], psi_[row]}; }
  Interval tangents(double s) const;

  const Part& part_;
  Finger finger_;
  const FingerRows& rows_;
  double start_;
  /// length: a contact on the finger this near to one of its corners may be on it
  double within_;
  /// length: a contact on the part this near to one of its corners may be on it
  double on_corner_;
  /// unwrapped, as is psi_
  std::vector<double> u_;
  std::vector<double> psi_;
};

/// The directions that the tangent may have at s, in the part's frame.
Interval FeltPart::tangents(double s) const {
  const TurningFunction& turning = part_.turning();
  const double P = part_.perimeter();
  for (const Corner& corner : part_.corners()) {
    // Signed distance to the corner, to the nearest lap.
    const double ahead = part_.closed() ? std::remainder(s - corner.s, P) : s - corner.s;
    if (std::abs(ahead) > on_corner_) continue;
    const double laps = part_.closed() ? std::round((s - corner.s) / P) : 0;
    const double lap_turn = laps * turning.period_turn();
    // Theta before and after the jump; at a concave corner the smaller one is the one after.
    const double before = turning.angle(corner.s, Side::before) + lap_turn;
    const double after = turning.angle(corner.s, Side::after) + lap_turn;
    return {std::min(before, after), std::max(before, after)};
  }
  const double angle = turning.angle(s);
  return {angle, angle};
}

Interval FeltPart::heading(std::size_t row) const {
  // phi = N + psi - pi / 2 - Theta: least for the least N and the largest Theta.
  const Interval tangent = tangents(place(row));
  const Interval normals = finger_.normals(u_[row], within_);
  const double psi = psi_[row] - std::numbers::pi / 2;
  return {normals.lo + psi - tangent.hi, normals.hi + psi - tangent.lo};
}

Vec2 FeltPart::in_world(std::size_t row) const {
  // Where the frame's origin would be if the contact were at 0 says how far the contact is from it.
  return Vec2(rows_.x[row], rows_.y[row]) - centre_of(finger_, Vec2::Zero(), contact(row));
}

double clamped(double value, const Interval& interval) { return std::clamp(value, interval.lo, interval.hi); }

/// The pose with this heading that brings the contact on the part to where it is in the world: X = q - R(phi) p.
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
    // Exact: off the corners a single row tells the heading.
    if (heading.width() == 0) return heading.lo;
    common = {std::max(common.lo, heading.lo), std::min(common.hi, heading.hi)};
  }
  // All rows are on corners: what all intervals have in common, and its middle where more than one heading is possible.
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
  // Both headings are known up to whole turns only: b's is brought next to a's.
  const double turns = kFullTurn * std::round((of_a.middle() - of_b.middle()) / kFullTurn);
  of_b = {of_b.lo + turns, of_b.hi + turns};
  const Interval common{std::max(of_a.lo, of_b.lo), std::min(of_a.hi, of_b.hi)};
  // Without pivots both intervals are points: the mean, and how far they are apart. Apart, too, if the pivots do not
  // overlap.
  if (common.width() <= 0) return {common.middle(), std::abs(common.width())};
  // Both pivot: any heading in common fits the normals, and the chord chooses one of them.
  const double chord = chord_heading(a, b, row);
  const double nearest = chord + kFullTurn * std::round((common.middle() - chord) / kFullTurn);
  return {clamped(nearest, common), 0};
}

/// One finger: the part is at rest, and each row gives a pose of its own. Residuals compare it with the first row.
Poses resting_poses(const FeltPart& felt, const std::vector<std::size_t>& rows) {
  const double resting = resting_heading(felt);
  // Where a row's heading is an interval, the resting heading if it is in there, else the nearest end.
  const double first = clamped(resting, felt.heading(0));
  const double turns = turns_to_near(first);
  const Vec2 first_on_part = felt.on_part(0);
  const Vec2 first_in_world = felt.in_world(0);
  Poses result;
  for (const std::size_t row : rows) {
    beat();
    const double heading = clamped(resting, felt.heading(row));
    result.pose.push_back(pose_with(heading + turns, felt.on_part(row), felt.in_world(row)));
    result.residual.push_back((result.pose.back().world(first_on_part) - first_in_world).norm());
    result.turn_residual.push_back(std::abs(heading - first));
  }
  return result;
}

/// Two fingers: in each row both have one heading, and each gives an origin of the part; the mean is the pose, and
/// their distance the residual.
Poses moving_poses(const FeltPart& a, const FeltPart& b, const std::vector<std::size_t>& rows) {
  const double turns = turns_to_near(agreed_heading(a, b, 0).heading);
  Poses result;
  for (const std::size_t row : rows) {
    beat();
    const auto [heading, gap] = agreed_heading(a, b, row);
    const Pose of_a = pose_with(heading + turns, a.on_part(row), a.in_world(row));
    const Pose of_b = pose_with(heading + turns, b.on_part(row), b.in_world(row));
    result.pose.push_back({(of_a.x + of_b.x) / 2, (of_a.y + of_b.y) / 2, heading + turns});
    result.residual.push_back(std::hypot(of_a.x - of_b.x, of_a.y - of_b.y));
    result.turn_residual.push_back(gap);
  }
  return result;
}

}  // namespace

std::optional<Poses> poses(const Part& part, const std::vector<Finger>& fingers, const Log& log,
                           const PerFinger<double>& start, const std::vector<std::size_t>& rows, const Noise& noise,
                           double start_error) {
  // Of travelled lengths, or without a finger's centre, nothing is known of the world.
  const bool tells =
      !fingers.empty() && log.kind == LogKind::contact &&
      std::none_of(log.fingers.begin(), log.fingers.end(), [](const FingerRows& finger) { return finger.x.empty(); });
  if (!tells) return std::nullopt;
  require_fingers(fingers, log.fingers.size(), true, log.name);
  const FeltPart a(part, *finger_of(fingers, 0), log.fingers[0], start[0], noise, start_error);
  if (log.fingers.size() == 1) return resting_poses(a, rows);
  return moving_poses(a, FeltPart(part, *finger_of(fingers, 1), log.fingers[1], start[1], noise, start_error), rows);
}

}  // namespace rollfix
