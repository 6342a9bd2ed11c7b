#pragma once

#include <cstddef>
#include <vector>

#include "rollfix/curve.hpp"

namespace rollfix {

/// The points of a noisy scan that are at corners, in order: where the lines fitted to the points within `reach` before
/// and after turn by at least `corner_angle` (radians), and more than at any other point within reach. An arm has at
/// least the neighbouring point, so that sparse points have their chords' corners.
std::vector<std::size_t> scan_corners(const std::vector<Vec2>& points, bool closed, double reach, double corner_angle);

}  // namespace rollfix
