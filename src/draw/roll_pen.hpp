#pragma once

#include <cstddef>
#include <functional>
#include <string_view>
#include <vector>

#include "labels.hpp"
#include "offset.hpp"
#include "rolls.hpp"
#include "scene.hpp"

namespace rollfix::draw {

/// An extent wider than this gets a band, pixels.
inline constexpr double kVisibleExtent = 4;

/// Draws rolls beside a boundary: arcs, the thin lines that tie them to it, contacts and fingers. What it draws is
/// also an obstacle for labels.
class RollPen {
 public:
  /// All of them have to outlive the pen.
  RollPen(Svg& svg, const Scene& scene, const Clearance& clearance, Obstacles& obstacles)
      : svg_(svg), scene_(scene), clearance_(clearance), obstacles_(obstacles) {}

  /// The path of a run that starts at s, in the direction of the roll, with about `most` points; `offset` is its
  /// distance from the boundary in pixels by the length travelled.
  std::vector<Vec2> path(double start, const Run& run, const std::function<double(double)>& offset,
                         std::size_t most) const;

  /// Thin lines from the boundary to the path's ends.
  void stems(double start, const Run& run, const std::vector<Vec2>& path, std::string_view colour);
  /// The path itself; `head`: with an arrowhead.
  void arc(const std::vector<Vec2>& path, std::string_view colour, double width, bool head);
  /// A first contact: a dot. A later one: a ring.
  void start(double s, std::string_view colour, double radius);
  void contact(double s, std::string_view colour, double radius);
  /// A disk that touches the part at s, with a spoke in the direction `spoke` (radians, in the part's frame).
  void finger(const Part& part, double s, double radius, double spoke);

 private:
  void marker(double s, double radius, const Paint& paint);

  Svg& svg_;
  const Scene& scene_;
  const Clearance& clearance_;
  Obstacles& obstacles_;
};

/// Centre of a disk that touches the part's outside at s, in the part's coordinates; at a corner in the middle of
/// its pivot.
Vec2 finger_centre(const Part& part, double s, double radius);

/// Widens a box so that this disk is seen, unless it reaches too far beyond the part (of these bounds).
void include_finger(Box& box, const Box& bounds, const Part& part, double s, double radius);

}  // namespace rollfix::draw
