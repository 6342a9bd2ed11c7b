#pragma once

#include <cstddef>
#include <vector>

#include "rollfix/outline/curve.hpp"

namespace rollfix {

/// A symmetric, strictly diagonally dominant tridiagonal system, cyclic where `wrap` is not zero:
///   off[i-1] x[i-1] + diagonal[i] x[i] + off[i] x[i+1] = right[i],
/// with off[i] between unknowns i and i + 1 (the last entry is not used), and `wrap` between the last and the first
/// (then at least 3 unknowns).
struct TridiagonalSystem {
  std::vector<double> diagonal;
  std::vector<double> off;
  double wrap = 0;
  std::vector<Vec2> right;
};

/// The solution. Elimination needs no pivoting because the diagonal dominates.
std::vector<Vec2> solve(TridiagonalSystem system);

}  // namespace rollfix
