#include "plot.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "labels.hpp"
#include "outline/turn.hpp"
#include "scene.hpp"
#include "trace.hpp"

namespace rollfix::draw {
namespace {

constexpr int kMostDecimals = 5;    // of a number written without an exponent
constexpr double kMostPlain = 1e6;  // likewise

std::string with_minus(std::string text) {
  for (std::size_t at = 0; (at = text.find('-', at)) != std::string::npos; at += 3) text.replace(at, 1, "\u2212");
  return text;
}

/// Nothing where it is so little that rounding may have left it.
double without_rounding(double value, double scale) {
  constexpr double kRounding = 1e-9;  // as sure as an exact answer is
  return std::abs(value) <= kRounding * scale ? 0 : value;
}

Ticks ticks_at(const Interval& range, double step) {
  Ticks ticks;
  const double slack = 1e-9 * range.width();
  const double first = std::ceil((range.lo - slack) / step);
  for (double k = first; k * step <= range.hi + slack; ++k)
    ticks.at.push_back(k * step + 0.0);  // never a negative zero
  ticks.decimals = std::clamp(-static_cast<int>(std::floor(std::log10(step) + 1e-9)), 0, 17);
  return ticks;
}

/// Decimals that show two digits of a standard deviation.
int decimals_of(double sd) { return std::clamp(1 - static_cast<int>(std::floor(std::log10(sd))), 0, 12); }

/// "0.00", never "-0.00".
std::string without_sign_of_zero(std::string text) {
  const bool is_zero = text.find_first_of("123456789") == std::string::npos;
  return is_zero && text[0] == '-' ? text.substr(1) : text;
}

std::string fixed(double value, int decimals) {
  return with_minus(without_sign_of_zero(fmt::format("{:.{}f}", value, decimals)));
}

constexpr double kNumberSize = 9.5;  // pixels
constexpr double kTitleSize = 11;
constexpr double kBetweenNumbers = 4;
constexpr double kColumn = 1.0 / 3;
constexpr std::string_view kGrid = "#e4e4e4";

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

constexpr double kFrameLeft = 58;  // around the frame, pixels
constexpr double kFrameRight = 16;
constexpr double kFrameAbove = 22;
constexpr double kFrameBelow = 34;
constexpr double kFrameLeastHeight = 160;
constexpr double kFrameMostHeight = 720;
constexpr double kFrameMargin = 0.06;       // of what is shown
constexpr double kFrameLeastMargin = 1e-9;  // of the perimeter: a point has no size

}  // namespace

std::string pretty(double value, int digits) {
  const std::string text = fmt::format("{:.{}g}", value, digits);
  return with_minus(text == "-0" ? "0" : text);
}

std::string pretty_degrees(double radians, int digits) {
  return pretty(without_rounding(radians, 1) / kDegree, digits) + "\u00b0";
}

std::string pretty_on(const Part& part, double length, int digits) {
  return pretty(without_rounding(length, part.perimeter()), digits);
}

std::string percent(double probability) {
  if (probability > 0.999) return "> 99.9 %";
  if (probability < 0.001) return "< 0.1 %";
  return pretty(100 * probability, probability < 0.1 ? 2 : 3) + " %";
}

std::string as_sure_as(double value, double sd) { return sd > 0 ? fixed(value, decimals_of(sd)) : pretty(value, 6); }

std::string with_sd(double value, double sd) {
  if (!(sd > 0)) return pretty(value, 6);
  return fmt::format("{} \u00b1 {}", as_sure_as(value, sd), fixed(sd, decimals_of(sd)));
}

std::string with_unit(const std::string& length, const Part& part) {
  const std::string& unit = part.unit();
  return unit.empty() ? length : length + " " + unit;
}

Text with_unit(Text name, const Part& part) {
  const std::string& unit = part.unit();
  if (!unit.empty()) name.push_back({", " + unit});
  return name;
}

double round_below(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double digit : {5.0, 2.0}) {
    if (digit * power <= value * (1 + 1e-12)) return digit * power;
  }
  return power;
}

Ticks round_ticks(const Interval& range, int count) {
  const double rough = range.width() / count;
  double step = round_below(rough);
  if (step < 0.8 * rough) step = round_below(2.5001 * step);
  return ticks_at(range, step);
}

Ticks degree_ticks(const Interval& range, int count) {
  const double rough = range.width() / count;
  for (const double step : {5.0, 10.0, 15.0, 30.0, 45.0, 90.0, 180.0, 360.0}) {
    if (rough > 4 && step >= 0.8 * rough) return ticks_at(range, step);
  }
  if (rough <= 4) return round_ticks(range, count);
  // Many turns: a round number of them.
  double turns = round_below(rough / 360);
  if (360 * turns < 0.8 * rough) turns = round_below(2.5001 * turns);
  return ticks_at(range, 360 * turns);
}

std::string tick_text(double value, int decimals) {
  if (decimals > kMostDecimals || std::abs(value) >= kMostPlain) return pretty(value, 6);
  return fixed(value, decimals);
}

