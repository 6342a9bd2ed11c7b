#pragma once

#include <vector>

#include "observation.hpp"
#include "rollfix/solve.hpp"

namespace rollfix {

/// Takes the placements out of a list in which two fingers of any shape are in one another in some row of their log,
/// from wherever in its extent they started. With an outline it takes u: of readings nothing goes. `length_error`: how
/// far a length, or a contact on a finger, may be off.
std::vector<Impossible> drop_overlapping(const Problem& problem, const Observation& observed, double length_error,
                                         std::vector<Placement>& placements);

}  // namespace rollfix
