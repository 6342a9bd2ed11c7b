#pragma once

#include <functional>
#include <string>
#include <vector>

#include "outline/box.hpp"
#include "rollfix/curve.hpp"
#include "rollfix/draw.hpp"
#include "rollfix/part.hpp"
#include "rollfix/rolling.hpp"

namespace rollfix::draw {

/// A number for the eye: so many significant digits, a true minus sign.
std::string pretty(double value, int digits = 4);

/// The same of a length or coordinate on the part, 0 where rounding left a little.
std::string pretty_on(const Part& part, double length, int digits = 4);

/// An angle in radians shown in degrees, likewise.
std::string pretty_degrees(double radians, int digits = 4);

/// A probability as a percentage; never 0 % or 100 %, which nothing is.
std::string percent(double probability);

/// A number with as many digits as its standard deviation leaves meaningful, and that: "1.410 \u00b1 0.053".
std::string with_sd(double value, double sd);
/// The number alone, with these digits.
std::string as_sure_as(double value, double sd);

/// A length with the part's unit, if any.
std::string with_unit(const std::string& length, const Part& part);
/// What an axis is called, with the part's unit, if any.
Text with_unit(Text name, const Part& part);

/// Values for the marks of an axis.
struct Ticks {
  std::vector<double> at;
  int decimals = 0;  // that tell them apart
};

/// About `count` round values in the range: steps of 1, 2 or 5 times a power of ten.
Ticks round_ticks(const Interval& range, int count);

/// The same for degrees: steps such as 15, 45, 90, 360.
Ticks degree_ticks(const Interval& range, int count);

/// A tick's value with its axis's decimals and a true minus sign.
std::string tick_text(double value, int decimals);

/// The largest round number (1, 2 or 5 times a power of ten) that is at most `value` > 0.
double round_below(double value);

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

CurvatureRange shown_curvature(const Part& part);

/// The range of tangent angles to show, degrees.
Interval turning_range(const Part& part);

/// Points of a graph on the page. `value` takes a Turning. Jumps between spirals become upright lines.
std::vector<Vec2> graph(const Part& part, const Axes& axes, const std::function<double(const Turning&)>& value);

inline constexpr double kWorldDot = 2.6;  // a contact's, pixels

/// The world on the page, in a frame with axes: one scale both ways, and all that is seen inside.
class World {
 public:
  World() = default;
  World(const Box& seen, const Part& part, double width);

  double bottom() const;  // of what is below the frame's axis, on the page
  double pixels(double length) const { return length * scale_; }
  Vec2 at(const Vec2& point) const { return axes_(point.x(), point.y()); }
  std::vector<Vec2> path(const std::vector<Vec2>& points) const;

  /// Its axes; what is drawn until `close` stays inside.
  void open(Svg& svg, const std::string& words) const;
  static void close(Svg& svg);

 private:
  Axes axes_;
  double scale_ = 1;  // pixels for each unit of length
};

/// Points of a part in the world.
std::vector<Vec2> posed(const std::vector<Vec2>& points, const Pose& pose, bool mirrored = false);

}  // namespace rollfix::draw
