#include "pair_residual.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "../corner_sets.hpp"

namespace rollfix {
namespace {

Interval minus(const Interval& one, const Interval& two) { return {one.lo - two.hi, one.hi - two.lo}; }

std::vector<Interval> differences(const AngleSet& one, const AngleSet& two) {
  std::vector<Interval> result;
  for (const Interval& a : choices(one)) {
    for (const Interval& b : choices(two)) result.push_back(minus(a, b));
  }
  return result;
}

/// How far `start`, the two first tangents' difference, must be from fitting all that is wanted of it.
double slack(const Interval& start, const std::vector<Interval>& wanted) {
  double worst = 0;
  for (const Interval& one : wanted) {
    worst = std::max({worst, one.lo - start.hi, start.lo - one.hi});
    for (const Interval& two : wanted) worst = std::max(worst, 0.5 * (one.lo - two.hi));
  }
  return worst;
}

}  // namespace

namespace {

/// Where there are no corners.
double smooth_residual(const Part& part, const std::vector<PairReading>& readings, const std::optional<double>& facing,
                       const PairPoint& at) {
  const TurningFunction& turning = part.turning();
  const double start = turning.angle(at[0]) - turning.angle(at[1]);
  double largest = facing ? std::abs(std::remainder(start - *facing, 2 * std::numbers::pi)) : 0;
  for (const PairReading& reading : readings) {
    const double end = turning.angle(at[0] + reading.length_a) - turning.angle(at[1] + reading.length_b);
    largest = std::max(largest, std::abs(end - start - reading.turn));
  }
  return largest;
}

}  // namespace

double pair_residual(const Part& part, const std::vector<PairReading>& readings, const std::optional<double>& facing,
                     const PairPoint& at) {
  if (part.corners().empty()) return smooth_residual(part, readings, facing, at);
  const AngleSet start_a = angle_set(part, at[0]);
  const AngleSet start_b = angle_set(part, at[1]);
  // With w = Theta(s) - Theta(t):  f_k = Theta(s + La) - Theta(t + Lb) - theta - w.
  std::vector<std::vector<Interval>> combinations(1);
  for (const PairReading& reading : readings) {
    const AngleSet end_a = angle_set(part, at[0] + reading.length_a);
    const AngleSet end_b = angle_set(part, at[1] + reading.length_b);
    std::vector<std::vector<Interval>> longer;
    for (const Interval& difference : differences(end_a, end_b)) {
      for (const std::vector<Interval>& shorter : combinations) {
        longer.push_back(shorter);
        longer.back().push_back({difference.lo - reading.turn, difference.hi - reading.turn});
      }
    }
    combinations = std::move(longer);
  }
  double least = std::numeric_limits<double>::infinity();
  for (const Interval& start : differences(start_a, start_b)) {
    for (std::vector<Interval> wanted : combinations) {
      if (facing) {
        const double lap = 2 * std::numbers::pi * std::round((start.middle() - *facing) / (2 * std::numbers::pi));
        wanted.push_back({*facing + lap, *facing + lap});
      }
      least = std::min(least, slack(start, wanted));
    }
  }
  return least;
}

std::array<bool, 2> pivots_at(const Part& part, const std::vector<PairReading>& readings, const PairPoint& at) {
  std::array<bool, 2> pivots{angle_set(part, at[0]).pivot, angle_set(part, at[1]).pivot};
  for (const PairReading& reading : readings) {
    pivots[0] = pivots[0] || angle_set(part, at[0] + reading.length_a).pivot;
    pivots[1] = pivots[1] || angle_set(part, at[1] + reading.length_b).pivot;
  }
  return pivots;
}

std::array<Pivot, 2> pair_pivots(const Part& part, const std::vector<PairReading>& readings, const PairPoint& at) {
  const PairReading& last = readings.back();
  return {Pivot{angle_set(part, at[0]).angles, angle_set(part, at[0] + last.length_a).angles},
          Pivot{angle_set(part, at[1]).angles, angle_set(part, at[1] + last.length_b).angles}};
}

}  // namespace rollfix
