#pragma once

#include <cstddef>
#include <vector>

#include "pair_find.hpp"

namespace rollfix {

// Lines that end closer together than this share of the perimeter continue each other.
inline constexpr double kJointWidth = 1e-8;

/// A piece that touches another one.
struct PieceLink {
  std::size_t to;
  Shift shift;  // added to the other piece brings it here
};

/// A line through all the exact pieces of a set, unwrapped.
struct FamilyLine {
  std::vector<PairPoint> points;
  double error = 0;  // how far the line may be off the set
};

/// Depth first through the exact ones among the `members` of a set; where a branch ends the line goes back the way it
/// came. REQUIRES an exact member, and of each piece the links to exact ones first.
FamilyLine line_through_family(const std::vector<PairPiece>& pieces, const std::vector<std::vector<PieceLink>>& links,
                               const std::vector<std::size_t>& members, double period);

}  // namespace rollfix
