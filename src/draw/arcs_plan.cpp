#include "arcs_plan.hpp"

#include <fmt/format.h>

#include <cmath>

#include "roll_pen.hpp"
#include "rollfix/error.hpp"
#include "rolls.hpp"

namespace rollfix::draw {
namespace {

constexpr std::size_t kMostLabels = 20;  // placements with labels
constexpr std::size_t kMostLegend = 12;  // ... with a legend
constexpr std::size_t kMostArcs = 120;   // ... with arcs
constexpr std::size_t kMostFingers = 2;  // ... with a finger each when none is highlighted
constexpr std::size_t kLettered = 3;     // readings of which each has its own letter
constexpr double kMostLanesWidth = 64;   // of all lanes together
constexpr double kLabelRoom = 24;        // beyond the last lane

/// The fingers that are drawn, as far as they are not too far off.
Box fingers_of(const Plan& plan) {
  Box box;
  for (std::size_t i = 0; i < plan.placements().size(); ++i) {
    if (!plan.has_finger(i)) continue;
    for (const double s : {plan.placements()[i].start[0], plan.placements()[i].end[0]}) {
      include_finger(box, plan.framing.part, plan.part(), s, *radius_of(*plan.figure, 0));
    }
  }
  return box;
}

Lanes lanes_of(const Plan& plan) {
  std::vector<Interval> stretches;
  for (const Placement& placement : plan.placements()) {
    stretches.push_back({placement.start[0] + plan.roll.hull.lo, placement.start[0] + plan.roll.hull.hi});
  }
  // The scale is not known yet; the part's size over the page's width is near enough.
  const double gap = kEndGap * plan.framing.part.sizes().maxCoeff() / plan.framing.width;
  return assign_lanes(stretches, plan.part().boundary(), gap);
}

}  // namespace

bool Plan::has_arcs() const { return placements().size() <= kMostArcs; }
bool Plan::has_labels() const { return placements().size() <= kMostLabels; }
bool Plan::has_legend() const { return placements().size() <= kMostLegend; }
bool Plan::is_lettered(std::size_t k) const {
  return roll.contacts.size() <= kLettered || k + 1 == roll.contacts.size();
}

bool Plan::has_finger(std::size_t i) const {
  if (!radius_of(*figure, 0)) return false;
  return figure->highlight ? *figure->highlight == i : placements().size() <= kMostFingers;
}

double Plan::line_width(std::size_t i) const {
  const double width = std::clamp(0.4 * spacing, 0.6, 2.4);
  return figure->highlight == i ? 1.5 * width : width;
}

double Plan::offset(std::size_t i, const Run& run, double travelled) const {
  const double winding = goes_round(run, part().boundary()) ? travelled / part().perimeter() : 0;
  return kFirstLane + spacing * (lanes.of[i] * roll.lanes + run.lane + winding);
}

Plan arcs_plan_of(const AnswerFigure& figure) {
  Plan plan;
  plan.figure = &figure;
  plan.roll = roll_of(figure.answer->readings, figure.answer->part.boundary());
  plan.framing.width = width_of(figure);
  plan.framing.least_height = 0.3 * width_of(figure);
  plan.framing.most_height = 0.85 * width_of(figure);
  plan.framing.part = part_bounds(figure.answer->part);
  plan.framing.extras = fingers_of(plan);
  if (plan.has_arcs()) plan.lanes = lanes_of(plan);
  const int count = plan.lanes.count * plan.roll.lanes;
  plan.spacing = std::min(kLaneSpacing, kMostLanesWidth / std::max(count, 1));
  plan.framing.margin = kFirstLane + plan.spacing * count + kLabelRoom;
  return plan;
}

}  // namespace rollfix::draw
