#include "rollfix/draw/hold_figure.hpp"

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
#include "trace.hpp"

namespace rollfix {
namespace draw {
namespace {

constexpr std::size_t kMostHeldPoses = 6;
constexpr double kHoldLeft = 58;  // around the frame, pixels
constexpr double kHoldRight = 16;
constexpr double kHoldAbove = 22;
constexpr double kHoldBelow = 34;
constexpr double kHoldLeastHeight = 160;
constexpr double kHoldMostHeight = 720;
constexpr double kHoldMargin = 0.06;  // of what is shown
constexpr double kHoldGhost = 0.55;   // opacity of placements but the first
constexpr double kHoldDot = 2.6;      // pixels
constexpr double kHoldJaw = 0.45;     // half of a jaw as it is drawn, of the part's size

class HoldPicture {
 public:
  explicit HoldPicture(const HoldFigure& figure) : figure_(figure), answer_(*figure.answer) {
    const Box bounds = part_bounds(answer_.part);
    outline_ = trace(answer_.part, 1e-4 * bounds.sizes().maxCoeff()).points;
    const std::size_t shown = std::min(answer_.placements.size(), kMostHeldPoses);
    for (std::size_t k = 0; k < shown; ++k) {
      last_.push_back(in_world(outline_, answer_.placements[k].last));
      contacts_.push_back({});
      for (const HoldContact& contact : answer_.placements[k].contacts) {
        contacts_.back().push_back(in_world({answer_.part.point(contact.end)}, answer_.placements[k].last).front());
      }
    }
    if (shown > 0) first_ = in_world(outline_, answer_.placements.front().first);
    frame();
  }

  Svg draw() {
    const Legend legend(entries(), figure_.width);
    Svg svg(figure_.width, axes_.corner.y() + axes_.size.y() + kHoldBelow + legend.height());
    svg.describe("The part at the last instant in each placement that the fingers leave");
    draw_header(svg, figure_.title.empty() ? answer_.part.name() : figure_.title, answer_.verdict_text(),
                {{fingers_words()}});
    svg.open_group("world");
    draw_axes(
        svg, axes_, round_ticks(axes_.x, 5), round_ticks(axes_.y, 5),
        {{answer_.place == PlaceKnown::unknown ? "turned as in the world; its place is not known" : "in the world"}},
        "");
    svg.open_clip(axes_.corner.x(), axes_.corner.y(), axes_.size.x(), axes_.size.y());
    if (is_known()) svg.polyline(on_page(first_), stroke(kSoftInk, 1, "4 3"));
    for (std::size_t k = last_.size(); k-- > 0;) placement(svg, k);
    for (const HoldRoll& roll : answer_.rolls) {
      finger(svg, roll);
      if (roll.is_jaw && !roll.track.empty()) jaw(svg, roll);
    }
    svg.close_group();
    svg.close_group();
    legend.draw(svg, axes_.corner.y() + axes_.size.y() + kHoldBelow);
    return svg;
  }

 private:
  std::string fingers_words() const {
    const auto wheels = static_cast<std::size_t>(
        std::count_if(answer_.rolls.begin(), answer_.rolls.end(), [](const HoldRoll& roll) { return roll.is_wheel; }));
    const std::string fingers = counted(answer_.rolls.size() - wheels, "finger", "fingers");
    return wheels == 0 ? fingers : fmt::format("{} and {}", fingers, counted(wheels, "wheel", "wheels"));
  }

  bool is_known() const { return !first_.empty() && answer_.place != PlaceKnown::unknown; }

  std::vector<Vec2> in_world(const std::vector<Vec2>& points, const Pose& pose) const {
    const Pose shown = answer_.place == PlaceKnown::unknown ? Pose{0, 0, pose.heading} : pose;
    std::vector<Vec2> world;
    for (const Vec2& point : points) {
      world.push_back(shown.world({answer_.mirrored ? -point.x() : point.x(), point.y()}));
    }
    return world;
  }

  /// One scale both ways, and all of it inside.
  void frame() {
    Box seen;
    for (const std::vector<Vec2>& points : last_) seen.extend(box_around(points));
    if (is_known()) seen.extend(box_around(first_));
    for (const HoldRoll& roll : answer_.rolls) {
      for (const Vec2& centre : roll.track) {
        seen.extend(Vec2(centre + Vec2::Constant(roll.radius)));
        seen.extend(Vec2(centre - Vec2::Constant(roll.radius)));
      }
      for (std::size_t end = 0; end < 2 && roll.is_jaw && !roll.track.empty(); ++end) seen.extend(on_jaw(roll, end, 0));
    }
    if (seen.isEmpty()) seen = box_around(outline_);
    const double margin = std::max(kHoldMargin * seen.sizes().maxCoeff(), 1e-9 * answer_.part.perimeter());
    const Box wide(seen.min() - Vec2::Constant(margin), seen.max() + Vec2::Constant(margin));
    const double width = figure_.width - kHoldLeft - kHoldRight;
    const double height = std::clamp(width * wide.sizes().y() / wide.sizes().x(), kHoldLeastHeight, kHoldMostHeight);
    scale_ = std::min(width / wide.sizes().x(), height / wide.sizes().y());
    const Vec2 half = 0.5 * Vec2(width, height) / scale_;
    axes_.corner = {kHoldLeft, kHeaderHeight + kHoldAbove};
    axes_.size = {width, height};
    axes_.x = {wide.center().x() - half.x(), wide.center().x() + half.x()};
    axes_.y = {wide.center().y() - half.y(), wide.center().y() + half.y()};
  }

