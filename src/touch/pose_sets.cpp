#include "pose_sets.hpp"

#include <algorithm>
#include <limits>
#include <utility>

// Notation:
//   delta, eps     tolerances of a touch's place and of its normal: `place_most`, `angle_most`
//   leaf           how fine cells are: discs have a radius of no more than leaf x delta, tangents turn by no more than
//                  leaf x eps; CellSearch::kLeaf is the finest, the coarsest has discs of kFirstDisc of the part's
//                  diagonal
//   level          cells of one leaf: LevelCells, and what hangs together of them: LevelSets
//   enough         so many cells show a continuum, which is cut no finer
// Follows docs/touch.md, "How it works".
// Idea: a pose that is held has few cells however fine they are, a continuum ever more. So cells are cut level by
// level, and only sets with few of them go on to the next one.
namespace rollfix::touch {
namespace {

// Of the least standard deviation, or tolerance, of a place: two poses that differ by less are one.
constexpr double kSame = 0.2;

// Discs of the first level, as a share of the part's diagonal, and how much finer each next one is.
constexpr double kFirstDisc = 0.02;
constexpr double kFinerLevel = 0.125;
// A set with more than this share of the cells that are enough is a continuum.
// A pose that is held has some ten or a hundred of them, however fine.
constexpr double kContinuumShare = 0.1;
// More cells than so many times what is enough are a continuum: coarser ones will do.
constexpr std::size_t kFarTooMany = CellSearch::kMostCells / kEnoughCells;

/// The leaf of the next level, no finer than what tolerances ask for.
double finer(double leaf) { return std::max(CellSearch::kLeaf, kFinerLevel * leaf); }

/// The leaf of the first level, in tolerances: discs of kFirstDisc of the diagonal, tangents of kFirstDisc radians. No
/// finer than kLeaf, where tolerances are as wide as that.
double coarsest_leaf(const std::vector<Measured>& contacts, const TouchPair& pair) {
  const double disc = kFirstDisc * contacts[pair.first].tree->path().diagonal();
  double leaf = CellSearch::kLeaf;
  for (const std::size_t k : {pair.first, pair.second}) {
    if (contacts[k].has_place) leaf = std::max(leaf, disc / contacts[k].place_most);
    if (contacts[k].tangent) leaf = std::max(leaf, kFirstDisc / contacts[k].angle_most);
  }
  return leaf;
}

/// Of a component: cells of all its groups.
std::size_t count_cells(const CellSets& sets, const std::vector<std::size_t>& groups) {
  std::size_t count = 0;
  for (const std::size_t g : groups) count += sets.groups[g].size();
  return count;
}

void add(const std::vector<Cell>& more, std::vector<Cell>& to) { to.insert(to.end(), more.begin(), more.end()); }

}  // namespace

/// All cells of these groups, in the groups' order.
std::vector<Cell> cells_of(const CellSets& sets, const std::vector<std::size_t>& groups) {
  std::vector<Cell> cells;
  for (const std::size_t g : groups) {
    for (const std::size_t k : sets.groups[g]) cells.push_back(sets.cells[k]);
  }
  return cells;
}

/// Infinite where no contact has a place.
double least_difference(const std::vector<Measured>& contacts) {
  double least = std::numeric_limits<double>::infinity();
  for (const Measured& one : contacts) {
    if (one.has_place) least = std::min(least, one.place_unit);
  }
  return kSame * least;
}

void add_set(const Asked& asked, PoseSet set, std::vector<PoseSet>& to) {
  const double least = least_difference(asked.fit.touches());
  // A set joins the first one with about its pose; the better fit of the two stays.
  for (PoseSet& known : to) {
    // Where nothing tells the place, answers are of where the contacts are.
    if (asked.place != PlaceKnown::measured) break;
    if (asked.fit.distance(known.fitted.pose, set.fitted.pose) > least) continue;
    if (set.fitted.square < known.fitted.square) known.fitted = std::move(set.fitted);
    known.cells.insert(known.cells.end(), set.cells.begin(), set.cells.end());
    known.mode.nodes.insert(known.mode.nodes.end(), set.mode.nodes.begin(), set.mode.nodes.end());
    known.mode.probability += set.mode.probability;
    return;
  }
  to.push_back(std::move(set));
}

/// `search` starts anew where the first one is abandoned, so that its own comparisons begin at 0.
LevelCells search_levels(std::optional<CellSearch>& search, const AllContacts& contacts, const TouchPair& pair,
                         std::size_t budget, std::size_t enough) {
  LevelCells level;
  // Of a search that meets so many cells, the finest leaf is too fine for a continuum.
  const std::size_t most = kFarTooMany * enough;
  search.emplace(contacts.each, pair, budget, most);
  // Of touches alone the finest leaf is tried first: mostly it has few cells.
  if (contacts.rolls.empty()) {
    level.cells = search->search();
    if (level.cells.undecided.empty()) return level;
    level.abandoned = search->comparisons();
    search.emplace(contacts.each, pair, budget, most);
  }
  // From coarse to fine: each level cuts the cells of the last one, until there are enough to show a continuum.
  level.leaf = coarsest_leaf(contacts.each, pair);
  level.cells = search->search(level.leaf);
  while (level.leaf > CellSearch::kLeaf && level.cells.fit.size() < enough && level.cells.undecided.empty()) {
    level.leaf = finer(level.leaf);
    level.cells = search->search(level.cells.fit, level.leaf);
  }
  return level;
}

/// Each turn: `cells` are all of one leaf that no set of a coarser level holds. Blocked ones go, sets of few cells are
/// cut to the next leaf, sets of many stay as they are.
std::vector<LevelSets> cut_sets(const Asked& asked, CellSearch& search, LevelCells from, std::size_t enough) {
  const PathTree& first = asked.fit.tree(asked.pair.first);
  const PathTree& second = asked.fit.tree(asked.pair.second);
  const auto of_continuum = static_cast<std::size_t>(kContinuumShare * static_cast<double>(enough));
  std::vector<LevelSets> levels;
  std::vector<Cell> cells = std::move(from.cells.fit);
  for (double leaf = from.leaf;; leaf = finer(leaf)) {
    asked.free.drop_blocked(cells, first, asked.fit.touches()[asked.pair.first]);
    CellSets sets = sets_of(first, second, std::move(cells));
    // The finest level takes all that is left.
    if (leaf <= CellSearch::kLeaf) {
      levels.push_back({std::move(sets), leaf});
      return levels;
    }
    std::vector<Cell> few;
    std::vector<Cell> kept;
    for (const std::vector<std::size_t>& component : sets.components) {
      add(cells_of(sets, component), count_cells(sets, component) < of_continuum ? few : kept);
    }
    // Where the budget ends while cutting, the sets stay at this leaf: a coarser cover, but still a cover.
    Cells cut = search.search(few, finer(leaf));
    const bool is_last = few.empty() || !cut.undecided.empty();
    if (is_last) add(few, kept);
    // Components do not change: cells that were apart at this leaf stay apart.
    if (!kept.empty()) levels.push_back({sets_of(first, second, std::move(kept)), leaf});
    if (is_last) return levels;
    cells = std::move(cut.fit);
  }
}

/// Indices of cells and of groups are moved on by those of the levels before. Sets of different levels have no links:
/// they were different components at the coarser one.
CellSets together(std::vector<LevelSets> levels) {
  CellSets all;
  for (LevelSets& level : levels) {
    CellSets& sets = level.sets;
    const std::size_t cells = all.cells.size();
    const std::size_t groups = all.groups.size();
    all.cells.insert(all.cells.end(), sets.cells.begin(), sets.cells.end());
    for (std::vector<std::size_t>& group : sets.groups) {
      for (std::size_t& cell : group) cell += cells;
      all.groups.push_back(std::move(group));
    }
    for (const auto& [one, other] : sets.links) all.links.emplace_back(one + groups, other + groups);
    for (std::vector<std::size_t>& component : sets.components) {
      for (std::size_t& group : component) group += groups;
      all.components.push_back(std::move(component));
    }
  }
  return all;
}

}  // namespace rollfix::touch
