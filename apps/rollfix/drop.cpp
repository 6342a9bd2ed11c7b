#include "rollfix/drop.hpp"

namespace rollfix::app {

void drop(const Finger& finger, const Observation& observation, LocateOutcome& outcome) {
  outcome.dropped.has_finger = true;
  outcome.dropped.items = drop_unreachable(outcome.part, reach_of(outcome.part, finger), observation.readings,
                                           outcome.found, observation.rolls, length_error_of(observation.roundings));
}

void drop(const FingerPair& fingers, const PairObservation& observation, PairOutcome& outcome) {
  const Reach reach = reach_of(outcome.part, fingers[0]);
  const bool alike = fingers[0].curvature(0) == fingers[1].curvature(0);
  outcome.dropped.has_finger = true;
  outcome.dropped.items =
      drop_unreachable(outcome.part, {reach, alike ? reach : reach_of(outcome.part, fingers[1])}, observation.readings,
                       outcome.found, observation.rolls, length_error_of(observation.roundings));
}

}  // namespace rollfix::app
