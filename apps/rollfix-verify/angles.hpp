#pragma once

#include <cmath>

namespace rollfix_verify {

/// A full turn, radians, to a double's digits.
inline const double kTurn = 2 * std::acos(-1.0);

/// The angle that differs by whole turns and is nearest to 0.
inline double nearest(double angle) { return std::remainder(angle, kTurn); }

}  // namespace rollfix_verify
