#include "outline/end_clusters.hpp"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <numeric>
#include <unordered_map>

namespace rollfix {

namespace {

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

/// Disjoint sets with path halving.
class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), std::size_t{0}); }

  std::size_t root(std::size_t one) {
    while (parent_[one] != one) one = parent_[one] = parent_[parent_[one]];
    return one;
  }
  void join(std::size_t a, std::size_t b) {
    const std::size_t first = std::min(root(a), root(b));
    parent_[std::max(root(a), root(b))] = first;
  }

 private:
  std::vector<std::size_t> parent_;
};

/// A square of the grid. Its diagonal is just below the gap: all points in one square are one cluster.
struct Square {
  std::int64_t column = 0;
  std::int64_t row = 0;
  bool operator==(const Square& other) const { return column == other.column && row == other.row; }
};

struct SquareHash {
  std::size_t operator()(const Square& square) const {
    const std::uint64_t mixed =
        static_cast<std::uint64_t>(square.column) * 0x9E3779B97F4A7C15U ^ static_cast<std::uint64_t>(square.row);
    return std::hash<std::uint64_t>()(mixed);
  }
};

}  // namespace

EndClusters::EndClusters(const std::vector<Vec2>& points, double gap) : cluster_(points.size(), kNone) {
  Sets sets(points.size());
  std::unordered_map<Square, std::vector<std::size_t>, SquareHash> grid;
  const double side = 0.7 * gap;
  Vec2 corner = points.empty() ? Vec2(0, 0) : points.front();
  for (const Vec2& point : points) corner = corner.cwiseMin(point);
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Square own{static_cast<std::int64_t>((points[k].x() - corner.x()) / side),
                     static_cast<std::int64_t>((points[k].y() - corner.y()) / side)};
    // Two squares to each side are near enough to hold a point within the gap.
    for (std::int64_t column = own.column - 2; column <= own.column + 2; ++column) {
      for (std::int64_t row = own.row - 2; row <= own.row + 2; ++row) {
        const auto found = grid.find({column, row});
        if (found == grid.end() || sets.root(found->second.front()) == sets.root(k)) continue;
        const auto near = [&](std::size_t other) { return (points[other] - points[k]).norm() <= gap; };
        const auto link = std::find_if(found->second.begin(), found->second.end(), near);
        if (link != found->second.end()) sets.join(*link, k);
      }
    }
    grid[own].push_back(k);
  }
  for (std::size_t k = 0; k < points.size(); ++k) {
    const std::size_t root = sets.root(k);  // never above k: it has its number by now
    if (root == k) {
      cluster_[k] = members_.size();
      members_.emplace_back();
    } else {
      cluster_[k] = cluster_[root];
    }
    members_[cluster_[k]].push_back(k);
  }
}

}  // namespace rollfix
