#pragma once

#include <optional>
#include <string>

#include "rollfix/draw/svg.hpp"
#include "rollfix/part/part.hpp"
#include "rollfix/part/reach.hpp"

namespace rollfix {

/// What a part is: its shape with inflections, vertices, corners and a scale of arc length, and below it the
/// curvature and the turning function by arc length. A curvature with peaks far above the rest is cut, and the plot
/// says so.
struct PartFigure {
  const Part* part = nullptr;    // not owned; required
  std::string title;             // empty: the part's name
  double width = 640;            // pixels
  std::optional<Reach> reach{};  // of a finger: where it can't touch is marked
};

/// Throws InputError: no part.
Svg draw_part(const PartFigure& figure);

}  // namespace rollfix
