#pragma once

#include <cstddef>

#include "rollfix/part/part.hpp"
#include "root_search.hpp"

namespace rollfix {

/// What a sweep leaves, also of its budget.
struct Swept {
  Findings findings;
  std::size_t budget = 0;
};

/// Walks one reading's first contact s along [lo, hi] of the boundary: cuts it where s or its end s + L passes from
/// one spiral to the next, searches each piece, and looks at the pivot wherever the end passes a convex corner.
Swept sweep(const Part& part, const Reading& reading, const Interval& range, const LocateOptions& options);

}  // namespace rollfix
