#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "outline/turn.hpp"

// Arcs of the part's heading, modulo a turn, and which headings turn vectors of the part into one of the world.
// Notation:
//   phi             the part's heading; R(phi) turns the part's frame into the world's
//   v, w            a vector of the part, as between two centres on it, and one of the world: `part`, `world`
//   slack           |R(phi) v - w| is at most this
//   v = a d + b d'  in a rectangle: d a direction and d' to the left of it, a and b in intervals: VectorBox, `ahead`,
//                   `left`
// Equations: |R(phi) v - w|^2 = |v|^2 + |w|^2 - 2 |v| |w| cos(phi - phi_0), where phi_0 is the angle from v to w. Of a
// rectangle | |v| - |w| | <= slack bounds a and b, by a^2 + b^2 = |v|^2. Follows docs/touch.md, "How it works".
// Idea: of one vector the arc is exact. A rectangle is first cut to vectors that are long enough and not too long; what
// is left lies in a cone about its middle, and the arc is as wide as the cone and asin(slack / |w|) together. Arcs may
// be wide, never narrow: the search drops what they leave out.
namespace rollfix::touch {

/// Headings within `half` of a middle, modulo a turn; half below 0: none, from pi on: all.
struct HeadingArc {
  double middle = 0;
  double half = std::numbers::pi;

  bool is_empty() const { return half < 0; }
  bool is_all() const { return half >= std::numbers::pi; }
};

// A cell with it holds no pose.
inline constexpr HeadingArc kNoHeading{0, -1};

/// An arc that holds what two have in common. Where they meet at both ends that is the smaller one.
inline HeadingArc common(const HeadingArc& one, const HeadingArc& other) {
  if (one.is_empty() || other.is_empty()) return kNoHeading;
  if (other.is_all()) return one;
  if (one.is_all()) return other;
  // In (-pi, pi], so that arcs are compared on the shorter way round.
  const double apart = nearest_angle(other.middle - one.middle);
  if (std::abs(apart) > one.half + other.half) return kNoHeading;
  // They meet on the far side as well: what they have in common is two arcs, and either of the two given holds both.
  if (2 * std::numbers::pi - std::abs(apart) <= one.half + other.half) return one.half < other.half ? one : other;
  const double lo = std::max(-one.half, apart - other.half);
  const double hi = std::min(one.half, apart + other.half);
  return {one.middle + 0.5 * (lo + hi), 0.5 * (hi - lo)};
}

/// Arcs that touch at one heading meet.
inline bool meet(const HeadingArc& one, const HeadingArc& other) { return !common(one, other).is_empty(); }

/// The headings by which a vector of the part's frame is turned to within `slack` of one of the world: by the law of
/// cosines all of them, and no other.
inline HeadingArc headings_between(const Vec2& part, const Vec2& world, double slack) {
  const double in_part = part.norm();
  const double in_world = world.norm();
  // Turning changes no length: the triangle inequality leaves none, ...
  if (std::abs(in_part - in_world) > slack) return kNoHeading;
  // ... or all, as for vectors that are shorter than the slack.
  if (in_part + in_world <= slack) return {};
  // |R(phi) v - w|^2 = |v|^2 + |w|^2 - 2 |v| |w| cos(angle between): at most slack^2.
  const double cosine = (in_part * in_part + in_world * in_world - slack * slack) / (2 * in_part * in_world);
  return {angle_between(part, world), std::acos(std::clamp(cosine, -1.0, 1.0))};
}

/// A rectangle of vectors: coordinates along a direction, and to the left of it.
/// `ahead` and `left` are intervals in the part's unit; lo above hi: empty.
struct VectorBox {
  Vec2 direction = Vec2::UnitX();
  Interval ahead;
  Interval left;

  Vec2 vector(double ahead_by, double left_by) const {
    return ahead_by * direction + left_by * Vec2(-direction.y(), direction.x());
  }
  bool is_empty() const { return ahead.lo > ahead.hi || left.lo > left.hi; }
  /// Then vectors of every direction are in it.
  bool has_zero() const { return ahead.contains(0) && left.contains(0); }
};

/// What a coordinate can be where the length is known, and the other coordinate: up to two intervals, here from the
/// first to the end of the second; lo above hi: nothing.
/// From a^2 + b^2 = l^2: |a| lies between sqrt(l.lo^2 - max b^2) and sqrt(l.hi^2 - min b^2), with either sign.
inline Interval coordinate(const Interval& own, const Interval& other, const Interval& length) {
  const double rounding = 1e-14 * length.hi * length.hi;  // of squares
  const double most_other = std::max(std::abs(other.lo), std::abs(other.hi));
  const double least_other = std::max({0.0, other.lo, -other.hi});
  const double square = length.hi * length.hi - least_other * least_other + rounding;
  if (square < 0) return {1, 0};
  const double hi = std::sqrt(square);
  const double lo = std::sqrt(std::max(0.0, length.lo * length.lo - most_other * most_other - rounding));
  // Of the two intervals, -hi to -lo and lo to hi, those that the coordinate's own interval meets.
  const bool is_below = own.lo <= -lo && own.hi >= -hi;
  const bool is_above = own.lo <= hi && own.hi >= lo;
  if (!is_below && !is_above) return {1, 0};
  return {is_below ? std::max(own.lo, -hi) : std::max(own.lo, lo),
          is_above ? std::min(own.hi, hi) : std::min(own.hi, -lo)};
}

/// The headings by which some vector of a box is turned to within `slack` of one of the world.
/// A superset of them: the box is cut to vectors of a possible length, then a cone about its middle holds it.
inline HeadingArc headings_between(VectorBox part, const Vec2& world, double slack) {
  const double in_world = world.norm();
  if (in_world <= slack) return {};
  const Interval length{in_world - slack, in_world + slack};
  // The second cut knows the first coordinate as the first cut has left it.
  part.ahead = coordinate(part.ahead, part.left, length);
  if (part.is_empty()) return kNoHeading;
  part.left = coordinate(part.left, part.ahead, length);
  if (part.is_empty()) return kNoHeading;
  if (part.has_zero()) return {};
  const Vec2 middle = part.vector(part.ahead.middle(), part.left.middle());
  double slope = 0;  // of the corners, seen from there
  for (const double ahead : {part.ahead.lo, part.ahead.hi}) {
    for (const double left : {part.left.lo, part.left.hi}) {
      const Vec2 corner = part.vector(ahead, left);
      // A corner is a quarter of a turn or more off the middle's direction: no cone.
      if (!(middle.dot(corner) > 0)) return {};
      slope = std::max(slope, std::abs(cross(middle, corner)) / middle.dot(corner));
    }
  }
  // The cone's half angle, and by how much the world's vector can be off in direction.
  return {angle_between(middle, world), std::atan(slope) + std::asin(slack / in_world)};
}

}  // namespace rollfix::touch
