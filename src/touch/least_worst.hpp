#pragma once

#include <vector>

#include "cell_search.hpp"
#include "pose_fit.hpp"

namespace rollfix::touch {

/// The fitted pose whose worst residual is least, as a share of its tolerance: from a few of the set's cells, until one
/// is within all tolerances.
FittedPose best_within(const PoseFit& fit, const std::vector<Cell>& cells, const TouchPair& pair);

}  // namespace rollfix::touch
