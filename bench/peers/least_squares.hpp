#pragma once

#include <vector>

#include "rollfix/locate.hpp"

namespace bench {

/// The method that came before: eqs. (8) and (9) as a nonlinear least-squares problem in (s0, t0), from `starts` places
/// drawn at random. Returns the pairs at which it vanishes, each once. Two readings.
std::vector<rollfix::PerFinger<double>> locate_by_least_squares(const rollfix::Part& part,
                                                                const std::vector<rollfix::Reading>& readings,
                                                                int starts);

}  // namespace bench
