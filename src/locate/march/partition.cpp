#include "rollfix/locate/march/partition.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "rollfix/locate/march/refusal.hpp"
#include "rollfix/part/period.hpp"

namespace rollfix::march {

namespace {

/// Stationary points that are closer than this part of P are one: in between a phi changes by its square, which is a
/// rounding error.
constexpr double kSamePoint = 1e-9;

/// Eq. (6) for the total curvature of a roll by `length`, with the reason in the words of section 3.
Result stationary_points(const March& march, double length) {
  try {
    return march.segments(length, 0);
  } catch (const Refusal& refusal) {
    if (refusal.reason() != Reason::continuum) throw;
    throw Refusal(Reason::continuum, refusal.where(),
                  fmt::format("march: expected a total curvature with isolated stationary points, found that of a roll "
                              "by {:.17g} (without whole loops) to be constant from s = {:.17g} on; rollfix::locate "
                              "handles it",
                              length, refusal.where()));
  }
}

/// The stationary points of one phi, and both ends of what the march doubts.
void add_stationary_points(const PartitionTools& tools, double length, Partition& partition, PairSteps& steps) {
  const Result level = stationary_points(tools.march, length);
  steps.stationary += level.steps.start + level.steps.marching + level.steps.bisection;
  steps.landings += level.steps.landings;
  steps.refinements += level.steps.refinements;
  for (const Segment& segment : level.segments) partition.points.push_back(segment.start);
  for (const Doubt& doubt : level.doubts) {
    const double lo = wrap(doubt.where.lo, tools.perimeter).base;
    partition.doubts.push_back({lo, lo + doubt.where.width()});
    partition.points.push_back(lo);
    partition.points.push_back(wrap(doubt.where.hi, tools.perimeter).base);
  }
}

/// In order, each once.
void merge(Partition& partition, double perimeter) {
  std::vector<double>& points = partition.points;
  std::sort(points.begin(), points.end());
  const std::size_t all = points.size();
  const auto same = [&](double one, double two) { return two - one <= kSamePoint * perimeter; };
  points.erase(std::unique(points.begin(), points.end(), same), points.end());
  while (points.size() > 1 && points.front() + perimeter - points.back() <= kSamePoint * perimeter) points.pop_back();
  partition.merged = all - points.size();
}

/// s = 0 with both ends of the segments in place.
Start first_start(const Path& path, const Segments& segments, Tally& tally) {
  Start start(Walker(path, first_position(path), tally), segments);
  start.move_to(0);
  return start;
}

std::array<int, 2> trends(const Start& at) { return {at.slope(0) < 0 ? -1 : 1, at.slope(1) < 0 ? -1 : 1}; }

}  // namespace

Partition divide(const PartitionTools& tools, const Segments& segments, Tally& evaluation, PairSteps& steps) {
  Partition partition;
  for (const double length : segments.length) add_stationary_points(tools, length, partition, steps);
  merge(partition, tools.perimeter);

  // One round. The slope half-way tells the trend also where the values at both ends differ by rounding only.
  std::vector<double> ends = partition.points;
  if (!ends.empty()) ends.push_back(ends.front() + tools.perimeter);
  Start at = first_start(tools.path, segments, evaluation);
  for (std::size_t i = 0; i < ends.size(); ++i) {
    if (i > 0) {
      at.move_to(0.5 * (ends[i - 1] + ends[i]));
      partition.intervals.back().trend = trends(at);
    }
    at.move_to(ends[i]);
    if (i > 0) partition.intervals.back().hi = at;
    if (i + 1 < ends.size()) partition.intervals.push_back({at, at, {}});
  }
  return partition;
}

}  // namespace rollfix::march
