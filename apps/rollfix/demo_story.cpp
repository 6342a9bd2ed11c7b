#include "rollfix/demo_story.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "rollfix/contact/log.hpp"
#include "rollfix/contact/rolling.hpp"
#include "rollfix/draw/locate_figure.hpp"
#include "rollfix/draw/svg.hpp"
#include "rollfix/drop.hpp"
#include "rollfix/error.hpp"
#include "rollfix/locate_outcome.hpp"
#include "rollfix/observation.hpp"
#include "rollfix/typed_number.hpp"

namespace rollfix::app {
namespace {

std::string log_name(const DemoStory& story) { return story.stem + "-roll.csv"; }

Roll roll_along(const DemoStory& story, const Part& part) {
  RollPlan plan;
  plan.start = read_number(story.start, "start");
  plan.distance = read_number(story.whole_length, "length");
  plan.psi = part.tangent(plan.start) + std::numbers::pi / 2;
  plan.rows = kDemoRows;
  return roll(part, story.finger, plan);
}

/// The time of the row nearest to b, as somebody would type it.
std::string instant_of_b(const DemoStory& story, const Roll& roll) {
  const auto distance_from_b = [&](double s) { return std::abs(std::abs(s - roll.s.front()) - story.first_length); };
  const auto nearest = std::min_element(roll.s.begin(), roll.s.end(), [&](double one, double two) {
    return distance_from_b(one) < distance_from_b(two);
  });
  return fmt::format("{:.2f}", roll.log.time[static_cast<std::size_t>(nearest - roll.s.begin())]);
}

LocateOutcome locate_at(const DemoStory& story, const Part& part, const Log& log, const std::string& instants) {
  const Observation observation = observe_log(log, part, story.finger, read_instants(instants));
  LocateOutcome outcome{
      part, observation.readings, observation.instants, tolerance_from_rounding(part, observation.roundings), {},
      {},   observation.times};
  LocateOptions options;
  options.tolerance = outcome.tolerance.value;
  outcome.found = locate(part, outcome.readings, options);
  drop(Finger(story.finger), observation, outcome);
  for (const Placement& placement : outcome.found.placements) {
    outcome.poses.push_back(poses(part, story.finger, log, placement.start, observation.rows));
  }
  return outcome;
}

/// The placement that holds the true start, if one does.
std::optional<std::size_t> true_placement(const LocateOutcome& outcome, double start) {
  const std::vector<Placement>& placements = outcome.found.placements;
  const auto distance = [&](const Placement& placement) {
    return periodic_distance(placement.start, start, outcome.part.perimeter());
  };
  const auto nearest = std::min_element(placements.begin(), placements.end(), [&](const auto& one, const auto& two) {
    return distance(one) < distance(two);
  });
  constexpr double kSamePlace = 1e-6;  // of the perimeter
  if (nearest == placements.end() || distance(*nearest) > kSamePlace * outcome.part.perimeter()) return std::nullopt;
  return static_cast<std::size_t>(nearest - placements.begin());
}

LocateFigure figure_of(const DemoStory& story, const LocateOutcome& outcome, double start) {
  LocateFigure figure;
  figure.part = &outcome.part;
  figure.readings = outcome.readings;
  figure.found = outcome.found;
  figure.finger_radius = story.finger.radius;
  figure.highlight = true_placement(outcome, start);
  return figure;
}

Svg draw(const DemoStory& story, const LocateOutcome& at_b, const LocateOutcome& at_c, double start) {
  LocateFigure before = figure_of(story, at_b, start);
  before.title = fmt::format("{}: rolled to b", story.title);
  LocateFigure after = figure_of(story, at_c, start);
  after.title = "rolled on to c";
  after.numbers = numbers_of(at_c.found, at_b.found, at_b.part);
  return side_by_side({before, after});
}

/// The simulation knows the answer: the demo checks itself.
std::string ending(const DemoStory& story, const LocateOutcome& at_b, const LocateOutcome& at_c, double start) {
  const std::optional<std::size_t> truth = true_placement(at_b, start);
  if (!truth || at_c.found.placements.size() != 1 || !true_placement(at_c, start)) {
    throw InternalError(fmt::format("the demo's finger started at s = {}, which is not what was found", start));
  }
  return fmt::format("The one that is left is a{} of the roll to b. The simulated finger did start there, at s = {}.\n",
                     *truth, story.start);
}

std::string tell(const DemoStory& story, const LocateOutcome& at_b, const LocateOutcome& at_c, const std::string& b,
                 const std::string& c, double start) {
  const std::string part_and_finger = fmt::format("{} --finger disk,r={}", story.argument, story.finger.radius);
  const auto located = [&](const std::string& instants, const LocateOutcome& outcome) {
    return fmt::format("  rollfix locate {} --log {} --at {}\n{}\n", part_and_finger, log_name(story), instants,
                       locate_text(outcome));
  };
  return fmt::format("{}\n{}\n\n", story.title, std::string(story.title.size(), '-')) +
         fmt::format("  rollfix simulate {} --start {} --length {} --samples {} -o {}\n\n", part_and_finger,
                     story.start, story.whole_length, kDemoRows, log_name(story)) +
         located(b, at_b) + located(b + "," + c, at_c) + ending(story, at_b, at_c, start);
}

}  // namespace

std::vector<std::string> file_names(const DemoStory& story) {
  return {log_name(story), story.stem + ".svg", story.stem + ".png"};
}

DemoAct perform(const DemoStory& story, const Part& part) {
  const Roll roll = roll_along(story, part);
  const std::string log_text = format_log(roll.log);
  const Log log = parse_log(log_text, log_name(story));
  const std::string b = instant_of_b(story, roll);
  const std::string c = fmt::format("{:.2f}", roll.log.time.back());
  const LocateOutcome at_b = locate_at(story, part, log, b);
  const LocateOutcome at_c = locate_at(story, part, log, b + "," + c);

  const double start = roll.s.front();
  const Svg figure = draw(story, at_b, at_c, start);
  const std::vector<std::string> names = file_names(story);
  return {tell(story, at_b, at_c, b, c, start),
          {{names[0], log_text},
           {names[1], encode(figure, FigureFormat::svg)},
           {names[2], encode(figure, FigureFormat::png)}}};
}

}  // namespace rollfix::app
