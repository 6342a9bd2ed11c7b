#pragma once

#include <vector>

#include "placements.hpp"
#include "workspace.hpp"

namespace rollfix {

/// Joins pieces that touch into connected sets (across s = 0 on a closed outline), one placement each, and says
/// what kind of answer each is. What the workspace has found may be in any order, of all readings together: sorts it.
void make_placements(const Question& question, Workspace& work, std::vector<Placement>& placements);

}  // namespace rollfix
