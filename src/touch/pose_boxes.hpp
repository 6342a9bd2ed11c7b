#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "cell_search.hpp"
#include "pose_fit.hpp"

namespace rollfix::touch {

/// What boxes of poses came to.
struct BoxesFound {
  std::optional<FittedPose> witness;  // a pose with every residual within its tolerance
  bool refuted = false;               // there is none; neither: the budget ran out
};

/// Whether some pose with its first two contacts on one of the cells fits all touches. In a single pose touches have
/// nothing to do with each other, so halving boxes of poses decides it, where pairs of places leave near misses.
BoxesFound search_boxes(PoseFit& fit, const std::vector<Cell>& cells, const TouchPair& pair, std::size_t budget);

}  // namespace rollfix::touch
