#include "bounds.hpp"

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

// Rows that are looked at first, and then. More rows take time in each cell and tell little more; with fewer, more
// parts are left to the search.
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
  // Steps of a power of two, halved: the rows at odd multiples of each are those that no larger step had.
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

/// Of each variance the larger one: a slack that holds at both ends of a range of perimeters.
void widen(std::vector<RowErrors>& errors, const std::vector<RowErrors>& others) {
  for (std::size_t k = 0; k < errors.size(); ++k) {
    errors[k].length = std::max(errors[k].length, others[k].length);
    errors[k].shared = std::max(errors[k].shared, others[k].shared);
    errors[k].own = std::max(errors[k].own, others[k].own);
    errors[k].gathered = std::max(errors[k].gathered, others[k].gathered);
  }
}

/// The least and the largest perimeter of the catalog: noise depends on it a little, and a clue has to hold on every
/// part. REQUIRES that there is one.
Interval perimeters(const Catalog& catalog) {
  Interval range{std::numeric_limits<double>::infinity(), 0};
  for (std::size_t k = 0; k < catalog.size(); ++k) {
    const double perimeter = catalog.entry(k).perimeter;
    range = {std::min(range.lo, perimeter), std::max(range.hi, perimeter)};
  }
  return range;
}

/// Clues of a roll with noise. `few`: the slack of each turn holds all of its errors. `many`: own and shared errors are
/// told apart and added up as squares; only what gathers on the way is slack of the turn. `range`: of perimeters.
RollClues clues_with_noise(const Problem& problem, const Observation& observed, const Interval& range, double excess) {
  const double farthest = excess * kFarthest;
  // Of a log all of its rows.
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
  // One interval for each row: `farthest` standard deviations of all that it may be off.
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
  // On the true part the squares add up to a chi-square of `count` degrees of freedom: below this but once in a million
  // rolls, with `excess` times the noise excess^2 of it.
  const auto count = static_cast<double>(roll.many.clues.size());
  roll.many.shared_sd = std::sqrt(errors.front().shared);
  roll.many.most_cost = square(excess) * (count + kSigmasOfSum * std::sqrt(2 * count) + square(kSigmasOfSum));
  // The facing is the difference of both first contacts' directions, which have the shared error each.
  if (observed.facing) {
    roll.few.facing = roll.many.facing = observed.facing;
    roll.few.facing_slack = roll.many.facing_slack = farthest * std::sqrt(2 * errors.front().shared);
  }
  spread(roll.few.clues);
  spread(roll.many.clues);
  return roll;
}

/// Clues of rows that are exact up to their digits, or to the tolerance: no squares are added up. Readings to search
/// with have the search's own slack, all other rows of a log ten times that.
RollClues clues_without_noise(const Problem& problem, const Observation& observed) {
  // A log's rows all have to fit, unless only some were asked for.
  const bool takes_all = problem.measured.is_log() && !problem.tolerance && problem.at.empty();
  // The largest rounding of any reading, so that one slack holds for all.
  Rounding rounding;
  for (const Rounding& one : observed.roundings) {
    rounding = {std::max(rounding.length, one.length), std::max(rounding.turn, one.turn)};
  }
  Clue slack;
  slack.turn_slack = LocateOptions().tolerance + rounding.turn;
  // A length that is off by d turns the tangent by at most |kappa| d.
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
    // What is searched with has to fit within the search's own tolerance.
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
    // One part that is stored this way stands for all of them: its direction decides the signs of lengths.
    std::size_t k = 0;
    while (k < catalog.size() && catalog.entry(k).reversed != is_reversed) ++k;
    if (k == catalog.size()) continue;
    // One way, or both where lengths may count either way.
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
