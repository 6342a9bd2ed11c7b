#pragma once

#include <string>
#include <vector>

#include "outline/box.hpp"
#include "plot.hpp"
#include "rollfix/draw.hpp"
#include "rollfix/part.hpp"
#include "rollfix/rolling.hpp"

namespace rollfix::draw {

inline constexpr double kWorldDot = 2.6;     // a contact's, pixels
inline constexpr double kWorldGhost = 0.55;  // opacity of poses but the first

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
std::vector<Vec2> posed(const std::vector<Vec2>& points, const Pose& pose, bool mirrored);

}  // namespace rollfix::draw
