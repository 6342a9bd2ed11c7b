#include "files/dxf/placement.hpp"

#include <cmath>
#include <numbers>

namespace rollfix::dxf {

namespace {

/// A direction this far off the vertical, relative to its length, is one that was written with few digits.
constexpr double kVertical = 1e-9;

/// Exact for quarter turns.
Vec2 direction(double degrees) {
  const double turn = std::remainder(degrees, 360);
  if (turn == 0) return {1, 0};
  if (turn == 90) return {0, 1};
  if (turn == -90) return {0, -1};
  if (std::abs(turn) == 180) return {-1, 0};
  const double angle = turn / 180 * std::numbers::pi;
  return {std::cos(angle), std::sin(angle)};
}

}  // namespace

Placement composed(const Placement& outer, const Placement& inner) {
  Placement result;
  result.linear = outer.linear * inner.linear;
  result.offset = outer.linear * inner.offset + outer.offset;
  result.height_scale = outer.height_scale * inner.height_scale;
  result.height_offset = outer.height_scale * inner.height_offset + outer.height_offset;
  return result;
}

std::optional<Placement> facing(const Vec3& extrusion) {
  const double slant = extrusion.head<2>().cwiseAbs().maxCoeff();
  if (!(slant <= kVertical * std::abs(extrusion.z())) || extrusion.z() == 0) return std::nullopt;
  Placement result;
  if (extrusion.z() < 0) {
    result.linear(0, 0) = -1;
    result.height_scale = -1;
  }
  return result;
}

Placement cell_of(const InsertShape& insert, const Vec3& base, std::int64_t column, std::int64_t row) {
  const Vec2 along = direction(insert.rotation);
  const Vec2 across(-along.y(), along.x());
  Placement result;
  result.linear.col(0) = insert.scale.x() * along;
  result.linear.col(1) = insert.scale.y() * across;
  // The spacing of an array is turned, but not scaled.
  const Vec2 cell = (static_cast<double>(column) * insert.column_spacing) * along +
                    (static_cast<double>(row) * insert.row_spacing) * across;
  result.offset = insert.at.head<2>() + cell - result.linear * base.head<2>();
  result.height_scale = insert.scale.z();
  result.height_offset = insert.at.z() - insert.scale.z() * base.z();
  return result;
}

}  // namespace rollfix::dxf
