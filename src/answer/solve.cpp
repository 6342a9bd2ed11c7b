#include "rollfix/solve.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "either_way.hpp"
#include "finger_corners.hpp"
#include "observation.hpp"
#include "rollfix/error.hpp"
#include "rollfix/locate.hpp"
#include "rollfix/pulse.hpp"
#include "rollfix/rolling.hpp"
#include "weighing.hpp"

namespace rollfix {
namespace {

// With noise the search only says what kinds there are; with two fingers a wide tolerance is not worth more boxes than
// this, and where nearly any direction would do it has nothing to say.
constexpr std::size_t kBudgetWithNoise = 30000;
constexpr double kWidestSearch = 0.5;  // radians
// A million normal numbers are within so many standard deviations.
constexpr double kFarthestRow = 5;
// A disk with an uncertain radius is not taken to be smaller than this share of what was said.
constexpr double kSmallestDisk = 0.01;

bool is_in_another_unit(const Log& log, const Part& part) {
  return !log.unit.empty() && !part.unit().empty() && log.unit != part.unit();
}

Tolerance tolerance_of(const Problem& problem, const Observation& observed, std::optional<Belief>& belief) {
  if (problem.tolerance) return tolerance_given(*problem.tolerance);
  return belief ? tolerance_from_noise(belief->tolerance(observed.readings))
                : tolerance_from_digits(problem.part, observed.roundings, observed.readings);
}

/// Of one finger: with what the rows before the first one say as well.
Search search_from_row(const LeadingRows& leading, const LocateOptions& options, const Answer& answer) {
  std::vector<Reading> readings = answer.readings;
  readings.insert(readings.end(), leading.readings.begin(), leading.readings.end());
  Search found = locate(answer.part, readings, options);
  const double last = answer.readings.back().length[0];
  for (Placement& placement : found.placements) {
    placement.end = answer.part.boundary().canonical(placement.start[0] + last);
  }
  return found;
}

/// Everything that fits the readings.
void search(const Problem& problem, const LeadingRows& leading, Answer& answer) {
  const Doing doing("searching for all places that fit");
  LocateOptions options;
  options.tolerance = answer.tolerance.value;
  options.facing = answer.facing;
  const bool of_two_with_noise = answer.tolerance.source == Tolerance::Source::noise && answer.finger_count() == 2;
  if (of_two_with_noise) options.budget = kBudgetWithNoise;
  if (problem.budget) options.budget = *problem.budget;
  if (of_two_with_noise && options.tolerance > kWidestSearch) return;
  Search found = leading.readings.empty() ? locate(answer.part, answer.readings, options)
                                          : search_from_row(leading, options, answer);
  answer.status = found.status;
  answer.placements = std::move(found.placements);
  answer.unresolved = std::move(found.unresolved);
  answer.counts = found.counts;
}

/// Of a continuum of pairs those that fit all rows are left: the search is asked about one row after the other that the
/// place which stands for it does not fit, while something fits them all.
void search_all_rows(const Problem& problem, const Observation& observed, Answer& answer) {
  std::vector<std::size_t> asked;
  while (const std::optional<std::size_t> row = row_to_ask(problem, observed, answer)) {
    if (std::find(asked.begin(), asked.end(), *row) != asked.end()) return;
    asked.push_back(*row);
    Answer next = answer;
    const auto at = next.readings.end() - 1;  // the last one stays so
    next.readings.insert(at, observed.rolls[*row]);
    if (!next.times.empty()) next.times.insert(next.times.end() - 1, next.pose_time[*row]);
    put_on_corners(problem.part, observed.length_error(), next.readings);
    search(problem, {}, next);
    if (next.status != Status::complete || next.placements.empty()) return;
    answer = std::move(next);
  }
}

/// The smallest disk that a finger may be: it lies within any larger one that touches at the same contact, so that all
/// of them hit what it hits.
Finger smallest(const Finger& finger, double radius_sd) {
  if (!finger.is_disk()) return finger;
  const double radius = finger.disk()->radius;
  return disk(std::max(radius - kFarthestRow * radius_sd, kSmallestDisk * radius));
}

PerFinger<Reach> reaches_of(const Problem& problem, std::size_t count) {
  const double radius_sd = problem.noise ? problem.noise->radius : 0;
  const Finger a = smallest(problem.fingers.front(), radius_sd), b = smallest(problem.fingers.back(), radius_sd);
  const Reach reach = reach_of(problem.part, a);
  if (count == 1) return reach;
  return {reach, a.curvature(0) == b.curvature(0) ? reach : reach_of(problem.part, b)};
}

/// How far a rolled length may be off: by its digits, and by its noise.
double length_error(const Problem& problem, const Observation& observed) {
  const double digits = observed.length_error();
  if (!problem.noise) return digits;
  double travelled = 0;
  for (const Reading& roll : observed.rolls) {
    for (const double length : roll.length) travelled = std::max(travelled, std::abs(length));
  }
  const Noise& noise = *problem.noise;
  double scale = std::hypot(noise.slip, noise.part.length);
  for (const Finger& finger : problem.fingers) scale = std::hypot(scale, noise.radius * finger.curvature(0));
  // Of the first contact and of the row.
  const double contact = std::hypot(noise.contact, noise.contact);
  return digits + kFarthestRow * std::hypot(contact, scale * travelled);
}

/// What the fingers can't do goes: where they can be is known if all of them are disks or jaws.
void drop_impossible(const Problem& problem, const Observation& observed, Answer& answer) {
  const Doing doing("looking where the fingers can reach");
  if (answer.fingers.empty()) return;
  answer.has_reach = std::all_of(answer.fingers.begin(), answer.fingers.end(), has_reach);
  const double error = length_error(problem, observed);
  answer.impossible = answer.has_reach
                          ? drop_unreachable(answer.part, reaches_of(problem, answer.finger_count()), answer.readings,
                                             answer.placements, observed.rolls, error, problem.may_overlap)
                          : drop_overlapping(problem, observed, error, answer.placements);
  for (const Impossible& item : answer.impossible) {
    ++(item.reason == Impossible::Reason::reach ? answer.dropped.reach : answer.dropped.overlap);
  }
}

/// Without noise. Rows that contradict every place are wrong themselves: the places count all the same.
Verdict verdict_of(const Answer& answer, bool fits_badly) {
  if (!fits_badly) return verdict_of(answer.status, answer.placements);
  std::vector<Placement> placements = answer.placements;
  for (Placement& placement : placements) placement.is_contradicted = false;
  Verdict verdict = verdict_of(answer.status, placements);
  verdict.fits_badly = true;
  return verdict;
}

/// Where the part is in the world, where a log tells.
void add_poses(const Problem& problem, Answer& answer) {
  if (problem.fingers.empty() || !problem.measured.is_log()) return;
  std::vector<std::size_t> rows(problem.measured.log->rows());
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  for (Placement& placement : answer.placements) {
    std::optional<Poses> poses = rollfix::poses(problem.part, problem.fingers, *problem.measured.log, placement.start,
                                                rows, problem.noise.value_or(Noise{}));
    if (!poses) continue;
    const auto largest = [](const std::vector<double>& values) {
      return values.empty() ? std::nan("") : *std::max_element(values.begin(), values.end());
    };
    placement.pose_residual = {largest(poses->residual), largest(poses->turn_residual)};
    placement.pose = std::move(poses->pose);
  }
}

/// Rows of a log that jump away are no part of the roll, however robust the weighing of the others is.
Problem without_jumps(const Problem& problem, std::vector<std::size_t>& strays) {
  Problem result = problem;
  result.measured.log = without_strays(*problem.measured.log, problem.part, problem.fingers, *problem.noise, &strays);
  return result;
}

/// `leading`: rows before the log's first one, what they say of it.
Answer solve_from_row(const Problem& problem, const LeadingRows& leading, bool explains) {
  const Doing doing("weighing the rows against every place");
  const Observation observed = observe(problem);
  std::optional<Belief> belief = believe(problem, observed);
  Answer answer{problem.part, problem.fingers};
  answer.readings = observed.readings;
  answer.times = observed.times;
  answer.facing = observed.facing;
  answer.pose_time = observed.pose_time;
  answer.lengths_reversed = observed.lengths_reversed;
  const std::vector<bool>& on_corners = observed.on_corners;
  answer.corner_rows.count =
      leading.count + static_cast<std::size_t>(std::count(on_corners.begin(), on_corners.end(), true));
  answer.corner_rows.first = leading.count > 0 || (!on_corners.empty() && on_corners.front());
  answer.corner_rows.last = !on_corners.empty() && on_corners.back();
  answer.tolerance = tolerance_of(problem, observed, belief);
  search(problem, leading, answer);
  const bool all_rows_count = !belief && problem.measured.is_log() && !problem.tolerance && problem.at.empty();
  if (all_rows_count && leading.count == 0) search_all_rows(problem, observed, answer);
  bool fits_badly = belief && weigh(problem, observed, explains, *belief, answer);
  drop_impossible(problem, observed, answer);
  if (belief) {
    const CornerRowsSay corner_rows = weigh_corner_rows(problem, leading, observed, answer);
    conclude(*belief, answer, corner_rows.are_heeded, fits_badly || corner_rows.fits_badly);
    to_last_contacts(observed, *problem.noise, answer);
  }
  add_poses(problem, answer);
  if (all_rows_count) fits_badly = !check_rows(problem, observed, explains, answer);
  if (!belief) answer.verdict = verdict_of(answer, fits_badly);
  return answer;
}

Answer solve_roll(const Problem& problem, bool explains) {
  const std::optional<LeadingRows> leading = leading_rows(problem);
  if (!leading) return solve_from_row(problem, {}, explains);
  Answer answer = solve_from_row(without(*leading, problem), *leading, explains);
  to_first_contacts(*leading, problem, answer);
  answer.pose_time = problem.measured.log->time;
  add_poses(problem, answer);
  return answer;
}

/// Of one way round. `explains`: what may be wrong is looked for where the rows fit badly.
Answer solve_one_way(const Problem& problem, bool explains) {
  if (!problem.robust || !problem.measured.is_log()) return solve_roll(problem, explains);
  std::vector<std::size_t> strays;
  const Problem cleaned = without_jumps(problem, strays);
  Answer answer = solve_roll(cleaned, explains);
  answer.strays = std::move(strays);
  return answer;
}

/// Nothing, and why, where the rows can't follow from one another.
std::optional<Answer> try_one_way(const Problem& problem, std::string& why_not) {
  try {
    return solve_one_way(problem, false);
  } catch (const InputError& error) {
    why_not = error.what();
    return std::nullopt;
  }
}

/// Both ways round. What can't be one way can be the other way: that is no mistake then.
Answer solve_either_way(const Problem& problem) {
  const std::array<Problem, 2> ways{problem, counted_clockwise(problem)};
  std::array<std::string, 2> why_not;
  std::array<std::optional<Answer>, 2> answers{try_one_way(ways[0], why_not[0]), try_one_way(ways[1], why_not[1])};
  if (!answers[0] && !answers[1]) throw InputError(why_not[0]);
  const auto both = [&] {
    if (answers[0] && answers[1]) return either_of(*answers[0], *answers[1]);
    return answers[0] ? only_way(*answers[0], false, why_not[1]) : only_way(*answers[1], true, why_not[0]);
  };
  Answer answer = both();
  if (!problem.diagnose) return answer;
  if (!answer.verdict.fits_badly && answer.verdict.name != Verdict::inconsistent) return answer;
  for (const std::size_t way : {0U, 1U}) {
    if (answers[way]) answers[way] = solve_one_way(ways[way], true);
  }
  return both();
}

}  // namespace

bool has_reach(const Finger& finger) { return finger.outline() == nullptr; }

Reach reach_of(const Part& part, const Finger& finger) {
  return finger.is_disk() ? reach_of_disk(part, finger.disk()->radius) : reach_of_jaw(part);
}

Answer solve(const Problem& problem) {
  if (problem.fingers.size() > 2) throw InputError("`fingers`: expected at most two fingers");
  require_noise(problem);
  if (problem.measured.is_log() && is_in_another_unit(*problem.measured.log, problem.part)) {
    Problem converted = problem;
    converted.measured.log = in_unit(*problem.measured.log, problem.part.unit(), problem.fingers);
    return solve(converted);
  }
  if (problem.mirrored) {
    Problem seen = in_mirror(problem);
    seen.mirrored = false;
    Answer answer = solve(seen);
    out_of_mirror(problem, answer);
    return answer;
  }
  if (problem.either_way) return solve_either_way(problem);
  return solve_one_way(problem, problem.diagnose);
}

}  // namespace rollfix
