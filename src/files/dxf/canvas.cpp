#include "files/dxf/read.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <variant>

#include "outline/refusals.hpp"
#include "outline/turn.hpp"
#include "rollfix/curve.hpp"
#include "rollfix/error.hpp"
#include "rollfix/outline.hpp"

// Notation:
//   placement       x -> A x + b of an INSERT within those around it, and what it makes of heights: Placement
//   bulge           tan of a quarter of an arc's sweep, from one vertex to the next
//   major, minor    half axes of centre + cos(u) major + sin(u) minor; an affine map leaves that form
//   extrusion       direction that an entity's plane faces: up, or down, which mirrors it
// Follows docs/files.md, "DXF"; Autodesk's "DXF Reference", "Arbitrary axis algorithm".
namespace rollfix::dxf {

namespace {

/// Half axes that differ by no more, or are no farther from a right angle, are a circle's: what nested turns leave.
constexpr double kRound = 1e-12;
/// An arc of a smaller bulge is off its chord by less than its centre, far away, can be held to.
constexpr double kStraightBulge = 1e-8;
/// Parameters of a full ellipse may miss a full turn by so much: some programs write few digits.
constexpr double kFullEllipse = 1e-9;
/// Heights that differ by no more than this share of the drawing's size are one.
constexpr double kSameHeight = 1e-9;

double in_radians(double degrees) { return degrees / 180 * std::numbers::pi; }

/// Sweep of an arc, counter-clockwise, in (0, 360]: equal angles are a full circle.
double sweep_of(const ArcShape& arc) {
  const double sweep = std::fmod(arc.end - arc.start, 360);
  return sweep > 0 ? sweep : sweep + 360;
}

/// Of an elliptic arc in (0, 2 pi].
double sweep_of(const EllipseShape& ellipse) {
  double sweep = ellipse.end - ellipse.start;
  if (std::abs(std::abs(sweep) - kFullTurn) <= kFullEllipse) return kFullTurn;
  sweep = std::fmod(sweep, kFullTurn);
  return sweep > 0 ? sweep : sweep + kFullTurn;
}

bool are_round(const Vec2& major, const Vec2& minor) {
  const double a = std::hypot(major.x(), major.y());
  const double b = std::hypot(minor.x(), minor.y());
  const double skew = (major / a).dot(minor / b);
  return std::abs(a - b) <= kRound * a && std::abs(skew) <= kRound;
}

/// As Line sees it.
bool has_length(const Vec2& from, const Vec2& to) { return (to - from).squaredNorm() > 0; }

}  // namespace

template <class Make>
auto Canvas::made(const Make& make) const {
  try {
    return make();
  } catch (const InputError& error) {
    refuse(error.what());
  }
}

void Canvas::refuse(const std::string& what) const {
  dxf::refuse(reader_, entity_->place,
              fmt::format("{} on layer '{}': {}", shown(model_.types.name(entity_->type)),
                          shown(model_.layer_names.name(layer_)), what));
}

void Canvas::draw(const Entity& entity, const Placement& placement, std::size_t layer) {
  entity_ = &entity;
  layer_ = layer;
  std::visit([&](const auto& shape) { draw_shape(shape, placement); }, entity.shape);
}

Placement Canvas::placement_of(const Entity& entity, const Placement& outer) const {
  const std::optional<Placement> own = facing(entity.extrusion);
  if (own) return composed(outer, *own);
  const Vec3& e = entity.extrusion;
  dxf::refuse(
      reader_, entity.place,
      fmt::format("{} is tilted by its extrusion ({}, {}, {}), expected a flat drawing, with (0, 0, 1) or (0, 0, -1)",
                  shown(model_.types.name(entity.type)), e.x(), e.y(), e.z()));
}

void Canvas::require_flat() const {
  if (!any_) return;
  const double size = box_.diagonal().norm();
  const double deviation = std::abs(other_height_ - first_height_);
  if (deviation > kSameHeight * size) {
    dxf::refuse(
        reader_, other_place_,
        fmt::format("lies at z = {} and the first curve at {}, expected a flat drawing", other_height_, first_height_));
  }
  if (first_height_ != 0 || deviation != 0) {
    drawing_.notes.push_back(fmt::format("flattened: all lies at z = {}", first_height_));
  }
}

Vec2 Canvas::placed(const Placement& placement, const Vec3& point) {
  Vec2 result = placement.point(point);
  const double height = placement.height(point);
  if (!result.allFinite() || !std::isfinite(height)) {
    refuse(fmt::format("its INSERTs scale it beyond all numbers, expected coordinates of at most {}", kMostCoordinate));
  }
  if (!(result.cwiseAbs().maxCoeff() <= kMostCoordinate && std::abs(height) <= kMostCoordinate)) {
    refuse(fmt::format("its INSERT puts it at ({}, {}, {}), expected coordinates of at most {}", result.x(), result.y(),
                       height, kMostCoordinate));
  }
  if (!any_) {
    first_height_ = other_height_ = height;
    any_ = true;
  }
  box_.extend(result);
  if (std::abs(height - first_height_) > std::abs(other_height_ - first_height_)) {
    other_height_ = height;
    other_place_ = entity_->place;
  }
  return result;
}

std::vector<Vec2> Canvas::placed(const Placement& placement, const std::vector<Vec3>& points) {
  std::vector<Vec2> result;
  result.reserve(points.size());
  for (const Vec3& point : points) result.push_back(placed(placement, point));
  return result;
}

void Canvas::take(Curve curve) {
  require_few_pieces(drawing_.curves.size() + 1, drawing_.name);
  drawing_.curves.push_back(
      {std::move(curve), {model_.types.name(entity_->type), model_.layer_names.name(layer_), entity_->place}});
}

void Canvas::draw_line(const Placement& placement, const Vec3& from, const Vec3& to) {
  const Vec2 p = placed(placement, from);
  const Vec2 q = placed(placement, to);
  draw_line(p, q);
}

void Canvas::draw_line(const Vec2& from, const Vec2& to) {
  if (has_length(from, to)) {
    take(Line(from, to));
  } else {
    ++tally_.without_length;
  }
}

/// centre + cos(u) major + sin(u) minor, u from `from` by `sweep`: after an affine map the same with other half axes.
void Canvas::draw_arc(const Placement& placement, const Vec3& centre, const Vec2& major, const Vec2& minor, double from,
                      double sweep) {
  const Vec2 middle = placed(placement, centre);
  const Vec2 a = placement.vector(major);
  const Vec2 b = placement.vector(minor);
  // The ends of the half axes count for the drawing's size and range.
  const Placement flat;
  for (const Vec2& end : {a, b}) placed(flat, {middle.x() + end.x(), middle.y() + end.y(), placement.height(centre)});
  if (!(cross(a, b) != 0 && std::isfinite(cross(a, b)))) {
    ++tally_.without_length;
    return;
  }
  sweep = std::clamp(sweep, -kFullTurn, kFullTurn);
  if (!are_round(a, b)) {
    take(made([&] { return EllipticArc(middle, a, b, from, sweep); }));
    return;
  }
  // A mirrored circle's parameter runs clockwise.
  const double sense = cross(a, b) > 0 ? 1 : -1;
  const double angle = std::atan2(a.y(), a.x());
  take(made([&] { return Arc(middle, std::hypot(a.x(), a.y()), angle + sense * from, sense * sweep); }));
}

/// The arc from one vertex to the next with sweep 4 atan(bulge): counter-clockwise for a bulge above 0.
void Canvas::draw_bulge(const Placement& placement, const Vertex& from, const Vertex& to) {
  const Vec2 p = from.point.head<2>();
  const Vec2 q = to.point.head<2>();
  const Vec2 chord = q - p;
  const double b = from.bulge;
  const double span = std::max(p.cwiseAbs().maxCoeff(), q.cwiseAbs().maxCoeff());
  const double sagitta = 0.5 * std::abs(b) * chord.norm();
  const bool is_straight = std::abs(b) < kStraightBulge || sagitta < std::numeric_limits<double>::epsilon() * span;
  if (is_straight || !has_length(p, q)) {
    draw_line(placement, from.point, to.point);
    return;
  }
  // The centre is (1 - b^2) / (4 b) chords to the left of the chord's middle.
  const Vec2 left(-chord.y(), chord.x());
  const Vec2 centre = 0.5 * (p + q) + (0.25 * (1 - b) * (1 + b) / b) * left;
  const double radius = chord.norm() * (0.25 * (1 + b * b) / std::abs(b));
  const double start = std::atan2(p.y() - centre.y(), p.x() - centre.x());
  draw_arc(placement, {centre.x(), centre.y(), from.point.z()}, {radius, 0}, {0, radius}, start, 4 * std::atan(b));
}

void Canvas::draw_shape(const OtherShape&, const Placement&) { ++tally_.others[model_.types.name(entity_->type)]; }

void Canvas::draw_shape(const LineShape& line, const Placement& outer) { draw_line(outer, line.from, line.to); }

void Canvas::draw_shape(const ArcShape& arc, const Placement& outer) {
  if (arc.radius < 0) {
    ++tally_.negative;
    return;
  }
  draw_arc(placement_of(*entity_, outer), arc.centre, {arc.radius, 0}, {0, arc.radius}, in_radians(arc.start),
           in_radians(sweep_of(arc)));
}

void Canvas::draw_shape(const EllipseShape& ellipse, const Placement& outer) {
  // An ellipse is given in the drawing's coordinates; the extrusion only tells which way it runs.
  const double sense = placement_of(*entity_, {}).linear(0, 0);
  const Vec2 major = ellipse.major.head<2>();
  placed(outer, ellipse.centre + ellipse.major);
  draw_arc(outer, ellipse.centre, major, (sense * ellipse.ratio) * Vec2(-major.y(), major.x()), ellipse.start,
           sweep_of(ellipse));
}

void Canvas::draw_shape(const PolylineShape& line, const Placement& outer) {
  const Placement placement = line.spatial ? outer : placement_of(*entity_, outer);
  if (line.wide) ++tally_.wide;
  if (line.spline_fit) ++tally_.spline_fit;
  const std::size_t count = line.vertices.size();
  if (count < 2) ++tally_.without_length;
  for (std::size_t k = 0; k + (line.closed ? 0 : 1) < count; ++k) {
    const Vertex& from = line.vertices[k];
    const Vertex& to = line.vertices[k + 1 < count ? k + 1 : 0];
    if (count > 1) draw_bulge(placement, from, to);
  }
}

std::vector<Curve> Canvas::curves_of(const SplineShape& spline, const Placement& outer) {
  if (!spline.controls.empty()) {
    const std::vector<Vec2> points = placed(outer, spline.controls);
    if (spline.degree < 1 || spline.degree > kMostDegree) {
      refuse(fmt::format("expected a spline of degree 1 to {}, found {}", kMostDegree, spline.degree));
    }
    return made([&] { return nurbs(static_cast<int>(spline.degree), spline.knots, points, spline.weights); });
  }
  ++tally_.fit_points;
  std::vector<Vec2> points = placed(outer, spline.fits);
  const auto is_repeated = [](const Vec2& a, const Vec2& b) { return !has_length(a, b); };
  const std::size_t given = points.size();
  points.erase(std::unique(points.begin(), points.end(), is_repeated), points.end());
  while (spline.closed && points.size() > 1 && is_repeated(points.front(), points.back())) points.pop_back();
  tally_.repeated += given - points.size();
  if (points.size() < 2) return {};
  return made([&] { return spline_through(points, spline.closed, std::numbers::pi); });
}

void Canvas::draw_shape(const SplineShape& spline, const Placement& outer) {
  const std::vector<Curve> curves = curves_of(spline, outer);
  if (curves.empty()) ++tally_.without_length;
  const bool is_polygon = spline.degree == 1 && !spline.controls.empty();
  for (const Curve& curve : curves) {
    if (is_polygon) {
      draw_line(curve.front(), curve.back());
    } else {
      take(curve);
    }
  }
}

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
