#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace rollfix {

/// What one finger adds to the equations: (8) and (9) say that two curves meet, A(s) of finger a and B(t) of finger b,
/// with the components Theta(s + L_k) - Theta(s) + shift_k, one for each reading, and with the facing equation one
/// more, Theta(s) + facing.
struct RollEquations {
  std::vector<double> lengths;   // L_k
  std::vector<double> shifts;    // added to each component, radians
  std::optional<double> facing;  // added to Theta(s)

  std::size_t rows() const { return lengths.size() + (facing ? 1 : 0); }
  std::size_t contacts() const { return lengths.size() + 1; }
  /// From the first contact to contact c.
  double length_to(std::size_t c) const { return c == 0 ? 0 : lengths[c - 1]; }
};

}  // namespace rollfix
