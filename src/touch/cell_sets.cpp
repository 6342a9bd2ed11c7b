#include "cell_sets.hpp"

#include <algorithm>

namespace rollfix::touch {
namespace {

/// Cells in order, and which of them are neighbours.
class Neighbours {
 public:
  Neighbours(const PathTree& first, const PathTree& second, const std::vector<Cell>& cells)
      : first_(first), second_(second), cells_(cells) {
    for (std::size_t k = 0; k < cells.size(); ++k) {
      if (k == 0 || cells[k].first != cells[k - 1].first) columns_.push_back({k, k});
      columns_.back().second = k + 1;
    }
  }

  /// Calls `found(i, j)` for neighbouring cells with the same stretch for the first touch.
  template <class Found>
  void within(const Found& found) const {
    for (const Column& column : columns_) {
      for (std::size_t k = column.first; k < column.second; ++k) each_in(column, k, found);
    }
  }

  /// The same for those with neighbouring ones.
  template <class Found>
  void between(const Found& found) const {
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      const std::size_t next = c + 1 < columns_.size() ? c + 1 : 0;
      if (next == c || !touch(first_, first(columns_[c].first), first(columns_[next].first))) continue;
      for (std::size_t k = columns_[c].first; k < columns_[c].second; ++k) each_in(columns_[next], k, found);
    }
  }

 private:
  using Column = std::pair<std::size_t, std::size_t>;

  const Interval& first(std::size_t k) const { return first_.node(cells_[k].first).number; }
  const Interval& second(std::size_t k) const { return second_.node(cells_[k].second).number; }

  /// Whether the numbers of places meet, also across the start of a closed path.
  static bool touch(const PathTree& tree, const Interval& one, const Interval& other) {
    if (one.lo <= other.hi && other.lo <= one.hi) return true;
    const double period = tree.path().period();
    return period > 0 && ((one.hi >= period && other.lo <= 0) || (other.hi >= period && one.lo <= 0));
  }

  template <class Found>
  void each_in(const Column& column, std::size_t k, const Found& found) const {
    const Interval& at = second(k);
    const auto try_one = [&](std::size_t j) {
      if (j != k && touch(second_, at, second(j)) && meet(cells_[k].heading, cells_[j].heading)) found(k, j);
    };
    std::size_t lo = column.first;
    std::size_t hi = column.second;
    while (lo < hi) {  // the first whose second touch lies no further back
      const std::size_t middle = lo + (hi - lo) / 2;
      (second(middle).hi < at.lo ? lo : hi) = second(middle).hi < at.lo ? middle + 1 : middle;
    }
    for (std::size_t j = lo; j < column.second && second(j).lo <= at.hi; ++j) try_one(j);
    try_one(column.first);  // across the start
    try_one(column.second - 1);
  }

  const PathTree& first_;
  const PathTree& second_;
  const std::vector<Cell>& cells_;
  std::vector<Column> columns_;
};

}  // namespace

std::vector<std::vector<std::size_t>> UnionFind::sets() {
  std::vector<std::vector<std::size_t>> result;
  std::vector<std::size_t> index(parent_.size(), parent_.size());
  for (std::size_t k = 0; k < parent_.size(); ++k) {
    const std::size_t root = find(k);
    if (index[root] == parent_.size()) {
      index[root] = result.size();
      result.emplace_back();
    }
    result[index[root]].push_back(k);
  }
  return result;
}

CellSets sets_of(const PathTree& first, const PathTree& second, std::vector<Cell> cells) {
  std::sort(cells.begin(), cells.end(), [&](const Cell& one, const Cell& other) {
    const double a = first.node(one.first).number.lo;
    const double b = first.node(other.first).number.lo;
    return a != b ? a < b : second.node(one.second).number.lo < second.node(other.second).number.lo;
  });
  CellSets result;
  result.cells = std::move(cells);
  const Neighbours neighbours(first, second, result.cells);
  UnionFind columns(result.cells.size());
  neighbours.within([&](std::size_t i, std::size_t j) { columns.join(i, j); });
  result.groups = columns.sets();
  std::vector<std::size_t> group_of(result.cells.size());
  for (std::size_t g = 0; g < result.groups.size(); ++g) {
    for (const std::size_t k : result.groups[g]) group_of[k] = g;
  }
  UnionFind all(result.groups.size());
  neighbours.between([&](std::size_t i, std::size_t j) {
    result.links.emplace_back(group_of[i], group_of[j]);
    all.join(group_of[i], group_of[j]);
  });
  std::sort(result.links.begin(), result.links.end());
  result.links.erase(std::unique(result.links.begin(), result.links.end()), result.links.end());
  result.components = all.sets();
  return result;
}

}  // namespace rollfix::touch
