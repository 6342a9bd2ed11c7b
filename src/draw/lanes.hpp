#pragma once

#include <vector>

#include "rollfix/part/boundary.hpp"

namespace rollfix::draw {

inline constexpr double kFirstLane = 8;  // from the boundary to the first lane, pixels
inline constexpr double kLaneSpacing = 6.5;
inline constexpr double kEndGap = 14;  // between neighbours on a lane

/// Lanes on which stretches of a boundary can be drawn side by side without overlapping.
struct Lanes {
  std::vector<int> of;  // each stretch's lane, 0 is the nearest to the boundary
  int count = 0;
};

/// Puts each stretch on the nearest lane where it is `gap` away from its neighbours.
Lanes assign_lanes(const std::vector<Interval>& stretches, const Boundary& boundary, double gap);

}  // namespace rollfix::draw
