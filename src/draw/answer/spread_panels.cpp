// What lies below the legend with noise: of one finger its density over s, with the narrow places enlarged; of two the
// likeliest pairs, enlarged, with their ellipses.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "draw/answer/answer_plan.hpp"
#include "draw/answer/densities.hpp"
#include "draw/labels.hpp"

namespace rollfix::draw {
namespace {

constexpr double kDensityHeight = 96;  // of a plot, pixels
constexpr double kZoomHeight = 84;
constexpr double kDensityLeft = 58;
constexpr double kDensityRight = 16;
constexpr double kDensityAbove = 28;  // room for a plot's title
constexpr double kDensityBelow = 40;  // ... and for the numbers and the name of its axis
constexpr double kZoomGap = 46;       // between enlarged plots
constexpr std::size_t kMostZooms = 4;
constexpr std::size_t kMostPairZooms = 3;
constexpr double kNarrow = 0.12;     // of the perimeter: what holds 95 % of a place that is enlarged
constexpr double kZoomMargin = 0.8;  // beyond that, as a share of it
constexpr double kWorthZoom = 0.01;  // probability of a place that is enlarged
constexpr double kPairZoomSigmas = 3.4;
constexpr double kMarginHeight = 0.2;      // of an enlarged square, for what each finger has by itself
constexpr double kHeadroom = 0.3;          // above the highest, for labels
constexpr double kSmoothShare = 1.0 / 24;  // of what holds 95 %: cells of the density are not seen as steps

const Density& density_of(const AnswerPlan& plan, std::size_t finger) {
  return plan.figure->answer->weighing->density[finger];
}

bool has_density(const AnswerPlan& plan) {
  return plan.has_noise() && !plan.placements().empty() && !density_of(plan, 0).empty();
}

std::size_t most_zooms(const AnswerPlan& plan) {
  if (!plan.has_pairs()) return kMostZooms;
  return plan.has_world() ? kMostPairZooms - 1 : kMostPairZooms;
}

/// The placements that are shown enlarged.
std::vector<std::size_t> zoomed(const AnswerPlan& plan) {
  std::vector<std::size_t> chosen;
  for (std::size_t k = 0; k < plan.placements().size() && chosen.size() < most_zooms(plan); ++k) {
    const Placement& placement = plan.placements()[k];
    const bool narrow = placement.interval[0].width() < kNarrow * plan.part().perimeter();
    if (placement.probability >= kWorthZoom && (plan.has_pairs() || narrow)) chosen.push_back(k);
  }
  return chosen;
}

/// A density as steps, with the area below it in the placement's colours.
class DensityPlot {
 public:
  enum class Heights { mean, highest };  // of each column

  DensityPlot(Svg& svg, const AnswerPlan& plan, const Axes& axes, std::size_t finger, Heights heights)
      : svg_(svg), plan_(plan), axes_(axes), finger_(finger) {
    const auto count = static_cast<std::size_t>(std::max(1.0, std::round(axes.size.x() / kColumn)));
    const auto of_columns = heights == Heights::mean ? &binned : &draw::highest;
    heights_ = of_columns(density_of(plan, finger), plan.part().boundary(), axes.x, count);
  }

  /// Without the steps that the density was computed in, over so many columns.
  void smooth(double columns) {
    if (columns > 0.5) heights_ = smoothed(heights_, columns, false);
  }

  double height_at(double s) const {
    const double at = (s - axes_.x.lo) / axes_.x.width() * static_cast<double>(heights_.size());
    return heights_[static_cast<std::size_t>(std::clamp(at, 0.0, static_cast<double>(heights_.size() - 1)))];
  }

  double most() const { return std::max(1e-300, *std::max_element(heights_.begin(), heights_.end())); }

  /// `axes`: the same with the range of heights.
  void draw(const Axes& axes) {
    axes_ = axes;
    svg_.open_clip(axes.corner.x(), axes.corner.y(), axes.size.x(), axes.size.y() + 1);
    for (std::size_t k = 0; k < plan_.placements().size(); ++k) interval(k);
    const std::vector<Vec2> top = steps(0, heights_.size());
    svg_.open_group("density");
    svg_.polyline(pick(top, simplify(top, kInvisible)), stroke(kInk, 1));
    svg_.close_group();
    svg_.close_group();
  }

 private:
  static constexpr double kColumn = 1;  // pixels

  std::vector<Vec2> steps(std::size_t begin, std::size_t end) const {
    std::vector<Vec2> points;
    const double width = axes_.size.x() / static_cast<double>(heights_.size());
    for (std::size_t k = begin; k < end; ++k) {
      const double left = axes_.corner.x() + static_cast<double>(k) * width, y = axes_.page_y(heights_[k]);
      points.emplace_back(left, y);
      points.emplace_back(left + width, y);
    }
    return points;
  }

