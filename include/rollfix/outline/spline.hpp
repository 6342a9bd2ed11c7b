#pragma once

#include <numbers>
#include <vector>

#include "rollfix/outline/curve.hpp"

namespace rollfix {

/// Neighbouring chords that turn by at least this make a corner. Below 60 degrees, so that a hexagon has corners.
inline constexpr double kCornerAngle = 59 * std::numbers::pi / 180;

/// The curve through points, as drawn by hand: a cubic spline with continuous second derivative in cumulative
/// chord length, one Curve per chord; the curve number i starts at points[i] exactly.
///  * closed: periodic; open: second derivative zero at both ends ("natural")
///  * where two neighbouring chords turn by at least corner_angle (radians, in [0, pi]; 0 makes a polygon)
///    there is a corner: a new spline starts, natural at both ends. On a closed curve the first point is no exception,
///    and where it is not a corner the spline runs across it
///  * a stretch between corners that is straight to rounding is made of lines
/// Linear in the number of points.
/// Throws InputError: fewer than 3 points (open: 2), a point that is not finite, two equal neighbours, or a
/// corner angle outside [0, pi].
std::vector<Curve> spline_through(const std::vector<Vec2>& points, bool closed, double corner_angle = kCornerAngle);

}  // namespace rollfix
