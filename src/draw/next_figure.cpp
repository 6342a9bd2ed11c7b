#include "rollfix/draw.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <utility>

#include "labels.hpp"
#include "outline/box.hpp"
#include "plot.hpp"
#include "posed_part.hpp"
#include "rollfix/error.hpp"
#include "scene.hpp"
#include "text/text.hpp"

// What the fingers can do next: what a roll would tell by its length, and a plan in the world and in time.
namespace rollfix {

namespace draw {
namespace {

constexpr double kGainLeft = 58;  // pixels
constexpr double kGainRight = 16;
constexpr double kGainHeight = 150;
constexpr double kGainGap = 46;  // above each plot
constexpr double kGainEnd = 44;  // below the last one

/// One quantity by the roll's length.
struct GainPlot {
  Text title;
  std::function<double(const ExpectedGain&)> value;
  double most = 1;
  std::string_view colour;
};

void draw_gains(Svg& svg, const Advice& advice, const GainPlot& plot, double top, double width) {
  Axes axes;
  axes.corner = {kGainLeft, top};
  axes.size = {width - kGainLeft - kGainRight, kGainHeight};
  axes.x = widened({advice.gains.front().length, advice.gains.back().length}, 0.02);
  axes.y = widened({0, plot.most}, 0.06);
  axes.y.lo = 0;
  draw_axes(svg, axes, round_ticks(axes.x, 8), round_ticks(axes.y, 5), plot.title, "");
  std::vector<Vec2> points;
  for (const ExpectedGain& gain : advice.gains) points.push_back(axes(gain.length, plot.value(gain)));
  svg.segments({axes(0, axes.y.lo), axes(0, axes.y.hi)}, stroke(kSoftInk, 0.8));
  draw_graph(svg, axes, points, stroke(plot.colour, 1.6));
  if (!advice.helps) return;
  const ExpectedGain& advised = advice.advised();
  svg.segments({axes(advised.length, axes.y.lo), axes(advised.length, axes.y.hi)}, stroke(kInk, 1, "4 3"));
  svg.circle(axes(advised.length, plot.value(advised)), 4, filled(plot.colour));
}

/// What the length along the plots means.
std::string about_way(const PerFinger<double>& way) {
  if (way.size() == 1) return "rolling on from where the contact is now; below 0: backwards";
  const auto of = [&](std::size_t finger) {
    const char* const name = finger == 0 ? "a" : "b";
    if (way[finger] == 0) return fmt::format("{} stays", name);
    return way[finger] == 1 ? fmt::format("{} rolls on", name)
                            : fmt::format("{} by {:g} times as far", name, way[finger]);
  };
  return fmt::format("from where the contacts are now: finger {}, finger {}; below 0: backwards", of(0), of(1));
}

}  // namespace
}  // namespace draw

Svg draw_advice(const AdviceFigure& figure) {
  using namespace draw;
  const double top = kHeaderHeight + 30;
  const double second = top + kGainHeight + kGainGap;
  Svg svg(figure.width, second + kGainHeight + kGainEnd);
  svg.describe(figure.title + ": " + figure.outcome);
  svg.rectangle(0, 0, svg.width(), svg.height(), filled(kPaper));
  draw_header(svg, figure.title, figure.outcome, {{about_way(figure.advice.way)}});
  double most = 1;
  for (const ExpectedGain& gain : figure.advice.gains) most = std::max(most, gain.placements);
  draw_gains(
      svg, figure.advice,
      {{{"placements that remain, expected"}}, [](const ExpectedGain& p) { return p.placements; }, most, colour(0)},
      top, figure.width);
  draw_gains(svg, figure.advice,
             {{{"information gained, bits"}},
              [](const ExpectedGain& p) { return p.bits; },
              std::max(figure.advice.bits_wanted, 0.1),
              colour(1)},
             second, figure.width);
  Axes last;
  last.corner = {kGainLeft, second};
  last.size = {figure.width - kGainLeft - kGainRight, kGainHeight};
  draw_x_name(svg, last, {{"length rolled"}});
  return svg;
}

namespace draw {
namespace {

constexpr double kPlanCone = 0.14;  // of the part's size: how long a cone is drawn
constexpr int kPlanSides = 96;      // of a finger's outline

class PlanPicture {
 public:
  explicit PlanPicture(const PlanFigure& figure)
      : figure_(figure), plan_(*figure.plan), problem_(*figure.problem), rows_(plan_.roll.log.time.size()) {
    const Box bounds = part_bounds(problem_.part);
    size_ = bounds.sizes().maxCoeff();
    outline_ = coarse_outline(problem_.part, size_).points;
    shown_ = plan_.failure ? std::min(plan_.margins[*plan_.failure].row, rows_ - 1) : rows_ - 1;
    frame_all();
  }

  Svg draw() {
    const Legend legend(entries(), figure_.width);
    Svg svg(figure_.width, world_.bottom() + legend.height());
    svg.describe("The part and the fingers at the start and the end of the planned roll");
    draw_header(svg, figure_.title.empty() ? problem_.part.name() : figure_.title,
                plan_.feasible() ? "a plan"
                : plan_.failure  ? "no plan"
                                 : "undecided",
                {{counted(fingers(), "finger", "fingers")}});
    world_.open(svg, "in the world");
    part(svg);
    for (std::size_t which = 0; which < fingers(); ++which) finger(svg, which);
    if (fingers() == 2) force(svg);
    World::close(svg);
    legend.draw(svg, world_.bottom());
    return svg;
  }

