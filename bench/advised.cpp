// How soon do advised rolls leave one place, and after how much travel? Beside it, rolling on and random rolls.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "belief_cases.hpp"
#include "logs.hpp"
#include "outlines.hpp"
#include "program.hpp"
#include "rollfix/advise.hpp"
#include "rollfix/error.hpp"
#include "rollfix/inspect.hpp"
#include "table.hpp"

namespace {

using namespace rollfix;
using belief_cases::distance;
using belief_cases::Robot;

constexpr std::size_t kCases = 49;
constexpr std::size_t kFewCases = 3;
constexpr double kFirstRoll = 0.05;    // of the perimeter
constexpr double kStep = 0.03;         // of whoever rolls on by small steps
constexpr double kRandomRoll = 0.25;   // the longest of whoever rolls at random, either way
constexpr double kRowsTogether = 10;   // as the program takes it of a log of 100 rows and more
constexpr std::size_t kCounted = 2;    // advised rolls
constexpr std::size_t kMostRolls = 8;  // advised ones; the other ways go on for ...
constexpr double kMostTravel = 3;      // ... so many laps

/// How to choose the next roll.
enum class Way { advised, steps, random };

/// How a loop of locating and rolling ends.
struct Loop {
  bool begins = false;    // the first roll is one that the finger can do
  bool resolved = false;  // one place, and what looks just like it
  bool wrong = false;     // ... which is not the true one
  std::size_t rolls = 0;  // after the first one
  double travel = 0;      // of these, as a share of the perimeter
};

/// A finger on a part, with what it knows of where it is.
struct Setting {
  const Part& part;
  const Reach& reach;
  const BeliefOptions& options;
};

std::size_t remaining(const std::vector<Mode>& modes) {
  return static_cast<std::size_t>(
      std::count_if(modes.begin(), modes.end(), [](const Mode& mode) { return mode.probability >= 0.01; }));
}

bool lists(const Part& part, const std::vector<Mode>& modes, double truth) {
  return std::any_of(modes.begin(), modes.end(), [&](const Mode& mode) {
    return mode.probability >= 0.01 && distance(part, mode.start[0], truth) < 5 * mode.sd[0] + 1e-6 * part.perimeter();
  });
}

bool is_resolved(const Setting& setting, Belief& belief) {
  const auto alike = static_cast<std::size_t>(std::max(1, symmetry(setting.part)));
  const std::vector<Mode>& modes = belief.modes();
  const Verdict verdict = belief.verdict();
  const bool is_stretch = verdict.stretches > 0 || verdict.name == Verdict::unobservable;
  return !is_stretch && !modes.empty() && (remaining(modes) <= alike || modes.front().probability >= 0.95);
}

/// The advised length; nothing where no roll helps.
std::optional<double> advised(const Setting& setting, Belief& belief) {
  const Noise& noise = setting.options.noise;
  AdviceOptions how;
  how.turn_sd = std::numbers::sqrt2 * noise.angle;
  how.length_sd = std::numbers::sqrt2 * noise.contact;
  how.rows = kRowsTogether;
  how.length_share_sd = noise.slip;
  how.reach = &setting.reach;
  if (belief.modes().empty()) return std::nullopt;
  const Advice advice = advise(setting.part, hypotheses_of(setting.part, belief.modes()), how);
  if (!advice.helps) return std::nullopt;
  return advice.advised().length;
}

/// The finger's way from one start. Whoever takes steps turns round where the part or the reach ends, whoever rolls at
/// random draws another length, and whoever is advised gives up: no such roll may be advised.
Loop close_loop(const Setting& setting, Way way, double start, double first_length, std::uint64_t seed) {
  const double P = setting.part.perimeter();
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> length_share(-kRandomRoll, kRandomRoll);
  Robot robot(setting.part, bench::log_radius(setting.part), start, setting.options.noise, random());
  Belief belief(setting.part, LogKind::contact, setting.options);
  Loop loop;
  try {
    robot.roll(first_length, belief);
  } catch (const InputError&) {
    return loop;
  }
  loop.begins = true;
  double step = std::copysign(kStep * P, first_length);
  while (!is_resolved(setting, belief)) {
    if (way == Way::advised ? loop.rolls == kMostRolls : loop.travel > kMostTravel) return loop;
    const std::optional<double> length = way == Way::advised ? advised(setting, belief)
                                         : way == Way::steps ? step
                                                             : length_share(random) * P;
    if (!length) return loop;
    try {
      robot.roll(*length, belief);
    } catch (const InputError&) {
      if (way == Way::advised) return loop;
      step = -step;
      continue;
    }
    loop.travel += std::abs(*length) / P;
    ++loop.rolls;
  }
  loop.resolved = true;
  loop.wrong = !lists(setting.part, belief.modes(), start);
  return loop;
}

/// What the loops on one outline add up to.
struct Tally {
  int cases = 0;
  int resolved[kCounted + 1] = {0, 0, 0};  // after so many advised rolls
  int later = 0;                           // after more of them
  int open = 0;
  int wrong = 0;
  int not_at_once = 0;
  double rolls = 0;              // of those that are not resolved at once
  double travel[3] = {0, 0, 0};  // of the same, by way

