#pragma once

#include <algorithm>
#include <boost/container/small_vector.hpp>
#include <cmath>

#include "rollfix/curve.hpp"

namespace rollfix {

/// Bounds least <= value <= most, with the arithmetic of intervals. Results are not rounded outwards: they hold up to
/// rounding. least > most: no value, as `common` of ranges that do not meet.
struct Range {
  double least = 0;
  double most = 0;

  double spread() const { return most - least; }  // how much the value can vary
  double middle() const { return 0.5 * (least + most); }
  double size() const { return std::max(std::abs(least), std::abs(most)); }           // the largest absolute value
  bool comes_within(double limit) const { return least <= limit && most >= -limit; }  // of 0
  bool has_sign() const { return least > 0 || most < 0; }                             // surely not 0
  bool keeps_sign() const { return least >= 0 || most <= 0; }                         // 0 allowed
};

/// Sum and difference of two values that know nothing of each other: shared terms do not cancel here. See
/// PlaneCurve::Combination.
inline Range operator+(const Range& one, const Range& two) { return {one.least + two.least, one.most + two.most}; }
inline Range operator-(const Range& one, const Range& two) { return {one.least - two.most, one.most - two.least}; }

/// The extremes of a product are at corners of the box of both factors.
inline Range operator*(const Range& one, const Range& two) {
  const double a = one.least * two.least;
  const double b = one.least * two.most;
  const double c = one.most * two.least;
  const double d = one.most * two.most;
  return {std::min(std::min(a, b), std::min(c, d)), std::max(std::max(a, b), std::max(c, d))};
}

inline Range operator*(double factor, const Range& range) {
  return factor >= 0 ? Range{factor * range.least, factor * range.most}
                     : Range{factor * range.most, factor * range.least};
}

/// REQUIRES that the divisor has a sign: has_sign().
inline Range operator/(const Range& one, const Range& two) { return one * Range{1 / two.most, 1 / two.least}; }

/// The bounds that follow from both, which are on the same value: they meet, but for rounding.
inline Range common(const Range& one, const Range& two) {
  return {std::max(one.least, two.least), std::min(one.most, two.most)};
}

/// The least range that holds both.
inline Range hull(double one, double two) { return {std::min(one, two), std::max(one, two)}; }

inline Range hull(const Range& one, const Range& two) {
  return {std::min(one.least, two.least), std::max(one.most, two.most)};
}

/// Bounds on a function over a width, from its values at the ends and bounds on its slope. With a slope of one sign it
/// is monotone. Else the lines of least and of largest slope through the two ends meet at the bounds.
inline Range value_range(double at_lo, double at_hi, const Range& slope, double width) {
  if (slope.keeps_sign()) return hull(at_lo, at_hi);
  const double scale = slope.least * slope.most * width;
  const double share = 1 / slope.spread();
  return {(slope.most * at_lo - slope.least * at_hi + scale) * share,
          (slope.most * at_hi - slope.least * at_lo - scale) * share};
}

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
    // A corner stays where it is on the right side; an edge that changes sides leaves the point where it crosses.
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

/// The part of a convex polygon where a function that is straight, with this value and slope at `at`, is at most `most`
/// in size.
inline Polygon within(const Polygon& polygon, const Vec2& at, double value, const Vec2& slope, double most) {
  const auto f = [&](const Vec2& x) { return value + slope.dot(x - at); };
  const Polygon below = clipped(polygon, [&](const Vec2& x) { return f(x) - most; });
  return clipped(below, [&](const Vec2& x) { return -f(x) - most; });
}

}  // namespace rollfix
