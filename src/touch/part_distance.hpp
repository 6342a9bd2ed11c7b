#pragma once

#include <vector>

#include "centre_path.hpp"
#include "path_tree.hpp"
#include "rollfix/part.hpp"

namespace rollfix::touch {

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
