#pragma once

#include <vector>

#include "belief/grid.hpp"
#include "rollfix/belief/belief.hpp"

namespace rollfix::belief {

/// What the modes are asked about, beyond the grid.
struct ModeQuestion {
  const TiltedBoundary* boundary = nullptr;
  Reading last;       // the last sample
  RowCovariance own;  // its own errors
  double perimeter = 0;
  bool closed = true;
};

/// The stretches of the boundary that hold the mass, the most probable first: two peaks of the density are two modes
/// where it falls far enough between them.
std::vector<Mode> modes_of(const Grid& grid, const ModeQuestion& question);

/// The cells that hold the mass, in order.
std::vector<Mass> mass_of(const Grid& grid, const TiltedBoundary& boundary, double perimeter);

/// The length of the boundary that holds 95 % of the mass, as short as can be.
double credible_length(const Grid& grid);

}  // namespace rollfix::belief
