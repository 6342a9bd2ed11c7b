#include "rollfix/demo_pair_story.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>

#include "rollfix/contact/free_part.hpp"
#include "rollfix/contact/pair_log.hpp"
#include "rollfix/draw/pair_figure.hpp"
#include "rollfix/draw/svg.hpp"
#include "rollfix/drop.hpp"
#include "rollfix/error.hpp"
#include "rollfix/observation.hpp"
#include "rollfix/pair_outcome.hpp"
#include "rollfix/typed_number.hpp"

namespace rollfix::app {
namespace {

constexpr double kSamePairPlace = 1e-4;  // of the perimeter: what is left of it in readings with six decimals

FingerPair fingers_of(const DemoPairStory& story) { return {story.finger, story.finger}; }

PairOutcome search(const Part& part, const PairObservation& observation) {
  PairOutcome outcome{part, observation.readings, observation.instants, observation.facing, {}, {},
                      {},   observation.times};
  outcome.tolerance = tolerance_from_rounding(part, observation.roundings);
  PairOptions options;
  options.tolerance = outcome.tolerance.value;
  options.facing = observation.facing;
  outcome.found = locate(part, outcome.readings, options);
  return outcome;
}

PairOutcome locate_by(const std::vector<std::string>& readings, const Part& part) {
  return search(part, observe_pair_readings(readings, ""));
}

PairOutcome locate_by(const PairLog& log, const DemoPairStory& story, const Part& part) {
  const FingerPair fingers = fingers_of(story);
  const PairObservation observation = observe_pair_log(log, part, fingers, {});
  PairOutcome outcome = search(part, observation);
  drop(fingers, observation, outcome);
  for (const PairPlacement& placement : outcome.found.placements) {
    outcome.poses.push_back(poses(part, fingers, log, placement.start, observation.rows));
  }
  return outcome;
}

PairPoint true_starts(const DemoPairStory& story) {
  return {read_number(story.starts[0], "start"), read_number(story.starts[1], "start")};
}

PairLog roll_both(const DemoPairStory& story, const Part& part) {
  const PairPoint starts = true_starts(story);
  const auto finger = [&](std::size_t which) {
    FreeFinger free;
    free.disk = story.finger;
    free.start = starts[which];
    free.distance = read_number(story.lengths[which], "length");
    free.psi = part.tangent(free.start) + std::numbers::pi / 2;
    return free;
  };
  FreePlan plan;
  plan.a = finger(0);
  plan.b = finger(1);
  plan.part_rotation = read_angle(story.part_rotation, "part rotation");
  plan.rows = kDemoRows;
  return roll_free(part, plan).log;
}

/// The simulation knows the answer: the demo checks itself.
void require_true(const DemoPairStory& story, const PairOutcome& outcome) {
  const PairPoint truth = true_starts(story);
  const double period = outcome.part.perimeter();
  const auto is_true = [&](const PairPlacement& placement) {
    return periodic_distance(placement.start[0], truth[0], period) < kSamePairPlace * period &&
           periodic_distance(placement.start[1], truth[1], period) < kSamePairPlace * period;
  };
  const std::vector<PairPlacement>& placements = outcome.found.placements;
  if (placements.size() == 1 && is_true(placements.front())) return;
  throw InternalError(fmt::format("the demo's fingers started at s = {} and t = {}, which is not what was found",
                                  story.starts[0], story.starts[1]));
}

std::string repeated(const char* option, const std::vector<std::string>& values) {
  std::string text;
  for (const std::string& value : values) text += fmt::format(" {} {}", option, value);
  return text;
}

std::string tell(const DemoPairStory& story, const PairOutcome& by_two, const PairOutcome& by_three,
                 const PairOutcome& by_log) {
  const std::vector<std::string> names = file_names(story);
  const std::string& log = names.front();
  const std::string part_and_finger = fmt::format("{} --finger disk,r={}", story.argument, story.finger.radius);
  // The paper's readings know nothing of the fingers' size: without it all of its pairs are there.
  const auto located = [&](const std::string& how, const PairOutcome& outcome) {
    return fmt::format("  rollfix locate {}\n{}\n", how, pair_text(outcome));
  };
  const std::vector<std::string> first_two(story.readings.begin(), story.readings.begin() + 2);
  return fmt::format("{}\n{}\n\n", story.title, std::string(story.title.size(), '-')) +
         located(fmt::format("{}{} -o {}", story.argument, repeated("--reading", first_two), names[1]), by_two) +
         located(fmt::format("{}{} -o {}", story.argument, repeated("--reading", story.readings), names[3]), by_three) +
         fmt::format("  rollfix simulate {}{}{} --part-rotation {} --samples {} -o {}\n\n", part_and_finger,
                     repeated("--start", story.starts), repeated("--length", story.lengths), story.part_rotation,
                     kDemoRows, log) +
         located(fmt::format("{} --log {}", part_and_finger, log), by_log) +
         fmt::format("A log also says how the fingers face each other. The simulated ones did start at {} and {}.\n",
                     story.starts[0], story.starts[1]);
}

}  // namespace

std::vector<std::string> file_names(const DemoPairStory& story) {
  return {story.stem + "-rolls.csv", story.stem + ".svg", story.stem + ".png", story.stem + "-rolled-on.svg",
          story.stem + "-rolled-on.png"};
}

DemoAct perform(const DemoPairStory& story, const Part& part) {
  const PairOutcome by_two = locate_by({story.readings.begin(), story.readings.begin() + 2}, part);
  const PairOutcome by_three = locate_by(story.readings, part);
  const std::vector<std::string> names = file_names(story);
  const std::string log_text = format_pair_log(roll_both(story, part));
  const PairOutcome by_log = locate_by(parse_pair_log(log_text, names[0]), story, part);
  require_true(story, by_three);
  require_true(story, by_log);

  const Svg before = draw_pairs(figure_of(by_two, std::nullopt));
  const Svg after = draw_pairs(figure_of(by_three, std::nullopt));
  return {tell(story, by_two, by_three, by_log),
          {{names[0], log_text},
           {names[1], encode(before, FigureFormat::svg)},
           {names[2], encode(before, FigureFormat::png)},
           {names[3], encode(after, FigureFormat::svg)},
           {names[4], encode(after, FigureFormat::png)}}};
}

}  // namespace rollfix::app
