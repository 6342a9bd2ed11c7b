#pragma once

#include <string>
#include <vector>

#include "rollfix/outline.hpp"
#include "rollfix/part.hpp"

namespace rollfix {

/// What to tell who gave these points, of which the part was made: that corners were made of some that look like a
/// curve sampled sparsely, where, and how to have it round. Empty where there are none, or where they look meant: a
/// corner whose neighbours go straight on, or a polygon's, whose neighbours are corners as well.
std::string sparse_corners_note(const std::vector<Vec2>& points, const OutlineOptions& options, const Part& part);

}  // namespace rollfix
