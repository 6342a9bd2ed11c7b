#include "pair_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "legend.hpp"
#include "plot.hpp"
#include "roll_pen.hpp"
#include "rollfix/error.hpp"
#include "rolls.hpp"

namespace rollfix::draw {
namespace {

constexpr std::size_t kMostNumbers = 20;  // placements with numbers
constexpr std::size_t kMostNamed = 4;     // contacts of which each has its own name
constexpr std::size_t kMostLines = 4;     // equations that are drawn
constexpr double kPairLabelRoom = 26;     // beyond the last lane
constexpr double kPlaneShare = 0.4;       // of the width
constexpr double kPlaneLeft = 64;         // room for the numbers and the name of the axis
constexpr double kPlaneAbove = 24;
constexpr double kPlaneBelow = 42;
constexpr double kPlaneRight = 16;
constexpr std::array<std::string_view, kMostLines> kLineColours = {kPalette[2], kPalette[10], kPalette[5], kPalette[4]};

std::vector<Reading> readings_of(const AnswerFigure& figure, std::size_t finger) {
  std::vector<Reading> readings;
  for (const Reading& reading : figure.answer->readings) {
    readings.push_back({finger == 0 ? reading.length[0] : reading.length[1], reading.turn});
  }
  return readings;
}

std::vector<PairLine> lines_of(const AnswerFigure& figure) {
  std::vector<PairLine> lines;
  const auto add = [&](std::optional<std::size_t> reading, const std::string& index) {
    if (lines.size() == kMostLines) return;
    const std::string dash = lines.empty() ? "" : "7 2";  // seen where lines coincide, and without colours
    lines.push_back(
        {reading, kLineColours[lines.size()], dash, {{"f", true, false, false}, {index, false, false, true}}});
  };
  if (figure.answer->facing) add({}, "0");
  for (std::size_t k = 0; k < figure.answer->readings.size(); ++k) add(k, std::to_string(k + 1));
  return lines;
}

Lanes lanes_of(const PairPlan& plan, double part_size) {
  std::vector<Interval> stretches;
  const PerFinger<double>& start = plan.placements()[*plan.shown].start;
  for (std::size_t finger = 0; finger < 2; ++finger) {
    const Interval& hull = plan.rolls[finger].hull;
    stretches.push_back({start[finger] + hull.lo, start[finger] + hull.hi});
  }
  // The scale is not known yet; the part's size over the drawing's width is near enough.
  const double gap = kEndGap * part_size / plan.framing.width;
  return assign_lanes(stretches, plan.part().boundary(), gap);
}

int lanes_each(const PairPlan& plan) { return std::max(plan.rolls[0].lanes, plan.rolls[1].lanes); }

Text finger_text(const PairPlan& plan, std::size_t finger) {
  Text text{{finger == 0 ? "finger a" : "finger b"}};
  if (!plan.shown) return text;
  const std::vector<double>& contacts = plan.rolls[finger].contacts;
  const double start = plan.placements()[*plan.shown].start[finger];
  for (std::size_t k = 0; k <= contacts.size(); ++k) {
    if (!plan.is_named(k)) continue;
    const double s = k == 0 ? start : start + contacts[k - 1];
    text.push_back({k == 0 ? ": " : ", "});
    append(text, pair_contact(finger, k));
    text.push_back({" = " + pretty(plan.part().boundary().base(s))});
  }
  return text;
}

Text line_text(const PairPlan& plan, const PairLine& line) {
  Text text = line.name;
  text.push_back({" = 0: "});
  if (!line.reading) {
    text.push_back({"facing " + pretty_degrees(*plan.figure->answer->facing)});
    return text;
  }
  const Reading& reading = plan.figure->answer->readings[*line.reading];
  text.push_back({"L", true, false, false});
  text.push_back({"a", false, false, true});
  text.push_back({" = " + pretty(reading.length[0]) + ", "});
  text.push_back({"L", true, false, false});
  text.push_back({"b", false, false, true});
  text.push_back({" = " + pretty(reading.length[1]) + ", "});
  text.push_back({"\u03b8", true, false, false});
  text.push_back({" = " + pretty_degrees(std::abs(reading.turn) < kTurnAccuracy ? 0 : reading.turn)});
  return text;
}

}  // namespace

bool PairPlan::has_numbers() const { return placements().size() <= kMostNumbers; }

double PairPlan::offset(std::size_t finger, const Run& run, double travelled) const {
  const double winding = goes_round(run, part().boundary()) ? travelled / part().perimeter() : 0;
  return kFirstLane + kLaneSpacing * (lanes.of[finger] * lanes_each(*this) + run.lane + winding);
}

bool PairPlan::is_named(std::size_t k) const {
  const std::size_t count = figure->answer->readings.size() + 1;
  return count <= kMostNamed || k == 0 || k + 1 == count;
}

PairPlan pair_plan_of(const AnswerFigure& figure) {
  PairPlan plan;
  plan.figure = &figure;
  plan.shown = figure.highlight;
  if (!plan.shown && !figure.answer->placements.empty()) plan.shown = 0;
  const double side = kPlaneShare * width_of(figure);
  plan.framing.width = width_of(figure) - side - kPlaneLeft - kPlaneRight;
  plan.framing.least_height = side + kPlaneAbove + kPlaneBelow;
  plan.framing.most_height = std::max(0.7 * width_of(figure), plan.framing.least_height);
  plan.framing.part = part_bounds(figure.answer->part);
  for (std::size_t finger = 0; finger < 2; ++finger) {
    plan.rolls[finger] = roll_of(readings_of(figure, finger), plan.part().boundary());
    if (!plan.shown || !radius_of(figure, finger)) continue;
    const Placement& placement = plan.placements()[*plan.shown];
    for (const double s : {placement.start[finger], placement.end[finger]}) {
      include_finger(plan.framing.extras, plan.framing.part, plan.part(), s, *radius_of(figure, finger));
    }
  }
  if (plan.shown) plan.lanes = lanes_of(plan, plan.framing.part.sizes().maxCoeff());
  plan.framing.margin = kFirstLane + kLaneSpacing * plan.lanes.count * lanes_each(plan) + kPairLabelRoom;
  const double spare = drawing_height(plan.framing) - plan.framing.least_height;
  plan.plane.corner = Vec2(plan.framing.width + kPlaneLeft, kHeaderHeight + kPlaneAbove + 0.5 * spare);
  plan.plane.size = Vec2(side, side);
  plan.plane.x = plan.plane.y = {0, plan.part().perimeter()};
  plan.lines = lines_of(figure);
  return plan;
}

Text pair_contact(std::size_t finger, std::size_t k) {
  return {{finger == 0 ? "s" : "t", true, false, false}, {std::to_string(k), false, false, true}};
}

Legend pair_legend(const PairPlan& plan) {
  std::vector<LegendEntry> entries;
  for (std::size_t finger = 0; finger < 2; ++finger) {
    entries.push_back({Sign::line, kFingerColours[finger], finger_text(plan, finger)});
  }
  for (const PairLine& line : plan.lines) entries.push_back({Sign::line, line.colour, line_text(plan, line)});
  return {std::move(entries), width_of(*plan.figure)};
}

}  // namespace rollfix::draw
