#include "rollfix/draw.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

#include "labels.hpp"
#include "outline/box.hpp"
#include "outline/turn.hpp"
#include "plot.hpp"
#include "posed_part.hpp"
#include "rollfix/error.hpp"
#include "rollfix/touch.hpp"
#include "scene.hpp"
#include "text/text.hpp"

// Touches and the poses that fit them, in the world; below, with noise, how dense the part's heading is. Notation:
//   w_k, m_k, sd_k   terms of a pose's heading, radians: MixtureTerm, of all together 1
//   p(phi)           sum of w_k / (sqrt(2 pi) sd_k) exp(-((phi - m_k) / sd_k)^2 / 2), per degree: `heading_density_at`
namespace rollfix {
namespace draw {
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

/// Below the figure of touches, with noise: the density of the part's heading in the likeliest poses, each at its own
/// scale, with what holds 95 % of it shaded.
class HeadingDensities {
 public:
  HeadingDensities(const TouchAnswer& answer, double width) : answer_(answer), width_(width) {
    for (std::size_t k = 0; k < answer.poses.size() && shown_.size() < kMostHeadings; ++k) {
      const TouchPose& pose = answer.poses[k];
      if (pose.probability >= kWorthHeading && is_heading_known(pose)) shown_.push_back(k);
    }
  }

  /// Pixels; 0: there is nothing to draw.
  double height() const { return shown_.empty() ? 0 : kHeadingAbove + kHeadingHeight + kHeadingBelow; }

  void draw(Svg& svg, double top) const {
    const auto count = static_cast<double>(shown_.size());
    const double each = (width_ - kHeadingLeft - kHeadingRight - (count - 1) * kHeadingGap) / std::max(1.0, count);
    for (std::size_t i = 0; i < shown_.size(); ++i) {
      draw_one(svg, shown_[i], {kHeadingLeft + static_cast<double>(i) * (each + kHeadingGap), top + kHeadingAbove},
               each);
    }
  }

 private:
  void draw_one(Svg& svg, std::size_t pose, const Vec2& corner, double width) const {
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
      svg.polygon(area, draw::filled(colour(pose), 0.45));
    }
    svg.polyline(line, stroke(kInk, 1));
    draw_x_name(svg, axes, {{width > kRoomyHeading ? "heading, degrees; shaded: 95 %" : "heading, degrees"}});
    svg.close_group();
  }

  const TouchAnswer& answer_;
  double width_;
  std::vector<std::size_t> shown_;
};

constexpr std::size_t kMostTouchPoses = 6;
constexpr double kTouchNormal = 26;  // length of a normal, pixels

class TouchPicture {
 public:
  explicit TouchPicture(const TouchFigure& figure)
      : figure_(figure),
        answer_(*figure.answer),
        headings_(answer_, figure.width),
        part_(answer_.part, answer_.place, answer_.mirrored),
        shown_(std::min(answer_.poses.size(), kMostTouchPoses)) {
    frame();
  }

  Svg draw() {
    const Legend legend(entries(), figure_.width);
    Svg svg(figure_.width, world_.bottom() + legend.height() + headings_.height());
    svg.describe("The part in each pose that the touches leave");
    draw_header(svg, figure_.title.empty() ? answer_.part.name() : figure_.title, answer_.verdict_text(),
                {{contacts_text()}});
    world_.open(svg, part_.frame_words());
    for (std::size_t k = shown_; k-- > 0;) pose(svg, k);
    for (const RollFacts& roll : answer_.rolls) rolled(svg, roll);
    for (const Clear& path : answer_.clear) passed(svg, path);
    for (std::size_t k = 0; k < answer_.touches.size(); ++k) touched(svg, answer_.touches[k], is_outlier(k));
    if (figure_.next != nullptr) advised(svg, *figure_.next);
    World::close(svg);
    const double below = world_.bottom();
    legend.draw(svg, below);
    headings_.draw(svg, below + legend.height());
    return svg;
  }

 private:
  /// One scale both ways, and all of the poses and touches inside.
  void frame() {
    Box seen;
    for (std::size_t k = 0; k < shown_; ++k) seen.extend(box_around(part_.at(answer_.poses[k].pose)));
    for (const MeasuredTouch& touch : answer_.touches) {
      if (!touch.has_place()) continue;
      seen.extend(Vec2(touch.at + Vec2::Constant(answer_.radius)));
      seen.extend(Vec2(touch.at - Vec2::Constant(answer_.radius)));
    }
    for (const RollFacts& roll : answer_.rolls) {
      for (const Vec2& centre : roll.track) seen.extend(centre);
    }
    if (figure_.next != nullptr) seen.extend(figure_.next->advised().approach.from);
    world_ = World(seen, answer_.part, figure_.width);
  }

