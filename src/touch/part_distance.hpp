#pragma once

#include "centre_path.hpp"
#include "path_tree.hpp"
#include "rollfix/part/part.hpp"

namespace rollfix::touch {

/// What of a part is nearest to a point of its own frame.
struct NearestOfPart {
  double distance = 0;          // below 0 inside; an open outline has no inside
  Vec2 away = Vec2::Zero();     // direction in which it grows
  Vec2 contact = Vec2::Zero();  // the nearest point of the boundary, and ...
  double curvature = 0;         // ... its curvature; infinite at a corner
};

/// How far points are from a part. By branch and bound on the tree of its boundary.
class PartDistance {
 public:
  explicit PartDistance(const Part& part);
  PartDistance(const PartDistance&) = delete;
  PartDistance& operator=(const PartDistance&) = delete;

  double diagonal() const { return boundary_.diagonal(); }
  NearestOfPart nearest(const Vec2& point);

 private:
  const Part& part_;
  CentrePath boundary_;
  PathTree tree_;
};

}  // namespace rollfix::touch
