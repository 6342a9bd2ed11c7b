#include "draw/answer/answer_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "rollfix/error.hpp"
#include "rollfix/log.hpp"

namespace rollfix::draw {
namespace {

constexpr std::size_t kMostFingers = 2;  // placements with a finger each when none is highlighted
constexpr std::size_t kMostNamed = 3;    // readings of which each has a named contact
constexpr std::size_t kMostLines = 4;    // equations of two fingers that are drawn
constexpr double kMostLanesWidth = 64;   // of all lanes of one finger together, pixels
constexpr std::array<std::string_view, kMostLines> kLineColours = {kPalette[2], kPalette[10], kPalette[5], kPalette[4]};

void require_valid(const AnswerFigure& figure) {
  if (figure.answer == nullptr) throw InputError("a figure needs an answer, found none: set AnswerFigure::answer");
  const std::size_t count = figure.answer->placements.size();
  if (figure.highlight && *figure.highlight >= count) {
    throw InputError(fmt::format("a figure's highlight must be the index of one of its {} placements, found {}", count,
                                 *figure.highlight));
  }
  if (!figure.numbers.empty() && figure.numbers.size() != count) {
    throw InputError(
        fmt::format("a figure needs a number for each of its {} placements, found {}", count, figure.numbers.size()));
  }
}

std::vector<Way> ways_of(const AnswerPlan& plan) {
  if (plan.has_pairs()) return plan.shown ? std::vector<Way>{{*plan.shown, 0}, {*plan.shown, 1}} : std::vector<Way>{};
  std::vector<Way> ways;
  for (std::size_t i = 0; i < plan.placements().size(); ++i) ways.push_back({i, 0});
  return ways;
}

/// The fingers that are drawn, as far as they are not too far off.
Box fingers_of(AnswerPlan& plan) {
  Box box;
  for (const Way& way : plan.ways) {
    if (!plan.has_finger(way)) continue;
    for (const double s : {plan.start(way), plan.placement(way).end[way.finger]}) {
      const bool is_whole = include_finger(box, plan.framing.part, plan.part(), s, *plan.radius(way.finger));
      plan.cuts_finger = plan.cuts_finger || !is_whole;
    }
  }
  return box;
}

Lanes lanes_of(const AnswerPlan& plan) {
  std::vector<Interval> stretches;
  for (const Way& way : plan.ways) {
    const Interval& hull = plan.roll(way).hull;
    stretches.push_back({plan.start(way) + hull.lo, plan.start(way) + hull.hi});
  }
  // The scale is not known yet; the part's size over the drawing's width is near enough.
  const double gap = kEndGap * plan.framing.part.sizes().maxCoeff() / plan.framing.width;
  return assign_lanes(stretches, plan.part().boundary(), gap);
}

void read_along_outline(AnswerPlan& plan) {
  plan.readings = plan.figure->answer->readings;
  plan.facing = plan.figure->answer->facing;
  if (!plan.figure->answer->mirrored) return;
  for (Reading& reading : plan.readings) {
    for (double& length : reading.length) length = -length;
    reading.turn = -reading.turn;
  }
  if (plan.facing) plan.facing = -*plan.facing;
}

int lanes_each(const AnswerPlan& plan) { return std::max(plan.rolls[0].lanes, plan.rolls[1].lanes); }

std::vector<PairLine> lines_of(const Answer& answer) {
  std::vector<PairLine> lines;
  const auto add = [&](std::optional<std::size_t> reading, const std::string& index) {
    if (lines.size() == kMostLines) return;
    const std::string dash = lines.empty() ? "" : "7 2";  // seen where lines coincide, and without colours
    lines.push_back({reading, kLineColours[lines.size()], dash, symbol("f", index)});
  };
  if (answer.facing) add({}, "0");
  for (std::size_t k = 0; k < answer.readings.size(); ++k) {
    if (answer.readings[k].is_exact()) add(k, std::to_string(k + 1));
  }
  return lines;
}

bool has_places(const Log& log) {
  return log.kind == LogKind::contact && log.rows() > 0 &&
         std::all_of(log.fingers.begin(), log.fingers.end(),
                     [](const FingerRows& rows) { return !rows.x.empty() && !rows.y.empty() && !rows.psi.empty(); });
}

}  // namespace

std::size_t AnswerPlan::world_placement() const {
  if (shown) return *shown;
  return figure->highlight.value_or(0);
}

bool AnswerPlan::has_world() const {
  if (figure->log == nullptr || placements().empty() || figure->answer->fingers.empty()) return false;
  return has_places(*figure->log) && !placements()[world_placement()].pose.empty();
}

bool AnswerPlan::has_arcs() const { return has_pairs() || placements().size() <= most.arcs; }
bool AnswerPlan::has_labels() const { return placements().size() <= most.labels; }

bool AnswerPlan::has_list() const { return has_pairs() || ways.size() <= most.listed; }

bool AnswerPlan::is_anywhere(std::size_t placement, std::size_t finger) const {
  return draw::is_anywhere(placements()[placement].interval[finger], part().boundary());
}

Interval AnswerPlan::held(std::size_t placement, std::size_t finger) const {
  return is_anywhere(placement, finger) ? part().boundary().full_arc() : placements()[placement].interval[finger];
}

double AnswerPlan::strength(std::size_t placement) const {
  double likeliest = 0;
  for (const Placement& each : placements()) likeliest = std::max(likeliest, each.probability);
  return likeliest > 0 ? placements()[placement].probability / likeliest : 1;
}

std::string AnswerPlan::key() const {
  std::vector<std::string> parts;
  if (!has_arcs()) parts.emplace_back("rolls");
  if (!has_labels()) parts.emplace_back("labels");
  if (!has_list()) parts.emplace_back("list");
  std::vector<std::string> texts;
  if (has_noise() && !placements().empty()) texts.emplace_back("area: density of the first contact; band: 95 %");
  if (!parts.empty()) {
    texts.push_back(fmt::format("{} placements: no {}", placements().size(), fmt::join(parts, ", no ")));
  }
  if (part().corners().size() > kMostCorners) {
    texts.push_back(fmt::format("{} corners: no marks", part().corners().size()));
  }
  if (cuts_finger) texts.emplace_back("a finger is too large to be drawn whole");
  return fmt::format("{}", fmt::join(texts, "; "));
}

bool AnswerPlan::has_finger(const Way& way) const {
  if (!radius(way.finger)) return false;
  if (has_pairs()) return true;
  return figure->highlight ? *figure->highlight == way.placement : placements().size() <= kMostFingers;
}

bool AnswerPlan::is_named(std::size_t k) const {
  const std::size_t last = figure->answer->readings.size();
  return last <= kMostNamed || k == 0 || k == last;
}

std::size_t AnswerPlan::number(std::size_t placement) const {
  return figure->numbers.empty() ? placement : figure->numbers[placement];
}

std::string_view AnswerPlan::colour_of(const Way& way) const {
  return has_pairs() ? kFingerColours[way.finger] : colour(number(way.placement));
}

double AnswerPlan::line_width(const Way& way) const {
  const double width = std::clamp(0.4 * spacing, 0.6, 2.4);
  return !has_pairs() && figure->highlight == way.placement ? 1.5 * width : width;
}

double AnswerPlan::width() const { return figure->width > 0 ? figure->width : has_pairs() || has_world() ? 960 : 640; }

std::optional<double> AnswerPlan::radius(std::size_t finger) const {
  const std::vector<Finger>& fingers = figure->answer->fingers;
  if (fingers.empty()) return std::nullopt;
  const Finger& own = finger == 0 ? fingers.front() : fingers.back();
  return own.is_disk() ? std::optional(own.disk()->radius) : std::nullopt;
}

double AnswerPlan::place(const Way& way, std::size_t k) const {
  const bool is_last = k > 0 && k == roll(way).contacts.size();
  // Of two fingers the arcs' ends are marked: with noise the estimated contacts are a little beside them.
  return is_last && !has_pairs() ? placement(way).end[way.finger] : start(way) + travelled(way, k);
}

double AnswerPlan::offset(std::size_t way, const Run& run, double travelled) const {
  const double winding = goes_round(run, part().boundary()) ? travelled / part().perimeter() : 0;
  return kFirstLane + spacing * (lanes.of[way] * lanes_each(*this) + run.lane + winding);
}

AnswerPlan plan_of(const AnswerFigure& figure) {
  require_valid(figure);
  AnswerPlan plan;
  plan.figure = &figure;
  const bool pairs = plan.has_pairs();
  if (pairs) {
    plan.label_size = 13.5;
    plan.shown = figure.highlight;
    if (!plan.shown && !plan.placements().empty()) plan.shown = 0;
    plan.lines = lines_of(*figure.answer);
  }
  read_along_outline(plan);
  for (std::size_t finger = 0; finger < figure.answer->finger_count(); ++finger) {
    plan.rolls[finger] = roll_of(plan.readings, plan.part().boundary(), finger);
  }
  if (figure.answer->either_way && !pairs) {
    std::vector<Reading> readings = plan.readings;
    for (Reading& reading : readings) reading.length[0] = -reading.length[0];
    plan.clockwise_roll = roll_of(readings, plan.part().boundary());
  }
  plan.ways = ways_of(plan);
  const double width = plan.width();
  plan.framing.width = width - (pairs ? plane_width(width) : world_width(plan));
  plan.framing.least_height = pairs ? plane_height(width) : (plan.has_world() ? 0.4 : 0.3) * width;
  const double most = pairs ? 0.7 * width : 0.85 * plan.framing.width;
  plan.framing.most_height = std::max(most, plan.framing.least_height);
  plan.framing.part = part_bounds(plan.part());
  plan.framing.extras = fingers_of(plan);
  plan.framing.extras.extend(bounds_of(figure.others, plan.framing.part));
  if (plan.has_arcs()) plan.lanes = lanes_of(plan);
  const int count = plan.lanes.count * lanes_each(plan);
  if (!pairs) plan.spacing = std::min(kLaneSpacing, kMostLanesWidth / std::max(count, 1));
  const double label_room = pairs ? 26 : 24;  // beyond the last lane, pixels
  plan.framing.margin = kFirstLane + plan.spacing * count + label_room;
  return plan;
}

}  // namespace rollfix::draw
