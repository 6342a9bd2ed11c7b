#pragma once

#include <optional>

#include "files/dxf/model.hpp"
#include "rollfix/outline/curve.hpp"

namespace rollfix::dxf {

/// How a block's flat content comes to lie in the drawing: an affine map of the plane, and its height above it.
struct Placement {
  Eigen::Matrix2d linear = Eigen::Matrix2d::Identity();
  Vec2 offset = Vec2::Zero();
  double height_scale = 1;
  double height_offset = 0;

  Vec2 vector(const Vec2& v) const { return linear * v; }
  Vec2 point(const Vec3& p) const { return linear * p.head<2>() + offset; }
  double height(const Vec3& p) const { return height_scale * p.z() + height_offset; }
};

/// First `inner`, then `outer`.
Placement composed(const Placement& outer, const Placement& inner);

/// From the coordinates of an entity that was drawn from this direction; nothing unless it is (0, 0, 1), which changes
/// nothing, or (0, 0, -1), which mirrors x (the "arbitrary axis algorithm" of the format).
std::optional<Placement> facing(const Vec3& extrusion);

/// From a block's coordinates to those in which its INSERT is drawn, for one cell of the array.
Placement cell_of(const InsertShape& insert, const Vec3& base, std::int64_t column, std::int64_t row);

}  // namespace rollfix::dxf
