#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

#include "files/dxf/entity_tags.hpp"
#include "files/dxf/read.hpp"
#include "files/dxf/text.hpp"

namespace rollfix::dxf {

namespace {

LineShape read_line(EntityTags& tags) {
  PointParts from;
  PointParts to;
  while (tags.next()) tags.take(from, 10) || tags.take(to, 11);
  tags.require(from, 10);
  tags.require(to, 11);
  return {from.point, to.point};
}

ArcShape read_arc(EntityTags& tags, bool whole_circle) {
  ArcShape arc;
  PointParts centre;
  bool has_radius = false;
  bool has_start = whole_circle;
  bool has_end = whole_circle;
  while (tags.next()) {
    if (tags.take_extrusion() || tags.take(centre, 10)) continue;
    if (tags.code() == 40) {
      arc.radius = tags.real();
      has_radius = true;
    } else if (tags.code() == 50 && !whole_circle) {
      arc.start = tags.real();
      has_start = true;
    } else if (tags.code() == 51 && !whole_circle) {
      arc.end = tags.real();
      has_end = true;
    }
  }
  tags.require(centre, 10);
  tags.require(has_radius, "its radius (group code 40)");
  tags.require(has_start && has_end, "its angles (group codes 50 and 51)");
  if (arc.radius < 0) tags.refuse(fmt::format("has the radius {}, expected one of at least 0", arc.radius));
  arc.centre = centre.point;
  return arc;
}

EllipseShape read_ellipse(EntityTags& tags) {
  EllipseShape ellipse;
  PointParts centre;
  PointParts major;
  bool has_ratio = false;
  bool has_start = false;
  bool has_end = false;
  while (tags.next()) {
    if (tags.take_extrusion() || tags.take(centre, 10) || tags.take(major, 11)) continue;
    if (tags.code() == 40) {
      ellipse.ratio = tags.real();
      has_ratio = true;
    } else if (tags.code() == 41) {
      ellipse.start = tags.real();
      has_start = true;
    } else if (tags.code() == 42) {
      ellipse.end = tags.real();
      has_end = true;
    }
  }
  tags.require(centre, 10);
  tags.require(major, 11);
  tags.require(has_ratio, "the ratio of its axes (group code 40)");
  tags.require(has_start && has_end, "its parameters (group codes 41 and 42)");
  if (ellipse.ratio == 0) tags.refuse("has axes of ratio 0, expected another");
  ellipse.centre = centre.point;
  ellipse.major = major.point;
  return ellipse;
}

/// A number of things that the file announces and then has.
void require_count(const EntityTags& tags, const std::optional<std::int64_t>& said, std::size_t found,
                   const char* things) {
  if (!said || *said == static_cast<std::int64_t>(found)) return;
  tags.refuse(fmt::format("says that it has {} {}, but has {}", *said, things, found));
}

/// Appends a point at its x, and fills in y and z that follow.
bool take_point(const EntityTags& tags, std::vector<Vec3>& points, int code_of_x) {
  if (tags.code() == code_of_x) {
    points.emplace_back(tags.real(), 0, 0);
    return true;
  }
  const int axis = tags.code() - code_of_x;
  if (axis != 10 && axis != 20) return false;
  if (points.empty()) tags.refuse(fmt::format("has a coordinate (group code {}) before its point's x", tags.code()));
  points.back()[axis / 10] = tags.real();
  return true;
}

SplineShape read_spline(EntityTags& tags) {
  SplineShape spline;
  std::optional<std::int64_t> degree;
  std::optional<std::int64_t> knots;
  std::optional<std::int64_t> controls;
  std::optional<std::int64_t> fits;
  while (tags.next()) {
    if (take_point(tags, spline.controls, 10) || take_point(tags, spline.fits, 11)) continue;
    switch (tags.code()) {
      case 40:
        spline.knots.push_back(tags.real());
        break;
      case 41:
        spline.weights.push_back(tags.real());
        break;
      case 70:
        spline.closed = (tags.whole() & 1) != 0;
        break;
      case 71:
        degree = tags.whole();
        break;
      case 72:
        knots = tags.whole();
        break;
      case 73:
        controls = tags.whole();
        break;
      case 74:
        fits = tags.whole();
        break;
      default:
        break;
    }
  }
  require_count(tags, knots, spline.knots.size(), "knots");
  require_count(tags, controls, spline.controls.size(), "control points");
  require_count(tags, fits, spline.fits.size(), "fit points");
  tags.require(!spline.controls.empty() || !spline.fits.empty(), "points (group code 10 or 11)");
  tags.require(degree.has_value() || spline.controls.empty(), "its degree (group code 71)");
  spline.degree = degree.value_or(0);
  return spline;
}

InsertShape read_insert(EntityTags& tags) {
  InsertShape insert;
  PointParts at;
  bool has_name = false;
  while (tags.next()) {
    if (tags.take_extrusion() || tags.take(at, 10)) continue;
    switch (tags.code()) {
      case 2:
        insert.block = tags.model().block_names.number_of(text_of(tags.cursor().tag));
        item_at(tags.model().blocks, insert.block);
        has_name = true;
        break;
      case 41:
        insert.scale.x() = tags.real();
        break;
      case 42:
        insert.scale.y() = tags.real();
        break;
      case 43:
        insert.scale.z() = tags.real();
        break;
      case 44:
        insert.column_spacing = tags.real();
        break;
      case 45:
        insert.row_spacing = tags.real();
        break;
      case 50:
        insert.rotation = tags.real();
        break;
      case 70:
        insert.columns = tags.whole();
        break;
      case 71:
        insert.rows = tags.whole();
        break;
      default:
        break;
    }
  }
  tags.require(has_name, "its block's name (group code 2)");
  tags.require(at, 10);
  insert.at = at.point;
  // 0 columns or rows are what some programs write for one.
  insert.columns = std::max<std::int64_t>(insert.columns, 1);
  insert.rows = std::max<std::int64_t>(insert.rows, 1);
  return insert;
}

Shape read_shape(EntityTags& tags, std::string_view type) {
  if (type == "LINE") return read_line(tags);
  if (type == "ARC") return read_arc(tags, false);
  if (type == "CIRCLE") return read_arc(tags, true);
  if (type == "ELLIPSE") return read_ellipse(tags);
  if (type == "LWPOLYLINE") return read_light_polyline(tags);
  if (type == "POLYLINE") return read_polyline(tags);
  if (type == "SPLINE") return read_spline(tags);
  if (type == "INSERT") return read_insert(tags);
  if (type == "VERTEX") tags.refuse("stands outside a POLYLINE");
  while (tags.next()) continue;
  return OtherShape{};
}

/// A record that can't stand among entities: what was being read has no end.
bool ends_too_much(const Tag& tag) {
  for (const std::string_view record : {"EOF", "SECTION", "ENDSEC", "BLOCK", "ENDBLK"}) {
    if (starts(tag, record)) return true;
  }
  return false;
}

}  // namespace

void read_entities(Cursor& cursor, Model& model, std::vector<Entity>& entities, std::string_view end,
                   const std::string& whose) {
  if (cursor.tag.code != 0) {
    cursor.refuse(fmt::format("found group code {}, expected 0 with the first entity of {}", cursor.tag.code, whose));
  }
  while (!starts(cursor.tag, end)) {
    if (ends_too_much(cursor.tag)) {
      cursor.refuse(fmt::format("found {}, expected {}, the end of {}", text_of(cursor.tag), end, whose));
    }
    // The end of an INSERT's attributes draws nothing.
    const bool draws = !starts(cursor.tag, "SEQEND");
    const std::string_view type = text_of(cursor.tag);
    EntityTags tags(cursor, model);
    Shape shape = read_shape(tags, type);
    if (!draws) continue;
    tags.entity().shape = std::move(shape);
    entities.push_back(std::move(tags.entity()));
  }
}

}  // namespace rollfix::dxf
