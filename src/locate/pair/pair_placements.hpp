#pragma once

#include <optional>
#include <vector>

#include "components.hpp"

namespace rollfix {

/// One placement for each connected set: its kind, its roots, how sure they are; ordered by start.
std::vector<PairPlacement> make_pair_placements(const Part& part, const std::vector<PairReading>& readings,
                                                const std::optional<double>& facing,
                                                const std::vector<PairCluster>& clusters);

}  // namespace rollfix
