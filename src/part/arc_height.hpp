#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rollfix::part {

/// No point of an arc is further from its chord. `chord` and `length` of the arc, `turn` of its tangent from end to end
/// in radians, all of it in one direction.
/// Up to a quarter turn the arc is within the triangle of its chord and of the tangents at its ends: the isosceles one
/// is the highest with that turn. Beyond, its points are within the ellipse around the ends of the chord whose sum of
/// distances is the length, which holds for every curve.
inline double arc_height(double chord, double length, double turn) {
  constexpr double kRounding = 1e-9;
  const double height = turn <= 0.5 * std::numbers::pi
                            ? 0.5 * chord * std::tan(0.5 * turn)
                            : 0.5 * std::sqrt(std::max(0.0, length - chord) * (length + chord));
  return height * (1 + kRounding);
}

}  // namespace rollfix::part
