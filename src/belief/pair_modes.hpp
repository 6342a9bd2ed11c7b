#pragma once

#include <vector>

#include "belief/pair_lattice.hpp"
#include "rollfix/belief/pair_belief.hpp"

namespace rollfix::belief {

struct PairModes {
  std::vector<PairMode> modes;  // the most probable first
  std::vector<PairMass> mass;
};

/// The connected pieces of a density: two peaks are two modes where it falls far enough on every way between them.
PairModes modes_of(const PairDensity& density, const PairModel& model, const PairReading& last);

}  // namespace rollfix::belief
