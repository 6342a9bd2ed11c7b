#pragma once

#include <cstddef>
#include <vector>

#include "rollfix/part.hpp"
#include "rollfix/reading.hpp"

namespace bench {

/// What is done without a theory: f(s) = Theta(s + L) - Theta(s) - theta at so many evenly spaced places, and where it
/// changes its sign from one to the next a root by Boost's toms748_solve. One reading of one finger.
std::vector<double> locate_by_sign_changes(const rollfix::Part& part, const rollfix::Reading& reading,
                                           std::size_t samples);

}  // namespace bench
