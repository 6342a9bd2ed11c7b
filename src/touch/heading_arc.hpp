#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "outline/turn.hpp"

namespace rollfix::touch {

/// Headings within `half` of a middle, modulo a turn; half below 0: none, from pi on: all.
struct HeadingArc {
  double middle = 0;
  double half = std::numbers::pi;

  bool is_empty() const { return half < 0; }
  bool is_all() const { return half >= std::numbers::pi; }
};

inline constexpr HeadingArc kNoHeading{0, -1};

/// An arc that holds what two have in common. Where they meet at both ends that is the smaller one.
inline HeadingArc common(const HeadingArc& one, const HeadingArc& other) {
  if (one.is_empty() || other.is_empty()) return kNoHeading;
  if (other.is_all()) return one;
  if (one.is_all()) return other;
  const double apart = nearest_angle(other.middle - one.middle);
  if (std::abs(apart) > one.half + other.half) return kNoHeading;
  if (2 * std::numbers::pi - std::abs(apart) <= one.half + other.half) return one.half < other.half ? one : other;
  const double lo = std::max(-one.half, apart - other.half);
  const double hi = std::min(one.half, apart + other.half);
  return {one.middle + 0.5 * (lo + hi), 0.5 * (hi - lo)};
}

inline bool meet(const HeadingArc& one, const HeadingArc& other) { return !common(one, other).is_empty(); }

/// The headings by which a vector of the part's frame is turned to within `slack` of one of the world: by the law of
/// cosines all of them, and no other.
inline HeadingArc headings_between(const Vec2& part, const Vec2& world, double slack) {
  const double in_part = part.norm();
  const double in_world = world.norm();
  if (std::abs(in_part - in_world) > slack) return kNoHeading;
  if (in_part + in_world <= slack) return {};
  const double cosine = (in_part * in_part + in_world * in_world - slack * slack) / (2 * in_part * in_world);
  return {angle_between(part, world), std::acos(std::clamp(cosine, -1.0, 1.0))};
}

}  // namespace rollfix::touch
