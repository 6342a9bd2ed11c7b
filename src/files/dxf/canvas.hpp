#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "files/dxf/read.hpp"
#include "outline/box.hpp"
#include "rollfix/outline.hpp"

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

/// What a drawing lost on the way, counted for the user to read.
struct Tally {
  std::map<std::string, std::size_t> others;  // by the kind of entity
  std::size_t hidden = 0;                     // on layers that are off or frozen
  std::size_t invisible = 0;
  std::size_t paper = 0;
  std::size_t other_layers = 0;
  std::size_t without_length = 0;
  std::size_t negative = 0;    // circles of a radius below 0
  std::size_t wide = 0;        // polylines with widths
  std::size_t spline_fit = 0;  // polylines that stand for a spline
  std::size_t fit_points = 0;  // splines without control points
  std::size_t repeated = 0;    // points of theirs that repeat the one before
};

/// Where placed shapes become curves.
class Canvas {
 public:
  Canvas(const TagReader& reader, const Model& model, Drawing& drawing, Tally& tally)
      : reader_(reader), model_(model), drawing_(drawing), tally_(tally) {}

  /// Draws a shape that is not an INSERT. `layer` is where it comes to lie.
  /// Throws InputError: out of range, not parallel to the plane, or no curve (a spline's knots that fall).
  void draw(const Entity& entity, const Placement& placement, std::size_t layer);

  /// The map from the coordinates in which this entity is drawn. Throws InputError where it is tilted.
  Placement placement_of(const Entity& entity, const Placement& outer) const;

  /// Throws InputError unless all that was drawn lies at one height; notes a height that is not 0.
  void require_flat() const;

 private:
  void draw_shape(const OtherShape& shape, const Placement& outer);
  void draw_shape(const LineShape& line, const Placement& outer);
  void draw_shape(const ArcShape& arc, const Placement& outer);
  void draw_shape(const EllipseShape& ellipse, const Placement& outer);
  void draw_shape(const PolylineShape& line, const Placement& outer);
  void draw_shape(const SplineShape& spline, const Placement& outer);
  void draw_shape(const InsertShape&, const Placement&) {}

  /// Where the point comes to lie. Throws InputError beyond kMostCoordinate.
  Vec2 placed(const Placement& placement, const Vec3& point);
  std::vector<Vec2> placed(const Placement& placement, const std::vector<Vec3>& points);
  void draw_line(const Placement& placement, const Vec3& from, const Vec3& to);
  void draw_line(const Vec2& from, const Vec2& to);
  void draw_arc(const Placement& placement, const Vec3& centre, const Vec2& major, const Vec2& minor, double from,
                double sweep);
  void draw_bulge(const Placement& placement, const Vertex& from, const Vertex& to);
  std::vector<Curve> curves_of(const SplineShape& spline, const Placement& outer);
  void take(Curve curve);

  /// What `make` makes; its InputError gets the entity's place in front.
  template <class Make>
  auto made(const Make& make) const;
  [[noreturn]] void refuse(const std::string& what) const;

  const TagReader& reader_;
  const Model& model_;
  Drawing& drawing_;
  Tally& tally_;
  const Entity* entity_ = nullptr;  // being drawn
  std::size_t layer_ = 0;

  Box box_;  // around all points
  bool any_ = false;
  double first_height_ = 0;
  double other_height_ = 0;  // the farthest from the first
  std::size_t other_place_ = 0;
};

}  // namespace rollfix::dxf
