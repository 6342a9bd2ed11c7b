#pragma once

#include <array>
#include <optional>
#include <vector>

#include "rollfix/locate/locate_pair.hpp"

namespace rollfix {

/// The largest |f_k| at (s, t), the facing equation's included, corners taken as sets: for the best choice of pivots,
/// those of the first contacts being the same for all readings.
double pair_residual(const Part& part, const std::vector<PairReading>& readings, const std::optional<double>& facing,
                     const PairPoint& at);

/// Does a contact of finger a or b, first or later, stand at a convex corner?
std::array<bool, 2> pivots_at(const Part& part, const std::vector<PairReading>& readings, const PairPoint& at);

/// The tangents at the first and last contacts that are left by corners, of finger a and of finger b.
std::array<Pivot, 2> pair_pivots(const Part& part, const std::vector<PairReading>& readings, const PairPoint& at);

}  // namespace rollfix
