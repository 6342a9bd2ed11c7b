#pragma once

#include <optional>

#include "observation.hpp"

// With noise: what all rows of a log, or the readings where there is no log, make of the placements.
namespace rollfix {

/// Nothing without noise.
std::optional<Belief> believe(const Problem& problem, const Observation& observed);

/// Puts what the samples leave in place of what the search found. What nothing explains is not listed.
void weigh(const Problem& problem, Belief& belief, Answer& answer);

/// After the fingers dropped some: the others' probabilities, as if there were no more.
void conclude(Belief& belief, Answer& answer);

}  // namespace rollfix
