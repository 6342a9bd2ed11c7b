#pragma once

#include "files/svg/segment.hpp"
#include "files/svg/value.hpp"

namespace rollfix::svg {

/// A rotation by an angle in degrees, exact for multiples of 90.
Eigen::Matrix2d rotation(double degrees);

/// A `transform` attribute: a list of matrix, translate, scale, rotate, skewX, skewY. Throws InputError with the place.
Affine parse_transform(const Value& value);

/// A `viewBox`: its corner and its size.
struct ViewBox {
  Vec2 corner = Vec2::Zero();
  Vec2 size = Vec2::Zero();
};

/// Throws InputError with the place: not four numbers, or a size that is not above 0.
ViewBox parse_view_box(const Value& value);

/// From a viewBox onto a viewport of this size whose corner is the origin, as a `preserveAspectRatio` says; an empty
/// one is its default, "xMidYMid meet".
Affine fit(const ViewBox& box, const Vec2& viewport, const Value& aspect_ratio);

}  // namespace rollfix::svg
