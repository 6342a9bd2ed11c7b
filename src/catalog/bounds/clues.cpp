#include "clues.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "answer/steps.hpp"
#include "rollfix/error.hpp"
#include "rollfix/locate.hpp"

// Notation, as in docs/identify.md, the table of what may be off:
//   L, theta        a row's length and turn: `Clue::length`, `Clue::turn`
//   slack           how far these may be off, with `kFarthest` standard deviations: `length_slack`, `turn_slack`
//   own, shared, gathered  variances of a row's turn: its own, the first contact's, and what gathers on the way
//   most_cost       m + 5 sqrt(2 m) + 25: a sum of squares of m rows, exceeded once in a million rolls
//   excess          so many times the noise that was said
// Follows docs/identify.md, "How parts are ruled out"; the noise is docs/belief.md, "What the noise is".
// Idea: what is known of a roll before a part is known: its rows, far apart ones first, with slacks that hold on every
// part of the catalog, whatever its perimeter.
namespace rollfix::catalog {
namespace {

// Rows that are looked at first, and then: more tell little more, and take time.
constexpr std::size_t kFew = 12;
constexpr std::size_t kMany = 48;
// Without noise, rows that were not searched with may be off by so many times what the digits leave open: as for one
// part.
constexpr double kOverTolerance = 10;
// No row is farther off than this many standard deviations: one of 48 is once in ten million rolls.
constexpr double kFarthest = 6;
// The sum of squares of m rows is below m + 5 sqrt(2 m) + 25 but once in a million rolls.
constexpr double kSigmasOfSum = 5;

/// Those that are far apart first: neighbours tell nearly the same, and the sooner nothing is left, the better.
void spread(std::vector<Clue>& clues) {
  std::vector<Clue> all;
  all.reserve(clues.size());
  for (std::size_t step = std::bit_ceil(clues.size()); step > 0; step /= 2) {
    for (std::size_t k = step; k <= clues.size(); k += 2 * step) all.push_back(clues[k - 1]);
  }
  clues = std::move(all);
}

/// The numbers of about so many rows, evenly over all; the last is one of them.
std::vector<std::size_t> some_of(std::size_t rows, std::size_t wanted) {
  std::vector<std::size_t> some;
  const std::size_t count = std::min(rows, wanted);
  for (std::size_t k = 1; k <= count; ++k) some.push_back(k * rows / count - 1);
  return some;
}

double square(double x) { return x * x; }

/// The larger of both.
void widen(std::vector<RowErrors>& errors, const std::vector<RowErrors>& others) {
  for (std::size_t k = 0; k < errors.size(); ++k) {
    errors[k].length = std::max(errors[k].length, others[k].length);
    errors[k].shared = std::max(errors[k].shared, others[k].shared);
    errors[k].own = std::max(errors[k].own, others[k].own);
    errors[k].gathered = std::max(errors[k].gathered, others[k].gathered);
  }
}

/// The least and the largest perimeter: noise depends on it a little.
Interval perimeters(const Catalog& catalog) {
  Interval range{std::numeric_limits<double>::infinity(), 0};
  for (std::size_t k = 0; k < catalog.size(); ++k) {
    const double perimeter = catalog.entry(k).perimeter;
    range = {std::min(range.lo, perimeter), std::max(range.hi, perimeter)};
  }
  return range;
}

RollClues clues_with_noise(const Problem& problem, const Observation& observed, const Interval& range, double excess) {
  const double farthest = excess * kFarthest;
  const std::vector<Reading>& rows = problem.measured.is_log() ? observed.rolls : observed.readings;
  RollClues roll;
  for (Clues* clues : {&roll.few, &roll.many}) clues->fingers = rows.front().fingers();
  if (problem.robust) return roll;  // any row may be a stray one
  std::vector<RowErrors> errors = errors_of(problem, *problem.noise, rows, range.lo);
  widen(errors, errors_of(problem, *problem.noise, rows, range.hi));
  const auto clue = [&](std::size_t row) {
    Clue one;
    one.length = rows[row].length;
    one.turn = rows[row].turn;
    one.length_slack = farthest * std::sqrt(errors[row].length);
    return one;
  };
  for (const std::size_t row : some_of(rows.size(), kFew)) {
    roll.few.clues.push_back(clue(row));
    roll.few.clues.back().turn_slack =
        farthest * std::sqrt(errors[row].shared + errors[row].own + errors[row].gathered);
  }
  for (const std::size_t row : some_of(rows.size(), kMany)) {
    roll.many.clues.push_back(clue(row));
    roll.many.clues.back().turn_slack = farthest * std::sqrt(errors[row].gathered);
    roll.many.clues.back().turn_sd = std::sqrt(errors[row].own);
  }
  const auto count = static_cast<double>(roll.many.clues.size());
  roll.many.shared_sd = std::sqrt(errors.front().shared);
  roll.many.most_cost = square(excess) * (count + kSigmasOfSum * std::sqrt(2 * count) + square(kSigmasOfSum));
  if (observed.facing) {
    roll.few.facing = roll.many.facing = observed.facing;
    roll.few.facing_slack = roll.many.facing_slack = farthest * std::sqrt(2 * errors.front().shared);
  }
  spread(roll.few.clues);
  spread(roll.many.clues);
  return roll;
}

RollClues clues_without_noise(const Problem& problem, const Observation& observed) {
  // A log's rows all have to fit, unless only some were asked for.
  const bool takes_all = problem.measured.is_log() && !problem.tolerance && problem.at.empty();
  Rounding rounding;
  for (const Rounding& one : observed.roundings) {
    rounding = {std::max(rounding.length, one.length), std::max(rounding.turn, one.turn)};
  }
  Clue slack;
  slack.turn_slack = LocateOptions().tolerance + rounding.turn;
  slack.turn_slack_by_curvature = rounding.length;
  if (problem.tolerance) {
    slack.turn_slack = std::max(*problem.tolerance, kLeastTolerance);
    slack.turn_slack_by_curvature = 0;
  }
  const auto some = [&](std::size_t wanted) {
    Clues clues;
    clues.fingers = observed.readings.front().fingers();
    const auto add = [&](const Reading& reading, double times) {
      Clue clue = slack;
      clue.length = reading.length;
      clue.turn = reading.turn;
      clue.turn_slack *= times;
      clue.turn_slack_by_curvature *= times;
      clues.clues.push_back(clue);
    };
    for (const Reading& reading : observed.readings) add(reading, 1);
    if (observed.facing) {
      clues.facing = observed.facing;
      clues.facing_slack = slack.turn_slack;
      clues.facing_slack_by_curvature = slack.turn_slack_by_curvature;
    }
    if (takes_all) {
      for (const std::size_t row : some_of(observed.rolls.size(), wanted)) add(observed.rolls[row], kOverTolerance);
    }
    spread(clues.clues);
    return clues;
  };
  return {some(kFew), some(kMany)};
}

}  // namespace

std::array<std::vector<RollClues>, 2> clues_of(const Catalog& catalog, const Problem& like, double excess) {
  const Interval range = perimeters(catalog);
  std::array<std::vector<RollClues>, 2> clues;
  for (const bool is_reversed : {false, true}) {
    std::size_t k = 0;
    while (k < catalog.size() && catalog.entry(k).reversed != is_reversed) ++k;
    if (k == catalog.size()) continue;
    for (const View& view : views_of(like)) {
      Problem way = view.of(like);
      way.part = catalog.part(k);
      try {
        const Observation observed = observe(way);
        clues.at(is_reversed ? 1 : 0)
            .push_back(way.noise ? clues_with_noise(way, observed, range, excess) : clues_without_noise(way, observed));
      } catch (const InputError&) {  // what this part has against it says nothing about the others
        clues.at(is_reversed ? 1 : 0).emplace_back();
      }
    }
  }
  return clues;
}

}  // namespace rollfix::catalog
