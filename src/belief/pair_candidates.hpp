#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "belief/pair_filter.hpp"
#include "rollfix/part/turning_function.hpp"

namespace rollfix::belief {

/// The least and the largest tangent's angle on any stretch of a boundary.
class TurningRange {
 public:
  explicit TurningRange(const TurningFunction& turning);

  Interval over(double lo, double hi) const;

 private:
  const TurningFunction* turning_;
  double step_;
  std::size_t cells_;                      // of one perimeter
  std::vector<std::vector<float>> least_;  // [j][i]: over the cells i, ..., i + 2^j - 1
  std::vector<std::vector<float>> most_;
};

/// A square of first contacts (s, t), in cells of a grid over both perimeters.
struct PairSquare {
  std::uint32_t i = 0;
  std::uint32_t j = 0;
};

/// Where the first contacts can be at all.
struct PairCandidates {
  std::vector<PairSquare> squares;
  std::uint32_t cells = 0;  // of the grid, along a perimeter
  double missed = 0;        // no more than this is the chance that the true ones are elsewhere, the noise being as said
};

/// Branch and prune over all pairs: a square is refused when no pair in it explains some rows, each of whose contacts
/// may lie anywhere within `sigmas` standard deviations of where it was felt. `resolution`: length of the squares.
PairCandidates pair_candidates(const PairModel& model, const TurningRange& range, const std::vector<PairNode>& nodes,
                               double sigmas, double resolution);

/// All squares there are: where even wide errors leave none.
PairCandidates all_squares();

}  // namespace rollfix::belief
