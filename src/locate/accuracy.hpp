#pragma once

#include "rollfix/locate.hpp"

namespace rollfix {

/// What a simple root is accurate to: this share of the perimeter, or kRootTurn over the slope of f (of two fingers,
/// through the inverse of J).
inline constexpr double kRootLength = 1e-9;
/// |f| at a root, radians.
inline constexpr double kRootTurn = kLeastTolerance;
/// A slope of f, or a singular value of J, below this share of the curvatures that it is made of is rounding noise.
inline constexpr double kNoSlope = 1e-10;
/// The search takes places no further apart than kLengthAccuracy P for one; what bounds it has so many times that to
/// spare.
inline constexpr double kSamePlaces = 4;
/// An angle is rounded to this share of itself.
inline constexpr double kAngleRounding = 1e-15;

}  // namespace rollfix
