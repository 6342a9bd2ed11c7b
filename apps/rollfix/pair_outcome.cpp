#include "rollfix/pair_outcome.hpp"

namespace rollfix::app {

PairFigure figure_of(const PairOutcome& outcome, const std::optional<FingerPair>& fingers) {
  PairFigure figure;
  figure.part = &outcome.part;
  figure.readings = outcome.readings;
  figure.found = outcome.found;
  figure.facing = outcome.facing;
  for (std::size_t k = 0; fingers && k < 2; ++k) {
    if (const auto disk = (*fingers)[k].disk()) figure.finger_radius[k] = disk->radius;
  }
  return figure;
}

}  // namespace rollfix::app
