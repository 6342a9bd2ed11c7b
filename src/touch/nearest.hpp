#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "centre_path.hpp"
#include "measured.hpp"
#include "rollfix/part.hpp"

namespace rollfix::touch {

/// A touch as the part's frame sees it, in some pose.
/// The same members as Measured has: place in the part's unit, angles in radians.
struct InPart {
  Vec2 at = Vec2::Zero();
  bool has_place = true;
  std::optional<double> tangent{};
  double place_unit = 1;
  double angle_unit = 1;
};

/// How far a place is from a touch: the sum of squares of its residuals, and its derivatives by u.
struct Distance {
  double square = 0;
  double slope = 0;   // half the derivative of it, with its sign: above 0 where it falls with u
  double weight = 0;  // half the second derivative, but for ...
  double bend = 0;    // ... what the path's bends add to it, if they are those of a circle
};
Distance distance_at(const CentrePoint& point, const InPart& touch);

/// No place of a node has a smaller sum of squares.
/// In units of the touch, squared.
double least_square(const PathTree::Node& node, const InPart& touch);

/// A place of the path, and what is there.
struct OnPath {
  PathPlace place;
  CentrePoint point;
};

/// The nearest place to be found by going downhill from this one, from stretch to stretch.
/// A local minimum of Distance::square.
OnPath downhill(const CentrePath& path, const InPart& touch, OnPath from);

/// The nearest of all places. Branch and bound.
OnPath nearest_place(PathTree& tree, const InPart& touch);

/// The nearest of all places if it is nearer than this one, by more than rounding: nothing if none is.
std::optional<OnPath> nearer_place(PathTree& tree, const InPart& touch, const OnPath& than);

/// What of a part is nearest to a point of its own frame.
struct NearestOfPart {
  double distance = 0;          // below 0 inside; an open outline has no inside
  Vec2 away = Vec2::Zero();     // direction in which it grows
  Vec2 contact = Vec2::Zero();  // the nearest point of the boundary, and ...
  double s = 0;                 // where it is, ...
  double curvature = 0;         // ... its curvature; infinite at a corner
};

/// How far points are from a part. By branch and bound on the tree of its boundary.
class PartDistance {
 public:
  explicit PartDistance(const Part& part);
  PartDistance(const PartDistance&) = delete;
  PartDistance& operator=(const PartDistance&) = delete;

  double diagonal() const { return boundary_.diagonal(); }
  bool is_hole() const { return is_hole_; }  // the material is outside
  /// A place about as far from the boundary as a hole allows. REQUIRES a hole.
  Vec2 middle_of_hole();
  NearestOfPart nearest(const Vec2& point);
  /// Between which distances a point is from the part: quick, and close only where it is far.
  Interval between(const Vec2& point);
  double at_least(const Vec2& point) { return between(point).lo; }

 private:
  static constexpr int kCells = 256;  // of a grid over the part's box, each way

  const Part& part_;
  CentrePath boundary_;
  PathTree tree_;
  Vec2 corner_ = Vec2::Zero();  // of the grid
  Vec2 cell_ = Vec2::Zero();    // sizes of its cells
  bool is_hole_ = false;
  std::vector<double> of_cell_;  // distance at a cell's middle; NaN: not asked for yet; empty: none was
};

}  // namespace rollfix::touch
