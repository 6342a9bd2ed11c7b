#pragma once

#include <vector>

#include "placements.hpp"
#include "root_search.hpp"

namespace rollfix {

/// Joins pieces that touch into connected sets (across s = 0 on a closed outline), one placement each, and says
/// what kind of answer each is. What was found may be in any order, of all readings together.
std::vector<Placement> make_placements(const ContactEquations& question, Findings found);

}  // namespace rollfix
