#include "roll_pen.hpp"

#include <algorithm>
#include <cmath>

namespace rollfix::draw {
namespace {

constexpr std::string_view kFingerColour = "#8a8a8a";
constexpr double kMostFingerReach = 0.3;  // beyond the part, as a fraction of its size

}  // namespace

std::vector<Vec2> RollPen::path(double start, const Run& run, const std::function<double(double)>& offset,
                                std::size_t most) const {
  const double from = start + run.from, to = start + run.to;
  const auto beside = [&](double s) { return offset(std::abs(s - from)); };
  std::vector<Vec2> path =
      path_beside(slice(scene_.boundary, std::min(from, to), std::max(from, to)), clearance_, beside);
  path = pick(path, simplify(path, kInvisible, most));
  if (to < from) std::reverse(path.begin(), path.end());
  return path;
}

void RollPen::stems(double start, const Run& run, const std::vector<Vec2>& path, std::string_view colour) {
  const std::vector<Vec2> ends = {scene_.at(start + run.from), path.front(), scene_.at(start + run.to), path.back()};
  Paint paint = stroke(colour, 0.7);
  paint.stroke_opacity = 0.8;
  svg_.segments(ends, paint);
  obstacles_.add({ends[0], ends[1]});
  obstacles_.add({ends[2], ends[3]});
}

void RollPen::arc(const std::vector<Vec2>& path, std::string_view colour, double width, bool head) {
  svg_.open_group("arc");
  const double size = head ? 4 + 2 * width : 0;
  svg_.polyline(without_tip(path, 0.7 * size), stroke(colour, width));
  if (head) draw_arrowhead(svg_, path, size, colour);
  svg_.close_group();
  obstacles_.add(path);
}

void RollPen::start(double s, std::string_view colour, double radius) {
  Paint paint = stroke("#ffffff", 0.6);
  paint.fill = colour;
  marker(s, radius, paint);
}

void RollPen::contact(double s, std::string_view colour, double radius) {
  Paint paint = stroke(colour, 1.4);
  paint.fill = "#ffffff";
  marker(s, radius, paint);
}

void RollPen::marker(double s, double radius, const Paint& paint) {
  const Vec2 at = scene_.at(s), half = Vec2::Constant(radius);
  svg_.circle(at, radius, paint);
  obstacles_.add_box(at - half, at + half);
}

void RollPen::finger(const Part& part, double s, double radius, double spoke) {
  const Vec2 centre = scene_.view(finger_centre(part, s, radius));
  const double size = scene_.pixels(radius);
  Paint disk = stroke(kFingerColour, 1.2);
  disk.fill = kFingerColour;
  disk.fill_opacity = 0.15;
  Paint hub;
  hub.fill = kFingerColour;
  svg_.circle(centre, size, disk);
  const std::vector<Vec2> line = {centre, centre + size * Vec2(std::cos(spoke), -std::sin(spoke))};
  svg_.segments(line, stroke(kFingerColour, 1));
  svg_.circle(centre, 1.8, hub);
  obstacles_.add(line);
  obstacles_.add_circle(centre, size);
}

Vec2 finger_centre(const Part& part, double s, double radius) {
  const double at = part.closed() ? s : std::clamp(s, 0.0, part.perimeter());
  const TurningFunction& turning = part.turning();
  const double tangent = 0.5 * (turning.angle(at, Side::before) + turning.angle(at, Side::after));
  return part.point(at) + radius * Vec2(std::sin(tangent), -std::cos(tangent));
}

void include_finger(Box& box, const Box& bounds, const Part& part, double s, double radius) {
  const Vec2 reach = Vec2::Constant(kMostFingerReach * bounds.sizes().maxCoeff());
  const Vec2 centre = finger_centre(part, s, radius);
  for (const double side : {-radius, radius}) {
    const Vec2 edge = centre + Vec2::Constant(side);
    box.extend(edge.cwiseMax(bounds.min() - reach).cwiseMin(bounds.max() + reach));
  }
}

}  // namespace rollfix::draw
