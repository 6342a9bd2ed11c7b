#include "cell_levels.hpp"

#include <algorithm>
#include <utility>

namespace rollfix::touch {
namespace {

// Discs of the first level, as a share of the part's diagonal, and how much
// finer each next one is.
constexpr double kFirstDisc = 0.02;
constexpr double kFinerLevel = 0.125;
// A set with more than this share of the cells that are enough is a continuum.
// A pose that is held has some ten or a hundred of them, however fine.
constexpr double kContinuumShare = 0.1;
// More cells than so many times what is enough are a continuum: coarser ones will do.
constexpr std::size_t kFarTooMany = CellSearch::kMostCells / kEnoughCells;

double finer(double leaf) { return std::max(CellSearch::kLeaf, kFinerLevel * leaf); }

double coarsest_leaf(const std::vector<Measured>& contacts, const TouchPair& pair) {
  const double disc = kFirstDisc * contacts[pair.first].tree->path().diagonal();
  double leaf = CellSearch::kLeaf;
  for (const std::size_t k : {pair.first, pair.second}) {
    if (contacts[k].has_place) leaf = std::max(leaf, disc / contacts[k].place_most);
    if (contacts[k].tangent) leaf = std::max(leaf, kFirstDisc / contacts[k].angle_most);
  }
  return leaf;
}

std::size_t count_cells(const CellSets& sets, const std::vector<std::size_t>& groups) {
  std::size_t count = 0;
  for (const std::size_t g : groups) count += sets.groups[g].size();
  return count;
}

void add(const std::vector<Cell>& more, std::vector<Cell>& to) { to.insert(to.end(), more.begin(), more.end()); }

}  // namespace

LevelCells search_levels(std::optional<CellSearch>& search, const AllContacts& contacts, const TouchPair& pair,
                         std::size_t budget, std::size_t enough) {
  LevelCells level;
  const std::size_t most = kFarTooMany * enough;
  search.emplace(contacts.each, pair, budget, most);
  if (contacts.rolls.empty()) {
    level.cells = search->search();
    if (level.cells.undecided.empty()) return level;
    level.abandoned = search->comparisons();
    search.emplace(contacts.each, pair, budget, most);
  }
  level.leaf = coarsest_leaf(contacts.each, pair);
  level.cells = search->search(level.leaf);
  while (level.leaf > CellSearch::kLeaf && level.cells.fit.size() < enough && level.cells.undecided.empty()) {
    level.leaf = finer(level.leaf);
    level.cells = search->search(level.cells.fit, level.leaf);
  }
  return level;
}

std::vector<LevelSets> cut_sets(const Asked& asked, CellSearch& search, LevelCells from, std::size_t enough) {
  const PathTree& first = asked.fit.tree(asked.pair.first);
  const PathTree& second = asked.fit.tree(asked.pair.second);
  const auto of_continuum = static_cast<std::size_t>(kContinuumShare * static_cast<double>(enough));
  std::vector<LevelSets> levels;
  std::vector<Cell> cells = std::move(from.cells.fit);
  for (double leaf = from.leaf;; leaf = finer(leaf)) {
    asked.free.drop_blocked(cells, first, asked.fit.touches()[asked.pair.first]);
    CellSets sets = sets_of(first, second, std::move(cells));
    if (leaf <= CellSearch::kLeaf) {
      levels.push_back({std::move(sets), leaf});
      return levels;
    }
    std::vector<Cell> few;
    std::vector<Cell> kept;
    for (const std::vector<std::size_t>& component : sets.components) {
      add(cells_of(sets, component), count_cells(sets, component) < of_continuum ? few : kept);
    }
    Cells cut = search.search(few, finer(leaf));
    const bool is_last = few.empty() || !cut.undecided.empty();
    if (is_last) add(few, kept);
    if (!kept.empty()) levels.push_back({sets_of(first, second, std::move(kept)), leaf});
    if (is_last) return levels;
    cells = std::move(cut.fit);
  }
}

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
