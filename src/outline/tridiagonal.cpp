#include "outline/tridiagonal.hpp"

#include <utility>

namespace rollfix {

std::vector<Vec2> solve(TridiagonalSystem system) {
  std::vector<double>& diagonal = system.diagonal;
  const std::vector<double>& off = system.off;
  const double wrap = system.wrap;
  std::vector<Vec2>& right = system.right;
  const std::size_t last = diagonal.size() - 1;
  // border[i]: what elimination leaves between unknown i and the last one.
  std::vector<double> border(last, 0.0);
  if (last > 0) {
    border[0] = wrap;
    for (std::size_t i = 0; i + 1 < last; ++i) {
      const double factor = off[i] / diagonal[i];
      diagonal[i + 1] -= factor * off[i];
      border[i + 1] = -factor * border[i];
      right[i + 1] -= factor * right[i];
      const double last_factor = border[i] / diagonal[i];
      diagonal[last] -= last_factor * border[i];
      right[last] -= last_factor * right[i];
    }
    border[last - 1] += off[last - 1];
    const double factor = border[last - 1] / diagonal[last - 1];
    diagonal[last] -= factor * border[last - 1];
    right[last] -= factor * right[last - 1];
  }
  std::vector<Vec2>& solution = right;
  solution[last] /= diagonal[last];
  for (std::size_t i = last; i-- > 0;) {
    solution[i] -= border[i] * solution[last];
    if (i + 1 < last) solution[i] -= off[i] * solution[i + 1];
    solution[i] /= diagonal[i];
  }
  return std::move(solution);
}

}  // namespace rollfix
