#pragma once

#include "labels.hpp"
#include "plot.hpp"
#include "rollfix/draw.hpp"
#include "scene.hpp"

namespace rollfix::draw {

inline constexpr std::string_view kRowColour = kPalette[1];
inline constexpr std::string_view kGapColour = kBlocked;

/// What has to be seen of the rows.
Box bounds_of(const TaughtRows& taught, const Box& bounds);

/// The rows as they were added up, and the gap from the lap's end to its start.
void draw_rows(Svg& svg, const Scene& scene, const TaughtRows& taught, LabelSet& labels, Obstacles& obstacles);

/// How far the rows' turns are off the part's: places (s, degrees). None of a part that is stored the other way round.
std::vector<Vec2> turns_off(const Part& part, const TaughtRows& taught);
/// What of that is shown: the few that are far off, as within a pivot, are not.
Interval range_of_turns(const std::vector<Vec2>& off);
void draw_turns_off(Svg& svg, const Axes& axes, const std::vector<Vec2>& off);

/// What both are.
std::vector<LegendEntry> entries_of(const TaughtRows& taught, const Part& part);

}  // namespace rollfix::draw
