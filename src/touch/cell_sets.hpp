#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "cell_search.hpp"

namespace rollfix::touch {

/// How cells hang together. Two are neighbours if the places of each touch are, and headings meet.
struct CellSets {
  std::vector<Cell> cells;                                 // by the first touch's place
  std::vector<std::vector<std::size_t>> groups;            // neighbouring cells with one stretch for the first touch
  std::vector<std::pair<std::size_t, std::size_t>> links;  // of neighbouring groups
  std::vector<std::vector<std::size_t>> components;        // groups that hang together
};

/// `first`, `second`: the trees that the cells' nodes are of.
CellSets sets_of(const PathTree& first, const PathTree& second, std::vector<Cell> cells);

/// Sets that are joined one by one.
class UnionFind {
 public:
  explicit UnionFind(std::size_t count) : parent_(count) {
    for (std::size_t k = 0; k < count; ++k) parent_[k] = k;
  }
  std::size_t find(std::size_t k) {
    while (parent_[k] != k) k = parent_[k] = parent_[parent_[k]];
    return k;
  }
  /// The second's set becomes part of the first's.
  void join(std::size_t one, std::size_t other) { parent_[find(other)] = find(one); }
  /// The sets' members, in order of their first ones.
  std::vector<std::vector<std::size_t>> sets();

 private:
  std::vector<std::size_t> parent_;
};

}  // namespace rollfix::touch
