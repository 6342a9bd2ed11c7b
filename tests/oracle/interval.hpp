#pragma once

// Numbers of the oracle: long double, and intervals of them that hold every value they may stand for.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace oracle {

/// 64 bits on a PC, 11 more than the library has: what is rounded here is 1e-19, what is compared 1e-12.
using Real = long double;

inline constexpr Real kPi = std::numbers::pi_v<Real>;
inline constexpr Real kRounding = std::numeric_limits<Real>::epsilon();  // more than one operation's

struct Interval {
  Real lo = 0;
  Real hi = 0;

  Interval() = default;
  Interval(Real value) : lo(value), hi(value) {}  // NOLINT(google-explicit-constructor): a number is an interval
  Interval(Real from, Real to) : lo(from), hi(to) {}

  Real width() const { return hi - lo; }
  Real middle() const { return lo + (hi - lo) / 2; }
  Real size() const { return std::max(std::abs(lo), std::abs(hi)); }
  bool contains(Real value) const { return lo <= value && value <= hi; }
};

/// An interval whose ends were rounded by a few operations' worth.
inline Interval rounded(Real lo, Real hi) {
  return {lo - 4 * kRounding * std::abs(lo), hi + 4 * kRounding * std::abs(hi)};
}

inline Interval hull(const Interval& one, const Interval& other) {
  return {std::min(one.lo, other.lo), std::max(one.hi, other.hi)};
}

/// What two intervals that hold one value both allow.
inline Interval both(const Interval& one, const Interval& other) {
  return {std::max(one.lo, other.lo), std::min(one.hi, other.hi)};
}

inline Interval operator-(const Interval& a) { return {-a.hi, -a.lo}; }
inline Interval operator+(const Interval& a, const Interval& b) { return rounded(a.lo + b.lo, a.hi + b.hi); }
inline Interval operator-(const Interval& a, const Interval& b) { return a + -b; }

inline Interval operator*(const Interval& a, const Interval& b) {
  const auto [least, most] = std::minmax({a.lo * b.lo, a.lo * b.hi, a.hi * b.lo, a.hi * b.hi});
  return rounded(least, most);
}

inline Interval inverse(const Interval& a) {
  constexpr Real kInfinity = std::numeric_limits<Real>::infinity();
  if (a.contains(0)) return {-kInfinity, kInfinity};
  return rounded(1 / a.hi, 1 / a.lo);
}
inline Interval operator/(const Interval& a, const Interval& b) { return a * inverse(b); }

inline Interval exp(const Interval& a) { return rounded(std::exp(a.lo), std::exp(a.hi)); }

/// a >= 0 to a power; the usual ones by roots, which are faster and rounded better.
inline Real power(Real a, Real exponent) {
  if (exponent == 0.5L) return std::sqrt(a);
  if (exponent == -0.5L) return 1 / std::sqrt(a);
  if (exponent == -1.5L) return 1 / (a * std::sqrt(a));
  if (exponent == -0.25L) return 1 / std::sqrt(std::sqrt(a));
  return std::pow(a, exponent);
}
inline Interval power(const Interval& a, Real exponent) {
  const Real lo = power(std::max<Real>(a.lo, 0), exponent), hi = power(a.hi, exponent);
  return rounded(std::min(lo, hi), std::max(lo, hi));
}

inline Interval sin(const Interval& a) {
  const auto passes = [&](Real peak) {
    return std::floor((a.hi - peak) / (2 * kPi)) > std::floor((a.lo - peak) / (2 * kPi));
  };
  const Real one = std::sin(a.lo), other = std::sin(a.hi);
  const Real slack = 4 * kRounding;
  return {passes(-kPi / 2) ? -1 : std::min(one, other) - slack, passes(kPi / 2) ? 1 : std::max(one, other) + slack};
}
inline Interval cos(const Interval& a) { return sin(a + Interval(kPi / 2)); }

/// What a function can be between two places, given its values there and bounds on its slope in between.
inline Interval between(Real first, Real last, const Interval& slope, Real width) {
  Interval values = hull(first, last);
  if (slope.lo < 0 && slope.hi > 0) {
    values.hi = std::max(values.hi, first + slope.hi * (last - first - slope.lo * width) / slope.width());
    values.lo = std::min(values.lo, first + slope.lo * (first - last + slope.hi * width) / slope.width());
  }
  return values;
}

}  // namespace oracle
