#pragma once

#include "rollfix/locate.hpp"

namespace rollfix {

/// One finger's pivots at both ends of a roll that starts or ends at a corner: can it pivot as a placement asks?
/// `roll`: from the first contact to the furthest on both sides; `last`: to the last.
bool can_pivot(const Part& part, const Reach& reach, const Placement& placement, std::size_t finger,
               const Interval& roll, double last);

/// What is in the way of a finger that can't.
Obstruction pivot_obstruction(const Part& part, const Reach& reach, const Placement& placement, std::size_t finger);

}  // namespace rollfix
