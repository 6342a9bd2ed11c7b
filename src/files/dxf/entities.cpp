#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "files/dxf/read.hpp"

namespace rollfix::dxf {
namespace {

/// An arc of this bulge is a circle but for 1/2,500 of a radian; beyond it is nonsense.
constexpr double kMostBulge = 1e4;

// Bits of a polyline's flags (70).
constexpr std::int64_t kClosed = 1;
constexpr std::int64_t kSplineFit = 4;
constexpr std::int64_t kSpatial = 8;
constexpr std::int64_t kMesh = 16 | 64;
// A bit of VERTEX's flags: the corner of a spline's frame, which is not drawn.
constexpr std::int64_t kFrame = 16;

double bulge_of(const EntityTags& tags) {
  const double bulge = tags.real();
  if (std::abs(bulge) > kMostBulge) {
    tags.refuse_here(
        fmt::format("the bulge {} is nonsense, expected one from -{} to {}", bulge, kMostBulge, kMostBulge));
  }
  return bulge;
}

struct PolylineVertex {
  Vertex vertex;
  bool is_frame = false;
  bool wide = false;
};

/// Whether the group is a width that is not 0: of a segment's start or end, or of the whole.
bool is_wide(const EntityTags& tags) {
  return (tags.code() == 40 || tags.code() == 41 || tags.code() == 43) && tags.real() != 0;
}

PolylineVertex read_vertex(Cursor& cursor, Model& model) {
  EntityTags tags(cursor, model);
  PolylineVertex result;
  std::int64_t flags = 0;
  while (tags.next()) {
    if (tags.take(10, result.vertex.point) || tags.take(70, flags)) continue;
    result.wide = result.wide || is_wide(tags);
    if (tags.code() == 42) result.vertex.bulge = bulge_of(tags);
  }
  tags.require_point(10);
  result.is_frame = (flags & kFrame) != 0;
  return result;
}

/// From the record behind the polyline up to the one behind SEQEND, at which the cursor stands then.
template <class Take>
void read_vertices(EntityTags& tags, const Take& take) {
  Cursor& cursor = tags.cursor();
  while (starts(cursor.tag, "VERTEX")) take(cursor);
  if (!starts(cursor.tag, "SEQEND")) {
    cursor.refuse(fmt::format("found {}, expected VERTEX or SEQEND, the end of the POLYLINE that starts at {}",
                              shown(text_of(cursor.tag)), cursor.reader.where(tags.entity().place)));
  }
  cursor.skip_record();
}

}  // namespace

Shape read_light_polyline(EntityTags& tags) {
  PolylineShape line;
  std::int64_t count = 0, flags = 0;
  double elevation = 0;
  const auto last = [&]() -> Vertex& {
    if (line.vertices.empty()) tags.refuse_here("a value of a vertex before the first vertex (group code 10)");
    return line.vertices.back();
  };
  std::size_t without_y = 0;
  while (tags.next()) {
    if (tags.take_extrusion() || tags.take(38, elevation) || tags.take(70, flags) || tags.take(90, count)) continue;
    line.wide = line.wide || is_wide(tags);
    if (tags.code() == 10) {
      line.vertices.push_back({{tags.real(), 0, 0}, 0});
      ++without_y;
    } else if (tags.code() == 20) {
      last().point.y() = tags.real();
      --without_y;
    } else if (tags.code() == 42) {
      last().bulge = bulge_of(tags);
    }
  }
  line.closed = (flags & kClosed) != 0;
  tags.require(without_y == 0, "the y of each of its vertices (group code 20)");
  tags.require_count(90, count, line.vertices.size(), "vertices");
  for (Vertex& vertex : line.vertices) vertex.point.z() = elevation;
  return line;
}

Shape read_polyline(EntityTags& tags) {
  PolylineShape line;
  std::int64_t flags = 0;
  Vec3 elevation = Vec3::Zero();
  while (tags.next()) {
    if (tags.take_extrusion() || tags.take(10, elevation) || tags.take(70, flags)) continue;
    line.wide = line.wide || is_wide(tags);
  }
  if ((flags & kMesh) != 0) {
    read_vertices(tags, [](Cursor& cursor) { cursor.skip_record(); });
    return OtherShape{};
  }
  line.closed = (flags & kClosed) != 0;
  line.spatial = (flags & kSpatial) != 0;
  line.spline_fit = (flags & kSplineFit) != 0;
  read_vertices(tags, [&](Cursor& cursor) {
    PolylineVertex read = read_vertex(cursor, tags.model());
    if (read.is_frame) return;
    if (!line.spatial) read.vertex.point.z() = elevation.z();
    line.wide = line.wide || read.wide;
    line.vertices.push_back(read.vertex);
  });
  return line;
}

namespace {

/// From here on the group codes are those of extended data, which programs append for themselves.
constexpr int kExtended = 1000;

}  // namespace

EntityTags::EntityTags(Cursor& cursor, Model& model) : cursor_(cursor), model_(model) {
  entity_.type = model.types.number_of(text_of(cursor.tag));
  entity_.layer = kLayerZero;
  entity_.place = cursor.tag.place;
}

bool EntityTags::next() {
  for (cursor_.advance(); cursor_.tag.code != 0; cursor_.advance()) {
    if (!take_common()) return true;
  }
  return false;
}

bool EntityTags::take_common() {
  const int code = cursor_.tag.code;
  if (code == 102) in_group_ = !text_of(cursor_.tag).empty() && text_of(cursor_.tag).front() == '{';
  if (code == 101) in_embedded_ = true;
  if (in_group_ || in_embedded_ || code >= kExtended || code == 102) return true;
  switch (code) {
    case 8:
      entity_.layer = model_.layer_names.number_of(text_of(cursor_.tag));
      item_at(model_.layers, entity_.layer);
      return true;
    case 60:
      entity_.invisible = whole() != 0;
      return true;
    case 67:
      entity_.paper = whole() != 0;
      return true;
    default:
      return false;
  }
}

bool EntityTags::take(int code, double& into) {
  if (cursor_.tag.code != code) return false;
  into = real();
  taken_.set(static_cast<std::size_t>(code));
  return true;
}

bool EntityTags::take(int code, std::int64_t& into) {
  if (cursor_.tag.code != code) return false;
  into = whole();
  taken_.set(static_cast<std::size_t>(code));
  return true;
}

bool EntityTags::take(int code_of_x, Vec3& into) {
  return take(code_of_x, into.x()) || take(code_of_x + 10, into.y()) || take(code_of_x + 20, into.z());
}

void EntityTags::refuse(const std::string& what) const {
  dxf::refuse(cursor_.reader, entity_.place, fmt::format("{} {}", shown(model_.types.name(entity_.type)), what));
}

void EntityTags::require(bool found, const std::string& what) const {
  if (!found) refuse("without " + what);
}

void EntityTags::require(std::initializer_list<int> codes, const std::string& what) const {
  const auto is_taken = [&](int code) { return taken_[static_cast<std::size_t>(code)]; };
  require(std::all_of(codes.begin(), codes.end(), is_taken), what);
}

void EntityTags::require_point(int code_of_x) const {
  require({code_of_x, code_of_x + 10}, fmt::format("its point (group codes {} and {})", code_of_x, code_of_x + 10));
}

void EntityTags::require_count(int code, std::int64_t said, std::size_t found, std::string_view things) const {
  if (!taken_[static_cast<std::size_t>(code)] || said == static_cast<std::int64_t>(found)) return;
  refuse(fmt::format("says that it has {} {}, but has {}", said, things, found));
}

namespace {

LineShape read_line(EntityTags& tags) {
  LineShape line;
  while (tags.next()) tags.take(10, line.from) || tags.take(11, line.to);
  tags.require_point(10);
  tags.require_point(11);
  return line;
}

ArcShape read_arc(EntityTags& tags, bool whole_circle) {
  ArcShape arc;
  while (tags.next()) {
    if (tags.take_extrusion() || tags.take(10, arc.centre) || tags.take(40, arc.radius) || whole_circle) continue;
    tags.take(50, arc.start) || tags.take(51, arc.end);
  }
  tags.require_point(10);
  tags.require({40}, "its radius (group code 40)");
  if (!whole_circle) tags.require({50, 51}, "its angles (group codes 50 and 51)");
  // A circle is an outline by itself, and what is wrong with it is of no other: it is left out when it is drawn.
  if (arc.radius < 0 && !whole_circle)
    tags.refuse(fmt::format("has the radius {}, expected one of at least 0", arc.radius));
  return arc;
}

EllipseShape read_ellipse(EntityTags& tags) {
  EllipseShape ellipse;
  while (tags.next()) {
    if (tags.take_extrusion() || tags.take(10, ellipse.centre) || tags.take(11, ellipse.major)) continue;
    tags.take(40, ellipse.ratio) || tags.take(41, ellipse.start) || tags.take(42, ellipse.end);
  }
  tags.require_point(10);
  tags.require_point(11);
  tags.require({40}, "the ratio of its axes (group code 40)");
  tags.require({41, 42}, "its parameters (group codes 41 and 42)");
  if (ellipse.ratio == 0) tags.refuse("has axes of ratio 0, expected another");
  return ellipse;
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
  std::int64_t flags = 0, knots = 0, controls = 0, fits = 0;
  double number = 0;
  while (tags.next()) {
    if (take_point(tags, spline.controls, 10) || take_point(tags, spline.fits, 11)) continue;
    if (tags.take(40, number)) {
      spline.knots.push_back(number);
    } else if (tags.take(41, number)) {
      spline.weights.push_back(number);
    } else {
      tags.take(70, flags) || tags.take(71, spline.degree) || tags.take(72, knots) || tags.take(73, controls) ||
          tags.take(74, fits);
    }
  }
  spline.closed = (flags & 1) != 0;
  tags.require_count(72, knots, spline.knots.size(), "knots");
  tags.require_count(73, controls, spline.controls.size(), "control points");
  tags.require_count(74, fits, spline.fits.size(), "fit points");
  tags.require(!spline.controls.empty() || !spline.fits.empty(), "points (group code 10 or 11)");
  if (!spline.controls.empty()) tags.require({71}, "its degree (group code 71)");
  return spline;
}

InsertShape read_insert(EntityTags& tags) {
  InsertShape insert;
  bool has_name = false;
  while (tags.next()) {
    if (tags.code() == 2) {
      insert.block = tags.model().block_names.number_of(text_of(tags.cursor().tag));
      item_at(tags.model().blocks, insert.block);
      has_name = true;
    } else {
      tags.take_extrusion() || tags.take(10, insert.at) || tags.take(41, insert.scale.x()) ||
          tags.take(42, insert.scale.y()) || tags.take(43, insert.scale.z()) || tags.take(44, insert.column_spacing) ||
          tags.take(45, insert.row_spacing) || tags.take(50, insert.rotation) || tags.take(70, insert.columns) ||
          tags.take(71, insert.rows);
    }
  }
  tags.require(has_name, "its block's name (group code 2)");
  tags.require_point(10);
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
