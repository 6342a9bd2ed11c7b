#pragma once

#include <array>

#include "rollfix/finger_argument.hpp"
#include "rollfix/locate_outcome.hpp"
#include "rollfix/observation.hpp"
#include "rollfix/pair_outcome.hpp"

namespace rollfix::app {

/// Takes the placements out of an outcome that the finger makes impossible. Of a log all rows tell where the contact
/// has been, not only those that were searched with. The fingers are disks or jaws.
void drop(const Finger& finger, const Observation& observation, LocateOutcome& outcome);
void drop(const FingerPair& fingers, const PairObservation& observation, PairOutcome& outcome);

}  // namespace rollfix::app
