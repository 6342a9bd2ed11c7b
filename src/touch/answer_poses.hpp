#pragma once

#include <array>
#include <optional>
#include <vector>

#include "cell_search.hpp"
#include "pose_fit.hpp"
#include "posterior.hpp"
#include "rollfix/touch.hpp"

namespace rollfix::touch {

/// Where a contact is in a pose that it need not fit.
TouchContact nearest_contact(const PoseFit& fit, const Pose& pose, std::size_t touch);

/// The share of its tolerance that the worst residual takes.
/// 1 or less means that all of them are within their tolerances.
double worst_of(const PoseFit& fit, const FittedPose& fitted);

/// Intervals of x, y and the heading, in radians.
using PoseExtent = std::array<Interval, 3>;

/// Around all poses that have their first two contacts on one of the cells; the heading is unwrapped about that of
/// `about`.
/// An outer bound: poses of the box need not fit.
PoseExtent extent_of(const PoseFit& fit, const std::vector<Cell>& cells, const TouchPair& pair, const Pose& about);

/// Around the nodes of a mode, each with its own spread.
PoseExtent extent_of(const PoseMode& mode, const std::vector<PosteriorNode>& nodes, const Pose& about);

/// Whether a pose is in an extent, or no further from it than these; modulo turns.
bool holds(const PoseExtent& extent, const Pose& pose, double place = 0, double turn = 0);

/// Arcs of the boundary that the first touch's nodes of cells cover. `tree`: its own.
std::vector<Interval> places_of(const PathTree& tree, const std::vector<Cell>& cells);

/// A fitted pose as the answer has it, with all that cells say of its set: extent, and whether it is a continuum.
TouchPose described(const PoseFit& fit, const FittedPose& fitted, const std::vector<Cell>& cells,
                    const TouchPair& pair);

/// Adds what the posterior knows of a mode.
/// REQUIRES a mode with nodes.
void add_posterior(TouchPose& pose, const PoseMode& mode, const std::vector<PosteriorNode>& nodes);

}  // namespace rollfix::touch
