#pragma once

#include <vector>

#include "rollfix/curve.hpp"
#include "rollfix/reading.hpp"

namespace bench {

/// Certainty as it is to be had elsewhere: every start of one finger's reading on the ellipse x = a cos u, y = b sin u,
/// isolated and proved by Arb's arb_calc_isolate_roots with rigorous ball arithmetic, the arc length by its elliptic
/// integrals.
struct ProvedRoots {
  std::vector<rollfix::Interval> starts;  // each holds exactly one start, arc length from u = 0
  int undecided = 0;                      // stretches of which it could not say
};
ProvedRoots locate_by_arb(double a, double b, const rollfix::Reading& reading);

}  // namespace bench
