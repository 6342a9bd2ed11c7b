#pragma once

#include <vector>

#include "rollfix/locate.hpp"
#include "rollfix/part.hpp"

namespace rollfix {

/// The tangent's angles anywhere in an interval of s; corners within rounding of its ends are in it.
Interval tangents_over(const Part& part, const Interval& contacts);

/// What a placement of two fingers consists of: its extent, or of a continuum boxes along its line in which both first
/// contacts move by no more than about `step`.
std::vector<PerFinger<Interval>> pieces_of(const Placement& placement, double step);

}  // namespace rollfix
