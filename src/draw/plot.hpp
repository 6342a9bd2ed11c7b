#pragma once

#include <string>
#include <vector>

#include <functional>
#include "numerals.hpp"
#include "rollfix/draw/svg.hpp"
#include "rollfix/part/part.hpp"

namespace rollfix::draw {

/// A pair of axes on the page, x growing to the right and y upward.
struct Axes {
  Vec2 corner = Vec2::Zero();  // upper left, on the page
  Vec2 size = Vec2::Zero();    // pixels
  Interval x;
  Interval y;

  double page_x(double value) const { return corner.x() + size.x() * (value - x.lo) / x.width(); }
  double page_y(double value) const { return corner.y() + size.y() * (y.hi - value) / y.width(); }
  Vec2 operator()(double x_value, double y_value) const { return {page_x(x_value), page_y(y_value)}; }
};

/// The frame, grid lines and numbers. `title` goes above at the left, `note` at the right.
void draw_axes(Svg& svg, const Axes& axes, const Ticks& x_ticks, const Ticks& y_ticks, const Text& title,
               const std::string& note);

/// The name of the x axis, below its numbers.
void draw_x_name(Svg& svg, const Axes& axes, const Text& name);

/// A graph's points on the page thinned to what the pixels show: in each column of a third of a pixel the first, the
/// lowest, the highest and the last. Points come with x growing.
std::vector<Vec2> thinned(const std::vector<Vec2>& points);

/// A graph, cut off at the frame.
void draw_graph(Svg& svg, const Axes& axes, const std::vector<Vec2>& points, const Paint& paint);

/// The interval widened on both sides by a fraction of its width; one without width gets some.
Interval widened(const Interval& range, double fraction);

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
