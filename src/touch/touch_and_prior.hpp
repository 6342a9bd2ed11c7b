#pragma once

#include <vector>

#include "pose_sets.hpp"
#include "posterior.hpp"

namespace rollfix::touch {

/// Whether what is known of the pose beforehand says where the part is.
bool knows_place(const TouchProblem& problem);

/// The posterior by one touch that has a place, or by several at one place without normals, and by what is known
/// beforehand: the nodes of a group hang together. REQUIRES that it knows the place.
std::vector<PosteriorNode> nodes_by_prior(const Asked& asked);

}  // namespace rollfix::touch
