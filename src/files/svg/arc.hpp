#pragma once

#include "files/svg/segment.hpp"

namespace rollfix::svg {

/// The arc of an ellipse with these radii, the first one turned by this angle against the x axis, that joins two
/// points: the longer way or the shorter one, with rising or falling angle. Radii too small to reach are scaled up
/// until they do, and where one is 0 it is a line (SVG, appendix on elliptical arcs). Where the points are the same it
/// is a line without length.
Segment arc_between(const Vec2& from, const Vec2& to, const Vec2& radii, double degrees, bool large, bool positive);

}  // namespace rollfix::svg
