#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "rollfix/locate/march/march.hpp"
#include "rollfix/locate/march/pair_result.hpp"
#include "rollfix/locate/march/start.hpp"

namespace rollfix::march {

/// An interval on which both phi of a finger are monotone.
struct MonotoneInterval {
  Start lo;
  Start hi;
  std::array<int, 2> trend{};  // of each phi as s grows: +1 or -1

  /// Its end at which the first phi is smaller, and the other one.
  const Start& bottom() const { return trend[0] > 0 ? lo : hi; }
  const Start& top() const { return trend[0] > 0 ? hi : lo; }
  /// Trend of the second phi as the first one grows.
  int second_along_first() const { return trend[0] * trend[1]; }
};

/// Section 3.1 for one finger. The places point to `segments`, which must outlive it.
struct Partition {
  std::vector<MonotoneInterval> intervals;  // in order; together one loop
  std::vector<double> points;               // a_0 ... a_{n-1}, in [0, P)
  std::vector<Interval> doubts;             // stretches of s with doubtful stationary points, cut out by points
  std::size_t merged = 0;
};

/// What section 3.1 is done with.
struct PartitionTools {
  const Path& path;    // integrates the curvature
  const March& march;  // integrates its derivative
  double perimeter = 0;
};

/// "The stationary points of phi_1 and phi_2, found by the modified marching algorithm, divide the curve domain into n
/// intervals [a_i, a_{i+1}]. The values of phi_1 and phi_2 at all a_i are computed with one round of integrations."
/// Throws Refusal (continuum) where one of them is constant.
Partition divide(const PartitionTools& tools, const Segments& segments, Tally& evaluation, PairSteps& steps);

}  // namespace rollfix::march
