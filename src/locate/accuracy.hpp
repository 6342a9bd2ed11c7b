#pragma once

namespace rollfix {

/// What a simple root is accurate to: this share of the perimeter, or kRootTurn over the slope of f (of two fingers,
/// through the inverse of J).
inline constexpr double kRootLength = 1e-9;
/// |f| at a root: up to four tangents, each with its rounding, radians.
inline constexpr double kRootTurn = 4e-12;
/// A slope of f, or a singular value of J, below this share of the curvatures that it is made of is rounding noise.
inline constexpr double kNoSlope = 1e-10;

}  // namespace rollfix
