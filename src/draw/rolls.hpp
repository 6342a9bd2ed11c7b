#pragma once

#include <cstddef>
#include <functional>
#include <string_view>
#include <vector>

#include "labels.hpp"
#include "outline/box.hpp"
#include "rollfix/curve.hpp"
#include "rollfix/reading.hpp"
#include "rollfix/turning_function.hpp"
#include "scene.hpp"
#include "trace.hpp"

namespace rollfix::draw {

/// A part of a roll without a change of direction.
struct Run {
  double from = 0;  // length travelled at its ends, measured from the first contact
  double to = 0;
  int lane = 0;  // of its drawing, counted from the roll's own first lane

  double size() const { return to > from ? to - from : from - to; }
};

/// What the drawings of all placements have in common: the way along the boundary that the readings tell of.
struct Roll {
  std::vector<Run> runs;         // empty where nothing rolled
  std::vector<double> contacts;  // length travelled at each reading
  Interval hull;                 // least and greatest length travelled
  int lanes = 1;                 // that it needs side by side
  bool tangled = false;          // changes its direction so often that one run stands for all
};

/// Whether a run covers a closed boundary more than once and has to wind outward.
bool goes_round(const Run& run, const Boundary& boundary);

/// Of one finger's lengths.
Roll roll_of(const std::vector<Reading>& readings, const Boundary& boundary, std::size_t finger = 0);

inline constexpr double kFirstLane = 8;  // from the boundary to the first lane, pixels
inline constexpr double kLaneSpacing = 6.5;
inline constexpr double kEndGap = 14;  // between neighbours on a lane

/// Lanes on which stretches of a boundary can be drawn side by side without overlapping.
struct Lanes {
  std::vector<int> of;  // each stretch's lane, 0 is the nearest to the boundary
  int count = 0;
};

/// Puts each stretch on the nearest lane where it is `gap` away from its neighbours.
Lanes assign_lanes(const std::vector<Interval>& stretches, const Boundary& boundary, double gap);

/// The outward normal of a boundary direction on the page. The material is on the left, so outside is on the right;
/// the page's y points down, which mirrors the quarter turn.
inline Vec2 outward(const Vec2& direction) { return {-direction.y(), direction.x()}; }

/// Answers whether a place on the page is near a boundary. Points are found through a grid of square cells.
class Clearance {
 public:
  explicit Clearance(const Trace& boundary);
  bool closer_than(const Vec2& point, double distance) const;

 private:
  std::size_t cell_of(double value, double origin, std::size_t count) const;

  Box box_;
  std::size_t columns_ = 0;
  std::size_t rows_ = 0;
  std::vector<std::vector<Vec2>> cells_;
};

/// The path beside a stretch of the boundary at the distance `offset(s)` outside of it: the path of a disk's centre
/// that rolls along, so that it bridges what is too narrow. Where hardly anything of it would remain it comes nearer.
std::vector<Vec2> path_beside(const Trace& stretch, const Clearance& boundary,
                              const std::function<double(double)>& offset);

/// An extent wider than this gets a band, pixels.
inline constexpr double kVisibleExtent = 4;

/// What holds 95 % may leave as much of a closed boundary out without telling where.
inline bool is_anywhere(const Interval& held, const Boundary& boundary) {
  constexpr double kNearlyAll = 0.85;  // of the perimeter
  return boundary.closed && held.width() > kNearlyAll * boundary.perimeter;
}

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

/// Widens a box so that this disk is seen, as far as it does not reach too far beyond the part (of these bounds);
/// whether it is seen whole.
bool include_finger(Box& box, const Box& bounds, const Part& part, double s, double radius);

}  // namespace rollfix::draw
