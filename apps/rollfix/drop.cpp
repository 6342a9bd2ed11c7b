#include "rollfix/drop.hpp"

namespace rollfix::app {

void drop(const FingerShape& shape, const Observation& observation, LocateOutcome& outcome) {
  outcome.dropped.has_finger = true;
  outcome.dropped.items = drop_unreachable(outcome.part, reach_of(outcome.part, shape), observation.readings,
                                           outcome.found, observation.rolls, length_error_of(observation.roundings));
}

void drop(const std::array<FingerShape, 2>& shapes, const PairObservation& observation, PairOutcome& outcome) {
  const Reach reach = reach_of(outcome.part, shapes[0]);
  const bool alike = shapes[0].curvature() == shapes[1].curvature();
  outcome.dropped.has_finger = true;
  outcome.dropped.items =
      drop_unreachable(outcome.part, {reach, alike ? reach : reach_of(outcome.part, shapes[1])}, observation.readings,
                       outcome.found, observation.rolls, length_error_of(observation.roundings));
}

}  // namespace rollfix::app
