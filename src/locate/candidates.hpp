#pragma once

#include "corner_sets.hpp"
#include "rollfix/locate/locate.hpp"
#include "workspace.hpp"

namespace rollfix {

/// Into the workspace: the stretches of `range`, in rising order and apart, on which one finger's first contact can
/// lie: everywhere else some reading is off by more than the tolerance, whatever pivots at corners do, which bounds
/// over runs of spirals prove. They start and end where spirals do, or the range does; s = 0 of a closed outline may be
/// in the last one, as s = P. All of the range where the part has too few spirals to make it worth while. Adds to the
/// counts.
void find_candidates(const Question& question, const Interval& range, double tolerance, Workspace& work,
                     SearchCounts& counts);

}  // namespace rollfix
