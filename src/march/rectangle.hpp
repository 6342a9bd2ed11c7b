#pragma once

#include "march/correspondence.hpp"

namespace rollfix::march {

/// Steps of section 3.2 by what they are for.
struct RectangleTallies {
  Tally iteration;
  Tally bisection;
};

/// Section 3.2: all pairs in one pair of monotone intervals, along its correspondence.
/// Adds pairs, not reduced to one loop, doubts and counts to `result`.
void search_rectangle(const Correspondence& way, const PairMarchOptions& options, RectangleTallies& tallies,
                      PairResult& result);

}  // namespace rollfix::march
