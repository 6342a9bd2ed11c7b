#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "all_contacts.hpp"
#include "pose_sets.hpp"

// From coarse cells to finer ones, for what a search straight to the finest would not end of.
namespace rollfix::touch {

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
