#include "rollfix/advise.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <list>
#include <memory>
#include <utility>

#include "advise/comparison.hpp"
#include "rollfix/error.hpp"

// Notation, as in docs/belief.md, "The next roll":
//   hypothesis i     the place p_i where the contact may be, of two fingers the pair of places
//   way             how far each finger rolls while the roll's length x grows: one finger has one, two have eight
//   told            after which travel j is told from i, if i is the true one
// Each way is looked at as if the fingers could only go on or back on it; what another way tells and this one does not
// is added as travel there. One way at a time is less than all that two fingers can do: a later roll may take another.
namespace rollfix {

namespace {

using advising::Comparison;
using advising::Way;
using advising::WayToTell;

// Lengths that are looked at, forward and back, and on each of two fingers' ways.
constexpr std::size_t kSteps = 400;
constexpr std::size_t kStepsOfTwo = 200;
// Of two fingers, so many hypotheses are compared, the likeliest: the time grows with their square.
constexpr std::size_t kMostPairs = 200;
// A roll counts as this much travel more, a share of the perimeter: to stop, to locate and to start again is not free.
constexpr double kOneRoll = 0.01;
// It leaves open at most this share of the probability that some roll can settle: the travel that is expected of a
// shorter one is too good, as it takes the finger to know when to turn round.
constexpr double kMostOpen = 0.9;
// Where no roll tells any two places apart, the advised roll gains at least this share of what the best one does ...
constexpr double kNearlyAll = 0.98;
// ... and leaves no more than this many placements more.
constexpr double kNearlyAsFew = 0.02;
// A way is looked at only so much less far than the roll on it that the robot can't do, and no more than so often.
constexpr double kShorter = 0.7;
constexpr std::size_t kMostCuts = 24;
// A roll that gains less than this share of the bits wanted is no help.
constexpr double kHelp = 0.05;

/// Throws InputError for no places, places of one finger and of two together, and options out of range.
void require_valid(const std::vector<PartHypothesis>& hypotheses, const AdviceOptions& options) {
  if (hypotheses.empty()) throw InputError("advise: expected at least one place where the contact may be, found none");
  for (const PartHypothesis& one : hypotheses) {
    if (one.hypothesis.place.size() == hypotheses.front().hypothesis.place.size()) continue;
    throw InputError("advise: expected places of one finger, or pairs of places of two, found both");
  }
  if (!(options.turn_sd > 0)) {
    throw InputError(fmt::format("advise: the turn's standard deviation is {}, expected one above 0", options.turn_sd));
  }
  if (!(options.rows > 0)) {
    throw InputError(
        fmt::format("advise: {} rows are read at about the same place, expected more than 0", options.rows));
  }
  if (options.travel && !(options.travel->lo <= 0 && options.travel->hi >= 0)) {
    throw InputError(fmt::format("advise: the travel goes from {} to {}, expected it to hold 0: where the finger is",
                                 options.travel->lo, options.travel->hi));
  }
}

/// Fewer placements remain; of equally many the one with more bits.
bool is_better(const ExpectedGain& one, const ExpectedGain& other) {
  if (one.placements != other.placements) return one.placements < other.placements;
  return one.bits > other.bits;
}

/// A way with all that is to be expected on it.
struct Trial {
  Trial(const std::vector<PartHypothesis>& hypotheses, const AdviceOptions& options, const Way& on)
      : way(on), back(hypotheses, options, on.direction), forward(hypotheses, options, on.direction) {
    const std::size_t steps = on.direction.size() == 1 ? kSteps : kStepsOfTwo;
    const auto part_of = [&](double whole, std::size_t k) {
      return whole * static_cast<double>(k) / static_cast<double>(steps);
    };
    // Back and forward each from 0 outwards, as Comparison asks; the gains are then put in order of length.
    for (std::size_t k = 1; k <= steps && way.travel.lo < 0; ++k) {
      gains.push_back(back.roll_to(part_of(way.travel.lo, k)));
    }
    std::reverse(gains.begin(), gains.end());
    here = gains.size();
    for (std::size_t k = 0; k <= steps && (k == 0 || way.travel.hi > 0); ++k) {
      gains.push_back(forward.roll_to(part_of(way.travel.hi, k)));
    }
    most = gains[here];
    for (const ExpectedGain& gain : gains) {
      if (is_better(gain, most)) most = gain;
    }
    // Only after both comparisons are done: it reads after which travel each place is told.
    to_go = std::make_unique<WayToTell>(hypotheses, back, forward);
    for (ExpectedGain& gain : gains) gain.travel = to_go->after(gain.length);
  }

