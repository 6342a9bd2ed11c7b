#pragma once

#include <boost/container/small_vector.hpp>

#include "rollfix/curve.hpp"

namespace rollfix {

/// The corners of a convex polygon in order; none: empty. A box that a few lines cut needs no allocation.
using Polygon = boost::container::small_vector<Vec2, 8>;

/// What is left of a convex polygon where `excess`, a linear function of a point, is not above 0.
template <class Excess>
Polygon clipped(const Polygon& polygon, const Excess& excess) {
  Polygon kept;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec2& here = polygon[k];
    const Vec2& next = polygon[(k + 1) % polygon.size()];
    const double from = excess(here);
    const double to = excess(next);
    if (from <= 0) kept.push_back(here);
    if ((from < 0 && to > 0) || (from > 0 && to < 0)) kept.push_back(here + (next - here) * (from / (from - to)));
  }
  return kept;
}

/// The part of a convex polygon in the box from `lo` to `hi`. What is cut off leaves its corners on the very edge.
inline Polygon clipped(const Polygon& polygon, const Vec2& lo, const Vec2& hi) {
  Polygon kept = polygon;
  for (const Eigen::Index axis : {0, 1}) {
    kept = clipped(kept, [&](const Vec2& x) { return lo[axis] - x[axis]; });
    kept = clipped(kept, [&](const Vec2& x) { return x[axis] - hi[axis]; });
  }
  for (Vec2& corner : kept) corner = corner.cwiseMax(lo).cwiseMin(hi);
  return kept;
}

/// The part of a convex polygon where |value + slope . (x - at)| <= most.
inline Polygon within(const Polygon& polygon, const Vec2& at, double value, const Vec2& slope, double most) {
  const auto f = [&](const Vec2& x) { return value + slope.dot(x - at); };
  const Polygon below = clipped(polygon, [&](const Vec2& x) { return f(x) - most; });
  return clipped(below, [&](const Vec2& x) { return -f(x) - most; });
}

}  // namespace rollfix
