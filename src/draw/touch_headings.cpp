#include "touch_headings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "outline/turn.hpp"
#include "plot.hpp"
#include "scene.hpp"

namespace rollfix::draw {
namespace {

constexpr std::size_t kMostHeadings = 4;
constexpr double kWorthHeading = 0.01;  // probability of a pose
constexpr double kHeadingHeight = 84;   // pixels
constexpr double kHeadingLeft = 58;
constexpr double kHeadingRight = 16;
constexpr double kHeadingAbove = 28;
constexpr double kHeadingBelow = 40;
constexpr double kHeadingGap = 52;
constexpr double kHeadingMargin = 0.8;    // beyond what holds 95 %, as a share of it
constexpr double kHeadingHeadroom = 0.1;  // above the highest
constexpr double kLeastDegrees = 1e-9;
constexpr double kRoomyHeading = 220;  // pixels: there is room to say what is shaded

/// Per degree.
double heading_density_at(const std::vector<MixtureTerm>& terms, double degrees) {
  double sum = 0;
  for (const MixtureTerm& term : terms) {
    const double off = (degrees * kDegree - term.mean) / term.sd;
    sum += term.weight / term.sd * std::exp(-0.5 * off * off);
  }
  return sum * kDegree / std::sqrt(2 * std::numbers::pi);
}

bool is_heading_known(const TouchPose& pose) {
  const bool any_is_exact = std::any_of(pose.density[2].begin(), pose.density[2].end(),
                                        [](const MixtureTerm& term) { return !(term.sd > 0); });
  return !pose.any_heading && !pose.density[2].empty() && !any_is_exact;
}

}  // namespace

HeadingDensities::HeadingDensities(const TouchAnswer& answer, double width) : answer_(answer), width_(width) {
  for (std::size_t k = 0; k < answer.poses.size() && shown_.size() < kMostHeadings; ++k) {
    const TouchPose& pose = answer.poses[k];
    if (pose.probability >= kWorthHeading && is_heading_known(pose)) shown_.push_back(k);
  }
}

double HeadingDensities::height() const { return shown_.empty() ? 0 : kHeadingAbove + kHeadingHeight + kHeadingBelow; }

void HeadingDensities::draw(Svg& svg, double top) const {
  const auto count = static_cast<double>(shown_.size());
  const double each = (width_ - kHeadingLeft - kHeadingRight - (count - 1) * kHeadingGap) / std::max(1.0, count);
  for (std::size_t i = 0; i < shown_.size(); ++i) {
    draw_one(svg, shown_[i], {kHeadingLeft + static_cast<double>(i) * (each + kHeadingGap), top + kHeadingAbove}, each);
  }
}

void HeadingDensities::draw_one(Svg& svg, std::size_t pose, const Vec2& corner, double width) const {
  const TouchPose& set = answer_.poses[pose];
  const Interval held{set.interval[2].lo / kDegree, set.interval[2].hi / kDegree};
  Axes axes;
  axes.corner = corner;
  axes.size = {width, kHeadingHeight};
  axes.x = widened({held.lo, std::max(held.hi, held.lo + kLeastDegrees)}, kHeadingMargin);
  std::vector<Vec2> values;
  const auto columns = static_cast<int>(width);
  for (int k = 0; k <= columns; ++k) {
    const double degrees = axes.x.lo + axes.x.width() * k / columns;
    values.emplace_back(degrees, heading_density_at(set.density[2], degrees));
    axes.y.hi = std::max(axes.y.hi, (1 + kHeadingHeadroom) * values.back().y());
  }
  svg.open_group("heading-density");
  draw_axes(svg, axes, round_ticks(axes.x, std::max(2, static_cast<int>(width / 70))), round_ticks(axes.y, 3),
            {{fmt::format("p{}: density, 1/\u00b0", pose)}}, "");
  std::vector<Vec2> line, area;
  for (const Vec2& value : values) {
    line.push_back(axes(value.x(), value.y()));
    if (value.x() >= held.lo && value.x() <= held.hi) area.push_back(line.back());
  }
  if (!area.empty()) {
    area.emplace_back(area.back().x(), axes.page_y(0));
    area.emplace_back(area.front().x(), axes.page_y(0));
    svg.polygon(area, filled(colour(pose), 0.45));
  }
  svg.polyline(line, stroke(kInk, 1));
  draw_x_name(svg, axes, {{width > kRoomyHeading ? "heading, degrees; shaded: 95 %" : "heading, degrees"}});
  svg.close_group();
}

}  // namespace rollfix::draw