  /// What holds 95 % of a placement, as the area below the density; of a closed part it may go on at the other side.
  void interval(std::size_t placement) {
    const Interval arc = plan_.held(placement, finger_);
    const double P = plan_.part().perimeter(), count = static_cast<double>(heights_.size());
    for (const double lap : {-1.0, 0.0, 1.0}) {
      if (lap != 0 && !plan_.part().closed()) continue;
      const auto column = [&](double s) {
        return std::clamp((s + lap * P - axes_.x.lo) / axes_.x.width() * count, 0.0, count);
      };
      const auto begin = static_cast<std::size_t>(std::floor(column(arc.lo)));
      const auto end = static_cast<std::size_t>(std::ceil(column(arc.hi)));
      if (end <= begin) continue;
      std::vector<Vec2> area = steps(begin, end);
      area.emplace_back(area.back().x(), axes_.page_y(0));
      area.emplace_back(area.front().x(), axes_.page_y(0));
      svg_.polygon(pick(area, simplify(area, kInvisible)), filled(plan_.colour_of(placement, finger_), 0.45));
    }
  }

  Svg& svg_;
  const AnswerPlan& plan_;
  Axes axes_;
  std::size_t finger_;
  std::vector<double> heights_;
};

Text density_title(const AnswerPlan& plan, const Text& subject) {
  Text title = {{"density of "}};
  append(title, subject);
  if (!plan.part().unit().empty()) title.push_back({", 1/" + plan.part().unit()});
  return title;
}

Axes with_heights(Axes axes, double most) {
  axes.y = {0, (1 + kHeadroom) * most};
  return axes;
}

/// The whole boundary.
void draw_whole(Svg& svg, const AnswerPlan& plan, double top) {
  Axes axes;
  axes.corner = {kDensityLeft, top + kDensityAbove};
  axes.size = {plan.width() - kDensityLeft - kDensityRight, kDensityHeight};
  axes.x = {0, plan.part().perimeter()};
  DensityPlot plot(svg, plan, axes, 0, DensityPlot::Heights::highest);
  axes = with_heights(axes, plot.most());
  svg.open_group("density-over-s");
  draw_axes(svg, axes, round_ticks(axes.x, 10), round_ticks(axes.y, 4), density_title(plan, {{"the first contact"}}),
            "shaded: 95 % of each place");
  plot.draw(axes);
  Obstacles obstacles(svg.width(), svg.height());
  obstacles.forbid({0, 0}, {svg.width(), axes.corner.y() - 1});
  obstacles.forbid({0, 0}, {axes.corner.x(), svg.height()});
  obstacles.forbid({axes.corner.x() + axes.size.x(), 0}, {svg.width(), svg.height()});
  obstacles.forbid({0, axes.corner.y() + axes.size.y()}, {svg.width(), svg.height()});
  LabelSet labels;
  for (std::size_t k = 0; k < plan.placements().size() && plan.has_labels(); ++k) {
    const Placement& placement = plan.placements()[k];
    if (placement.probability < kWorthZoom) continue;
    const double s = plan.part().boundary().base(placement.start[0]);
    labels.add({axes(s, plot.height_at(s))}, Vec2(0, -1), start_name(plan, {k, 0}), plan.colour_of(k, 0), 11);
  }
  labels.draw(svg, obstacles);
  draw_x_name(svg, axes, with_unit(Text{{"arc length "}, {"s", true, false, false}}, plan.part()));
  svg.close_group();
}

/// One placement, enlarged: a step at its own scale, whose unit is the same.
void draw_zoom(Svg& svg, const AnswerPlan& plan, std::size_t placement, const Vec2& corner, double width) {
  const Interval& held = plan.placements()[placement].interval[0];
  Axes axes;
  axes.corner = corner;
  axes.size = {width, kZoomHeight};
  const double least = 1e-9 * plan.part().perimeter();
  axes.x = widened({held.lo, held.lo + std::max(held.width(), least)}, kZoomMargin);
  if (!plan.part().closed()) axes.x = {std::max(0.0, axes.x.lo), std::min(plan.part().perimeter(), axes.x.hi)};
  DensityPlot plot(svg, plan, axes, 0, DensityPlot::Heights::mean);
  plot.smooth(kSmoothShare * held.width() / axes.x.width() * width);
  axes = with_heights(axes, plot.most());
  svg.open_group("zoom");
  const int ticks = std::max(3, static_cast<int>(width / 55));
  draw_axes(svg, axes, round_ticks(axes.x, ticks), round_ticks(axes.y, 3), start_name(plan, {placement, 0}), "");
  plot.draw(axes);
  svg.close_group();
}

void draw_zooms(Svg& svg, const AnswerPlan& plan, double top) {
  const std::vector<std::size_t> chosen = zoomed(plan);
  const auto count = static_cast<double>(chosen.size());
  const double room = plan.width() - kDensityLeft - kDensityRight;
  const double width = (room - (count - 1) * kZoomGap) / count;
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    const double x = kDensityLeft + static_cast<double>(k) * (width + kZoomGap);
    draw_zoom(svg, plan, chosen[k], {x, top + kDensityAbove}, width);
  }
}

// ---- of two fingers

/// What one finger has by itself, along a side of an enlarged square.
void draw_side(Svg& svg, const AnswerPlan& plan, const Axes& axes, std::size_t finger) {
  const double length = axes.size[finger == 0 ? 0 : 1];
  const Interval range = finger == 0 ? axes.x : axes.y;
  const auto count = static_cast<std::size_t>(length / 2);
  const std::vector<double> heights =
      smoothed(binned(density_of(plan, finger), plan.part().boundary(), range, count), 1.5, false);
  const double most = std::max(1e-300, *std::max_element(heights.begin(), heights.end()));
  const Vec2 origin = axes.corner + Vec2(0, axes.size.y());
  std::vector<Vec2> area = {origin};
  for (std::size_t k = 0; k < count; ++k) {
    const double along = (static_cast<double>(k) + 0.5) / static_cast<double>(count) * length;
    const double up = kMarginHeight * length * heights[k] / most;
    area.emplace_back(finger == 0 ? Vec2(origin + Vec2(along, -up)) : Vec2(origin + Vec2(up, -along)));
  }
  area.emplace_back(finger == 0 ? Vec2(origin + Vec2(length, 0)) : Vec2(origin - Vec2(0, length)));
  svg.polygon(area, filled(kFingerColours[finger], 0.3));
}

void draw_pair_zoom(Svg& svg, const AnswerPlan& plan, std::size_t index, const Vec2& corner, double side) {
  const Placement& placement = plan.placements()[index];
  Axes axes;
  axes.corner = corner;
  axes.size = {side, side};
  const Boundary places = plan.part().boundary();
  // About the mean, by the name that is nearest to the start.
  const auto range = [&](std::size_t finger) {
    const double mean = placement.start[finger] + places.offset(placement.start[finger], placement.mean[finger]);
    const double least = 1e-6 * plan.part().perimeter();
    const double reach = std::min(kPairZoomSigmas * std::max(placement.sd[finger], least), 0.5 * places.perimeter);
    return Interval{mean - reach, mean + reach};
  };
  axes.x = range(0);
  axes.y = range(1);
  svg.open_group("pair-zoom");
  draw_axes(svg, axes, round_ticks(axes.x, 3), round_ticks(axes.y, 4),
            {{std::to_string(index) + ": ", false, true, false}, {percent(placement.probability)}}, "");
  svg.open_clip(corner.x(), corner.y(), side, side);
  draw_side(svg, plan, axes, 0);
  draw_side(svg, plan, axes, 1);
  const Vec2 mean(axes.x.middle(), axes.y.middle());
  const Eigen::Matrix2d covariance = placement.covariance;
  for (const double sigmas : {kEllipseHalf, kEllipse95}) {
    std::vector<Vec2> rim;
    for (const Vec2& at : ellipse(mean, covariance, sigmas)) rim.emplace_back(axes(at.x(), at.y()));
    Paint paint = stroke(kInk, 1.2, sigmas == kEllipse95 ? "" : "3 2");
    if (sigmas == kEllipse95) paint.fill = std::string(kEllipseFill);
    paint.fill_opacity = 0.4;
    svg.polygon(rim, paint);
  }
  svg.circle(axes(placement.start[0], placement.start[1]), 3, filled(kInk));
  svg.close_group();
  const Text first = contact_name(plan, {0, 0}, 0), second = contact_name(plan, {0, 1}, 0);
  draw_x_name(svg, axes, with_unit(first, plan.part()));
  TextStyle style;
  style.align = Align::middle;
  style.turn = -90;
  svg.text(corner + Vec2(-40, 0.5 * side), with_unit(second, plan.part()), style);
  svg.close_group();
}

constexpr double kPairZoomLeft = 56;
constexpr double kPairZoomPitch = 76;  // between the squares

double pair_zoom_side(const AnswerPlan& plan) {
  const auto columns = static_cast<double>(most_zooms(plan));
  return (spread_width(plan) - kPairZoomLeft - kDensityRight - (columns - 1) * kPairZoomPitch) / columns;
}

}  // namespace

