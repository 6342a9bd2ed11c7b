#pragma once

#include <cstddef>
#include <numeric>
#include <vector>

namespace rollfix {

/// Disjoint sets of the numbers below `count`, at first of one number each, that are joined one by one (union and find,
/// with path halving, without ranks).
class UnionFind {
 public:
  explicit UnionFind(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), std::size_t{0}); }

  /// The number that stands for the set that k is in.
  std::size_t find(std::size_t k) {
    while (parent_[k] != k) k = parent_[k] = parent_[parent_[k]];
    return k;
  }

  /// The other's set becomes part of the first's, which keeps the number that stands for it.
  void join(std::size_t keep, std::size_t other) { parent_[find(other)] = find(keep); }

  /// The sets' members in rising order, the sets in that of their first ones.
  std::vector<std::vector<std::size_t>> sets() {
    std::vector<std::vector<std::size_t>> result;
    std::vector<std::size_t> index(parent_.size(), parent_.size());  // of each root's set
    for (std::size_t k = 0; k < parent_.size(); ++k) {
      std::size_t& set = index[find(k)];
      if (set == parent_.size()) {
        set = result.size();
        result.emplace_back();
      }
      result[set].push_back(k);
    }
    return result;
  }

 private:
  std::vector<std::size_t> parent_;  // of a root the root itself
};

}  // namespace rollfix
