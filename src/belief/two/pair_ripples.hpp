#pragma once

#include <vector>

#include "belief/nodes.hpp"

namespace rollfix::belief {

/// Tells each node what is left of its lengths and its turn, and of the distance and the direction of its centres,
/// beside the smooth course of its neighbours: the noise that it has, but for what a smooth course takes of it. Nodes
/// keep none where there are too few of them, or where the course is not smooth. Returns their covariance.
PairRipples tell_ripples(std::vector<PairNode>& nodes);

}  // namespace rollfix::belief
