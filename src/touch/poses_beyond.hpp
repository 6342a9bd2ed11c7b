#pragma once

#include <vector>

#include "rollfix/touch/touch.hpp"

namespace rollfix::touch {

/// Every set of poses within the tolerances, with noise those that its search starts from, that is in no extent of
/// these: nothing is weighed, and nothing is left out as improbable or in the way. REQUIRES a valid problem of two
/// touches or more, without rolls, prior and clear paths.
TouchAnswer poses_beyond(const TouchProblem& problem, const std::vector<TouchPose>& known);

}  // namespace rollfix::touch
