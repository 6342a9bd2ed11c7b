#pragma once

#include <functional>
#include <limits>
#include <vector>

#include "rollfix/belief.hpp"
#include "rollfix/solve.hpp"

namespace rollfix {

/// A mistake in how the columns of a log are read: a unit, a sign, a name.
struct SlipOfThePen {
  Cause cause;
  std::function<void(FingerRows&)> mend;
  double log_stretch = 0;  // by how much the numbers of a row grow, and their density with them: the logarithm of it
  double left_of_roll = std::numeric_limits<double>::infinity();  // where it makes the roll shorter: how far the
                                                                  // columns still go, radians
};

/// Those that what was felt may have.
std::vector<SlipOfThePen> slips_of_the_pen(const Felt& felt);

/// The problem as it is without that mistake.
Problem without(const SlipOfThePen& slip, const Problem& problem);

}  // namespace rollfix
