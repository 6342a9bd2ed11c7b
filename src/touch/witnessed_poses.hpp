#pragma once

#include <vector>

#include "pose_sets.hpp"

namespace rollfix::touch {

/// Without noise: sets of poses that hold one that is known to fit, and what is left.
struct WitnessedPoses {
  std::vector<TouchPose> poses;  // by their headings
  std::vector<Cell> without;     // of sets of which it is not known whether any of their poses fits
  std::vector<Cell> undecided;   // where the budget ran out
};

/// Looks in every set of cells for a pose that fits all contacts. Sets without one are searched again, finer; they go
/// where it is proved that none does.
WitnessedPoses witnessed_poses(const Asked& asked, CellSearch& search, const std::vector<LevelSets>& levels);

}  // namespace rollfix::touch
