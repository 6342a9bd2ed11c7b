#pragma once

#include <cmath>
#include <numbers>

#include "rollfix/outline/curve.hpp"

namespace rollfix {

/// The same angle in (-pi, pi].
inline double nearest_angle(double angle) {
  const double turned = std::remainder(angle, 2 * std::numbers::pi);
  return turned <= -std::numbers::pi ? std::numbers::pi : turned;
}

/// The signed angle from one direction to another, in (-pi, pi].
inline double angle_between(const Vec2& from, const Vec2& to) { return std::atan2(cross(from, to), from.dot(to)); }

}  // namespace rollfix