  void pose(Svg& svg, std::size_t k) const {
    svg.open_group("pose");
    part_.draw(svg, world_, k, answer_.poses[k].pose, figure_.others);
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
    const std::vector<Vec2> path = world_.path(roll.track);
    if (answer_.radius > 0) svg.circle(path.front(), world_.pixels(answer_.radius), stroke(kSoftInk, 0.8));
    svg.polyline(path, stroke(kInk, 1.4));
    svg.circle(path.front(), kWorldDot, draw::filled(kInk));
    svg.close_group();
  }

  /// Dotted: nothing was felt there.
  void passed(Svg& svg, const Clear& path) const {
    svg.open_group("clear");
    svg.polyline(world_.path({path.from, path.to}), stroke(kSoftInk, 1, "1.5 3"));
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
    const std::vector<Vec2> path = world_.path({way.from, end});
    svg.open_group("approach");
    svg.polyline(without_tip(path, 4), stroke(kInk, 1.2, "6 3"));
    draw_arrowhead(svg, path, 7, kInk);
    for (const ExpectedTouch& one : next.expected) {
      if (!one.hits || one.placement >= shown_) continue;
      svg.circle(world_.at(one.at), std::max(world_.pixels(answer_.radius), kWorldDot),
                 stroke(colour(one.placement), 1.2));
    }
    svg.close_group();
  }

  /// In the pose that is drawn first.
  bool is_outlier(std::size_t touch) const {
    if (answer_.poses.empty()) return false;
    const std::vector<std::size_t>& outliers = answer_.poses.front().outliers;
    return std::binary_search(outliers.begin(), outliers.end(), touch);
  }

  /// An outlier is dashed, its dot hollow.
  void touched(Svg& svg, const MeasuredTouch& touch, bool is_outlier) const {
    if (!touch.has_place()) return;
    const Vec2 at = world_.at(touch.at);
    svg.open_group(is_outlier ? "outlier" : "touch");
    if (answer_.radius > 0) {
      svg.circle(at, world_.pixels(answer_.radius), stroke(kSoftInk, 0.8, is_outlier ? "3 2" : ""));
    }
    svg.circle(at, kWorldDot, is_outlier ? stroke(kInk, 1) : draw::filled(kInk));
    if (touch.normal) {
      const std::vector<Vec2> path = {at, at + kTouchNormal * Vec2(std::cos(*touch.normal), -std::sin(*touch.normal))};
      svg.polyline(without_tip(path, 4), stroke(kInk, 1));
      draw_arrowhead(svg, path, 6, kInk);
    }
    svg.close_group();
  }

  std::vector<LegendEntry> entries() const {
    std::vector<LegendEntry> result;
    for (std::size_t k = 0; k < shown_; ++k) {
      const TouchPose& pose = answer_.poses[k];
      result.push_back(part_.entry(k, fmt::format("p{}:", k),
                                   {pose.estimate(), pose.probability, pose.continuum, pose.any_heading}));
    }
    for (std::size_t k = 0; k < answer_.touches.size(); ++k) {
      if (!is_outlier(k)) continue;
      result.push_back({Sign::line,
                        kPaper,
                        {{fmt::format("touch {} is an outlier, {} probable", k + 1, percent(answer_.outlier[k]))}},
                        ""});
    }
    const std::size_t more = answer_.poses.size() - shown_;
    if (more > 0)
      result.push_back({Sign::line, kPaper, {{fmt::format("{} less likely poses are not drawn", more)}}, ""});
    return result;
  }

  const TouchFigure& figure_;
  const TouchAnswer& answer_;
  HeadingDensities headings_;
  PosedPart part_;
  std::size_t shown_;  // poses
  World world_;
};

}  // namespace
}  // namespace draw

Svg draw_touches(const TouchFigure& figure) {
  if (figure.answer == nullptr) throw InputError("a figure of touches needs an answer, found none");
  return draw::TouchPicture(figure).draw();
}

}  // namespace rollfix