  std::vector<Vec2> on_page(const std::vector<Vec2>& points) const {
    std::vector<Vec2> page;
    for (const Vec2& point : points) page.push_back(axes_(point.x(), point.y()));
    return page;
  }

  void placement(Svg& svg, std::size_t k) const {
    const std::vector<Vec2> points = on_page(last_[k]);
    svg.open_group("placement");
    if (k == 0 && answer_.part.closed() && !answer_.part.outline().hole) svg.polygon(points, draw::filled(kMaterial));
    svg.polyline(points, stroke(colour(k), k == 0 ? 1.8 : 1.1, "", k == 0 ? 1 : kHoldGhost));
    if (k == 0) {
      for (const Outline& other : figure_.others) {
        svg.polyline(on_page(in_world(polyline_of(other), answer_.placements[0].last)), stroke(kSoftInk, 0.6));
      }
    }
    for (const Vec2& contact : on_page(contacts_[k])) svg.circle(contact, kHoldDot, draw::filled(colour(k)));
    svg.close_group();
  }

  /// A place of a jaw in the world at the first (0) or the last (1) instant, so far from its contact.
  static Vec2 on_jaw(const HoldRoll& roll, std::size_t end, double beside) {
    const Vec2& origin = end == 0 ? roll.track.front() : roll.track.back();
    return Pose{origin.x(), origin.y(), roll.psi[end]}.world({roll.u[end] + beside, 0});
  }

  /// Its surface, dashed where it was at first.
  void jaw(Svg& svg, const HoldRoll& roll) const {
    const Box bounds = box_around(outline_);
    const double half = kHoldJaw * bounds.sizes().maxCoeff();
    svg.open_group("jaw");
    for (std::size_t end = 0; end < 2; ++end) {
      const std::vector<Vec2> line{on_jaw(roll, end, -half), on_jaw(roll, end, half)};
      svg.polyline(on_page(line), end == 0 ? stroke(kSoftInk, 1, "4 3") : stroke(kInk, 1.6));
    }
    svg.close_group();
  }

  /// The way of its centre, with the finger where it is at the end; of a wheel where it was at first as well.
  void finger(Svg& svg, const HoldRoll& roll) const {
    if (roll.track.empty()) return;
    svg.open_group("finger");
    const std::vector<Vec2> path = on_page(roll.track);
    if (roll.is_wheel) svg.circle(path.front(), roll.radius * scale_, stroke(kSoftInk, 1, "4 3"));
    if (roll.radius > 0) svg.circle(path.back(), roll.radius * scale_, stroke(kSoftInk, 0.8));
    svg.polyline(path, stroke(kInk, 1.4));
    svg.circle(path.back(), kHoldDot, draw::filled(kInk));
    svg.close_group();
  }

  std::vector<LegendEntry> entries() const {
    std::vector<LegendEntry> result;
    for (std::size_t k = 0; k < last_.size(); ++k) {
      const HoldPlacement& one = answer_.placements[k];
      const auto place = [&](double value) {  // without what is rounding
        return pretty(std::abs(value) <= 1e-9 * answer_.part.perimeter() ? 0 : value);
      };
      const std::string where = answer_.place == PlaceKnown::unknown
                                    ? "its place is not known"
                                    : fmt::format("x {}, y {}", place(one.last.x), place(one.last.y));
      std::string text = fmt::format("{}: at the end {}, heading {}", k, where, pretty_degrees(one.last.heading));
      if (std::isfinite(one.probability)) text += ", " + percent(one.probability);
      if (one.continuum) text += ", one of a continuum";
      result.push_back({Sign::line, colour(k), {{text}}, ""});
    }
    const std::size_t more = answer_.placements.size() - last_.size();
    if (more > 0) {
      result.push_back({Sign::line, kPaper, {{fmt::format("{} more placements are not drawn", more)}}, ""});
    }
    if (is_known()) result.push_back({Sign::line, kSoftInk, {{"dashed: at the first contacts, in 0"}}, ""});
    const bool any_wheel =
        std::any_of(answer_.rolls.begin(), answer_.rolls.end(), [](const HoldRoll& roll) { return roll.is_wheel; });
    if (any_wheel) result.push_back({Sign::line, kInk, {{"the fingers, and the ways of their origins and pins"}}, ""});
    return result;
  }

  const HoldFigure& figure_;
  const HoldAnswer& answer_;
  std::vector<Vec2> outline_;
  std::vector<Vec2> first_;
  std::vector<std::vector<Vec2>> last_;
  std::vector<std::vector<Vec2>> contacts_;
  Axes axes_;
  double scale_ = 1;
};

}  // namespace
}  // namespace draw

Svg draw_hold(const HoldFigure& figure) {
  if (figure.answer == nullptr) throw InputError("a figure of fingers needs an answer, found none");
  return draw::HoldPicture(figure).draw();
}

}  // namespace rollfix
