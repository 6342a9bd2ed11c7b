#include "rollfix/draw/touch_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "legend.hpp"
#include "outline/box.hpp"
#include "plot.hpp"
#include "rollfix/error.hpp"
#include "scene.hpp"
#include "text/text.hpp"
#include "touch_headings.hpp"
#include "trace.hpp"

namespace rollfix {
namespace draw {
namespace {

constexpr std::size_t kMostTouchPoses = 6;
constexpr double kTouchLeft = 58;  // around the frame, pixels
constexpr double kTouchRight = 16;
constexpr double kTouchAbove = 22;
constexpr double kTouchBelow = 34;
constexpr double kTouchLeastHeight = 160;
constexpr double kTouchMostHeight = 720;
constexpr double kTouchMargin = 0.06;    // of what is shown
constexpr double kTouchGhost = 0.55;     // opacity of poses but the first
constexpr double kTouchDot = 2.6;        // pixels
constexpr double kTouchRounding = 1e-9;  // of the perimeter: a place's rounding
constexpr double kTouchNormal = 26;      // length of a normal, pixels

class TouchPicture {
 public:
  explicit TouchPicture(const TouchFigure& figure)
      : figure_(figure), answer_(*figure.answer), headings_(answer_, figure.width) {
    const Box bounds = part_bounds(answer_.part);
    outline_ = trace(answer_.part, 1e-4 * bounds.sizes().maxCoeff()).points;
    const std::size_t shown = std::min(answer_.poses.size(), kMostTouchPoses);
    for (std::size_t k = 0; k < shown; ++k) poses_.push_back(placed(outline_, answer_.poses[k].pose));
    frame();
  }

  Svg draw() {
    const Legend legend(entries(), figure_.width);
    Svg svg(figure_.width, axes_.corner.y() + axes_.size.y() + kTouchBelow + legend.height() + headings_.height());
    svg.describe("The part in each pose that the touches leave");
    draw_header(svg, figure_.title.empty() ? answer_.part.name() : figure_.title, answer_.verdict_text(),
                {{contacts_text()}});
    svg.open_group("world");
    draw_axes(
        svg, axes_, round_ticks(axes_.x, 5), round_ticks(axes_.y, 5),
        {{answer_.place == PlaceKnown::unknown ? "turned as in the world; its place is not known" : "in the world"}},
        "");
    svg.open_clip(axes_.corner.x(), axes_.corner.y(), axes_.size.x(), axes_.size.y());
    for (std::size_t k = poses_.size(); k-- > 0;) pose(svg, k);
    for (const RollFacts& roll : answer_.rolls) rolled(svg, roll);
    for (const Clear& path : answer_.clear) passed(svg, path);
    for (const MeasuredTouch& touch : answer_.touches) touched(svg, touch);
    if (figure_.next != nullptr) advised(svg, *figure_.next);
    svg.close_group();
    svg.close_group();
    const double below = axes_.corner.y() + axes_.size.y() + kTouchBelow;
    legend.draw(svg, below);
    headings_.draw(svg, below + legend.height());
    return svg;
  }

 private:
  std::vector<Vec2> placed(const std::vector<Vec2>& points, const Pose& pose) const {
    std::vector<Vec2> world;
    const Pose shown = answer_.place == PlaceKnown::unknown ? Pose{0, 0, pose.heading} : pose;
    for (const Vec2& point : points)
      world.push_back(shown.world({answer_.mirrored ? -point.x() : point.x(), point.y()}));
    return world;
  }

  /// One scale both ways, and all of the poses and touches inside.
  void frame() {
    Box seen;
    for (const std::vector<Vec2>& points : poses_) seen.extend(box_around(points));
    for (const MeasuredTouch& touch : answer_.touches) {
      if (!touch.has_place()) continue;
      seen.extend(Vec2(touch.at + Vec2::Constant(answer_.radius)));
      seen.extend(Vec2(touch.at - Vec2::Constant(answer_.radius)));
    }
    for (const RollFacts& roll : answer_.rolls) {
      for (const Vec2& centre : roll.track) seen.extend(centre);
    }
    if (figure_.next != nullptr) seen.extend(figure_.next->advised().approach.from);
    const double margin = std::max(kTouchMargin * seen.sizes().maxCoeff(), 1e-9 * answer_.part.perimeter());
    const Box wide(seen.min() - Vec2::Constant(margin), seen.max() + Vec2::Constant(margin));
    const double width = figure_.width - kTouchLeft - kTouchRight;
    const double height = std::clamp(width * wide.sizes().y() / wide.sizes().x(), kTouchLeastHeight, kTouchMostHeight);
    const double scale = std::min(width / wide.sizes().x(), height / wide.sizes().y());
    const Vec2 half = 0.5 * Vec2(width, height) / scale;
    axes_.corner = {kTouchLeft, kHeaderHeight + kTouchAbove};
    axes_.size = {width, height};
    axes_.x = {wide.center().x() - half.x(), wide.center().x() + half.x()};
    axes_.y = {wide.center().y() - half.y(), wide.center().y() + half.y()};
    scale_ = scale;
  }

  std::vector<Vec2> on_page(const std::vector<Vec2>& points) const {
    std::vector<Vec2> page;
    for (const Vec2& point : points) page.push_back(axes_(point.x(), point.y()));
    return page;
  }

