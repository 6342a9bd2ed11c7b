#pragma once

#include <cmath>
#include <limits>

namespace rollfix {

// Rounding in single precision: of sums of a few turns, radians, and of lengths, as a share, as they occur in bounds.
inline constexpr double kTurnRounding = 2e-5;
inline constexpr double kShareRounding = 1e-6;

/// The nearest float that is no larger, and no smaller.
inline float float_below(double value) {
  const auto rounded = static_cast<float>(value);
  return rounded <= value ? rounded : std::nextafter(rounded, -std::numeric_limits<float>::infinity());
}
inline float float_above(double value) { return -float_below(-value); }

}  // namespace rollfix
