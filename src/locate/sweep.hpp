#pragma once

#include "rollfix/part/part.hpp"
#include "root_search.hpp"

namespace rollfix {

/// Walks one reading's first contact s along [lo, hi] of the boundary: cuts it where s or its end s + L passes from
/// one spiral to the next, searches each piece, and looks at the pivot wherever the end passes a convex corner.
void sweep(const Part& part, const Reading& reading, const Interval& range, RootSearch& search, Findings& findings,
           const LocateOptions& options);

}  // namespace rollfix
