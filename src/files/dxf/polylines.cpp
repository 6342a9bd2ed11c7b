#include "files/dxf/entity_tags.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <string_view>

#include "files/dxf/text.hpp"

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

PolylineVertex read_vertex(Cursor& cursor, Model& model) {
  EntityTags tags(cursor, model);
  PolylineVertex result;
  PointParts at;
  while (tags.next()) {
    if (tags.take(at, 10)) continue;
    switch (tags.code()) {
      case 40:
      case 41:
        result.wide = result.wide || tags.real() != 0;
        break;
      case 42:
        result.vertex.bulge = bulge_of(tags);
        break;
      case 70:
        result.is_frame = (tags.whole() & kFrame) != 0;
        break;
      default:
        break;
    }
  }
  tags.require(at, 10);
  result.vertex.point = at.point;
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
  std::optional<std::int64_t> count;
  double elevation = 0;
  const auto last = [&]() -> Vertex& {
    if (line.vertices.empty()) tags.refuse_here("a value of a vertex before the first vertex (group code 10)");
    return line.vertices.back();
  };
  std::size_t without_y = 0;
  while (tags.next()) {
    if (tags.take_extrusion()) continue;
    switch (tags.code()) {
      case 10:
        line.vertices.push_back({{tags.real(), 0, 0}, 0});
        ++without_y;
        break;
      case 20:
        last().point.y() = tags.real();
        --without_y;
        break;
      case 38:
        elevation = tags.real();
        break;
      case 40:
      case 41:
      case 43:
        line.wide = line.wide || tags.real() != 0;
        break;
      case 42:
        last().bulge = bulge_of(tags);
        break;
      case 70:
        line.closed = (tags.whole() & kClosed) != 0;
        break;
      case 90:
        count = tags.whole();
        break;
      default:
        break;
    }
  }
  tags.require(without_y == 0, "the y of each of its vertices (group code 20)");
  if (count && *count != static_cast<std::int64_t>(line.vertices.size())) {
    tags.refuse(fmt::format("says that it has {} vertices, but has {}", *count, line.vertices.size()));
  }
  for (Vertex& vertex : line.vertices) vertex.point.z() = elevation;
  return line;
}

Shape read_polyline(EntityTags& tags) {
  PolylineShape line;
  std::int64_t flags = 0;
  PointParts elevation;
  while (tags.next()) {
    if (tags.take_extrusion() || tags.take(elevation, 10)) continue;
    switch (tags.code()) {
      case 40:
      case 41:
        line.wide = line.wide || tags.real() != 0;
        break;
      case 70:
        flags = tags.whole();
        break;
      default:
        break;
    }
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
    if (!line.spatial) read.vertex.point.z() = elevation.point.z();
    line.wide = line.wide || read.wide;
    line.vertices.push_back(read.vertex);
  });
  return line;
}

}  // namespace rollfix::dxf
