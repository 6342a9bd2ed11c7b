#include "files/svg/shapes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "files/svg/value.hpp"
#include "outline/turn.hpp"
#include "text/text.hpp"

namespace rollfix::svg {

namespace {

constexpr double kQuarter = std::numbers::pi / 2;

/// An element's lengths.
class Lengths {
 public:
  Lengths(const Document& document, pugi::xml_node node, const Vec2& viewport)
      : document_(document), node_(node), viewport_(viewport) {}

  double x(const char* name) const { return read(name, viewport_.x()).value_or(0); }
  double y(const char* name) const { return read(name, viewport_.y()).value_or(0); }
  double radius(const char* name) const { return size(name, viewport_.norm() / std::numbers::sqrt2).value_or(0); }
  Vec2 point(const char* first, const char* second) const { return {x(first), y(second)}; }
  Vec2 extent() const {
    const double width = size("width", viewport_.x()).value_or(0);
    return {width, size("height", viewport_.y()).value_or(0)};
  }
  /// rx and ry, one of which stands for both where the other is missing or "auto".
  Vec2 radii() const {
    const std::optional<double> rx = size("rx", viewport_.x());
    const std::optional<double> ry = size("ry", viewport_.y());
    return {rx ? *rx : ry.value_or(0), ry ? *ry : rx.value_or(0)};
  }
  /// Whether a size that was read is one that nothing can have.
  bool below_zero() const { return below_zero_; }

 private:
  std::optional<double> read(const char* name, double whole) const { return length_of(document_, node_, name, whole); }

  std::optional<double> size(const char* name, double whole) const {
    const std::optional<double> result = read(name, whole);
    below_zero_ = below_zero_ || (result && *result < 0);
    return result;
  }

  const Document& document_;
  pugi::xml_node node_;
  Vec2 viewport_;
  mutable bool below_zero_ = false;
};

using Subpaths = std::vector<Subpath>;

Subpaths ellipse(const Vec2& centre, const Vec2& radii) {
  if (!(radii.minCoeff() > 0)) return {};
  const Segment whole = elliptic(centre, radii, 0, kFullTurn);
  return {{whole.from, {whole}, true}};
}

/// From the end of the upper left rounding to the right, and around.
Subpaths rectangle(const Vec2& corner, const Vec2& extent, Vec2 radii) {
  if (!(extent.minCoeff() > 0)) return {};
  radii = radii.cwiseMin(0.5 * extent);
  const bool is_round = radii.minCoeff() > 0;
  if (!is_round) radii = Vec2::Zero();
  const Vec2 far = corner + extent;
  const Vec2 inner_near = corner + radii;
  const Vec2 inner_far = far - radii;
  const std::array<Vec2, 8> at = {{{inner_near.x(), corner.y()},
                                   {inner_far.x(), corner.y()},
                                   {far.x(), inner_near.y()},
                                   {far.x(), inner_far.y()},
                                   {inner_far.x(), far.y()},
                                   {inner_near.x(), far.y()},
                                   {corner.x(), inner_far.y()},
                                   {corner.x(), inner_near.y()}}};
  const std::array<Vec2, 4> centres = {
      {{inner_far.x(), inner_near.y()}, inner_far, {inner_near.x(), inner_far.y()}, inner_near}};
  Subpath path{at[0], {}, true};
  for (std::size_t side = 0; side < 4; ++side) {
    const bool horizontal = side % 2 == 0;
    const bool is_used_up = is_round && (horizontal ? 2 * radii.x() >= extent.x() : 2 * radii.y() >= extent.y());
    if (!is_used_up) path.segments.push_back(line(at[2 * side], at[2 * side + 1]));
    if (!is_round) continue;
    Segment rounding = elliptic(centres[side], radii, (static_cast<double>(side) - 1) * kQuarter, kQuarter);
    rounding.from = at[2 * side + 1];
    rounding.to = at[(2 * side + 2) % 8];
    path.segments.push_back(rounding);
  }
  return {path};
}

Subpaths chain(const std::vector<Vec2>& points, bool closed) {
  if (points.size() < 2) return {};
  Subpath path{points.front(), {}, closed};
  for (std::size_t k = 1; k < points.size(); ++k) path.segments.push_back(line(points[k - 1], points[k]));
  return {path};
}

}  // namespace

std::optional<double> length_of(const Document& document, pugi::xml_node node, const char* name, double whole) {
  const std::optional<Value> value = document.attribute(node, name);
  const std::optional<Length> length = value && !value->text.empty() ? parse_length(*value) : std::nullopt;
  if (!length) return std::nullopt;
  const auto refuse = [&](const char* message) {
    value->refuse(value->text.data(), fmt::format(fmt::runtime(message), shown(value->text)));
  };
  const std::optional<double> result = length->in_user_units(whole);
  if (!result) refuse("expected a length in px, mm, cm, in, pt, pc or without a unit, found '{}'");
  if (!std::isfinite(*result)) refuse("'{}' is a share of a page whose size the file does not say: write a length");
  return result;
}

bool is_shape(std::string_view kind) {
  constexpr std::array<std::string_view, 7> kShapes = {"path", "rect",     "circle", "ellipse",
                                                       "line", "polyline", "polygon"};
  return std::find(kShapes.begin(), kShapes.end(), kind) != kShapes.end();
}

namespace {

Subpaths drawn(const Document& document, pugi::xml_node node, const Lengths& lengths) {
  const std::string_view kind = document.kind(node);
  if (kind == "path") {
    const std::optional<Value> data = document.attribute(node, "d");
    return data ? parse_path(*data) : Subpaths();
  }
  if (kind == "rect") return rectangle(lengths.point("x", "y"), lengths.extent(), lengths.radii());
  if (kind == "circle") return ellipse(lengths.point("cx", "cy"), Vec2::Constant(lengths.radius("r")));
  if (kind == "ellipse") return ellipse(lengths.point("cx", "cy"), lengths.radii());
  if (kind == "line") return chain({lengths.point("x1", "y1"), lengths.point("x2", "y2")}, false);
  const std::optional<Value> points = document.attribute(node, "points");
  return points ? chain(parse_point_list(*points), kind == "polygon") : Subpaths();
}

}  // namespace

std::optional<std::vector<Subpath>> shape(const Document& document, pugi::xml_node node, const Vec2& viewport) {
  const Lengths lengths(document, node, viewport);
  Subpaths result = drawn(document, node, lengths);
  if (lengths.below_zero()) return std::nullopt;
  return result;
}

}  // namespace rollfix::svg