 private:
  std::size_t fingers() const { return plan_.length.size(); }
  Pose pose(std::size_t row) const { return plan_.roll.pose.empty() ? problem_.pose : plan_.roll.pose[row]; }
  Pose frame_of(std::size_t which, std::size_t row) const {
    const FingerRows& rows = plan_.roll.log.fingers[which];
    return {rows.x[row], rows.y[row], rows.psi[row]};
  }
  Vec2 contact(std::size_t which, std::size_t row) const {
    return posed({problem_.part.point(plan_.roll.s[which][row])}, pose(row), problem_.mirrored).front();
  }

  std::vector<Vec2> part_at(std::size_t row) const { return posed(outline_, pose(row), problem_.mirrored); }

  std::vector<Vec2> finger_at(std::size_t which, std::size_t row) const {
    const double contact = plan_.roll.log.fingers[which].u[row];
    return posed(shape_of(problem_.fingers[which].finger, kPlanSides, size_, contact), frame_of(which, row));
  }

  std::vector<Vec2> way(std::size_t which) const {
    const FingerRows& rows = plan_.roll.log.fingers[which];
    std::vector<Vec2> points;
    for (std::size_t row = 0; row <= shown_; ++row) points.emplace_back(rows.x[row], rows.y[row]);
    return points;
  }

  /// One scale both ways, and all of it inside.
  void frame_all() {
    Box seen = box_around(part_at(0));
    seen.extend(box_around(part_at(shown_)));
    for (std::size_t which = 0; which < fingers(); ++which) {
      for (const std::size_t row : {std::size_t{0}, shown_}) seen.extend(box_around(finger_at(which, row)));
    }
    world_ = World(seen, problem_.part, figure_.width);
  }

  void part(Svg& svg) const {
    const std::vector<Vec2> points = world_.path(part_at(shown_));
    svg.open_group("part");
    if (problem_.part.closed() && !problem_.part.outline().hole) svg.polygon(points, draw::filled(kMaterial));
    if (fingers() == 2) svg.polyline(world_.path(part_at(0)), stroke(kSoftInk, 1, "4 3"));
    svg.polyline(points, stroke(kInk, 1.6));
    svg.close_group();
  }

  void finger(Svg& svg, std::size_t which) const {
    svg.open_group("finger");
    svg.polyline(world_.path(finger_at(which, 0)), stroke(colour(which), 0.9, "4 3"));
    svg.polyline(world_.path(finger_at(which, shown_)), stroke(colour(which), 1.8));
    // A jaw's frame may be far from where it touches: its way would mislead.
    if (!problem_.fingers[which].finger.is_jaw()) svg.polyline(world_.path(way(which)), stroke(colour(which), 1.2));
    svg.circle(world_.at(contact(which, shown_)), kWorldDot, draw::filled(colour(which)));
    svg.close_group();
  }

  /// The line of the force, and the cones that it must lie in.
  void force(Svg& svg) const {
    svg.open_group("force");
    svg.polyline(world_.path({contact(0, shown_), contact(1, shown_)}), stroke(kInk, 1, "1 3"));
    for (std::size_t which = 0; which < 2; ++which) {
      const PlanFinger& finger = problem_.fingers[which];
      if (!finger.friction && !finger.wheel) continue;
      const double half = finger.wheel ? 0 : std::atan(*finger.friction);
      const double on_part = plan_.roll.angle[which][shown_] + 0.5 * std::numbers::pi;
      const double inward = pose(shown_).heading + (problem_.mirrored ? std::numbers::pi - on_part : on_part);
      const Vec2 tip = contact(which, shown_);
      const auto edge = [&](double angle) {
        return Vec2(tip + kPlanCone * size_ * Vec2(std::cos(angle), std::sin(angle)));
      };
      svg.polyline(world_.path({edge(inward - half), tip, edge(inward + half)}), stroke(colour(which), 1));
    }
    svg.close_group();
  }

  std::vector<LegendEntry> entries() const {
    std::vector<LegendEntry> result;
    for (std::size_t which = 0; which < fingers(); ++which) {
      const std::string name = fingers() == 1                  ? "the finger"
                               : problem_.fingers[which].wheel ? "the wheel"
                               : which == 0                    ? "finger a"
                                                               : "finger b";
      result.push_back({Sign::line,
                        colour(which),
                        {{fmt::format("{}: s from {} to {}", name, pretty(plan_.roll.s[which].front()),
                                      pretty(plan_.roll.s[which][shown_]))}},
                        ""});
    }
    const std::string when = plan_.failure ? "where it fails" : "at the end";
    result.push_back(
        {Sign::line,
         kSoftInk,
         {{fmt::format("dashed: at the start; else {}, at {} s", when, pretty(plan_.roll.log.time[shown_]))}},
         ""});
    if (fingers() == 2) result.push_back({Sign::line, kInk, {{"dotted: the force, with the friction cones"}}, ""});
    return result;
  }

  const PlanFigure& figure_;
  const Plan& plan_;
  const PlanProblem& problem_;
  std::size_t rows_;
  std::size_t shown_ = 0;
  double size_ = 1;
  std::vector<Vec2> outline_;
  World world_;
};

}  // namespace
}  // namespace draw

Svg draw_plan(const PlanFigure& figure) {
  if (figure.plan == nullptr || figure.problem == nullptr) {
    throw InputError("a figure of a plan needs the plan and its problem, found none");
  }
  return draw::PlanPicture(figure).draw();
}

}  // namespace rollfix
