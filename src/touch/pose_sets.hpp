#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "all_contacts.hpp"
#include "cell_search.hpp"
#include "free_space.hpp"
#include "pose_fit.hpp"
#include "posterior.hpp"
#include "rollfix/touch.hpp"

// What hangs together, and the poses in it; from coarse cells to finer ones, for what a search straight to the finest
// would not end of.
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

/// Cells that are cut no finer: they are a continuum, which so many show. To weigh each of them takes longer.
inline constexpr std::size_t kEnoughCells = 20000;
inline constexpr std::size_t kEnoughToWeigh = 4000;

/// Cells that fit, how fine they are, and comparisons of a search for finer ones that did not end.
struct LevelCells {
  Cells cells;
  double leaf = CellSearch::kLeaf;
  std::size_t abandoned = 0;
};

/// Cells down to the leaf of the tolerances. Measurements may be so exact that a continuum of poses would have too many
/// such cells: then they stay coarser, so many being enough. That can be of rolls; of touches alone the leaf is tried
/// first. `search`: the one that has found them.
LevelCells search_levels(std::optional<CellSearch>& search, const AllContacts& contacts, const TouchPair& pair,
                         std::size_t budget, std::size_t enough);

/// Sets of cells of one fineness.
struct LevelSets {
  CellSets sets;
  double leaf = CellSearch::kLeaf;
};

/// What hangs together of the cells that no path blocks. Of coarser ones sets with few, next to what was enough of them
/// all, are cut finer, so that a pose beside a continuum is told from it; as far as the budget goes.
std::vector<LevelSets> cut_sets(const Asked& asked, CellSearch& search, LevelCells from, std::size_t enough);

/// Sets of all levels.
CellSets together(std::vector<LevelSets> levels);

}  // namespace rollfix::touch
