#include "scene.hpp"

#include <algorithm>

#include "labels.hpp"
#include "plot.hpp"
#include "rolls.hpp"

namespace rollfix::draw {
namespace {

constexpr double kBoundaryWidth = 1.6;   // pixels
constexpr double kExtrasMargin = 8;      // around fingers and the like
constexpr double kScaleBarWidth = 0.22;  // at most, of the drawing's width

std::vector<Vec2> rectangle(const Box& box) {
  return {box.min(), Vec2(box.max().x(), box.min().y()), box.max(), Vec2(box.min().x(), box.max().y())};
}

/// A closed boundary without its repeated last vertex.
std::vector<Vec2> loop(const Trace& trace) {
  return std::vector<Vec2>(trace.points.begin(), std::prev(trace.points.end()));
}

/// What the content covers at a scale, in pixels from the part's own origin, y pointing up.
Box filled(const Framing& framing, double scale) {
  const Vec2 margin(framing.margin, framing.margin), small(kExtrasMargin, kExtrasMargin);
  Box box;
  box.extend(scale * framing.part.min() - margin);
  box.extend(scale * framing.part.max() + margin);
  if (!framing.extras.isEmpty()) {
    box.extend(scale * framing.extras.min() - small);
    box.extend(scale * framing.extras.max() + small);
  }
  return box;
}

}  // namespace

double fitting_scale(const Framing& framing, double width, double height) {
  const auto fits = [&](double scale) {
    const Vec2 size = size_at(framing, scale);
    return size.x() <= width && size.y() <= height;
  };
  // No part is seen at all below the first guess, and it sticks out above the second.
  const double extent = framing.part.sizes().maxCoeff();
  double lo = 16 / extent, hi = 2 * std::max(width, std::min(height, 4 * width)) / extent;
  for (int i = 0; i < 60 && lo < hi; ++i) {
    const double middle = 0.5 * (lo + hi);
    (fits(middle) ? lo : hi) = middle;
  }
  return lo;
}

Vec2 size_at(const Framing& framing, double scale) { return filled(framing, scale).sizes(); }

Vec2 Scene::normal(double s) const {
  const Vec2 after = direction_at(boundary, s, Side::after);
  const Vec2 sum = direction_at(boundary, s, Side::before) + after;
  return outward(sum.norm() > 1e-9 ? Vec2(sum.normalized()) : after);
}

double drawing_height(const Framing& framing) {
  const double height = size_at(framing, fitting_scale(framing, framing.width, 1e300)).y() + kStripHeight;
  return std::clamp(height, framing.least_height, framing.most_height);
}

Scene make_scene(const Part& part, const Framing& framing, const Vec2& corner) {
  const Box area(corner, corner + Vec2(framing.width, drawing_height(framing)));
  const Vec2 room = area.sizes() - Vec2(0, kStripHeight);
  Scene scene = scene_at(part, framing, fitting_scale(framing, room.x(), room.y()), Box(corner, corner + room));
  scene.area = area;
  return scene;
}

Scene scene_at(const Part& part, const Framing& framing, double scale, const Box& area) {
  Scene scene;
  scene.area = area;
  scene.view.scale = scale;
  const Vec2 centre = filled(framing, scale).center();
  scene.view.origin = area.min() + 0.5 * area.sizes() + Vec2(-centre.x(), centre.y());
  scene.boundary = trace(part, kInvisible / scale);
  for (Vec2& point : scene.boundary.points) point = scene.view(point);
  return scene;
}

Box part_bounds(const Part& part) { return box_around(trace(part, 1e-4 * part.perimeter()).points); }

void draw_material(Svg& svg, const Scene& scene, const Part& part) {
  if (!part.closed()) return;
  const Paint paint = filled(kMaterial);
  if (part.turns() < 0) {
    svg.loops({rectangle(scene.area), loop(scene.boundary)}, paint);  // a hole: the material is around it
  } else {
    svg.polygon(loop(scene.boundary), paint);
  }
}

void draw_boundary(Svg& svg, const Scene& scene, const Part& part) {
  const Paint paint = stroke(kInk, kBoundaryWidth);
  svg.open_group("boundary");
  if (part.closed()) {
    svg.polygon(loop(scene.boundary), paint);
  } else {
    svg.polyline(scene.boundary.points, paint);
  }
  svg.close_group();
}

void draw_corners(Svg& svg, const Scene& scene, const Part& part, Obstacles& obstacles) {
  if (part.corners().empty() || part.corners().size() > kMostCorners) return;
  svg.open_group("corners");
  for (const Corner& corner : part.corners()) {
    const Vec2 at = scene.at(corner.s);
    draw_sign(svg, Sign::corner, at, sign_colour(Sign::corner));
    obstacles.add_box(at - Vec2(3, 3), at + Vec2(3, 3));
  }
  svg.close_group();
}

void draw_origin(Svg& svg, const Scene& scene, Obstacles& obstacles) {
  const Vec2 at = scene.at(0), along = direction_at(scene.boundary, 0, Side::after);
  const Vec2 normal = outward(along);
  const Vec2 foot = at - 6 * normal;
  const std::vector<Vec2> arrow = {foot, foot + 14 * along};
  svg.open_group("origin");
  svg.segments({at + 4 * normal, foot}, stroke(kInk, 1.2));
  svg.polyline({arrow[0], arrow[1] - 3 * along}, stroke(kInk, 1));
  draw_arrowhead(svg, arrow, 5, kInk);
  svg.close_group();
  obstacles.add({at + 4 * normal, foot});
  obstacles.add(arrow);
}

void draw_scale_bar(Svg& svg, const Scene& scene, const Part& part) {
  const double length = round_below(kScaleBarWidth * scene.area.sizes().x() / scene.view.scale);
  const double width = scene.pixels(length);
  const Vec2 left(scene.area.min().x() + 14, scene.area.max().y() - 8);
  const Vec2 right = left + Vec2(width, 0), up(0, -4);
  svg.open_group("scale-bar");
  svg.segments({left, right, left, left + up, right, right + up}, stroke(kSoftInk, 1.2));
  svg.text(right + Vec2(6, 1), {{with_unit(pretty(length), part)}}, {10, Align::start, std::string(kSoftInk)});
  svg.close_group();
}

namespace {

constexpr int kOtherSteps = 200;       // of each curve that is not used
constexpr double kMostOtherReach = 1;  // beyond the part, as a fraction of its size
constexpr double kOtherWidth = 0.7;    // pixels

}  // namespace

std::vector<Vec2> polyline_of(const Outline& outline) {
  std::vector<Vec2> points;
  for (const Curve& curve : outline.curves) {
    const Interval range = curve.domain();
    for (int k = points.empty() ? 0 : 1; k <= kOtherSteps; ++k) {
      points.push_back(curve.position(range.lo + range.width() * k / kOtherSteps));
    }
  }
  return points;
}

void draw_others(Svg& svg, const Scene& scene, const std::vector<Outline>& others) {
  if (others.empty()) return;
  svg.open_group("others");
  for (const Outline& other : others) {
    std::vector<Vec2> path;
    for (const Vec2& point : polyline_of(other)) path.push_back(scene.view(point));
    svg.polyline(pick(path, simplify(path, kInvisible, kMostVertices)), stroke(kSoftInk, kOtherWidth));
  }
  svg.close_group();
}

Box bounds_of(const std::vector<Outline>& others, const Box& bounds) {
  const Vec2 reach = Vec2::Constant(kMostOtherReach * bounds.sizes().maxCoeff());
  Box box;
  for (const Outline& other : others) {
    for (const Vec2& point : polyline_of(other)) {
      box.extend(point.cwiseMax(bounds.min() - reach).cwiseMin(bounds.max() + reach));
    }
  }
  return box;
}

void draw_arrowhead(Svg& svg, const std::vector<Vec2>& path, double size, std::string_view colour) {
  if (path.size() < 2) return;
  const Vec2& tip = path.back();
  // The direction over the head's own length, so that a bent path's head does not stick out.
  Vec2 tail = path.front();
  for (auto point = path.rbegin(); point != path.rend(); ++point) {
    if ((tip - *point).norm() < size) continue;
    tail = *point;
    break;
  }
  const double distance = (tip - tail).norm();
  if (distance < 0.3 * size) return;
  const Vec2 back = (tail - tip) / distance, side(-back.y(), back.x());
  svg.polygon({tip, tip + size * back + 0.42 * size * side, tip + size * back - 0.42 * size * side}, filled(colour));
}

std::vector<Vec2> without_tip(const std::vector<Vec2>& path, double length) {
  const Vec2& tip = path.back();
  for (std::size_t count = path.size(); count-- > 1;) {
    const Vec2& before = path[count - 1];
    const double distance = (before - tip).norm();
    if (distance <= length) continue;
    // Where the edge enters the circle of that radius around the tip, near enough.
    const double inner = (path[count] - tip).norm();
    std::vector<Vec2> out(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(count));
    out.emplace_back(before + (path[count] - before) * (distance - length) / (distance - inner));
    return out;
  }
  return path;
}

}  // namespace rollfix::draw
