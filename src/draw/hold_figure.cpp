#include "rollfix/draw.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "labels.hpp"
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
constexpr double kHoldJaw = 0.45;  // half of a jaw as it is drawn, of the part's size

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
    Svg svg(figure_.width, world_.bottom() + legend.height());
    svg.describe("The part at the last instant in each placement that the fingers leave");
    draw_header(svg, figure_.title.empty() ? answer_.part.name() : figure_.title, answer_.verdict_text(),
                {{fingers_words()}});
    world_.open(
        svg, answer_.place == PlaceKnown::unknown ? "turned as in the world; its place is not known" : "in the world");
    if (is_known()) svg.polyline(world_.path(first_), stroke(kSoftInk, 1, "4 3"));
    for (std::size_t k = last_.size(); k-- > 0;) placement(svg, k);
    for (const HoldRoll& roll : answer_.rolls) {
      finger(svg, roll);
      if (roll.is_jaw && !roll.track.empty()) jaw(svg, roll);
    }
    World::close(svg);
    legend.draw(svg, world_.bottom());
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
    return posed(points, answer_.place == PlaceKnown::unknown ? Pose{0, 0, pose.heading} : pose, answer_.mirrored);
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
    world_ = World(seen, answer_.part, figure_.width);
  }

  void placement(Svg& svg, std::size_t k) const {
    const std::vector<Vec2> points = world_.path(last_[k]);
    svg.open_group("placement");
    if (k == 0 && answer_.part.closed() && !answer_.part.outline().hole) svg.polygon(points, draw::filled(kMaterial));
    svg.polyline(points, stroke(colour(k), k == 0 ? 1.8 : 1.1, "", k == 0 ? 1 : kWorldGhost));
    if (k == 0) {
      for (const Outline& other : figure_.others) {
        svg.polyline(world_.path(in_world(polyline_of(other), answer_.placements[0].last)), stroke(kSoftInk, 0.6));
      }
    }
    for (const Vec2& contact : world_.path(contacts_[k])) svg.circle(contact, kWorldDot, draw::filled(colour(k)));
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
      svg.polyline(world_.path(line), end == 0 ? stroke(kSoftInk, 1, "4 3") : stroke(kInk, 1.6));
    }
    svg.close_group();
  }

  /// The way of its centre, with the finger where it is at the end; of a wheel where it was at first as well.
  void finger(Svg& svg, const HoldRoll& roll) const {
    if (roll.track.empty()) return;
    svg.open_group("finger");
    const std::vector<Vec2> path = world_.path(roll.track);
    if (roll.is_wheel) svg.circle(path.front(), world_.pixels(roll.radius), stroke(kSoftInk, 1, "4 3"));
    if (roll.radius > 0) svg.circle(path.back(), world_.pixels(roll.radius), stroke(kSoftInk, 0.8));
    svg.polyline(path, stroke(kInk, 1.4));
    svg.circle(path.back(), kWorldDot, draw::filled(kInk));
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
  World world_;
};

}  // namespace
}  // namespace draw

Svg draw_hold(const HoldFigure& figure) {
  if (figure.answer == nullptr) throw InputError("a figure of fingers needs an answer, found none");
  return draw::HoldPicture(figure).draw();
}

}  // namespace rollfix
