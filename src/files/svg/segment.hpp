#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "rollfix/outline/curve.hpp"

namespace rollfix::svg {

/// A point of the drawing under the transformations around it: linear * p + shift.
struct Affine {
  Eigen::Matrix2d linear = Eigen::Matrix2d::Identity();
  Vec2 shift = Vec2::Zero();

  Vec2 operator()(const Vec2& point) const { return linear * point + shift; }
  /// First `inner`, then this one.
  Affine operator*(const Affine& inner) const { return {linear * inner.linear, linear * inner.shift + shift}; }
};

enum class SegmentKind { line, quadratic, cubic, arc };

/// One segment of a path, absolute.
struct Segment {
  SegmentKind kind = SegmentKind::line;
  Vec2 from = Vec2::Zero();
  Vec2 to = Vec2::Zero();
  std::array<Vec2, 3> shape{};  // quadratic: the control point; cubic: both; arc: centre and two half axes
  double angle = 0;             // arc: centre + cos(u) half axis + sin(u) other half axis, from u = angle
  double sweep = 0;             // by this much
};

/// What one "move to" begins.
struct Subpath {
  Vec2 start = Vec2::Zero();
  std::vector<Segment> segments;
  bool closed = false;  // back to the start, by a line if need be
};

inline Segment line(const Vec2& from, const Vec2& to) { return {SegmentKind::line, from, to}; }

/// A turn around an ellipse with axes along the coordinates.
inline Segment elliptic(const Vec2& centre, const Vec2& radii, double angle, double sweep) {
  const auto at = [&](double u) {
    return Vec2(centre.x() + radii.x() * std::cos(u), centre.y() + radii.y() * std::sin(u));
  };
  return {
      SegmentKind::arc, at(angle), at(angle + sweep), {centre, Vec2(radii.x(), 0), Vec2(0, radii.y())}, angle, sweep};
}

inline Segment mapped(const Affine& map, const Segment& segment) {
  Segment result = segment;
  result.from = map(segment.from);
  result.to = map(segment.to);
  result.shape[0] = map(segment.shape[0]);
  const bool is_arc = segment.kind == SegmentKind::arc;
  for (std::size_t k = 1; k < 3; ++k) {
    result.shape[k] = is_arc ? Vec2(map.linear * segment.shape[k]) : map(segment.shape[k]);
  }
  return result;
}

}  // namespace rollfix::svg