  /// After which travel one way or the other j is told from i, for sure (`how` 0) or in part (1).
  double told(std::size_t i, std::size_t j, std::size_t how) const {
    return std::min(back.told(i, j)[how], forward.told(i, j)[how]);
  }

  Way way;
  /// of the rolls on this way with a length below 0, and of the others
  Comparison back;
  Comparison forward;
  /// by growing length
  std::vector<ExpectedGain> gains;
  std::size_t here = 0;  // index of the roll of length 0
  ExpectedGain most;     // the one that tells most
  std::unique_ptr<WayToTell> to_go;
};

/// A roll on a way, and what it costs: infinite where the way tells nothing.
struct Choice {
  std::size_t best = 0;
  double cost = std::numeric_limits<double>::infinity();
};

/// The roll after which, itself included, the least travel is to be expected, of those that may be enough.
Choice least_travel(const Trial& trial, double one_roll) {
  // The probability that after each roll some place is still open that this way can settle.
  std::vector<double> open;
  for (const ExpectedGain& gain : trial.gains) open.push_back(trial.to_go->open_after(gain.length));
  const double least_open = *std::min_element(open.begin(), open.end());
  Choice choice;
  for (std::size_t k = 0; k < trial.gains.size(); ++k) {
    const ExpectedGain& gain = trial.gains[k];
    // The roll itself, and a further one with the probability that something is left.
    const double cost = gain.travel + one_roll * (1 + open[k]);
    // It settles at least the share 1 - kMostOpen of the probability that the best roll settles.
    const bool is_enough = open[k] <= least_open + kMostOpen * (1 - least_open);
    if (gain.length != 0 && is_enough && cost < choice.cost) choice = {k, cost};
  }
  return choice;
}

/// Index of the shortest roll that gains nearly as much as the best one.
std::size_t shortest_as_good_as(const Trial& trial) {
  std::size_t best = trial.here;
  for (std::size_t k = 0; k < trial.gains.size(); ++k) {
    const ExpectedGain& gain = trial.gains[k];
    const bool is_enough =
        gain.bits >= kNearlyAll * trial.most.bits && gain.placements <= trial.most.placements + kNearlyAsFew;
    if (!is_enough) continue;
    // Of equally good rolls the shortest; to stay only if no roll is as good.
    const bool is_first = best == trial.here && trial.here != k;
    if (is_first || std::abs(gain.length) < std::abs(trial.gains[best].length)) best = k;
  }
  return best;
}

/// The travel on other ways, to be expected after this one, for what it does not tell and they do.
double travel_elsewhere(const std::vector<PartHypothesis>& hypotheses, const std::list<Trial>& trials,
                        const Trial& trial, double one_roll) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  /// The least travel on any of the ways that tells j from i.
  const auto elsewhere = [&](std::size_t i, std::size_t j, std::size_t how) {
    double least = kNever;
    for (const Trial& other : trials) least = std::min(least, other.told(i, j, how));
    return least;
  };
  // the mean over the true place
  double sum = 0;
  for (std::size_t i = 0; i < hypotheses.size() && trials.size() > 1; ++i) {
    // If i is the true one: one travel on another way tells all that is nearer on it too.
    double farthest = 0;
    for (std::size_t j = 0; j < hypotheses.size(); ++j) {
      // Only what this way never tells for sure.
      if (!trial.to_go->matters(i, j) || trial.told(i, j, 0) < kNever) continue;
      double travel = elsewhere(i, j, 0);
      // In part: if no other way tells it for sure, and this one does not even in part.
      if (travel == kNever && trial.told(i, j, 1) == kNever) travel = elsewhere(i, j, 1);
      if (travel < kNever) farthest = std::max(farthest, travel + one_roll);
    }
    sum += hypotheses[i].hypothesis.probability * farthest;
  }
  return sum;
}

/// Which way, and which roll on it.
std::pair<const Trial*, std::size_t> chosen(const std::vector<PartHypothesis>& hypotheses,
                                            const std::list<Trial>& trials) {
  const double one_roll = kOneRoll * advising::shortest_perimeter(hypotheses);
  // The way whose best roll costs least, what is left for the other ways included.
  const Trial* best = nullptr;
  Choice choice;
  for (const Trial& trial : trials) {
    // A way that tells nothing is cheap, and must not be chosen for that.
    if (!trial.to_go->tells_any()) continue;
    // cost of this way: its own travel, and what is left to do on others
    Choice on_this = least_travel(trial, one_roll);
    on_this.cost += travel_elsewhere(hypotheses, trials, trial, one_roll);
    if (best != nullptr && on_this.cost >= choice.cost) continue;
    best = &trial;
    choice = on_this;
  }
  if (best != nullptr) return {best, choice.best};
  // No way tells any two places apart, for sure or in part: the one that gains most.
  best = &*std::min_element(trials.begin(), trials.end(),
                            [](const Trial& a, const Trial& b) { return is_better(a.most, b.most); });
  return {best, shortest_as_good_as(*best)};
}

/// Whether the robot can do this roll from every hypothesis that counts.
bool can_do(const std::vector<PartHypothesis>& hypotheses, const AdviceOptions& options, const PerFinger<double>& by) {
  const double least = advising::least_that_counts(hypotheses);
  return std::all_of(hypotheses.begin(), hypotheses.end(), [&](const PartHypothesis& one) {
    return one.hypothesis.probability < least || options.can_roll(one, by);
  });
}

/// The best roll that the robot can do: where it can't do one, that way ends before it. Of none that it can do nothing
/// is left but to stay.
std::pair<const Trial*, std::size_t> chosen_of_possible(const std::vector<PartHypothesis>& hypotheses,
                                                        const AdviceOptions& options, std::list<Trial>& trials) {
  for (std::size_t cut = 0;; ++cut) {
    const std::pair<const Trial*, std::size_t> now = chosen(hypotheses, trials);
    const Trial* const best = now.first;
    // With sign: below 0 back.
    const double length = best->gains[now.second].length;
    if (!options.can_roll || length == 0 || can_do(hypotheses, options, best->way.rolled(length))) return now;
    // The way is looked at anew, up to a share of the roll that can't be done. Each turn of the loop makes one way
    // shorter, so that it ends.
    const auto at = std::find_if(trials.begin(), trials.end(), [&](const Trial& one) { return &one == best; });
    Way way = at->way;
    (length < 0 ? way.travel.lo : way.travel.hi) = kShorter * length;
    // Enough cuts: this way is given up.
    if (cut >= kMostCuts) way.travel = {0, 0};
    trials.emplace(at, hypotheses, options, way);
    trials.erase(at);
  }
}

/// Of two fingers the likeliest, where they are too many.
std::vector<PartHypothesis> compared(std::vector<PartHypothesis> hypotheses) {
  // One finger has one way only: all of its places are compared.
  if (hypotheses.front().hypothesis.place.size() == 1 || hypotheses.size() <= kMostPairs) return hypotheses;
  std::stable_sort(hypotheses.begin(), hypotheses.end(), [](const PartHypothesis& a, const PartHypothesis& b) {
    return a.hypothesis.probability > b.hypothesis.probability;
  });
  hypotheses.resize(kMostPairs);
  // Their probabilities add up to 1 again.
  double total = 0;
  for (const PartHypothesis& one : hypotheses) total += one.hypothesis.probability;
  for (PartHypothesis& one : hypotheses) one.hypothesis.probability /= total;
  return hypotheses;
}

}  // namespace

