#pragma once

#include "oracle/boundary.hpp"
#include "rollfix/locate.hpp"

namespace oracle {

/// Radians by which the library may have f wrong: up to four tangents, each rounded, and the last digits of s.
inline Real doubt(const Boundary& boundary) {
  constexpr Real kLastDigits = 4e-16L;
  return rollfix::kLeastTolerance + kLastDigits * boundary.most_curvature() * boundary.perimeter();
}

}  // namespace oracle
