#pragma once

#include <cstddef>

#include "corner_sets.hpp"
#include "locate/pair/pair_find.hpp"
#include "locate/pair/roll_curve.hpp"

namespace rollfix::locating {

/// First contacts at which several contacts of one finger stand at convex corners and pivot independently: there its
/// curve is a patch, and the other finger's curve can run through the patch's inside. Looks where, to the resolution
/// of the part, on every patch of `patched`; `patched_is_a` says which finger that is. Halving takes from the budget.
void search_patches(const RollCurve& patched, PlaneCurve& other, bool patched_is_a, const PairLimits& limits,
                    std::size_t& budget, PairFindings& findings);

/// Both fingers on a patch each: each pair of them that fits within the tolerance is one place, not an interval.
void add_corner_pairs(const ContactEquations& question, const RollCurve& a, const RollCurve& b,
                      const PairLimits& limits, PairFindings& findings);

}  // namespace rollfix::locating
