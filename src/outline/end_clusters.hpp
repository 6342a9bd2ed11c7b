#pragma once

#include <cstddef>
#include <vector>

#include "rollfix/outline/curve.hpp"

namespace rollfix {

/// Points sorted into clusters: two that are within `gap` of each other are in the same one, and so are those that are
/// linked by others in between.
class EndClusters {
 public:
  /// gap > 0. Linear in the number of points but for those that crowd together.
  EndClusters(const std::vector<Vec2>& points, double gap);

  std::size_t of(std::size_t point) const { return cluster_[point]; }
  /// The points of a cluster, in rising order.
  const std::vector<std::size_t>& members(std::size_t cluster) const { return members_[cluster]; }

 private:
  std::vector<std::size_t> cluster_;
  std::vector<std::vector<std::size_t>> members_;
};

}  // namespace rollfix
