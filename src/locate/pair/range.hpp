#pragma once

#include <algorithm>
#include <cmath>

namespace rollfix {

/// Bounds from below and from above, with the arithmetic of intervals.
struct Range {
  double least = 0;
  double most = 0;

  double spread() const { return most - least; }
  double middle() const { return 0.5 * (least + most); }
  double size() const { return std::max(std::abs(least), std::abs(most)); }           // the largest absolute value
  bool comes_within(double limit) const { return least <= limit && most >= -limit; }  // of 0
  bool has_sign() const { return least > 0 || most < 0; }
  bool keeps_sign() const { return least >= 0 || most <= 0; }  // 0 allowed
};

inline Range operator+(const Range& one, const Range& two) { return {one.least + two.least, one.most + two.most}; }
inline Range operator-(const Range& one, const Range& two) { return {one.least - two.most, one.most - two.least}; }

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

/// REQUIRES that the divisor has a sign.
inline Range operator/(const Range& one, const Range& two) { return one * Range{1 / two.most, 1 / two.least}; }

/// What both leave; bounds on the same meet, but for rounding.
inline Range common(const Range& one, const Range& two) {
  return {std::max(one.least, two.least), std::min(one.most, two.most)};
}

inline Range hull(double one, double two) { return {std::min(one, two), std::max(one, two)}; }

inline Range hull(const Range& one, const Range& two) {
  return {std::min(one.least, two.least), std::max(one.most, two.most)};
}

/// Bounds on a function over a width, from its values at the ends and bounds on its slope.
inline Range value_range(double at_lo, double at_hi, const Range& slope, double width) {
  if (slope.keeps_sign()) return hull(at_lo, at_hi);
  const double scale = slope.least * slope.most * width;
  const double share = 1 / slope.spread();
  return {(slope.most * at_lo - slope.least * at_hi + scale) * share,
          (slope.most * at_hi - slope.least * at_lo - scale) * share};
}

}  // namespace rollfix
