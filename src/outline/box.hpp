#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "rollfix/curve.hpp"

namespace rollfix {

/// A rectangle with sides along the axes; empty until it is extended.
using Box = Eigen::AlignedBox2d;

/// Beyond this, products of four coordinates overflow.
inline constexpr double kMostCoordinate = 1e75;

inline Box box_around(const std::vector<Vec2>& points) {
  Box box;
  for (const Vec2& point : points) box.extend(point);
  return box;
}

}  // namespace rollfix
