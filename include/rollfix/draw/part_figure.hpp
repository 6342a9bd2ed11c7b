#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rollfix/contact/dead_reckoning.hpp"
#include "rollfix/draw/svg.hpp"
#include "rollfix/part/part.hpp"
#include "rollfix/part/reach.hpp"

namespace rollfix {

/// The roll that a part was taught by.
struct TaughtRows {
  std::vector<ReckonedRow> rows;  // see dead_reckoned
  double lap = 0;                 // how much of their length is in the part
  double gap = 0;                 // from the lap's end to its start, length
  bool closes = true;             // a lap was looked for
  std::string closing;            // what was done about the gap, in words
};

/// What a part is: its shape with inflections, vertices, corners and a scale of arc length, and below it the
/// curvature and the turning function by arc length. A curvature with peaks far above the rest is cut, and the plot
/// says so.
struct PartFigure {
  const Part* part = nullptr;     // not owned; required
  std::string title;              // empty: the part's name
  double width = 640;             // pixels
  std::optional<Reach> reach{};   // of a finger: where it can't touch is marked
  std::vector<Outline> others{};  // of a drawing: its other loops, drawn thin
  TaughtRows taught{};            // of a part that was taught: the rows and the gap are drawn as well
};

/// Throws InputError: no part.
Svg draw_part(const PartFigure& figure);

}  // namespace rollfix
