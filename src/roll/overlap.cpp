#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

#include "finger/convex_body.hpp"
#include "rollfix/rolling.hpp"

namespace rollfix {
namespace {

// Of the fingers' size: fingers that touch are apart.
constexpr double kTouchRounding = 1e-9;

/// A length that a finger is about as large as; of a jaw 0.
double size_of(const Finger& finger) {
  if (finger.is_disk()) return finger.length_per_u();
  return finger.is_jaw() ? 0 : finger.outline()->perimeter() / 2;
}

/// Of the finger's frame in the world, at a row.
Pose pose_of(const FingerRows& rows, std::size_t row) { return {rows.x[row], rows.y[row], rows.psi[row]}; }

}  // namespace

/// Above 0 if they overlap, below 0 if they are apart. Two jaws have no ends and always meet somewhere: they
/// are not compared. `enough`: a depth below this need not be exact.
double depth_of_overlap(const Finger& one, const Pose& pose_of_one, const Finger& other, const Pose& pose_of_other,
                        double enough) {
  if (one.is_jaw() && other.is_jaw()) return -std::numeric_limits<double>::infinity();
  if (one.is_jaw()) return depth_of_overlap(pose_of_one, ConvexBody(other, pose_of_other));
  if (other.is_jaw()) return depth_of_overlap(pose_of_other, ConvexBody(one, pose_of_one));
  // Two disks: the sum of their radii less the distance of their centres.
  if (one.is_disk() && other.is_disk()) {
    const double distance = std::hypot(pose_of_one.x - pose_of_other.x, pose_of_one.y - pose_of_other.y);
    return one.length_per_u() + other.length_per_u() - distance;
  }
  return depth_of_overlap(ConvexBody(one, pose_of_one), ConvexBody(other, pose_of_other), enough);
}

std::optional<Overlap> overlap_of(const Roll& roll, const Finger& a, const Finger& b) {
  if (roll.log.fingers.size() != 2 || (a.is_jaw() && b.is_jaw())) return std::nullopt;
  const FingerRows& of_a = roll.log.fingers[0];
  const FingerRows& of_b = roll.log.fingers[1];
  Overlap deepest;
  for (std::size_t k = 0; k < of_a.x.size(); ++k) {
    // Only the deepest row counts: a depth below the deepest so far need not be exact.
    const double depth = depth_of_overlap(a, pose_of(of_a, k), b, pose_of(of_b, k), deepest.depth);
    if (depth > deepest.depth) deepest = {k, depth};
  }
  return deepest.depth > kTouchRounding * (size_of(a) + size_of(b)) ? std::optional<Overlap>(deepest) : std::nullopt;
}

}  // namespace rollfix
