#include <utility>

#include "pair/box_search.hpp"
#include "pair/components.hpp"
#include "pair/pair_sets.hpp"
#include "pair/patch_search.hpp"
#include "pair/roll_curve.hpp"
#include "searches.hpp"

namespace rollfix {
namespace {

/// A corner of one finger's against a corner of the other's: places, not intervals.
void add_corner_pairs(const ContactEquations& question, const RollCurve& a, const RollCurve& b,
                      const PairLimits& limits, PairFindings& findings) {
  for (const RollPatch& on_a : a.patches()) {
    for (const RollPatch& on_b : b.patches()) {
      const PairPoint at{on_a.s, on_b.s};
      if (residual_at(question, at) > limits.tolerance) continue;
      PairPiece piece;
      piece.box = {Interval{at[0], at[0]}, Interval{at[1], at[1]}};
      piece.corner = true;
      findings.pieces.push_back(piece);
      findings.roots.push_back({at, 0, true});
    }
  }
}

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
  BoxSearch(a, b, limits, budget, findings).run();
  search_patches(a, b, true, limits, budget, findings);
  search_patches(b, a, false, limits, budget, findings);
  add_corner_pairs(question, a, b, limits, findings);

  Search search;
  search.placements = make_placements(question, join_pieces(part, findings, limits.same_place));
  for (const PairBox& box : findings.unresolved) search.unresolved.emplace_back(box);
  search.counts = findings.counts;
  search.counts.evaluations = a.evaluations() + b.evaluations();
  return search;
}

}  // namespace rollfix
