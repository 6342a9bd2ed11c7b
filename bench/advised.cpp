// How often do two advised rolls leave one place?

#include <fmt/format.h>

#include <cmath>

#include <random>
#include <string>
#include <vector>

#include "belief_cases.hpp"
#include "logs.hpp"
#include "outlines.hpp"
#include "program.hpp"
#include "rollfix/answer/part_facts.hpp"
#include "rollfix/belief/advise.hpp"
#include "rollfix/error.hpp"
#include "table.hpp"

namespace {

using namespace rollfix;
using belief_cases::distance;
using belief_cases::Robot;

constexpr std::size_t kCases = 49;
constexpr std::size_t kFewCases = 3;
constexpr double kFirstRoll = 0.05;  // of the perimeter

/// How a loop of locating and advised rolls ends.
struct Loop {
  int cases = 0;
  int resolved[3] = {0, 0, 0};  // after so many advised rolls: one place, and what looks just like it
  int open = 0;
  int wrong = 0;
  double rolled = 0;  // of all advised rolls, as a share of the perimeter
  int rolls = 0;
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

/// The finger's way from one start; false where it does not get along on the first roll.
bool close_loop(const Part& part, const Reach& reach, const BeliefOptions& options, double start,
                std::mt19937_64& random, Loop& loop) {
  const double P = part.perimeter();
  const auto alike = static_cast<std::size_t>(std::max(1, symmetry(part)));
  double length = (random() % 2 == 0 ? -1 : 1) * kFirstRoll * P;
  Robot robot(part, bench::log_radius(part), start, options.noise, random());
  Belief belief(part, LogKind::contact, options);
  for (int rolls = 0;; ++rolls) {
    try {
      robot.roll(length, belief);
    } catch (const InputError&) {
      loop.open += rolls > 0 ? 1 : 0;
      return rolls > 0;
    }
    const std::vector<Mode>& modes = belief.modes();
    const Verdict verdict = belief.verdict();
    const bool is_stretch = verdict.stretches > 0 || verdict.name == Verdict::unobservable;
    if (!is_stretch && !modes.empty() && (remaining(modes) <= alike || modes.front().probability >= 0.95)) {
      ++loop.resolved[rolls];
      loop.wrong += lists(part, modes, start) ? 0 : 1;
      return true;
    }
    AdviceOptions how;
    how.turn_sd = 2 * options.noise.angle;
    how.length_sd = 1.5 * options.noise.contact;
    how.length_share_sd = options.noise.slip;
    how.reach = &reach;
    if (rolls == 2 || modes.empty()) break;
    const Advice advice = advise(part, contenders_of(part, modes), how);
    if (!advice.helps) break;
    length = advice.advised().length;
    loop.rolled += std::abs(length) / P;
    ++loop.rolls;
  }
  ++loop.open;
  return true;
}

Loop loop_on(const Part& part, int count) {
  const double P = part.perimeter();
  const Reach reach = reach_of_disk(part, bench::log_radius(part));
  BeliefOptions options;
  options.noise = {1e-4 * P, 2e-3, 2e-3, 0};
  std::mt19937_64 random(20010529);
  std::uniform_real_distribution<double> unit;
  Loop loop;
  while (loop.cases < count) {
    const double start = (part.closed() ? unit(random) : 0.1 + 0.8 * unit(random)) * P;
    if (close_loop(part, reach, options, start, random, loop)) ++loop.cases;
  }
  return loop;
}

}  // namespace

int main(int argc, char** argv) {
  const bench::Program program(argc, argv);
  bench::Table table({"outline", "at once", "after 1", "after 2", "open", "wrong", "mean advised roll [P]"});
  int cases = 0;
  int resolved = 0;
  for (const bench::Family& family : bench::families()) {
    const Part part(family.outline);
    if (symmetry(part) == 0) continue;  // no roll will tell: it looks the same from everywhere
    const Loop loop = loop_on(part, static_cast<int>(program.effort(kCases, kFewCases)));
    table.add({family.name, std::to_string(loop.resolved[0]), std::to_string(loop.resolved[1]),
               std::to_string(loop.resolved[2]), std::to_string(loop.open), std::to_string(loop.wrong),
               bench::cell(loop.rolls > 0 ? loop.rolled / loop.rolls : 0, 3)});
    cases += loop.cases;
    resolved += loop.cases - loop.open - loop.wrong;
  }
  table.print();
  fmt::print("one place, or those that look just like it, in {} of {} cases\n", resolved, cases);
  program.write_figures();
}
