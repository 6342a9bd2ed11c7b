#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "rollfix/curve.hpp"

namespace rollfix {

/// How the chords between points turn, to the left; at an open end not at all. Keeps a reference to the points, of
/// which neighbours differ.
class ChordTurns {
 public:
  ChordTurns(const std::vector<Vec2>& points, bool closed) : points_(points), closed_(closed) {}

  /// The turn at point k, radians, in (-pi, pi]; 0 at an open end.
  double at(std::size_t k) const;

  /// Whether the curve bends on both sides of this point as it does here, behind those that turn by `least` as well: a
  /// curve that is sampled sparsely, and no corner.
  bool goes_on(std::size_t k, double least) const;
  /// Whether the side before this point or behind it is straight, points that turn by `least` left out; of a polygon,
  /// all of whose points do, it is. Of a side that is an open end's it can't be told.
  bool has_straight_side(std::size_t k, double least) const;
  /// The same of a nose: towards the point it bends more and more, from both sides. Along arcs that meet in a corner it
  /// does not.
  bool is_nose(std::size_t k, double least) const;

 private:
  /// Cyclic, also for open points: `at` is 0 at their ends, before a neighbour is asked for.
  std::size_t next(std::size_t k) const { return (k + 1) % points_.size(); }
  std::size_t previous(std::size_t k) const { return (k + points_.size() - 1) % points_.size(); }
  /// The first point after this one, or before it, that turns by less than `least`: those that turn more may be part of
  /// the same nose. None: once around every point turns like a corner, as on a polygon.
  std::optional<std::size_t> straighter_beside(std::size_t k, double least, bool after) const;
  bool is_open_end(std::size_t k) const { return !closed_ && (k == 0 || k + 1 == points_.size()); }
  /// The turn at point k by the length that it takes, 1 / length: the curvature of a curve through the points, roughly.
  double curvature(std::size_t k) const;

  const std::vector<Vec2>& points_;
  bool closed_;
};

/// The points, in order, where a spline through them has its corners: where neighbouring chords turn by kCornerAngle,
/// unless the neighbours show that it is a sparsely sampled nose. `airfoil`: from the trailing edge over the top and
/// back; then only those at the trailing edge.
std::vector<std::size_t> corners_of_points(const std::vector<Vec2>& points, bool closed, bool airfoil);

/// As spline_through, with corners at these points, in order.
std::vector<Curve> spline_with_corners(const std::vector<Vec2>& points, bool closed,
                                       const std::vector<std::size_t>& corners);

/// The points of a noisy scan that are at corners, in order: where the lines fitted to the points within `reach` before
/// and after turn by at least `corner_angle` (radians), and more than at any other point within reach. An arm has at
/// least the neighbouring point, so that sparse points have their chords' corners.
std::vector<std::size_t> scan_corners(const std::vector<Vec2>& points, bool closed, double reach, double corner_angle);

}  // namespace rollfix
