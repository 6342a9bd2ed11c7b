#include "rollfix/draw.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "labels.hpp"
#include "outline/box.hpp"
#include "plot.hpp"
#include "posed_part.hpp"
#include "rollfix/error.hpp"
#include "rolls.hpp"
#include "text/text.hpp"

namespace rollfix {
namespace draw {
namespace {

constexpr std::size_t kMostHeldPoses = 6;
constexpr double kHoldJaw = 0.45;  // half of a jaw as it is drawn, of the part's size
constexpr double kFreeWidth = 12;  // of the first finger's stretch, pixels, ...
constexpr double kFreeStep = 3;    // ... less of each further one's, ...
constexpr double kLeastFreeWidth = 3;
constexpr double kFreeOpacity = 0.5;

class HoldPicture {
 public:
  explicit HoldPicture(const HoldFigure& figure)
      : figure_(figure),
        answer_(*figure.answer),
        part_(answer_.part, answer_.place, answer_.mirrored),
        shown_(std::min(answer_.placements.size(), kMostHeldPoses)) {
    frame();
  }

  Svg draw() {
    const Legend legend(entries(), figure_.width);
    Svg svg(figure_.width, world_.bottom() + legend.height());
    svg.describe("The part at the last instant in each placement that the fingers leave");
    draw_header(svg, figure_.title.empty() ? answer_.part.name() : figure_.title, answer_.verdict_text(),
                {{fingers_words()}});
    world_.open(svg, part_.frame_words());
    if (!slides()) at_first(svg);
    for (std::size_t k = shown_; k-- > 0;) placement(svg, k);
    if (slides()) at_first(svg);  // its stretches are seen whole
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

  /// Whether the likeliest placement is one of a continuum.
  bool slides() const { return shown_ > 0 && answer_.placements.front().continuum; }
  /// Whether the part is drawn where it was at the first contacts as well.
  bool shows_first() const { return shown_ > 0 && (answer_.place != PlaceKnown::unknown || slides()); }
  std::vector<Vec2> first_outline() const { return part_.at(answer_.placements.front().first); }

  /// Where a first contact may be: with noise to 95 %.
  Interval starts(const HoldContact& contact) const {
    if (!answer_.noise) return contact.extent;
    const Boundary boundary = answer_.part.boundary();
    return is_anywhere(contact.interval, boundary) ? boundary.full_arc() : contact.interval;
  }

  /// The measurements leave it open: a point would say where it is.
  bool is_free(const HoldPlacement& one, const HoldContact& contact) const {
    return one.continuum && world_.pixels(starts(contact).width()) > kVisibleExtent;
  }

  /// In the likeliest placement.
  std::vector<std::size_t> free_fingers() const {
    std::vector<std::size_t> result;
    if (!slides()) return result;
    const HoldPlacement& one = answer_.placements.front();
    for (std::size_t k = 0; k < one.contacts.size(); ++k) {
      if (is_free(one, one.contacts[k])) result.push_back(k);
    }
    return result;
  }

  /// Apart from those of the placements.
  static std::string_view finger_colour(std::size_t finger) { return colour(kMostHeldPoses + finger); }

  /// One scale both ways, and all of it inside.
  void frame() {
    Box seen;
    for (std::size_t k = 0; k < shown_; ++k) seen.extend(box_around(part_.at(answer_.placements[k].last)));
    if (shows_first()) seen.extend(box_around(first_outline()));
    for (const HoldRoll& roll : answer_.rolls) {
      for (const Vec2& centre : roll.track) {
        seen.extend(Vec2(centre + Vec2::Constant(roll.radius)));
        seen.extend(Vec2(centre - Vec2::Constant(roll.radius)));
      }
      for (std::size_t end = 0; end < 2 && roll.is_jaw && !roll.track.empty(); ++end) seen.extend(on_jaw(roll, end, 0));
    }
    if (seen.isEmpty()) seen = box_around(part_.outline().points);
    world_ = World(seen, answer_.part, figure_.width);
  }

  void placement(Svg& svg, std::size_t k) const {
    const HoldPlacement& one = answer_.placements[k];
    svg.open_group("placement");
    part_.draw(svg, world_, k, one.last, figure_.others);
    for (const HoldContact& contact : one.contacts) {
      if (is_free(one, contact)) continue;
      const Vec2 at = part_.in_world({answer_.part.point(contact.end)}, one.last).front();
      svg.circle(world_.at(at), kWorldDot, draw::filled(colour(k)));
    }
    svg.close_group();
  }

  /// The part at the first contacts in the likeliest placement. Under its line the stretches of those that are free,
  /// each narrower than the one before: all are seen where they overlap.
  void at_first(Svg& svg) const {
    if (!shows_first()) return;
    const HoldPlacement& one = answer_.placements.front();
    for (const std::size_t k : free_fingers()) {
      const Interval range = starts(one.contacts[k]);
      const std::vector<Vec2> stretch = slice(part_.outline(), range.lo, range.hi).points;
      const double width = std::max(kLeastFreeWidth, kFreeWidth - kFreeStep * static_cast<double>(k));
      svg.open_group(answer_.noise ? "interval" : "extent");
      svg.polyline(world_.path(part_.in_world(stretch, one.first)), stroke(finger_colour(k), width, "", kFreeOpacity));
      svg.close_group();
    }
    svg.polyline(world_.path(first_outline()), stroke(kSoftInk, 1, "4 3"));
  }

  /// A place of a jaw in the world at the first (0) or the last (1) instant, so far from its contact.
  static Vec2 on_jaw(const HoldRoll& roll, std::size_t end, double beside) {
    const Vec2& origin = end == 0 ? roll.track.front() : roll.track.back();
    return Pose{origin.x(), origin.y(), roll.psi[end]}.world({roll.u[end] + beside, 0});
  }

  /// Its surface, dashed where it was at first.
  void jaw(Svg& svg, const HoldRoll& roll) const {
    const Box bounds = box_around(part_.outline().points);
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
    for (std::size_t k = 0; k < shown_; ++k) {
      const HoldPlacement& one = answer_.placements[k];
      result.push_back(part_.entry(k, fmt::format("{}: at the end", k), {one.last, one.probability, one.continuum}));
    }
    const std::size_t more = answer_.placements.size() - shown_;
    if (more > 0) {
      result.push_back({Sign::line, kPaper, {{fmt::format("{} more placements are not drawn", more)}}, ""});
    }
    for (const std::size_t k : free_fingers()) result.push_back(free_start(k));
    if (shows_first()) result.push_back({Sign::line, kSoftInk, {{"dashed: at the first contacts, in 0"}}, ""});
    const bool any_wheel =
        std::any_of(answer_.rolls.begin(), answer_.rolls.end(), [](const HoldRoll& roll) { return roll.is_wheel; });
    if (any_wheel) result.push_back({Sign::line, kInk, {{"the fingers, and the ways of their origins and pins"}}, ""});
    return result;
  }

  LegendEntry free_start(std::size_t k) const {
    const Interval range = starts(answer_.placements.front().contacts[k]);
    const Boundary boundary = answer_.part.boundary();
    const std::string where = boundary.is_full(range) ? "anywhere"
                                                      : fmt::format("{}in {} to {}", answer_.noise ? "95 % " : "",
                                                                    pretty_on(answer_.part, range.lo),
                                                                    pretty_on(answer_.part, boundary.base(range.hi)));
    const char letter = static_cast<char>('a' + k);
    const std::string text =
        fmt::format("{} {}'s first contact in 0: {}", answer_.rolls[k].is_wheel ? "wheel" : "finger", letter, where);
    return {Sign::area, finger_colour(k), {{text}}, ""};
  }

  const HoldFigure& figure_;
  const HoldAnswer& answer_;
  PosedPart part_;
  std::size_t shown_;  // placements
  World world_;
};

}  // namespace
}  // namespace draw

Svg draw_hold(const HoldFigure& figure) {
  if (figure.answer == nullptr) throw InputError("a figure of fingers needs an answer, found none");
  return draw::HoldPicture(figure).draw();
}

}  // namespace rollfix
