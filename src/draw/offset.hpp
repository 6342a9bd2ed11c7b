#pragma once

#include <functional>
#include <vector>

#include "rollfix/outline/curve.hpp"
#include "trace.hpp"

namespace rollfix::draw {

/// The outward normal of a boundary direction on the page. The material is on the left, so outside is on the right;
/// the page's y points down, which mirrors the quarter turn.
inline Vec2 outward(const Vec2& direction) { return {-direction.y(), direction.x()}; }

/// Answers whether a place on the page is near a boundary. Points are found through a grid of square cells.
class Clearance {
 public:
  explicit Clearance(const Trace& boundary);
  bool closer_than(const Vec2& point, double distance) const;

 private:
  std::size_t cell_of(double value, double origin, std::size_t count) const;

  Box box_;
  std::size_t columns_ = 0;
  std::size_t rows_ = 0;
  std::vector<std::vector<Vec2>> cells_;
};

/// The path beside a stretch of the boundary at the distance `offset(s)` outside of it: the path of a disk's centre
/// that rolls along, so that it bridges what is too narrow. Where hardly anything of it would remain it comes nearer.
std::vector<Vec2> path_beside(const Trace& stretch, const Clearance& boundary,
                              const std::function<double(double)>& offset);

}  // namespace rollfix::draw
