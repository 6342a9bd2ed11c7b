#pragma once

#include <vector>

#include "cell_search.hpp"
#include "cell_sets.hpp"
#include "free_space.hpp"
#include "pose_fit.hpp"
#include "posterior.hpp"
#include "rollfix/touch.hpp"

namespace rollfix::touch {

/// What every step after the search for cells looks at.
struct Asked {
  const TouchProblem& problem;
  PoseFit& fit;
  TouchPair pair;
  FreeSpace& free;
  PlaceKnown place;  // what the contacts tell of the part's place
};

/// Cells that hang together, with the pose that fits best.
struct PoseSet {
  FittedPose fitted;
  std::vector<Cell> cells;
  PoseMode mode{};  // with noise
};

std::vector<Cell> cells_of(const CellSets& sets, const std::vector<std::size_t>& groups);

/// Adds a set to those with another pose. One pose can have several: of touches near a bump more than one place fits.
void add_set(const Asked& asked, PoseSet set, std::vector<PoseSet>& to);

/// Poses are one where they differ by less than this: a share of the least standard deviation, or tolerance, of a
/// place.
double least_difference(const std::vector<Measured>& contacts);

}  // namespace rollfix::touch
