#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "cell_search.hpp"
#include "free_space.hpp"
#include "pose_fit.hpp"
#include "posterior.hpp"
#include "problem.hpp"
#include "rollfix/touch.hpp"

// What hangs together, from coarse cells to finer ones, for what a search straight to the finest would not end of; and
// the poses in it, without noise each with a witness, with noise by how probable they are.
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

/// Without noise: sets of poses that hold one that is known to fit, and what is left.
struct WitnessedPoses {
  std::vector<TouchPose> poses;  // by their headings
  std::vector<Cell> without;     // of sets of which it is not known whether any of their poses fits
  std::vector<Cell> undecided;   // where the budget ran out
};

/// Looks in every set of cells for a pose that fits all contacts. Sets without one are searched again, finer; they go
/// where it is proved that none does.
WitnessedPoses witnessed_poses(const Asked& asked, CellSearch& search, const std::vector<LevelSets>& levels);

/// Whether what is known of the pose beforehand says where the part is.
bool knows_place(const TouchProblem& problem);

/// The posterior by one touch that has a place, or by several at one place without normals, and by what is known
/// beforehand: the nodes of a group hang together. REQUIRES that it knows the place.
std::vector<PosteriorNode> nodes_by_prior(const Asked& asked);

/// The posterior as a list of poses.
struct WeighedPoses {
  std::vector<TouchPose> poses;        // the most probable first
  std::optional<TouchFit> fit;         // of the one that fits best
  std::size_t improbable = 0;          // sets that are not listed, ...
  double rest = 0;                     // ... and their probability
  std::optional<double> log_evidence;  // but for what rolls say of themselves, and contacts' own places
  bool is_too_long = false;            // so many places that they were not weighed
};

/// The most probable first; those that are as probable, as of a symmetric part, by their headings.
void put_in_order(std::vector<TouchPose>& poses);

/// The boundary's length as far as the finger gets to it, of a corner that of the finger's arc around it.
double length_in_reach(const CentrePath& path);

/// With noise: what is less probable than a bound is not looked at, and modes that end in one pose are one.
WeighedPoses weighed_poses(const Asked& asked, const CellSets& sets, std::size_t budget);

/// By one touch and what is known of the pose beforehand.
WeighedPoses weighed_by_prior(const Asked& asked);

}  // namespace rollfix::touch
