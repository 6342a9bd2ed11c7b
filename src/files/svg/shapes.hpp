#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "files/svg/document.hpp"
#include "rollfix/outline.hpp"

namespace rollfix::svg {

/// A point of the drawing under the transformations around it: linear * p + shift.
struct Affine {
  Eigen::Matrix2d linear = Eigen::Matrix2d::Identity();
  Vec2 shift = Vec2::Zero();

  Vec2 operator()(const Vec2& point) const { return linear * point + shift; }
  /// First `inner`, then this one.
  Affine operator*(const Affine& inner) const { return {linear * inner.linear, linear * inner.shift + shift}; }
};

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

/// A subpath in the drawing's own frame, and where it comes from.
struct PlacedSubpath {
  Subpath path;
  Origin origin;
  std::size_t offset = 0;  // of its element in the file
};

struct Curves {
  std::vector<DrawnCurve> curves;
  std::size_t without_length = 0;  // segments that were left out
};

/// The subpaths as curves. What is shorter than 1e-9 of the drawing is left out, and what ends that close to the start
/// of a closed subpath ends there. Throws InputError with the place: coordinates too large to work with.
Curves to_curves(std::vector<PlacedSubpath> subpaths, const Text& file);

/// Whether an element is one that draws: path, rect, circle, ellipse, line, polyline, polygon.
bool is_shape(std::string_view kind);

/// What it draws, before its transformations, in the direction and from the point that SVG gives it; nothing where it
/// has no size. No value: a size of it is below 0. Percentages are of `viewport`. Throws InputError with the place.
std::optional<std::vector<Subpath>> shape(const Document& document, pugi::xml_node node, const Vec2& viewport);

/// An attribute's length in user units, of which `whole` is 100 %; nothing where it is missing, empty or "auto".
/// Throws InputError: a unit or a percentage of something unknown.
std::optional<double> length_of(const Document& document, pugi::xml_node node, const char* name, double whole);

/// The subpaths of a `d` attribute, without those that are only a "move to". Throws InputError with the place of what
/// is not SVG's path grammar: unlike a viewer, which would draw what comes before it.
std::vector<Subpath> parse_path(const Value& data);

/// The points of a `points` attribute.
std::vector<Vec2> parse_point_list(const Value& points);

}  // namespace rollfix::svg
