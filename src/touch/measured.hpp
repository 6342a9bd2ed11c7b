#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "rollfix/outline/curve.hpp"

namespace rollfix::touch {

/// A touch as the search and the fit take it: what was measured, and how far each of it may be off. The units of
/// residuals are standard deviations, without noise tolerances.
struct Measured {
  Vec2 at = Vec2::Zero();
  std::optional<double> tangent{};  // direction of the part's tangent in the world, radians: normal + pi / 2
  double place_unit = 1;            // length
  double angle_unit = 1;            // radians
  double place_most = 1;            // how far it can be off: the search's tolerance, length, ...
  double angle_most = 1;            // ... and radians
};

}  // namespace rollfix::touch
