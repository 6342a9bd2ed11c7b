#pragma once

#include <cstddef>
#include <vector>

#include "rollfix/outline/curve.hpp"
#include "rollfix/outline/spline.hpp"

namespace rollfix {

/// The tolerance may be at most this share of the bounding box's diagonal: corners are looked for at a few tolerances'
/// length, and little else would be left of the outline.
inline constexpr double kMostSmoothing = 0.05;
/// A rounded corner that turns by the corner angle within this many tolerances is a corner: below a radius of about
/// this many tolerances, noise of the tolerance's size hides the rounding.
inline constexpr double kCornerReach = 5;

/// A smooth curve near points.
struct Smoothing {
  std::vector<Curve> curves;         // cubic spans, C2 but for the corners; lines between corners where lines will do
  double deviation = 0;              // the largest distance of a point from the curves, never above the tolerance
  std::vector<std::size_t> corners;  // the curves that start at a corner
};

/// The curve with few spans that stays within `tolerance` (a length) of every point of a scan: a least-squares cubic
/// spline whose knots are added only where a point is farther away, so that the noise on either side averages out. (A
/// spline that is pulled straight until it just keeps the tolerance would shrink every circle by it.) Knots are spaced
/// by a length that pixel stairs and noise do not add to, and each point is compared with its own nearest place.
///  * a corner is where the lines through the points within kCornerReach tolerances on either side turn by at least
///    corner_angle; where points are sparser than that, the chords, as in spline_through
///  * closed: the curve starts near the first point: within about the tolerance, or at a corner within that reach
///  * a point given several times counts once
///  * where the tolerance is finer than the noise, the curve follows the noise; where knots would get nearly as many
///    as points, spline_through is returned, with deviation 0
/// About linear in the number of points.
/// Throws InputError: what spline_through throws, and a tolerance that is not finite, not above 0 or too large.
Smoothing smooth_spline(const std::vector<Vec2>& points, bool closed, double tolerance,
                        double corner_angle = kCornerAngle);

}  // namespace rollfix
