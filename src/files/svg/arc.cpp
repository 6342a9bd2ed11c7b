#include "files/svg/arc.hpp"

#include <cmath>
#include <numbers>

#include "files/svg/transform.hpp"

namespace rollfix::svg {

Segment arc_between(const Vec2& from, const Vec2& to, const Vec2& radii, double degrees, bool large, bool positive) {
  if (from == to || !(radii.minCoeff() > 0)) return line(from, to);
  const Eigen::Matrix2d turn = rotation(degrees);
  // In the frame in which the ellipse is a circle of radius 1, `half` is half of the chord.
  Vec2 axes = radii;
  Vec2 half = (turn.transpose() * (0.5 * (to - from))).cwiseQuotient(axes);
  double length = half.norm();
  double to_chord = 0;  // from the centre
  if (length >= 1) {
    axes *= length;
    half /= length;
    length = 1;
  } else {
    to_chord = std::sqrt((1 - length) * (1 + length));
  }
  const double side = large == positive ? -1 : 1;  // on which side of the chord the centre lies
  const Vec2 left(-half.y(), half.x());
  const Vec2 centre = side * to_chord / length * left;  // from the chord's middle
  const Vec2 spoke = -half - centre;
  const double shorter = 2 * std::atan2(length, to_chord);
  const double size = large ? 2 * std::numbers::pi - shorter : shorter;
  Segment segment{SegmentKind::arc, from, to};
  segment.shape = {0.5 * (from + to) + turn * centre.cwiseProduct(axes), axes.x() * turn.col(0),
                   axes.y() * turn.col(1)};
  segment.angle = std::atan2(spoke.y(), spoke.x());
  segment.sweep = positive ? size : -size;
  return segment;
}

}  // namespace rollfix::svg
