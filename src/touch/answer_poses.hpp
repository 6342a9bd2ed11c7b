#pragma once

#include <array>
#include <optional>
#include <vector>

#include "cell_search.hpp"
#include "cell_sets.hpp"
#include "pose_fit.hpp"
#include "posterior.hpp"
#include "rollfix/touch/touch.hpp"

namespace rollfix::touch {

/// The share of its tolerance that the worst residual takes.
double worst_of(const PoseFit& fit, const FittedPose& fitted);

/// Around all poses that have their first two contacts on one of the cells: x, y and the heading, which is unwrapped
/// about that of `about`.
std::array<Interval, 3> extent_of(const PoseFit& fit, const std::vector<Cell>& cells, const TouchPair& pair,
                                  const Pose& about);

/// A fitted pose as the answer has it, with all that cells say of its set: extent, and whether it is a continuum.
TouchPose described(const PoseFit& fit, const FittedPose& fitted, const std::vector<Cell>& cells,
                    const TouchPair& pair);

/// Adds what the posterior knows of a mode.
void add_posterior(TouchPose& pose, const PoseMode& mode, const std::vector<PosteriorNode>& nodes);

/// The fitted pose with the least largest residual, as a share of its tolerance: from a few of the set's cells.
FittedPose best_within(PoseFit& fit, const std::vector<Cell>& cells, const TouchPair& pair);

}  // namespace rollfix::touch
