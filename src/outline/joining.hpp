#pragma once

#include <cstddef>
#include <vector>

#include "outline/box.hpp"
#include "rollfix/curve.hpp"
#include "rollfix/outline.hpp"

namespace rollfix {

/// What joining curves asks of each of them.
struct CurveMeasure {
  Vec2 front;
  Vec2 back;
  Vec2 middle;  // at the middle of its parameter
  Box box;      // around points of it, its ends among them
  double length = 0;
  double twice_area = 0;  // swept by the ray from its front, counter-clockwise
};

CurveMeasure measure(const Curve& curve);

/// Points of a closed outline, for asking what lies inside.
struct Polygon {
  std::vector<Vec2> points;
  Box box;

  bool contains(const Vec2& point) const;
};

Polygon polygon_of(const Outline& outline);

/// Points sorted into clusters: two that are within `gap` of each other are in the same one, and so are those that are
/// linked by others in between.
class EndClusters {
 public:
  /// gap > 0. Linear in the number of points but for those that crowd together.
  EndClusters(const std::vector<Vec2>& points, double gap);

  std::size_t of(std::size_t point) const { return cluster_[point]; }
  /// The points of a cluster, in rising order.
  const std::vector<std::size_t>& members(std::size_t cluster) const { return members_[cluster]; }

 private:
  std::vector<std::size_t> cluster_;
  std::vector<std::vector<std::size_t>> members_;
};

}  // namespace rollfix
