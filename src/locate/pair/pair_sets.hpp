#pragma once

#include <vector>

#include "../corner_sets.hpp"
#include "components.hpp"

namespace rollfix {

/// One placement for each connected set: its kind, its roots, how sure they are; ordered by start.
std::vector<Placement> make_placements(const ContactEquations& question, const std::vector<PairCluster>& clusters);

}  // namespace rollfix
