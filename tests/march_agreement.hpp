#pragma once

// What it means that a result of the march agrees with the exhaustive check.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include "march_oracle.hpp"
#include "rollfix/march.hpp"
#include "rollfix/turning_function.hpp"

namespace march_oracle {

/// Of a start, in parts of the perimeter, or this many of the march's own error estimates where those are larger.
constexpr double kAgreement = 1e-10;
constexpr double kEstimates = 4;
/// Where the march says that it doubts, the oracle's root is looked for this much wider.
constexpr double kDoubtMargin = 1e-7;

inline double distance(double a, double b, double perimeter, bool closed) {
  return rollfix::Boundary{perimeter, closed}.distance(a, b);
}

/// Every segment is a root; every root is a segment, or lies in a stretch that the march itself calls doubtful.
inline void expect_agreement(const rollfix::march::Result& result, const std::vector<double>& roots, double perimeter,
                             bool closed) {
  const auto agree = [&](const rollfix::march::Segment& segment, double root) {
    return distance(segment.start, root, perimeter, closed) <=
           std::max(kAgreement * perimeter, kEstimates * segment.error);
  };
  const auto is_root = [&](const auto& segment) {
    return std::any_of(roots.begin(), roots.end(), [&](double root) { return agree(segment, root); });
  };
  const auto is_listed = [&](double root) {
    return std::any_of(result.segments.begin(), result.segments.end(),
                       [&](const auto& segment) { return agree(segment, root); });
  };
  const auto is_doubtful = [&](double root) {
    return std::any_of(result.doubts.begin(), result.doubts.end(), [&](const auto& doubt) {
      const double middle = doubt.where.middle();
      return distance(root, middle, perimeter, closed) <= 0.5 * doubt.where.width() + kDoubtMargin * perimeter;
    });
  };
  for (const auto& segment : result.segments) {
    EXPECT_TRUE(is_root(segment)) << "not a root: s = " << segment.start;
  }
  for (const double root : roots) {
    EXPECT_TRUE(is_listed(root) || is_doubtful(root)) << "lost: s = " << root;
  }
  if (result.complete()) {
    EXPECT_EQ(result.segments.size(), roots.size());
  }
}

/// A reading that fits at least once: from a place and a length drawn at random. On a closed outline the length has
/// either sign and up to two and a half perimeters.
struct RandomReading {
  double length;
  double integral;

  RandomReading(const Exhaustive& oracle, bool closed, std::mt19937_64& generator) {
    std::uniform_real_distribution<double> uniform(0, 1);
    const double perimeter = oracle.perimeter();
    length = (2 * uniform(generator) - 1) * (closed ? 2.5 : 0.95) * perimeter;
    const double lo = closed ? 0 : std::max(0.0, -length);
    const double room = closed ? perimeter : perimeter - std::fabs(length);
    const double start = lo + room * uniform(generator);
    integral = oracle.phi(start, length);
  }
};

}  // namespace march_oracle
