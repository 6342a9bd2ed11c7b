#include <utility>
#include <vector>

#include "locate/pair/box_search.hpp"
#include "locate/pair/components.hpp"
#include "locate/pair/pair_find.hpp"
#include "locate/pair/roll_curve.hpp"
#include "patch_search.hpp"
#include "searches.hpp"

// Notation:
//   s, t            first contacts of finger a and of finger b
//   A(s), B(t)      the two fingers' curves, eqs. (8) and (9) being A(s) = B(t): `a`, `b`, with a component for each
//                   reading, Theta(s + La_k) - Theta(s) and Theta(t + Lb_k) - Theta(t) + theta_k, and for the facing
// Follows eqs. (8) and (9) of the paper (Jia, IROS 2001); docs/search.md, "Two fingers".
// Idea: boxes of (s, t), of which both sides are bounded by a tree over each curve, are decided or halved; where pivots
// at corners make patches of a curve, these are searched besides. What touches is one placement.
namespace rollfix::locating {
namespace {

/// Eqs. (8) and (9) as two curves that meet: of finger a with nothing added, of finger b with the turns.
RollEquations equations_of(const ContactEquations& question, std::size_t finger) {
  RollEquations equations;
  for (const Reading& reading : question.readings) {
    equations.lengths.push_back(reading.length[finger]);
    equations.shifts.push_back(finger == 0 ? 0 : reading.turn);
  }
  if (question.facing) equations.facing = finger == 0 ? 0 : *question.facing;
  return equations;
}

}  // namespace

Search search_two(const ContactEquations& question, const LocateOptions& options) {
  const Part& part = question.part;
  PairLimits limits;
  limits.tolerance = options.tolerance;
  limits.perimeter = part.perimeter();
  limits.same_place = kLengthAccuracy * part.perimeter();
  limits.facing = question.facing.has_value();

  const Interval range_a = first_contacts(question, 0);
  const Interval range_b = first_contacts(question, 1);
  RollCurve a(part, equations_of(question, 0), range_a);
  RollCurve b(part, equations_of(question, 1), range_b);
  PairFindings findings;
  std::size_t budget = options.budget;
  // All pairs (s, t), with at most one contact of each finger that pivots; then first contacts at which several
  // contacts of a finger pivot at once.
  PairBoxSearch(a, b, limits, budget, findings).run();
  search_patches(a, b, true, limits, budget, findings);
  search_patches(b, a, false, limits, budget, findings);
  add_corner_pairs(question, a, b, limits, findings);

  Search search;
  // Connected sets of what all of these found are the placements.
  search.placements = make_placements(question, join_pieces(part, findings, limits.same_place));
  for (const PairBox& box : findings.unresolved) search.unresolved.emplace_back(box);
  search.counts = findings.counts;
  search.counts.evaluations = a.evaluations() + b.evaluations();
  return search;
}

}  // namespace rollfix::locating
