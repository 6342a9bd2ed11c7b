#pragma once

#include <vector>

#include "outline/joining.hpp"

namespace rollfix {

/// How deep each polygon lies inside others, by a point inside of it: one deeper than the smallest around it. By
/// falling area, so that none lies in one after it.
std::vector<int> nesting_depths(const std::vector<Polygon>& polygons);

}  // namespace rollfix
