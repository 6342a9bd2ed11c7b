#pragma once

// Facts of a part: how large, how curved, how ambiguous rolls on it are, where a finger can touch it.
//
//     const Part part = load_part("gallery:ellipse,a=2,b=1");
//     symmetry(part);                             // 2
//     std::isinf(largest_disk(part));             // true
//     std::round(1e6 * curvature_range(part).hi); // 2e+06
//
// Degenerate cases: a circle has symmetry 0; a part with a concave corner lets no disk touch everywhere.
//
// Accuracy: `ambiguity` is a sample, of as many rolls as it says; all else follows the outline's formulas.

#include <cstddef>
#include <optional>
#include <vector>

#include "rollfix/curve.hpp"
#include "rollfix/finger.hpp"
#include "rollfix/part.hpp"

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

/// All of these facts of one part.
struct Inspection {
  Part part;
  BoundingBox box;
  Interval curvature;
  double largest_disk = 0;
  int symmetry = 1;
  std::vector<Ambiguity> ambiguity;
  std::optional<Finger> finger{};  // that was asked about, and ...
  std::optional<Reach> reach{};    // ... how far it can reach
};

/// Tries rolls all along the boundary for `ambiguity`: the slow part. Throws InputError: a finger of which it is not
/// known where it can touch (see has_reach), or a disk that is not valid.
Inspection inspect(const Part& part, const std::optional<Finger>& finger = {});

}  // namespace rollfix
