#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "rollfix/curve.hpp"

namespace rollfix {

/// A rectangle with sides along the axes; empty until it is extended.
using Box = Eigen::AlignedBox2d;

/// Coordinates are at most this large: beyond it, products of four of them overflow.
inline constexpr double kMostCoordinate = 1e75;

/// The smallest such rectangle around points; of no points the empty one.
inline Box box_around(const std::vector<Vec2>& points) {
  Box box;
  for (const Vec2& point : points) box.extend(point);
  return box;
}

}  // namespace rollfix
