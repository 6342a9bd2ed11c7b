#include "rollfix/solve.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "rollfix/error.hpp"
#include "rollfix/locate.hpp"
#include "rollfix/rolling.hpp"
#include "steps.hpp"
#include "work/pulse.hpp"

// From a problem to its answer: the order of the steps, and what each of them is given.
// Notation:
//   view            the problem as seen in a mirror or counted clockwise; without both it is solved as given
//   leading         rows at the beginning on a corner of the finger, whose turns are only known to an interval
//   exactly         without noise: a few rows are searched with, all rows contradict placements or do not
//   with noise      the posterior of all rows replaces the search's placements; the search says what kind each is
// Follows docs/search.md for the search, docs/belief.md for what follows.
namespace rollfix::answer {
namespace {

// With noise the search only says what kinds there are; with two fingers a wide tolerance is not worth more boxes than
// this, and where nearly any direction would do it has nothing to say.
constexpr std::size_t kBudgetWithNoise = 30000;
constexpr double kWidestSearch = 0.5;  // radians

/// Both state a unit, and not the same one.
bool is_in_another_unit(const Log& log, const Part& part) {
  return !log.unit.empty() && !part.unit().empty() && log.unit != part.unit();
}

/// As given; else from the noise of the readings searched with, or from their digits.
Tolerance tolerance_of(const Problem& problem, const Observation& observed, std::optional<Belief>& belief) {
  if (problem.tolerance) return tolerance_given(*problem.tolerance);
  return belief ? tolerance_from_noise(belief->tolerance(observed.readings))
                : tolerance_from_digits(problem.part, observed.roundings, observed.readings);
}

/// Everything that fits the readings.
Search search(const Problem& problem, const LeadingRows& leading, const Answer& answer) {
  const Doing doing("searching for all places that fit");
  LocateOptions options;
  options.tolerance = answer.tolerance.value;
  options.facing = answer.facing;
  const bool of_two_with_noise = answer.tolerance.source == Tolerance::Source::noise && answer.finger_count() == 2;
  if (of_two_with_noise) options.budget = kBudgetWithNoise;
  // What the user states overrides the default.
  if (problem.budget) options.budget = *problem.budget;
  // Nothing is found, and what kind of place each is stays open.
  if (of_two_with_noise && options.tolerance > kWidestSearch) return {};
  if (leading.readings.empty()) return locate(answer.part, answer.readings, options);
  // Of one finger: with what the rows before the first one say as well.
  std::vector<Reading> readings = answer.readings;
  // These lead from the base back to the first contact, on a corner of the finger.
  readings.insert(readings.end(), leading.readings.begin(), leading.readings.end());
  Search found = locate(answer.part, readings, options);
  // The search takes the end from its last reading, which is a leading one here.
  const double last = answer.readings.back().length[0];
  for (Placement& placement : found.placements) {
    placement.end = answer.part.boundary().canonical(placement.start[0] + last);
  }
  return found;
}

/// What the search found, into the answer.
void take(Search found, Answer& answer) {
  answer.status = found.status;
  answer.placements = std::move(found.placements);
  answer.unresolved = std::move(found.unresolved);
  answer.counts = found.counts;
}

/// What fits these rows as well; nothing where that is none, or not all of it was found.
std::optional<Answer> asked_about(const Problem& problem, const Observation& observed, const Answer& answer,
                                  std::span<const std::size_t> rows) {
  Answer next = answer;
  // Before the last reading: its end is the placement's end.
  for (const std::size_t row : rows) {
    next.readings.insert(next.readings.end() - 1, observed.rolls[row]);  // the last one stays so
    if (!next.times.empty()) next.times.insert(next.times.end() - 1, next.pose_time[row]);
  }
  // Rounded lengths between corners, as `observe` does it for the readings.
  put_on_corners(problem.part, observed.length_error(), next.readings);
  take(search(problem, {}, next), next);
  if (next.status != Status::complete || next.placements.empty()) return std::nullopt;
  return next;
}

/// Of a continuum those places that fit all rows are left: the search is asked about rows that the place which stands
/// for it does not fit, while something fits them all.
/// Each row is asked about once, so that it ends.
Answer search_all_rows(const Problem& problem, const Observation& observed, Answer answer) {
  std::set<std::size_t> asked;
  while (true) {
    std::vector<std::size_t> rows = rows_to_ask(problem, observed, answer);
    // Rows that were asked about once and are still off stay off.
    std::erase_if(rows, [&](std::size_t row) { return asked.count(row) > 0; });
    if (rows.empty()) return answer;
    std::optional<Answer> next = asked_about(problem, observed, answer, rows);
    // Together the rows fit nowhere, or take too long: the worst one alone.
    if (!next && rows.size() > 1) {
      rows.resize(1);
      next = asked_about(problem, observed, answer, rows);
    }
    // Nothing fits the row as well: what was found stays, and `check_rows` says so.
    if (!next) return answer;
    asked.insert(rows.begin(), rows.end());
    answer = *std::move(next);
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
/// One pose for each row, and the largest residuals over all rows: of the contacts' places, length, and of the turns,
/// radians. Nothing without u and psi.
void add_poses(const Problem& problem, Answer& answer) {
  if (problem.fingers.empty() || !problem.measured.is_log()) return;
  std::vector<std::size_t> rows(problem.measured.log->rows());
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  for (Placement& placement : answer.placements) {
    std::optional<Poses> poses =
        rollfix::poses(problem.part, problem.fingers, *problem.measured.log, placement.start, rows,
                       problem.noise.value_or(Noise{}), problem.noise ? 0 : width_of(placement));
    // A log without u and psi says nothing of the part in the world.
    if (!poses) continue;
    const auto largest = [](const std::vector<double>& values) {
      return values.empty() ? std::nan("") : *std::max_element(values.begin(), values.end());
    };
    placement.pose_residual = {largest(poses->residual), largest(poses->turn_residual)};
    placement.pose = std::move(poses->pose);
  }
}

/// Rows of a log that jump away are no part of the roll, however robust the weighing of the others is.
/// `strays`: the rows left out as outliers.
Problem without_jumps(const Problem& problem, std::vector<std::size_t>& strays) {
  Problem result = problem;
  result.measured.log = without_strays(*problem.measured.log, problem.part, problem.fingers, *problem.noise, &strays);
  return result;
}

/// What was given, as it is searched with.
Answer answer_to(const Problem& problem, const LeadingRows& leading, const Observation& observed) {
  Answer answer{problem.part, problem.fingers};
  answer.readings = observed.readings;
  answer.times = observed.times;
  answer.facing = observed.facing;
  answer.pose_time = observed.pose_time;
  answer.lengths_reversed = observed.lengths_reversed;
  const std::vector<bool>& on_corners = observed.on_corners;
  // All rows on corners, those before the base included.
  answer.corner_rows.count =
      leading.count + static_cast<std::size_t>(std::count(on_corners.begin(), on_corners.end(), true));
  answer.corner_rows.first = leading.count > 0 || (!on_corners.empty() && on_corners.front());
  answer.corner_rows.last = !on_corners.empty() && on_corners.back();
  return answer;
}

/// Without noise a few rows of a log are searched with, and all of them are held against what was found.
Answer solve_exactly(const Problem& problem, const LeadingRows& leading, const Observation& observed, bool explains,
                     Answer answer) {
  take(search(problem, leading, answer), answer);
  // With a tolerance or instants given, the user chose what is to count.
  const bool all_rows_count = problem.measured.is_log() && !problem.tolerance && problem.at.empty();
  if (all_rows_count && leading.count == 0) answer = search_all_rows(problem, observed, std::move(answer));
  drop_impossible(problem, observed, answer);
  add_poses(problem, answer);
  if (!all_rows_count) {
    answer.verdict = verdict_of(answer.status, answer.placements);
    return answer;
  }
  RowsChecked rows = check_rows(problem, observed, explains, answer);
  answer.placements = std::move(rows.placements);
  answer.diagnoses = std::move(rows.diagnoses);
  answer.verdict = verdict_of(answer, rows.fits_badly);
  return answer;
}

/// With noise the search says what kind of place each is, and all rows together how probable.
Answer solve_with_noise(const Problem& problem, const LeadingRows& leading, const Observation& observed, bool explains,
                        Belief& belief, Answer answer) {
  take(search(problem, leading, answer), answer);
  // The order matters: weighed, then without what fingers can't do, then by rows on corners; the verdict is about the
  // rest.
  RowsWeighed rows = weigh(problem, observed, explains, answer, belief);
  answer.status = rows.status;
  answer.placements = std::move(rows.placements);
  answer.dropped.improbable = rows.weighing.improbable.size();
  answer.weighing = std::move(rows.weighing);
  answer.diagnoses = std::move(rows.diagnoses);
  drop_impossible(problem, observed, answer);
  const CornerRowsSay corner_rows = weigh_corner_rows(problem, leading, observed, answer);
  conclude(belief, answer, corner_rows.are_heeded, rows.centres_contradict || corner_rows.fits_badly);
  to_last_contacts(observed, *problem.noise, answer);
  add_poses(problem, answer);
  return answer;
}

/// `leading`: rows before the log's first one, what they say of it.
Answer solve_from_row(const Problem& problem, const LeadingRows& leading, bool explains) {
  const Doing doing("weighing the rows against every place");
  const Observation observed = observe(problem);
  std::optional<Belief> belief = believe(problem, observed);
  Answer answer = answer_to(problem, leading, observed);
  answer.tolerance = tolerance_of(problem, observed, belief);
  return belief ? solve_with_noise(problem, leading, observed, explains, *belief, std::move(answer))
                : solve_exactly(problem, leading, observed, explains, std::move(answer));
}

/// A log that begins on a corner of the finger is solved from its first row off corners on, and led back.
Answer solve_roll(const Problem& problem, bool explains) {
  const std::optional<LeadingRows> leading = leading_rows(problem);
  if (!leading) return solve_from_row(problem, {}, explains);
  Answer answer = solve_from_row(without(*leading, problem), *leading, explains);
  to_first_contacts(*leading, problem, answer);
  answer.pose_time = problem.measured.log->time;
  add_poses(problem, answer);
  return answer;
}

/// As it is given. `explains`: what may be wrong is looked for where the rows fit badly.
Answer solve_given(const Problem& problem, bool explains) {
  if (!problem.robust || !problem.measured.is_log()) return solve_roll(problem, explains);
  std::vector<std::size_t> strays;
  const Problem cleaned = without_jumps(problem, strays);
  Answer answer = solve_roll(cleaned, explains);
  answer.strays = std::move(strays);
  return answer;
}

/// What a view changes is undone in the answer.
Answer solve_seen(const Problem& problem, const View& view, bool explains) {
  if (view.is_as_given()) return solve_given(problem, explains);
  Answer answer = solve_given(view.of(problem), explains);
  view.undo(problem, answer);
  return answer;
}

/// Nothing, and why, where the rows can't follow from one another.
std::optional<Answer> try_one_way(const Problem& problem, const View& view, std::string& why_not) {
  try {
    return solve_seen(problem, view, false);
  } catch (const InputError& error) {
    why_not = error.what();
    return std::nullopt;
  }
}

/// Both ways round. What can't be one way can be the other way: that is no mistake then.
Answer solve_either_way(const Problem& problem, const std::vector<View>& ways) {
  std::array<std::string, 2> why_not;
  std::array<std::optional<Answer>, 2> answers{try_one_way(problem, ways[0], why_not[0]),
                                               try_one_way(problem, ways[1], why_not[1])};
  // No roll in either direction.
  if (!answers[0] && !answers[1]) throw InputError(why_not[0]);
  // Built again after the diagnoses, which change each way's answer.
  const auto both = [&] {
    if (answers[0] && answers[1]) return either_of(*answers[0], *answers[1]);
    return answers[0] ? only_way(*answers[0], why_not[1]) : only_way(*answers[1], why_not[0]);
  };
  Answer answer = both();
  if (!problem.diagnose) return answer;
  // What is wrong is only looked for if both ways together leave something to explain: it takes long.
  if (!answer.verdict.fits_badly && answer.verdict.name != Verdict::inconsistent) return answer;
  for (const std::size_t way : {0U, 1U}) {
    if (answers[way]) answers[way] = solve_seen(problem, ways[way], true);
  }
  return both();
}

}  // namespace
}  // namespace rollfix::answer

namespace rollfix {

/// One finger or two, a log or readings. Lengths of a log in another unit are converted first.
Answer solve(const Problem& problem) {
  if (problem.fingers.size() > 2) throw InputError("`fingers`: expected at most two fingers");
  require_noise(problem);
  if (problem.measured.is_log() && answer::is_in_another_unit(*problem.measured.log, problem.part)) {
    Problem converted = problem;
    converted.measured.log = in_unit(*problem.measured.log, problem.part.unit(), problem.fingers);
    return solve(converted);
  }
  const std::vector<View> views = views_of(problem);
  return views.size() == 1 ? answer::solve_seen(problem, views.front(), problem.diagnose)
                           : answer::solve_either_way(problem, views);
}

}  // namespace rollfix
