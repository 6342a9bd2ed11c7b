#pragma once

#include <cstddef>
#include <vector>

#include "rollfix/turning_function.hpp"

namespace rollfix {

/// The least and the largest Theta anywhere on an arc, unwrapped, the jumps of corners at its ends included. Theta is
/// monotone on a spiral: exact. Of an open boundary what lies on it.
Interval angles_over(const TurningFunction& turning, const Interval& arc);

/// Bounds on the same, at once however long the arc: from a table over equal cells, which are looked at as a whole.
class TurningRange {
 public:
  /// `cells`: of one perimeter.
  TurningRange(const TurningFunction& turning, std::size_t cells);

  /// Of a closed boundary everything is possible on a lap or more.
  Interval over(double lo, double hi) const;

 private:
  double step_;
  Boundary boundary_;
  double period_turn_;
  std::vector<std::vector<float>> least_;  // [j][i]: over the cells i, ..., i + 2^j - 1
  std::vector<std::vector<float>> most_;
};

}  // namespace rollfix
