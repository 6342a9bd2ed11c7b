#pragma once

#include "hold_fit.hpp"
#include "hold_modes.hpp"
#include "rollfix/hold.hpp"

namespace rollfix::hold {

/// A state as the answer has it: places at the first and the last instant, poses, residuals; extents of its set.
HoldPlacement described(const HoldFit& fit, const Part& part, const HeldState& state, const HeldSet& set);

/// Adds what the posterior knows of a mode, but for its probability.
void add_posterior(HoldPlacement& placement, const HoldFit& fit, const Part& part, const HoldMode& mode);

/// How well a state fits the noise.
TouchFit fit_of(const HoldFit& fit, const HeldState& state);

}  // namespace rollfix::hold
