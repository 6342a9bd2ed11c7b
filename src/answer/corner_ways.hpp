#pragma once

#include <vector>

#include "rollfix/part.hpp"
#include "rollfix/reading.hpp"

namespace rollfix {

/// Lengths that their digits can't tell from a way between two corners, or from staying on one, made that way. A
/// contact on a corner pivots, and where a length is rounded it would leave the corner. `within`: how far digits can
/// have moved a length.
void put_on_corners(const Part& part, double within, std::vector<Reading>& readings);

}  // namespace rollfix
