#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "fingers_apart.hpp"
#include "held_question.hpp"
#include "hold_fit.hpp"
#include "hold_mistakes.hpp"
#include "locate/remaining.hpp"
#include "mended_holds.hpp"
#include "problem.hpp"
#include "rollfix/hold.hpp"
#include "rollfix/pulse.hpp"
#include "weigh_holds.hpp"

// Notation:
//   row, instant    of the logs; of them one that is searched with
//   box, set        an arc of first contacts for each finger; boxes that hang together: one placement or more
//   glance          a quick look for the likeliest place, by hold_mistakes.cpp
// Follows docs/two_fingers.md, "Three and more fingers", and docs/rig.md.
// Idea: boxes of first contacts are searched by some instants (box_search.cpp). With noise the posterior by all rows is
// taken over the sets that are left (weigh_holds.cpp). Without noise each set needs first contacts that fit
// (held_question.cpp). Boxes that can't be decided are reported, and make the answer incomplete.
namespace rollfix {
namespace hold {
namespace {

constexpr double kFreeHold = 0.05;  // of the perimeter: without noise what is confined no better is a continuum

/// One problem whose logs are aligned and checked; of a part face down as a mirror shows it.
class HoldSolver {
 public:
  HoldSolver(const HoldProblem& problem, const std::vector<Log>& logs, const WheelPaths& wheels, Care care,
             HoldAnswer& answer)
      : problem_(problem),
        care_(care),
        answer_(answer),
        boundary_(problem.part.boundary()),
        wheels_(wheels),
        question_(problem, held_rows(problem, logs), rows_to_search(problem, logs.front()), wheels),
        apart_(problem, question_.rows()) {}

  /// Search, then placements, then the verdict.
  void run() {
    for (const HeldRow& row : question_.searched().rows) answer_.instants.push_back(row.time);
    // Wheels keep length 0: theirs was not measured.
    for (std::size_t k = 0; k < question_.rows().fingers(); ++k) {
      answer_.rolls[k].length = question_.searched().rows.back().contacts[k].travelled;
    }
    const HeldRows& rows = question_.rows();
    // Without places as evidence the pose is by a finger's centre, or its position is unknown.
    if (!rows.any_place) answer_.place = rows.reference ? PlaceKnown::reference : PlaceKnown::unknown;
    Boxes boxes = question_.search().search();
    // At a glance boxes that the budget left are taken as they are: nothing is proved.
    if (care_ == Care::glance) {
      boxes.fit.insert(boxes.fit.end(), boxes.undecided.begin(), boxes.undecided.end());
      boxes.undecided.clear();
    }
    if (rows.has_noise) {
      weigh(problem_, rows, question_.searched(), question_.sets(boxes.fit), question_.search(), wheels_, care_,
            answer_);
      add_unresolved(boxes.undecided);
    } else {
      add_witnessed(std::move(boxes));
    }
    answer_.comparisons = question_.search().comparisons();
    conclude();
  }

 private:
  /// Without noise: a placement for each set with a witness, and for each other pose at the ends that fits as well.
  void add_witnessed(Boxes boxes) {
    HoldFit fit(problem_.part, question_.searched(), wheels_);
    Witnessed found = witnessed(question_, fit, std::move(boxes), &apart_);
    for (const WitnessedSet& one : found.sets) {
      if (one.overlaps) {
        ++answer_.overlap;
        continue;
      }
      for (const HeldState& state : fit.poses_at_ends(one.state)) {
        // Another pose at an end may be beyond its tolerance.
        if (fit.worst(state) > 1) continue;
        answer_.placements.push_back(described(fit, problem_.part, state, one.set));
        answer_.placements.back().continuum = is_free(fit, state, one.set);
      }
    }
    // A box in which nothing was found, but that can't be excluded, is undecided as well.
    found.undecided.insert(found.undecided.end(), found.doubtful.begin(), found.doubtful.end());
    add_unresolved(found.undecided);
    std::sort(answer_.placements.begin(), answer_.placements.end(),
              [](const HoldPlacement& a, const HoldPlacement& b) { return a.contacts[0].start < b.contacts[0].start; });
  }

  /// Whether the instants confine the first contacts no better than to a large share of the boundary.
  bool is_free(const HoldFit& fit, const HeldState& state, const HeldSet& set) const {
    double widest = 0;
    for (const Interval& arc : set.extent) widest = std::max(widest, arc.width());
    const UnknownsMatrix information = fit.reduced(state).matrix;
    const auto fingers = static_cast<Eigen::Index>(fit.fingers());  // an encoder's zero is no place
    const UnknownsMatrix places = information.topLeftCorner(fingers, fingers);
    // The information on the direction that is known worst, 1 / length^2 in units of the tolerances.
    const double weakest = Eigen::SelfAdjointEigenSolver<UnknownsMatrix>(places).eigenvalues()(0);
    const double confined = kFreeHold * boundary_.perimeter;
    return widest > 1e-3 * boundary_.perimeter && !(weakest > 1 / (confined * confined));
  }

