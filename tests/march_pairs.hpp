#pragma once

// The exhaustive check of the two-finger march: total curvatures from march_oracle.hpp, pairs by looking at every cell
// of a fine grid and Newton's iteration in each that may hold one. Shares nothing with the march but the curves.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "march_oracle.hpp"
#include "rollfix/march.hpp"
#include "rollfix/turning_function.hpp"

namespace march_pairs {

using rollfix::Reading;
using rollfix::march::PairResult;

struct Point {
  double s = 0;
  double t = 0;
};

/// (8) and (9).
using Readings = std::array<Reading, 2>;

class Exhaustive {
 public:
  explicit Exhaustive(const rollfix::Outline& outline)
      : turn_(outline), curvature_(outline, march_oracle::Measure::curvature, {}) {}

  double perimeter() const { return turn_.perimeter(); }
  rollfix::Boundary loop() const { return {perimeter(), true}; }
  double phi(double s, double length) const { return turn_.phi(s, length); }
  /// phi'(s) = kappa(s + L) - kappa(s)
  double slope(double s, double length) const { return curvature_.phi(s, length); }
  /// Stationary points of phi.
  std::vector<double> stationary(double length) const { return curvature_.scan(length, 0).roots; }

  double distance(const Point& one, const Point& two) const {
    return std::max(loop().distance(one.s, two.s), loop().distance(one.t, two.t));
  }

  double excess(const Point& at, const Reading& reading) const {
    return phi(at.s, reading.length[0]) - phi(at.t, reading.length[1]) - reading.turn;
  }

  /// All pairs that a grid of `places` squared shows.
  std::vector<Point> pairs(const Readings& readings, int places = 240) const {
    std::array<std::vector<double>, 2> a, b;
    for (std::size_t k = 0; k < 2; ++k) {
      for (int i = 0; i <= places; ++i) {
        a[k].push_back(phi(perimeter() * i / places, readings[k].length[0]));
        b[k].push_back(phi(perimeter() * i / places, readings[k].length[1]) + readings[k].turn);
      }
    }
    std::vector<Point> found;
    for (int i = 0; i < places; ++i) {
      for (int j = 0; j < places; ++j) {
        if (!may_vanish(a[0], b[0], i, j) || !may_vanish(a[1], b[1], i, j)) continue;
        polish({perimeter() * (i + 0.5) / places, perimeter() * (j + 0.5) / places}, readings, found);
      }
    }
    return found;
  }

 private:
  /// A margin for what the function does inside the cell, in parts of what its corners differ by.
  static constexpr double kMargin = 0.3;

  static bool may_vanish(const std::vector<double>& a, const std::vector<double>& b, int i, int j) {
    const auto [a_low, a_high] = std::minmax(a[i], a[i + 1]);
    const auto [b_low, b_high] = std::minmax(b[j], b[j + 1]);
    const double margin = kMargin * (a_high - a_low + b_high - b_low);
    return a_low - margin <= b_high && b_low <= a_high + margin;
  }

  void polish(Point at, const Readings& readings, std::vector<Point>& found) const {
    const double longest = 0.02 * perimeter();
    for (int round = 0; round < 25; ++round) {
      const std::array<double, 2> f{excess(at, readings[0]), excess(at, readings[1])};
      const std::array<double, 2> by_s{slope(at.s, readings[0].length[0]), slope(at.s, readings[1].length[0])};
      const std::array<double, 2> by_t{-slope(at.t, readings[0].length[1]), -slope(at.t, readings[1].length[1])};
      const double determinant = by_s[0] * by_t[1] - by_s[1] * by_t[0];
      const Point step{(f[0] * by_t[1] - f[1] * by_t[0]) / determinant,
                       (f[1] * by_s[0] - f[0] * by_s[1]) / determinant};
      const double size = std::max(std::fabs(step.s), std::fabs(step.t));
      if (!std::isfinite(size)) return;
      const double damping = std::min(1.0, longest / size);
      at = {at.s - damping * step.s, at.t - damping * step.t};
      if (size > 1e-12 * perimeter()) continue;
      const bool known = std::any_of(found.begin(), found.end(),
                                     [&](const Point& other) { return distance(at, other) < 1e-7 * perimeter(); });
      if (!known) found.push_back({loop().base(at.s), loop().base(at.t)});
      return;
    }
  }

  march_oracle::Exhaustive turn_;
  march_oracle::Exhaustive curvature_;
};

/// Readings that fit at least one pair of places, which are drawn at random like the lengths.
struct Planted {
  Point at;
  Readings readings;