double spread_width(const AnswerPlan& plan) {
  return plan.has_pairs() && plan.has_world() ? plan.width() - world_width(plan) : plan.width();
}

double spread_height(const AnswerPlan& plan) {
  if (!has_density(plan)) return 0;
  if (plan.has_pairs()) {
    return zoomed(plan).empty() ? 0 : kDensityAbove + pair_zoom_side(plan) + kDensityBelow;
  }
  const double whole = kDensityAbove + kDensityHeight + kDensityBelow;
  return zoomed(plan).empty() ? whole : whole + kDensityAbove + kZoomHeight + 0.6 * kDensityBelow;
}

void draw_spread(Svg& svg, const AnswerPlan& plan, double top) {
  if (!has_density(plan)) return;
  if (!plan.has_pairs()) {
    draw_whole(svg, plan, top);
    if (!zoomed(plan).empty()) draw_zooms(svg, plan, top + kDensityAbove + kDensityHeight + kDensityBelow);
    return;
  }
  const std::vector<std::size_t> chosen = zoomed(plan);
  const double side = pair_zoom_side(plan);
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    const double x = kPairZoomLeft + static_cast<double>(k) * (side + kPairZoomPitch);
    draw_pair_zoom(svg, plan, chosen[k], {x, top + kDensityAbove}, side);
  }
}

}  // namespace rollfix::draw
