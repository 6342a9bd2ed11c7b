#pragma once

#include <Eigen/Core>

namespace rollfix {

/// A point or a vector of the plane, in the outline's own unit.
using Vec2 = Eigen::Vector2d;

/// z component of the cross product: positive where b is to the left of a.
inline double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// A closed interval of reals.
struct Interval {
  double lo = 0;
  double hi = 0;

  double width() const { return hi - lo; }
  double middle() const { return lo + 0.5 * (hi - lo); }
  bool contains(double value) const { return lo <= value && value <= hi; }
};

}  // namespace rollfix
