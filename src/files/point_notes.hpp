#pragma once

#include <string>
#include <vector>

#include "rollfix/outline.hpp"
#include "rollfix/part.hpp"

namespace rollfix::files {

/// How far points of a closed or open outline scatter about a smooth curve, by their fourth differences; 0 where there
/// are too few of them.
double scatter_of(const std::vector<Vec2>& points, bool closed);

/// What to tell who gave these points, of which the part was made: that the curve through them wriggles as only noise
/// does, with an inflection for nearly every second one, and how to smooth them. Empty where it does not.
std::string noisy_points_note(const std::vector<Vec2>& points, const OutlineOptions& options, const Part& part);

/// The end of a message that refuses these points because the curve through them crosses itself: `smooth`, with a
/// tolerance. Empty where they were smoothed, and where they hardly scatter.
std::string noisy_crossing_hint(const std::vector<Vec2>& points, const OutlineOptions& options);

/// What to tell who gave these points, of which the part was made: that corners were made of some that look like a
/// curve sampled sparsely, where, and how to have it round. Empty where there are none, or where they look meant: a
/// corner whose neighbours go straight on, or a polygon's, whose neighbours are corners as well.
std::string sparse_corners_note(const std::vector<Vec2>& points, const OutlineOptions& options, const Part& part);

/// What to tell who gave these points, of which the part was made: that a curve runs through some that look like a
/// corner with an angle below kCornerAngle, how many, and how to keep them as corners. Empty where there are none, and
/// where the points were smoothed, or an angle was given.
std::string rounded_corners_note(const std::vector<Vec2>& points, const OutlineOptions& options, const Part& part);

}  // namespace rollfix::files
