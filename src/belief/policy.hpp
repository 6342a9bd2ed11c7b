#pragma once

#include <algorithm>
#include <cmath>

#include "rollfix/belief/belief.hpp"
#include "rollfix/outline/curve.hpp"
#include "rollfix/part/part.hpp"
#include "rollfix/part/period.hpp"

// What one finger and two have in common when it comes to a verdict.
namespace rollfix::belief {

// Samples that are off by more than this many times the noise can't be of this part and this finger.
inline constexpr double kMostExcess = 2.5;
// An explanation that leaves no more than this many times the excess of another is about as good.
inline constexpr double kAboutAsGood = 1.3;
// The farthest of the errors that are let pass, in standard deviations.
inline constexpr double kFarthest = 4.5;
// A place with this probability is the only one.
inline constexpr double kCertain = 0.95;
// One with less than this is not counted among those that remain.
inline constexpr double kCounts = 0.01;
// Of samples that are asked to be robust, this share is taken to be stray.
inline constexpr double kOutlierShare = 0.02;
// The samples' cost is beyond what chance makes of it: this many standard deviations of a chi-square.
inline constexpr double kExcessSigma = 3;
// A placement of the search further than this many standard deviations from a mode is another one.
inline constexpr double kNear = 3;

// s as a function of w need not be better than this share of what a contact is known to, nor than that of the
// perimeter.
inline constexpr double kShareOfNoise = 1e-3;
inline constexpr double kShareOfPerimeter = 1e-9;
// The scale of lengths is not believed beyond these many standard deviations, nor beyond this share.
inline constexpr double kMostSigmas = 8;
inline constexpr double kMostScale = 0.5;
// Two peaks are two places when the density on the best way between them is below exp(-3) = 5 % of the lower one.
inline constexpr double kValley = 3;
// A mode with less probability than this is not listed.
inline constexpr double kLeastProbability = 1e-4;
// What an interval of a mode holds.
inline constexpr double kCredible = 0.95;
// A piece of the posterior with less of it is not told of.
inline constexpr double kLeastShare = 1e-9;

inline double square(double x) { return x * x; }

/// The standard normal deviate that is as unlikely as this chi-square (Wilson and Hilferty 1931).
inline double normal_deviate(double chi_square, double freedom) {
  const double spread = 2 / (9 * freedom);
  return (std::cbrt(chi_square / freedom) - (1 - spread)) / std::sqrt(spread);
}

/// By how many times more the samples are off than the noise allows, given what the best place costs.
inline double excess_of(double cost, double freedom, bool robust) {
  const bool is_excess = freedom > 0 && !robust && normal_deviate(cost, freedom) > kExcessSigma;
  return is_excess ? std::max(1.0, std::sqrt(cost / freedom)) : 1.0;
}

/// Which explanation it is, given what both leave. Slip here and there explains a wrong scale as well: the simpler one
/// counts, where it is about as good.
inline Diagnosis likelier(const Diagnosis& radius, const Diagnosis& slip, double excess) {
  if (radius.excess <= kMostExcess && radius.excess <= kAboutAsGood * slip.excess) return radius;
  if (slip.excess <= kMostExcess) return {Cause::slip, slip.excess, 1};
  return {Cause::part, excess, 1};
}

/// How far outside an extent a place is; 0 inside.
inline double distance_to(const Interval& extent, double s, const Part& part) {
  if (!part.closed()) return std::max({0.0, extent.lo - s, s - extent.hi});
  const double P = part.perimeter();
  const double ahead = wrap(s - extent.lo, P).base;
  if (ahead <= extent.width()) return 0;
  return std::min(ahead - extent.width(), P - ahead);
}

}  // namespace rollfix::belief
