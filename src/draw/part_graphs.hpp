#pragma once

#include <functional>
#include <vector>

#include "plot.hpp"
#include "rollfix/part/part.hpp"

namespace rollfix::draw {

/// The range of curvatures to show, and whether peaks were left out.
struct CurvatureRange {
  Interval shown;
  bool cut = false;
  double most = 0;  // of |kappa|, corners aside
};

CurvatureRange curvature_range(const Part& part);

/// The range of tangent angles to show, degrees.
Interval turning_range(const Part& part);

/// Points of a graph on the page. `value` takes a Turning. Jumps between spirals become upright lines.
std::vector<Vec2> graph(const Part& part, const Axes& axes, const std::function<double(const Turning&)>& value);

}  // namespace rollfix::draw
