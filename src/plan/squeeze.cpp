#include "plan/squeeze.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "finger/convex_body.hpp"

// Notation as in squeeze.hpp. Between two instants, each contact going one way, a bound of the stability takes each
// term's worst: curvatures are monotone on spirals, so that their ends and the joints between them are all that is
// looked at.
namespace rollfix::planning {
namespace {

/// Direction of a vector, radians.
double angle_of(const Vec2& vector) { return std::atan2(vector.y(), vector.x()); }

/// From one direction to another, in [-pi, pi].
double angle_between(double from, double to) { return std::remainder(to - from, 2 * std::numbers::pi); }

/// The part's outward normal.
Vec2 outward_at(const ContactPlace& place) { return {std::sin(place.angle), -std::cos(place.angle)}; }

/// The gap of a jaw and a disk: the jaw's surface is the tangent at its contact, its body outside of it.
double of_disk_and_jaw(const ContactPlace& jaw, const ContactPlace& disk, double radius) {
  return -(disk.centre - jaw.point).dot(outward_at(jaw)) - radius;
}

/// Of the finger's frame, in the part's.
Pose frame_at(const ContactPlace& place) { return {place.centre.x(), place.centre.y(), place.contact.psi}; }

/// What of a finger's body is farthest from where it touches, at most; how far a disk is, its centre tells.
double arm_of(const Finger& finger) {
  if (finger.is_disk()) return finger.disk()->radius;
  return finger.outline()->closed() ? finger.outline()->perimeter() / 2 : finger.outline()->perimeter();
}

/// A finger that rolls turns about its contact, which is somewhere on it.
double moved(const Finger& finger, const ContactPlace& from, const ContactPlace& to) {
  return arm_of(finger) * std::abs(to.turned - from.turned);
}

/// Of a body seen from a jaw, which turns and goes along the part.
double change_at_jaw(const ContactPlace& jaw, const ContactPlace& next_jaw, const Finger& body,
                     const ContactPlace& from, const ContactPlace& to) {
  // The jaw's line turns by `turn` and its contact goes along the part by `along`; the body moves by `by`.
  const double turn = std::abs(next_jaw.turned - jaw.turned);
  const double along = std::abs(next_jaw.s - jaw.s);
  const double by = moved(body, from, to);
  const double away =
      body.is_disk() ? (from.centre - jaw.point).norm() : (from.point - jaw.point).norm() + arm_of(body);
  return (away + along + by) * turn + along * std::min(1.0, turn) + by;
}

constexpr double kInfinite = std::numeric_limits<double>::infinity();

void include(Interval& range, double value) {
  range.lo = std::min(range.lo, value);
  range.hi = std::max(range.hi, value);
}

/// What the curvature is between two places, ends and both sides of joints included; infinite above where there is a
/// convex corner. On a spiral it is monotone, so that its values at the ends are all that is needed.
Interval curvatures_between(const Part& part, double one, double other) {
  const double rounding = kLengthAccuracy * part.perimeter();
  const double lo = std::min(one, other) - rounding;
  const double hi = std::max(one, other) + rounding;
  const double P = part.perimeter();
  const double first_lap = part.closed() ? std::floor(lo / P) : 0;
  const double last_lap = part.closed() ? std::floor(hi / P) : 0;
  Interval range{kInfinite, -kInfinite};
  // On each lap that the way touches: the pieces of spirals in it.
  for (double lap = first_lap; lap <= last_lap; ++lap) {
    for (const Spiral& spiral : part.turning().spirals()) {
      const double from = std::max(lo - lap * P, spiral.lo);
      const double to = std::min(hi - lap * P, spiral.hi);
      if (from > to) continue;
      include(range, part.turning().on_spiral(spiral, from).curvature);
      include(range, part.turning().on_spiral(spiral, to).curvature);
    }
    for (const Corner& corner : part.corners()) {
      const double at = corner.s + lap * P;
      // On a corner's pivot the curvature is infinite, and Theta turns while s stays.
      if (corner.turn >= kJointTurn && lo <= at && at <= hi) range.hi = kInfinite;
    }
  }
  return range;
}

/// The finger's own curvature between two contacts: constant of a disk or a jaw.
Interval finger_curvatures(const ContactWay& way, const ContactPlace& one, const ContactPlace& two) {
  const Part* const outline = way.finger().outline();
  if (outline != nullptr) return curvatures_between(*outline, one.contact.u, two.contact.u);
  const double curvature = way.finger_curvature(one);
  return {curvature, curvature};
}

/// w of squeeze.hpp
double share_of(double bend, double distance, double radius) { return 1 / (1 + bend * (distance + radius)); }

/// The least b: it falls with kappa.
double least_bent(double kappa, const Interval& distance, double radius) {
  // The limit at a corner.
  if (std::isinf(kappa)) return -distance.hi / radius;
  return (1 - kappa * (kappa > 0 ? distance.hi : distance.lo)) / (1 + radius * kappa);
}

}  // namespace

/// A and B of squeeze.hpp: the line through both contacts against each inward normal.
Squeeze squeeze_of(const ContactPlace& a, const ContactPlace& b, bool expanding) {
  // Two fingers at one place press nothing together: as if they pulled.
  if (a.point == b.point) return {std::numbers::pi, std::numbers::pi, 0};
  const Vec2 to_b = expanding ? Vec2(a.point - b.point) : Vec2(b.point - a.point);
  const double line = angle_of(to_b);
  // The way from b to a is opposite to that from a to b.
  return {angle_between(a.inward(), line), angle_between(b.inward(), line + std::numbers::pi), to_b.norm()};
}

/// Exact for disks and a jaw; of outlines by the distance of convex bodies.
std::optional<double> gap_between(const Finger& finger_a, const ContactPlace& a, const Finger& finger_b,
                                  const ContactPlace& b, double enough) {
  if (finger_a.is_jaw() && finger_b.is_jaw()) return std::nullopt;
  if (finger_a.is_disk() && finger_b.is_disk()) {
    return (a.centre - b.centre).norm() - finger_a.disk()->radius - finger_b.disk()->radius;
  }
  if (finger_a.is_jaw() && finger_b.is_disk()) return of_disk_and_jaw(a, b, finger_b.disk()->radius);
  if (finger_a.is_disk() && finger_b.is_jaw()) return of_disk_and_jaw(b, a, finger_a.disk()->radius);
  const ConvexBody of_a(finger_a, frame_at(a));
  const ConvexBody of_b(finger_b, frame_at(b));
  // A jaw and an outline: minus how deep the outline is beyond the jaw's line.
  if (finger_a.is_jaw()) return -depth_of_overlap(frame_at(a), of_b);
  if (finger_b.is_jaw()) return -depth_of_overlap(frame_at(b), of_a);
  // A lower bound of the distance, from one direction alone: mostly that is enough.
  const double straight = -depth_along(of_a, of_b, angle_of(b.point - a.point));
  return straight >= enough ? straight : distance_between(of_a, of_b, enough);
}

double gap_change(const Finger& finger_a, const ContactPlace& a, const ContactPlace& next_a, const Finger& finger_b,
                  const ContactPlace& b, const ContactPlace& next_b) {
  if (finger_a.is_jaw() && finger_b.is_jaw()) return 0;
  // A jaw has no end: how far its line moves grows with the distance from its contact.
  if (finger_a.is_jaw()) return change_at_jaw(a, next_a, finger_b, b, next_b);
  if (finger_b.is_jaw()) return change_at_jaw(b, next_b, finger_a, a, next_a);
  // The distance of two bodies changes by what their points move, at most.
  return moved(finger_a, a, next_a) + moved(finger_b, b, next_b);
}

double size_of(const Finger& finger) {
  if (finger.is_disk()) return finger.disk()->radius;
  return finger.is_jaw() ? 0 : finger.outline()->perimeter() / (2 * std::numbers::pi);
}

double stability_of(const ContactWay& way_a, const ContactWay& way_b, const PairPlace& place) {
  return stability_between(way_a, way_b, place, place);
}

double stability_between(const ContactWay& way_a, const ContactWay& way_b, const PairPlace& one, const PairPlace& two) {
  const double r = way_b.finger().disk()->radius;
  // D
  const auto distance_of = [](const PairPlace& place) { return (place.b.point - place.a.point).norm(); };
  // Both contacts together go by `moved`, and the contacts' distance changes by no more, from either instant.
  const double moved = std::abs(two.a.s - one.a.s) + std::abs(two.b.s - one.b.s);
  const Interval distance{std::max({distance_of(one), distance_of(two)}) - moved,
                          std::min({distance_of(one), distance_of(two)}) + moved};
  // No bound: the caller halves the interval.
  if (distance.lo <= 0) return -kInfinite;
  const auto across_of = [](const PairPlace& place) { return std::abs(std::cos(place.b.angle - place.a.angle)); };
  // A lower bound of |cos d|, which changes by no more than d does.
  const double across =
      std::max(across_of(one), across_of(two)) - turn_between(one.a, two.a) - turn_between(one.b, two.b);
  // Bounds of the curvatures on the way: corners and joints on it included.
  const Interval kappa_s = curvatures_between(way_a.part(), one.a.s, two.a.s);
  // K is the sum of kappa_s and of_a
  const Interval of_a = finger_curvatures(way_a, one.a, two.a);
  const double kappa_t = curvatures_between(way_b.part(), one.b.s, two.b.s).hi;
  // A lower bound of b, at the largest kappa.
  const double bent = least_bent(kappa_t, distance, r);
  // w |cos d| + (1 - w) b is linear in w: its least value is at the least or at the largest w. K is at least 0.
  double least = kInfinite;
  for (const double share : {share_of(kappa_s.hi + of_a.hi, distance.hi, r),
                             share_of(std::max(0.0, kappa_s.lo + of_a.lo), distance.lo, r)}) {
    least = std::min(least, share * across + (1 - share) * bent);
  }
  return least;
}

}  // namespace rollfix::planning
