#include "files/dxf/read.hpp"

#include <fmt/format.h>

#include <cmath>

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

}  // namespace rollfix::dxf
