#include <cstddef>
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
