#pragma once

#include <array>

#include "rollfix/finger_argument.hpp"
#include "rollfix/locate_outcome.hpp"
#include "rollfix/observation.hpp"
#include "rollfix/pair_outcome.hpp"

namespace rollfix::app {

/// Takes the placements out of an outcome that the finger makes impossible. Of a log all rows tell where the contact
/// has been, not only those that were searched with.
void drop(const FingerShape& shape, const Observation& observation, LocateOutcome& outcome);
void drop(const std::array<FingerShape, 2>& shapes, const PairObservation& observation, PairOutcome& outcome);

}  // namespace rollfix::app
