#pragma once

#include <vector>

#include "observation.hpp"
#include "rollfix/belief.hpp"
#include "rollfix/solve.hpp"

namespace rollfix {

/// What may be wrong where the rows fit badly: the usual mistakes are tried, each estimated by the rows. Those with
/// which the rows fit, else those with which they fit far better, the likeliest first; Cause::part alone where nothing
/// does. Nothing where they fit.
std::vector<Diagnosis> diagnose(const Problem& problem, const Observation& observed, Belief& belief);

}  // namespace rollfix