  void add(const Loop& loop) {
    ++cases;
    if (!loop.resolved) ++open;
    if (loop.resolved && loop.rolls <= kCounted) ++resolved[loop.rolls];
    if (loop.resolved && loop.rolls > kCounted) ++later;
    wrong += loop.wrong ? 1 : 0;
  }
  void add(const Tally& other) {
    cases += other.cases;
    for (std::size_t k = 0; k <= kCounted; ++k) resolved[k] += other.resolved[k];
    later += other.later;
    open += other.open;
    wrong += other.wrong;
    not_at_once += other.not_at_once;
    rolls += other.rolls;
    for (std::size_t k = 0; k < 3; ++k) travel[k] += other.travel[k];
  }
  std::string mean(double sum) const { return bench::cell(not_at_once > 0 ? sum / not_at_once : 0, 3); }
};

void add_case(const Setting& setting, double start, double first_length, std::uint64_t seed, Tally& tally) {
  const Loop loop = close_loop(setting, Way::advised, start, first_length, seed);
  if (!loop.begins) return;
  tally.add(loop);
  if (loop.resolved && loop.rolls == 0) return;
  ++tally.not_at_once;
  tally.rolls += static_cast<double>(loop.rolls);
  tally.travel[0] += loop.travel;
  tally.travel[1] += close_loop(setting, Way::steps, start, first_length, seed).travel;
  tally.travel[2] += close_loop(setting, Way::random, start, first_length, seed).travel;
}

Tally tally_on(const Part& part, int count) {
  const double P = part.perimeter();
  const Reach reach = reach_of_disk(part, bench::log_radius(part));
  BeliefOptions options;
  options.noise = {1e-4 * P, 2e-3, 2e-3, 0};
  std::mt19937_64 random(20010529);
  std::uniform_real_distribution<double> unit;
  Tally tally;
  while (tally.cases < count) {
    const double start = (part.closed() ? unit(random) : 0.1 + 0.8 * unit(random)) * P;
    const double first_length = (random() % 2 == 0 ? -1 : 1) * kFirstRoll * P;
    add_case({part, reach, options}, start, first_length, random(), tally);
  }
  return tally;
}

void add_row(const std::string& name, const Tally& tally, bench::Table& table) {
  table.add({name, std::to_string(tally.resolved[0]), std::to_string(tally.resolved[1]),
             std::to_string(tally.resolved[2]), std::to_string(tally.later), std::to_string(tally.open),
             std::to_string(tally.wrong), tally.mean(tally.rolls), tally.mean(tally.travel[0]),
             tally.mean(tally.travel[1]), tally.mean(tally.travel[2])});
}

}  // namespace

int main(int argc, char** argv) {
  const bench::Program program(argc, argv);
  bench::Table table({"outline", "at once", "after 1", "after 2", "more", "open", "wrong", "rolls", "advised [P]",
                      "steps [P]", "random [P]"});
  Tally all;
  for (const bench::Family& family : bench::families()) {
    const Part part(family.outline);
    if (symmetry(part) == 0) continue;  // no roll will tell: it looks the same from everywhere
    const Tally tally = tally_on(part, static_cast<int>(program.effort(kCases, kFewCases)));
    add_row(family.name, tally, table);
    all.add(tally);
  }
  add_row("all", all, table);
  table.print();
  fmt::print("one place, or those that look just like it, in {} of {} cases\n", all.cases - all.open - all.wrong,
             all.cases);
  program.write_figures();
}