  /// Arcs, of each finger and wheel, where an unlisted placement may be: one entry for each set of connected boxes.
  void add_unresolved(const std::vector<Box>& boxes) {
    if (boxes.empty()) return;
    for (const FoundSet& one : question_.sets(boxes)) {
      answer_.unresolved.push_back(one.set.extent);
      answer_.unresolved.back().insert(answer_.unresolved.back().end(), one.set.wheels.begin(), one.set.wheels.end());
    }
  }

  /// The verdict, by what is listed; incomplete wins over everything.
  void conclude() {
    Verdict& verdict = answer_.verdict;
    verdict.name = Verdict::inconsistent;
    verdict.fits_badly = answer_.is_contradicted();
    const std::vector<HoldPlacement>& placements = answer_.placements;
    if (!answer_.unresolved.empty()) {
      answer_.status = Status::incomplete;
      verdict.name = Verdict::undecided;
      return;
    }
    if (placements.empty()) return;
    // With noise those that count by their probability; without, all.
    verdict.places = how_many_remain(placements, &HoldPlacement::probability);
    const bool is_sure = verdict.places == 1;
    verdict.stretches = 0;
    for (std::size_t k = 0; k < verdict.places; ++k) verdict.stretches += placements[k].continuum ? 1 : 0;
    // One continuum that goes all the way round some finger's boundary: such a roll does not determine it.
    const bool is_anywhere =
        is_sure && std::any_of(placements.front().contacts.begin(), placements.front().contacts.end(),
                               [&](const HoldContact& contact) { return boundary_.is_full(contact.extent); });
    if (is_anywhere && verdict.stretches > 0) {
      verdict = {Verdict::unobservable, 0, 0, verdict.fits_badly};
    } else if (is_sure && verdict.stretches == 0) {
      verdict = {Verdict::unique, 0, 0, verdict.fits_badly};
    } else {
      verdict.name = Verdict::ambiguous;
    }
  }

  const HoldProblem& problem_;
  Care care_;
  HoldAnswer& answer_;
  Boundary boundary_;
  const WheelPaths& wheels_;
  HeldQuestion question_;
  FingersApart apart_;
};

/// Of all fingers and wheels, for the answer.
TouchTolerance largest_tolerance(const HeldRows& rows) {
  TouchTolerance most;
  for (const HeldErrors& errors : rows.errors) {
    most.length = std::max(most.length, errors.has_place ? errors.place : 0);
    most.angle = std::max(most.angle, errors.angle);
  }
  for (const HeldWheel& wheel : rows.wheels) most.length = std::max(most.length, wheel.place);
  return most;
}

}  // namespace

/// Refusals come before the search: the problem itself, wheels and fingers inside each other, angles that may be
/// wrapped.
HoldAnswer solve_plain(const HoldProblem& problem, Care care) {
  require_valid(problem);
  const WheelPaths wheels = paths_of(problem);
  std::vector<Log> logs = logs_of(problem);
  require_wheels_apart(problem, logs);
  HoldAnswer answer{problem.part, {}};
  if (problem.robust) answer.jumps = leave_out_jumps(problem, logs);
  require_clear(problem, logs);
  for (std::size_t k = 0; k < logs.size(); ++k) answer.rolls.push_back(roll_of(problem, logs[k], k));
  answer.rows = logs.front().rows();
  answer.noise = problem.noise;
  answer.squeezed = problem.squeezed;
  answer.mirrored = problem.mirrored;
  answer.robust = problem.robust;
  answer.prior = problem.prior;
  answer.pose = problem.pose;
  // By x and y in the world, as given: a mirror changes no distance.
  require_apart(problem, logs);
  // A part face down is searched in a mirror, and the answer taken back.
  const HoldProblem seen = problem.mirrored ? in_mirror(problem, logs) : problem;
  if (!problem.noise) answer.tolerance = largest_tolerance(held_rows(seen, logs));
  HoldSolver(seen, logs, wheels, care, answer).run();
  if (problem.mirrored) out_of_mirror(answer);
  return answer;
}

}  // namespace hold

/// Mistakes are looked for only where the search is complete, and nothing fits or the noise is contradicted.
HoldAnswer solve(const HoldProblem& problem) {
  const Doing doing("looking for places that fit all fingers");
  HoldAnswer answer = hold::solve_plain(problem);
  const bool is_wrong = answer.placements.empty() || answer.verdict.fits_badly;
  if (!problem.diagnose || answer.status != Status::complete || !is_wrong) return answer;
  const Doing looking("looking for what explains the misfit");
  answer.diagnoses = hold::mistakes(problem, answer);
  answer.was_diagnosed = true;
  return answer;
}

std::string HoldAnswer::verdict_text() const {
  Verdict plain = verdict;
  plain.fits_badly = false;
  const bool is_said = verdict.fits_badly && verdict.name != Verdict::inconsistent;
  return plain.text() + (is_said ? ", but the measurements contradict the stated noise" : "");
}

}  // namespace rollfix
