#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "belief/pair_filter.hpp"
#include "belief/pair_starts.hpp"

namespace rollfix::belief {

/// A point within a leaf, where its mass is summed.
struct PairGrain {
  std::array<double, 2> s{};      // of finger a and b, unwrapped from the region's origin on
  std::array<double, 2> angle{};  // of the tangents, unwrapped likewise
  double share = 0;               // of the posterior's mass
};

/// A little of the density: a square of a region's own grid.
struct PairLeaf {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  // in the region's coordinates
  double size = 1;
  PairStart start;
  PairScore score;
  double log_density = 0;  // by (w_a, w_b) with the prior on the boundary, up to a constant
  double share = 0;
  std::vector<PairGrain> grains;
};

/// A connected piece of what the density leaves, on a grid of its own, which is turned and scaled so that a square is
/// about a standard deviation wide: it spreads from a peak to wherever the density is not negligible.
struct PairRegion {
  PairStart origin;
  std::array<double, 2> origin_s{};
  Eigen::Matrix2d frame = Eigen::Matrix2d::Identity();  // from the region's coordinates to (w_a, w_b)
  Eigen::Matrix2d back = Eigen::Matrix2d::Identity();
  std::vector<PairLeaf> leaves;
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> leaves_of;  // of each whole square
  std::vector<PairStart> beyond;  // where it leaves the half loop either way that it covers

  /// The leaf at these coordinates; none: leaves.size().
  std::size_t leaf_at(const Eigen::Vector2d& y) const;
  bool covers(const PairStart& start) const;
};

/// The posterior of two first contacts where it is not negligible.
struct PairDensity {
  std::vector<PairRegion> regions;
  double rest = 0;  // a bound on the share of what was not resolved
};

/// Spreads from the peaks, the likeliest first. `excess`: by how much the rows are off more than their noise.
/// `corner_length`: what a radian of pivoting counts as, length, of each finger.
PairDensity pair_density(const PairModel& model, const std::vector<PairPeak>& peaks, const std::vector<PairNode>& nodes,
                         double excess, const std::array<double, 2>& corner_length);

}  // namespace rollfix::belief
