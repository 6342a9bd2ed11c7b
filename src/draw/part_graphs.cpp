#include "part_graphs.hpp"

#include <algorithm>
#include <cmath>
#include "outline/turn.hpp"

namespace rollfix::draw {
namespace {

constexpr std::size_t kQuantileSamples = 4001;
constexpr double kQuantile = 0.97;   // of the boundary has less curvature than what is called usual
constexpr double kPeak = 3;          // times the usual curvature is a peak that gets cut ...
constexpr double kCut = 1.6;         // ... at this many times the usual one
constexpr double kSampleStep = 0.7;  // between samples of a graph, pixels
constexpr double kStraight = 1e-6;   // degrees: a boundary that turns less is shown as straight

/// Least and greatest value at the spirals' ends: both angle and curvature are monotone on a spiral.
Interval value_range(const Part& part, const std::function<double(const Turning&)>& value) {
  Interval range{1e300, -1e300};
  for (const Spiral& spiral : part.turning().spirals()) {
    range.lo = std::min({range.lo, value(spiral.start), value(spiral.end)});
    range.hi = std::max({range.hi, value(spiral.start), value(spiral.end)});
  }
  return range;
}

}  // namespace

CurvatureRange curvature_range(const Part& part) {
  const TurningFunction& turning = part.turning();
  const Interval all = value_range(part, [](const Turning& at) { return at.curvature; });
  std::vector<double> sizes;
  for (std::size_t i = 0; i < kQuantileSamples; ++i) {
    const double fraction = static_cast<double>(i) / static_cast<double>(kQuantileSamples - 1);
    sizes.push_back(std::abs(turning.curvature(fraction * part.perimeter())));
  }
  std::sort(sizes.begin(), sizes.end());
  const double usual = sizes[static_cast<std::size_t>(kQuantile * static_cast<double>(kQuantileSamples - 1))];
  CurvatureRange range{all, false, std::max(std::abs(all.lo), std::abs(all.hi))};
  if (usual > 1e-9 * range.most && range.most > kPeak * usual) {
    range.cut = true;
    range.shown = {std::max(all.lo, -kCut * usual), std::min(all.hi, kCut * usual)};
  }
  // The axis shows where zero is unless the curvature stays far from it.
  if (range.shown.lo > 0 && range.shown.lo < 0.5 * range.shown.hi) range.shown.lo = 0;
  if (range.shown.hi < 0 && range.shown.hi > 0.5 * range.shown.lo) range.shown.hi = 0;
  range.shown = range.most > 0 ? widened(range.shown, 0.06) : Interval{-1, 1};
  return range;
}

Interval turning_range(const Part& part) {
  const Interval range = value_range(part, [](const Turning& turning) { return turning.angle / kDegree; });
  return range.width() > kStraight ? widened(range, 0.06) : Interval{range.lo - 45, range.lo + 45};
}

std::vector<Vec2> graph(const Part& part, const Axes& axes, const std::function<double(const Turning&)>& value) {
  const TurningFunction& turning = part.turning();
  std::vector<Vec2> points;
  for (const Spiral& spiral : turning.spirals()) {
    points.push_back(axes(spiral.lo, value(spiral.start)));
    const double width = axes.page_x(spiral.hi) - axes.page_x(spiral.lo);
    const double count = std::ceil(width / kSampleStep);
    for (double k = 1; k < count; ++k) {
      const double s = spiral.lo + (spiral.hi - spiral.lo) * k / count;
      points.push_back(axes(s, value(turning.at(s))));
    }
    points.push_back(axes(spiral.hi, value(spiral.end)));
  }
  return thinned(points);
}

}  // namespace rollfix::draw
