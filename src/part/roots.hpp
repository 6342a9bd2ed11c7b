#pragma once

#include <vector>

#include "chebyshev.hpp"

namespace rollfix {

/// Where a polynomial, given by its powers, changes sign strictly inside (-1, 1), in rising order.
/// All of them: an interval is left only when a bound on the polynomial, or on its derivative, excludes more.
std::vector<double> sign_changes(const chebyshev::Series& powers);

}  // namespace rollfix