  void pose(Svg& svg, std::size_t k) const {
    const std::vector<Vec2> points = on_page(poses_[k]);
    svg.open_group("pose");
    if (k == 0 && answer_.part.closed() && !answer_.part.outline().hole) svg.polygon(points, draw::filled(kMaterial));
    svg.polyline(points, stroke(colour(k), k == 0 ? 1.8 : 1.1, "", k == 0 ? 1 : kTouchGhost));
    if (k == 0) {
      for (const Outline& other : figure_.others) {
        svg.polyline(on_page(placed(polyline_of(other), answer_.poses[0].pose)), stroke(kSoftInk, 0.6));
      }
    }
    svg.close_group();
  }

  std::string contacts_text() const {
    std::string touches = counted(answer_.touches.size(), "touch", "touches");
    if (answer_.rolls.empty()) return touches;
    const std::string rolls = counted(answer_.rolls.size(), "roll", "rolls");
    return answer_.touches.empty() ? rolls : rolls + ", " + touches;
  }

  /// The way of the finger's centre, with the finger where it first touched.
  void rolled(Svg& svg, const RollFacts& roll) const {
    if (roll.track.empty()) return;
    svg.open_group("roll");
    const std::vector<Vec2> path = on_page(roll.track);
    if (answer_.radius > 0) svg.circle(path.front(), answer_.radius * scale_, stroke(kSoftInk, 0.8));
    svg.polyline(path, stroke(kInk, 1.4));
    svg.circle(path.front(), kTouchDot, draw::filled(kInk));
    svg.close_group();
  }

  /// Dotted: nothing was felt there.
  void passed(Svg& svg, const Clear& path) const {
    svg.open_group("clear");
    svg.polyline(on_page({path.from, path.to}), stroke(kSoftInk, 1, "1.5 3"));
    svg.close_group();
  }

  /// The way to go, and where it ends in each pose.
  void advised(Svg& svg, const NextTouch& next) const {
    const Approach& way = next.advised().approach;
    double farthest = 0;
    for (const ExpectedTouch& one : next.expected) farthest = std::max(farthest, one.travel);
    const Vec2 along(std::cos(way.direction), std::sin(way.direction));
    if (next.expected.empty()) {  // after one touch: to beside it
      farthest = std::max(0.0, along.dot(answer_.touches.front().at - way.from));
    }
    const Vec2 end = way.from + farthest * along;
    const std::vector<Vec2> path = on_page({way.from, end});
    svg.open_group("approach");
    svg.polyline(without_tip(path, 4), stroke(kInk, 1.2, "6 3"));
    draw_arrowhead(svg, path, 7, kInk);
    for (const ExpectedTouch& one : next.expected) {
      if (!one.hits || one.placement >= poses_.size()) continue;
      svg.circle(axes_(one.at.x(), one.at.y()), std::max(answer_.radius * scale_, kTouchDot),
                 stroke(colour(one.placement), 1.2));
    }
    svg.close_group();
  }

  void touched(Svg& svg, const MeasuredTouch& touch) const {
    if (!touch.has_place()) return;
    const Vec2 at = axes_(touch.at.x(), touch.at.y());
    svg.open_group("touch");
    if (answer_.radius > 0) svg.circle(at, answer_.radius * scale_, stroke(kSoftInk, 0.8));
    svg.circle(at, kTouchDot, draw::filled(kInk));
    if (touch.normal) {
      const std::vector<Vec2> path = {at, at + kTouchNormal * Vec2(std::cos(*touch.normal), -std::sin(*touch.normal))};
      svg.polyline(without_tip(path, 4), stroke(kInk, 1));
      draw_arrowhead(svg, path, 6, kInk);
    }
    svg.close_group();
  }

  std::vector<LegendEntry> entries() const {
    std::vector<LegendEntry> result;
    for (std::size_t k = 0; k < poses_.size(); ++k) {
      const TouchPose& pose = answer_.poses[k];
      const auto place = [&](double value) {  // without what is rounding
        return pretty(std::abs(value) <= kTouchRounding * answer_.part.perimeter() ? 0 : value);
      };
      const std::string where = answer_.place == PlaceKnown::unknown
                                    ? "its place is not known"
                                    : fmt::format("x {}, y {}", place(pose.pose.x), place(pose.pose.y));
      std::string text =
          fmt::format("p{}: {}, heading {}", k, where, pose.any_heading ? "any" : pretty_degrees(pose.pose.heading));
      if (std::isfinite(pose.probability)) text += ", " + percent(pose.probability);
      if (pose.continuum) text += ", one of a continuum";
      result.push_back({Sign::line, colour(k), {{text}}, ""});
    }
    const std::size_t more = answer_.poses.size() - poses_.size();
    if (more > 0)
      result.push_back({Sign::line, kPaper, {{fmt::format("{} less likely poses are not drawn", more)}}, ""});
    return result;
  }

  const TouchFigure& figure_;
  const TouchAnswer& answer_;
  HeadingDensities headings_;
  std::vector<Vec2> outline_;
  std::vector<std::vector<Vec2>> poses_;
  Axes axes_;
  double scale_ = 1;
};

}  // namespace
}  // namespace draw

Svg draw_touches(const TouchFigure& figure) {
  if (figure.answer == nullptr) throw InputError("a figure of touches needs an answer, found none");
  return draw::TouchPicture(figure).draw();
}

}  // namespace rollfix
