#pragma once

#include <vector>

#include "outline/box.hpp"
#include "rollfix/outline/outline.hpp"

namespace rollfix {

/// What joining curves asks of each of them.
struct CurveMeasure {
  Vec2 front;
  Vec2 back;
  Vec2 middle;  // at the middle of its parameter
  Box box;      // around points of it, its ends among them
  double length = 0;
  Vec2 origin;            // its front
  double twice_area = 0;  // swept by the ray from `origin`, counter-clockwise
};

CurveMeasure measure(const Curve& curve);

/// Points of a closed outline, for asking what lies inside.
struct Polygon {
  std::vector<Vec2> points;
  Box box;

  bool contains(const Vec2& point) const;
};

Polygon polygon_of(const Outline& outline);

}  // namespace rollfix