void draw_axes(Svg& svg, const Axes& axes, const Ticks& x_ticks, const Ticks& y_ticks, const Text& title,
               const std::string& note) {
  const Vec2 end = axes.corner + axes.size;
  TextStyle numbers{kNumberSize, Align::middle, std::string(kSoftInk)};
  svg.open_group("axes");
  std::vector<Vec2> grid;
  double free_from = 0;
  for (const double x : x_ticks.at) {
    grid.insert(grid.end(), {Vec2(axes.page_x(x), axes.corner.y()), Vec2(axes.page_x(x), end.y())});
    const std::string number = tick_text(x, x_ticks.decimals);
    const double half = 0.5 * text_width({{number}}, kNumberSize);
    if (axes.page_x(x) - half < free_from || axes.page_x(x) + half > svg.width()) continue;  // numbers are kept apart
    free_from = axes.page_x(x) + half + kBetweenNumbers;
    svg.text({axes.page_x(x), end.y() + 13}, {{number}}, numbers);
  }
  numbers.align = Align::end;
  for (const double y : y_ticks.at) {
    grid.insert(grid.end(), {Vec2(axes.corner.x(), axes.page_y(y)), Vec2(end.x(), axes.page_y(y))});
    const Text number{{tick_text(y, y_ticks.decimals)}};
    numbers.size = fitting_size(number, kNumberSize, axes.corner.x() - 6 - kBetweenNumbers);
    svg.text({axes.corner.x() - 6, axes.page_y(y) + 3.4}, number, numbers);
  }
  svg.segments(grid, stroke(kGrid, 0.8));
  if (axes.y.lo < 0 && axes.y.hi > 0) {
    svg.segments({axes(axes.x.lo, 0), axes(axes.x.hi, 0)}, stroke("#9a9a9a", 0.8));
  }
  svg.rectangle(axes.corner.x(), axes.corner.y(), axes.size.x(), axes.size.y(), stroke(kSoftInk, 0.8));
  svg.text(axes.corner + Vec2(0, -6), title, {fitting_size(title, kTitleSize, svg.width() - axes.corner.x())});
  numbers.size = kNumberSize;
  const double room = axes.size.x() - text_width(title, kTitleSize) - 2 * kBetweenNumbers;
  if (!note.empty() && text_width({{note}}, kNumberSize) < room) {
    svg.text({end.x(), axes.corner.y() - 6}, {{note}}, numbers);
  }
  svg.close_group();
}

void draw_x_name(Svg& svg, const Axes& axes, const Text& name) {
  svg.text(axes.corner + Vec2(0.5 * axes.size.x(), axes.size.y() + 28), name, {kTitleSize, Align::middle});
}

std::vector<Vec2> thinned(const std::vector<Vec2>& points) {
  std::vector<Vec2> out;
  for (std::size_t first = 0; first < points.size();) {
    std::size_t lowest = first, highest = first, last = first;
    const double column = std::floor(points[first].x() / kColumn);
    for (std::size_t i = first; i < points.size() && std::floor(points[i].x() / kColumn) == column; last = i++) {
      if (points[i].y() < points[lowest].y()) lowest = i;
      if (points[i].y() > points[highest].y()) highest = i;
    }
    std::vector<std::size_t> kept = {first, lowest, highest, last};
    std::sort(kept.begin(), kept.end());
    kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
    for (const std::size_t i : kept) out.push_back(points[i]);
    first = last + 1;
  }
  return out;
}

void draw_graph(Svg& svg, const Axes& axes, const std::vector<Vec2>& points, const Paint& paint) {
  std::vector<Vec2> visible = points;
  // Far outside of the frame coordinates would only grow; a frame's height beyond it is as good.
  const double top = axes.corner.y() - axes.size.y(), bottom = axes.corner.y() + 2 * axes.size.y();
  for (Vec2& point : visible) point.y() = std::clamp(point.y(), top, bottom);
  visible = pick(visible, simplify(visible, kInvisible));
  svg.open_clip(axes.corner.x() - 1, axes.corner.y() - 1, axes.size.x() + 2, axes.size.y() + 2);
  svg.polyline(visible, paint);
  svg.close_group();
}

Interval widened(const Interval& range, double fraction) {
  const double least = 1e-9 * std::max({std::abs(range.lo), std::abs(range.hi), 1e-300});
  const double margin = range.width() > least ? fraction * range.width() : std::max(0.1 * std::abs(range.hi), 1e-300);
  return {range.lo - margin, range.hi + margin};
}

CurvatureRange shown_curvature(const Part& part) {
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

World::World(const Box& seen, const Part& part, double width) {
  const double margin = std::max(kFrameMargin * seen.sizes().maxCoeff(), kFrameLeastMargin * part.perimeter());
  const Box wide(seen.min() - Vec2::Constant(margin), seen.max() + Vec2::Constant(margin));
  const double across = width - kFrameLeft - kFrameRight;
  const double height = std::clamp(across * wide.sizes().y() / wide.sizes().x(), kFrameLeastHeight, kFrameMostHeight);
  scale_ = std::min(across / wide.sizes().x(), height / wide.sizes().y());
  const Vec2 half = 0.5 * Vec2(across, height) / scale_;
  axes_.corner = {kFrameLeft, kHeaderHeight + kFrameAbove};
  axes_.size = {across, height};
  axes_.x = {wide.center().x() - half.x(), wide.center().x() + half.x()};
  axes_.y = {wide.center().y() - half.y(), wide.center().y() + half.y()};
}

double World::bottom() const { return axes_.corner.y() + axes_.size.y() + kFrameBelow; }

std::vector<Vec2> World::path(const std::vector<Vec2>& points) const {
  std::vector<Vec2> page;
  for (const Vec2& point : points) page.push_back(at(point));
  return page;
}

void World::open(Svg& svg, const std::string& words) const {
  svg.open_group("world");
  draw_axes(svg, axes_, round_ticks(axes_.x, 5), round_ticks(axes_.y, 5), {{words}}, "");
  svg.open_clip(axes_.corner.x(), axes_.corner.y(), axes_.size.x(), axes_.size.y());
}

void World::close(Svg& svg) {
  svg.close_group();
  svg.close_group();
}

std::vector<Vec2> posed(const std::vector<Vec2>& points, const Pose& pose, bool mirrored) {
  std::vector<Vec2> world;
  for (const Vec2& point : points) world.push_back(pose.world({mirrored ? -point.x() : point.x(), point.y()}));
  return world;
}

}  // namespace rollfix::draw
