#pragma once

#include <vector>

#include "rollfix/part/part.hpp"

namespace rollfix {

/// The smallest upright rectangle around the boundary.
struct BoundingBox {
  Vec2 lo;
  Vec2 hi;
};
BoundingBox bounding_box(const Part& part);

/// Least and largest curvature; corners don't count.
Interval curvature_range(const Part& part);

/// The radius of the largest disk that the curvature lets roll everywhere: infinite on a part without concave places,
/// 0 with a concave corner. A narrow neck can stop a smaller one.
double largest_disk(const Part& part);

/// How many places of a closed part look alike, wherever a finger is put: 1 for no symmetry, 2 for an ellipse, 0 for
/// a circle (all of them).
int symmetry(const Part& part);

/// How many placements rolls of one length have.
struct Ambiguity {
  int share = 1;         // the roll's length is the perimeter divided by this
  int rolls = 0;         // that were tried, from places spread over the boundary
  int with_stretch = 0;  // of them fit a continuum of places
  double mean_placements = 0;
  std::size_t most_placements = 0;
};
std::vector<Ambiguity> ambiguity(const Part& part);

}  // namespace rollfix