  template <class Phi>
  Planted(double perimeter, const Phi& phi, std::mt19937_64& generator) {
    std::uniform_real_distribution<double> unit(0, 1);
    at.s = unit(generator) * perimeter;
    at.t = unit(generator) * perimeter;
    for (Reading& reading : readings) {  // of either sign, and beyond P
      reading.length[0] = (3 * unit(generator) - 1.5) * perimeter;
      reading.length[1] = (3 * unit(generator) - 1.5) * perimeter;
      reading.turn = phi(at.s, reading.length[0]) - phi(at.t, reading.length[1]);
    }
  }
  Planted(const Exhaustive& oracle, std::mt19937_64& generator)
      : Planted(
            oracle.perimeter(), [&](double s, double length) { return oracle.phi(s, length); }, generator) {}
};

/// Readings with a double pair: at `at` the curves (phi_1, phi_2)(s) and (phi_3 + theta_1, phi_4 + theta_2)(t) touch.
struct Touching {
  Point at{1.0, 2.0};
  Readings readings{{{1.3, 1.6, 0}, {2.2, 2.9, 0}}};

  explicit Touching(const Exhaustive& oracle) {
    const auto lean = [&](double place, double one, double two) {
      return oracle.slope(place, two) / oracle.slope(place, one);
    };
    const double lean_s = lean(at.s, readings[0].length[0], readings[1].length[0]);
    const auto off = [&](double t) { return lean(t, readings[0].length[1], readings[1].length[1]) - lean_s; };
    double hi = at.t;
    while (off(at.t) * off(hi) > 0 && hi < oracle.perimeter()) hi += 0.01;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (at.t + hi);
      (off(middle) * off(at.t) > 0 ? at.t : hi) = middle;
    }
    for (Reading& reading : readings) {
      reading.turn = oracle.phi(at.s, reading.length[0]) - oracle.phi(at.t, reading.length[1]);
    }
  }
};

inline PairResult march(const rollfix::march::PairMarch& prepared, const Readings& readings) {
  return prepared.pairs(readings[0], readings[1]);
}

/// What a pair may be off by, in parts of the perimeter, or this many of the march's own estimates.
constexpr double kAgreement = 1e-9;
constexpr double kEstimates = 4;
/// Where the march says that it doubts, a pair is looked for this much wider.
constexpr double kDoubtMargin = 1e-7;

inline bool lists(const PairResult& result, const Point& point, double period) {
  return std::any_of(result.pairs.begin(), result.pairs.end(), [&](const auto& pair) {
    const double near = std::max(kAgreement * period, kEstimates * pair.error);
    const rollfix::Boundary loop{period, true};
    return loop.distance(pair.s, point.s) <= near && loop.distance(pair.t, point.t) <= near;
  });
}

inline bool doubts(const PairResult& result, const Point& point, double period) {
  const auto holds = [&](const rollfix::Interval& where, double place) {
    return rollfix::Boundary{period, true}.contains(where, place, kDoubtMargin * period);
  };
  return std::any_of(result.doubts.begin(), result.doubts.end(),
                     [&](const auto& doubt) { return holds(doubt.s, point.s) && holds(doubt.t, point.t); });
}

/// Every pair satisfies (8) and (9), and every pair that the grid shows is listed or in doubt.
inline void expect_agreement(const Exhaustive& oracle, const PairResult& result, const Readings& readings) {
  for (const auto& pair : result.pairs) {
    const Point at{pair.s, pair.t};
    EXPECT_NEAR(oracle.excess(at, readings[0]), 0, 1e-10) << "s = " << at.s << ", t = " << at.t;
    EXPECT_NEAR(oracle.excess(at, readings[1]), 0, 1e-7) << "s = " << at.s << ", t = " << at.t;
  }
  for (const Point& root : oracle.pairs(readings)) {
    EXPECT_TRUE(lists(result, root, oracle.perimeter()) || doubts(result, root, oracle.perimeter()))
        << "lost: s = " << root.s << ", t = " << root.t;
  }
}

/// The interval, of those that the points divide the loop into, in which a place lies.
inline std::size_t interval_of(const std::vector<double>& points, double place) {
  const auto after = std::upper_bound(points.begin(), points.end(), place);
  return static_cast<std::size_t>(after - points.begin() + static_cast<std::ptrdiff_t>(points.size()) - 1) %
         points.size();
}

inline std::string trace_of(const std::string& name, const Readings& readings) {
  return fmt::format("{} La {:.17g} {:.17g} Lb {:.17g} {:.17g} theta {:.17g} {:.17g}", name, readings[0].length[0],
                     readings[1].length[0], readings[0].length[1], readings[1].length[1], readings[0].turn,
                     readings[1].turn);
}

}  // namespace march_pairs
