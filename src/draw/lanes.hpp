#pragma once

#include <vector>

#include "rollfix/outline/geometry.hpp"

namespace rollfix::draw {

/// Lanes on which stretches of a boundary can be drawn side by side without overlapping.
struct Lanes {
  std::vector<int> of;  // each stretch's lane, 0 is the nearest to the boundary
  int count = 0;
};

/// Puts each stretch on the nearest lane where it is `gap` away from its neighbours. `period` > 0: the boundary is
/// closed with this length and stretches may run over its seam; 0: open.
Lanes assign_lanes(const std::vector<Interval>& stretches, double period, double gap);

}  // namespace rollfix::draw
