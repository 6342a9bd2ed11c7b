#pragma once

#include <vector>

#include "cell_search.hpp"
#include "roll_contacts.hpp"
#include "rollfix/touch/touch.hpp"

// What a search for poses does otherwise where contacts roll.
namespace rollfix::touch {

/// Cells that are cut no finer: they are a continuum, which so many show. To weigh each of them takes longer.
inline constexpr std::size_t kEnoughCells = 20000;
inline constexpr std::size_t kEnoughToWeigh = 4000;

/// Cells that fit, from coarse ones to finer ones, down to the leaf of the tolerance. Measurements of rolls may be so
/// exact that a continuum of poses would have too many such cells: then they stay coarser, so many being enough.
/// `leaf`: of the cells.
Cells search_by_levels(CellSearch& search, const std::vector<Measured>& contacts, const TouchPair& pair, double& leaf,
                       std::size_t enough = kEnoughCells);

/// Says where rolls end.
void add_roll_ends(const std::vector<RollContact>& rolls, const std::vector<Measured>& contacts, TouchAnswer& answer);

/// What was not decided of a roll is not decided of all contacts, and rows that fit badly fit no better together.
void take_over_doubts(const std::vector<RollContact>& rolls, TouchAnswer& answer);

/// The answer of one roll as poses.
void take_from(const RollContact& roll, TouchAnswer& answer);

}  // namespace rollfix::touch
