#include "taught_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "outline/turn.hpp"
#include "text/text.hpp"

namespace rollfix::draw {
namespace {

constexpr double kApart = 4;            // rows further apart than this are seen as dots, pixels
constexpr double kRowSize = 1.4;        // of a dot
constexpr double kTurnSize = 1.2;       // in the plot
constexpr double kSmallGap = 10;        // a shorter gap is circled
constexpr double kGapRing = 9;          // its radius
constexpr double kGapEnd = 3.4;         // the mark at either end of a longer one
constexpr double kMostRowsReach = 0.5;  // beyond the part, as a fraction of its size
constexpr double kUsual = 0.95;         // of the rows are off by no more than what is called usual
constexpr double kFarOff = 2;           // times the usual are still shown
constexpr double kLeastOff = 1e-6;      // degrees: less is rounding
constexpr std::size_t kMostDots = 4000;

/// Where the rows are when the lap ends.
Vec2 lap_end(const TaughtRows& taught) {
  const std::vector<ReckonedRow>& rows = taught.rows;
  const auto after =
      std::find_if(rows.begin(), rows.end(), [&](const ReckonedRow& row) { return row.s >= taught.lap; });
  if (after == rows.begin() || after == rows.end()) return rows.back().point;
  const ReckonedRow& before = *std::prev(after);
  const double step = after->s - before.s;
  const double share = step > 0 ? (taught.lap - before.s) / step : 0;
  return before.point + share * (after->point - before.point);
}

}  // namespace

Box bounds_of(const TaughtRows& taught, const Box& bounds) {
  const Vec2 reach = Vec2::Constant(kMostRowsReach * bounds.sizes().maxCoeff());
  Box box;
  for (const ReckonedRow& row : taught.rows) {
    box.extend(row.point.cwiseMax(bounds.min() - reach).cwiseMin(bounds.max() + reach));
  }
  return box;
}

void draw_rows(Svg& svg, const Scene& scene, const TaughtRows& taught, LabelSet& labels, Obstacles& obstacles) {
  if (taught.rows.empty()) return;
  std::vector<Vec2> path;
  for (const ReckonedRow& row : taught.rows) path.push_back(scene.view(row.point));
  const double length = scene.pixels(taught.rows.back().s - taught.rows.front().s);
  svg.open_group("rows");
  svg.polyline(pick(path, simplify(path, kInvisible, kMostVertices)), stroke(kRowColour, 0.9));
  if (length > kApart * static_cast<double>(path.size())) {
    for (const Vec2& at : path) svg.circle(at, kRowSize, filled(kRowColour));
  }
  svg.close_group();
  const Vec2 end = scene.view(lap_end(taught)), start = path.front();
  svg.open_group("gap");
  if ((end - start).norm() >= kSmallGap) {
    svg.segments({end, start}, stroke(kGapColour, 2.2, "5 3"));
    for (const Vec2& at : {start, end}) svg.circle(at, kGapEnd, with_rim(kPaper, kGapColour, 1.6));
    obstacles.add({end, start});
  } else if (taught.closes) {
    svg.circle(0.5 * (start + end), kGapRing, stroke(kGapColour, 1.4));
    obstacles.add_circle(0.5 * (start + end), kGapRing);
  }
  svg.close_group();
  labels.add({Vec2(0.5 * (start + end))}, scene.normal(0), {{"gap " + pretty(taught.gap, 3)}}, kGapColour, 11);
}

std::vector<Vec2> turns_off(const Part& part, const TaughtRows& taught) {
  if (taught.rows.empty() || part.reversed()) return {};  // then s runs the other way
  const TurningFunction& turning = part.turning();
  const double laps = std::round((turning.angle(0) - taught.rows.front().angle) / kFullTurn);
  std::vector<Vec2> off;
  const std::size_t stride = 1 + taught.rows.size() / kMostDots;
  for (std::size_t k = 0; k < taught.rows.size(); k += stride) {
    const ReckonedRow& row = taught.rows[k];
    const Wrapped place = part.boundary().reduced(row.s);
    const double there = turning.angle(place.base) + place.winding * turning.period_turn();
    off.emplace_back(place.base, (row.angle + laps * kFullTurn - there) / kDegree);
  }
  return off;
}

Interval range_of_turns(const std::vector<Vec2>& off) {
  std::vector<double> sizes;
  for (const Vec2& at : off) sizes.push_back(std::abs(at.y()));
  std::sort(sizes.begin(), sizes.end());
  const double usual = sizes[static_cast<std::size_t>(kUsual * static_cast<double>(sizes.size() - 1))];
  const double most = std::max(std::min(sizes.back(), kFarOff * usual), kLeastOff);
  return widened({-most, most}, 0.06);
}

void draw_turns_off(Svg& svg, const Axes& axes, const std::vector<Vec2>& off) {
  svg.open_clip(axes.corner.x() - 1, axes.corner.y() - 1, axes.size.x() + 2, axes.size.y() + 2);
  for (const Vec2& at : off) {
    if (std::abs(at.y()) <= axes.y.hi) svg.circle(axes(at.x(), at.y()), kTurnSize, filled(kRowColour));
  }
  svg.close_group();
}

std::vector<LegendEntry> entries_of(const TaughtRows& taught, const Part& part) {
  if (taught.rows.empty()) return {};
  const std::string rows = counted(taught.rows.size(), "row", "rows");
  return {{Sign::line, kRowColour, {{rows + ", added up as logged"}}},
          {Sign::line, kGapColour, {{"gap " + with_unit(pretty(taught.gap, 3), part) + ": " + taught.closing}}, "5 3"}};
}

}  // namespace rollfix::draw
