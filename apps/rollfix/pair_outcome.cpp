#include "rollfix/pair_outcome.hpp"

namespace rollfix::app {

PairFigure figure_of(const PairOutcome& outcome, const std::optional<FingerPair>& fingers) {
  PairFigure figure;
  figure.part = &outcome.part;
  figure.readings = outcome.readings;
  figure.found = outcome.found;
  figure.facing = outcome.facing;
  if (fingers) figure.finger_radius = {(*fingers)[0].radius, (*fingers)[1].radius};
  return figure;
}

}  // namespace rollfix::app