/// Theta(p + L) - Theta(p), radians; of two fingers that of a less that of b.
double turn_ahead(const Part& part, const Hypothesis& hypothesis, const PerFinger<double>& lengths) {
  const auto turn = [&](std::size_t finger) {
    const double from = hypothesis.place[finger];
    return part.turning().angle(from + lengths[finger]) - part.turning().angle(from);
  };
  return lengths.size() == 1 ? turn(0) : turn(0) - turn(1);
}

Advice advise(const Part& part, const std::vector<Hypothesis>& hypotheses, const AdviceOptions& options) {
  // One part for all, and its reach.
  std::vector<PartHypothesis> on_part;
  for (const Hypothesis& hypothesis : hypotheses) on_part.push_back({&part, options.reach, hypothesis});
  return advise(on_part, options);
}

/// Every way with all its rolls is tried; the choice is between them. The time grows with the square of the hypotheses.
Advice advise(const std::vector<PartHypothesis>& hypotheses, const AdviceOptions& options) {
  require_valid(hypotheses, options);
  const std::vector<PartHypothesis> some = compared(hypotheses);
  std::vector<double> prior;
  for (const PartHypothesis& one : some) prior.push_back(one.hypothesis.probability);
  std::list<Trial> trials;
  for (const Way& way : advising::ways_of(some, options)) trials.emplace_back(some, options, way);
  const auto [trial, best] = chosen_of_possible(some, options, trials);
  // A roll helps if any way gains a noticeable part of the bits, and the chosen one is not to stay.
  double most_bits = 0;
  for (const Trial& each : trials) most_bits = std::max(most_bits, each.most.bits);
  Advice advice;
  advice.gains = trial->gains;
  advice.best = best;
  advice.way = trial->way.direction;
  advice.bits_wanted = advising::entropy(prior);
  advice.helps = most_bits > kHelp * advice.bits_wanted && best != trial->here;
  return advice;
}

}  // namespace rollfix
