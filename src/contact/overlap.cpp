#include <cmath>
#include <cstddef>
#include <optional>

#include "contact/convex_body.hpp"
#include "rollfix/contact/rolling.hpp"

namespace rollfix {
namespace {

// Of the fingers' size: fingers that touch are apart.
constexpr double kTouchRounding = 1e-9;

/// A length that a finger is about as large as; of a jaw 0.
double size_of(const Finger& finger) {
  if (finger.is_disk()) return finger.length_per_u();
  return finger.is_jaw() ? 0 : finger.outline()->perimeter() / 2;
}

Pose pose_of(const FingerRows& rows, std::size_t row) { return {rows.x[row], rows.y[row], rows.psi[row]}; }

/// How deep the fingers are in one another; at most `enough` where that is all that matters.
double depth_in(const FingerRows& of_a, const FingerRows& of_b, const Finger& a, const Finger& b, std::size_t row,
                double enough) {
  if (a.is_jaw()) return depth_of_overlap(pose_of(of_a, row), ConvexBody(b, pose_of(of_b, row)));
  if (b.is_jaw()) return depth_of_overlap(pose_of(of_b, row), ConvexBody(a, pose_of(of_a, row)));
  if (a.is_disk() && b.is_disk()) {
    const double distance = std::hypot(of_a.x[row] - of_b.x[row], of_a.y[row] - of_b.y[row]);
    return a.length_per_u() + b.length_per_u() - distance;
  }
  return depth_of_overlap(ConvexBody(a, pose_of(of_a, row)), ConvexBody(b, pose_of(of_b, row)), enough);
}

}  // namespace

std::optional<Overlap> overlap_of(const Roll& roll, const Finger& a, const Finger& b) {
  if (roll.log.fingers.size() != 2 || (a.is_jaw() && b.is_jaw())) return std::nullopt;
  const FingerRows& of_a = roll.log.fingers[0];
  const FingerRows& of_b = roll.log.fingers[1];
  Overlap deepest;
  for (std::size_t k = 0; k < of_a.x.size(); ++k) {
    const double depth = depth_in(of_a, of_b, a, b, k, deepest.depth);
    if (depth > deepest.depth) deepest = {k, depth};
  }
  return deepest.depth > kTouchRounding * (size_of(a) + size_of(b)) ? std::optional<Overlap>(deepest) : std::nullopt;
}

}  // namespace rollfix
