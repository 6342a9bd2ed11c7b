#include "posed_part.hpp"

#include <fmt/format.h>

#include <cmath>

#include "outline/turn.hpp"
#include "scene.hpp"

namespace rollfix::draw {
namespace {

constexpr double kCoarse = 1e-4;        // of the part's size: how far a coarse outline may be off
constexpr double kJawShare = 0.35;      // likewise: how much of a jaw is drawn to each side
constexpr double kPoseRounding = 1e-9;  // of the perimeter: a place's rounding
constexpr double kOtherPose = 0.55;     // opacity of poses but the first

}  // namespace

Trace coarse_outline(const Part& part, double size) { return trace(part, kCoarse * size); }

std::vector<Vec2> shape_of(const Finger& finger, int sides, double part_size, double u) {
  if (finger.is_jaw()) return {{u - kJawShare * part_size, 0}, {u + kJawShare * part_size, 0}};
  if (finger.outline()) return finger.outline()->polyline(0, finger.outline()->perimeter(), sides);
  std::vector<Vec2> points;
  for (int k = 0; k <= sides; ++k) points.push_back(finger.point(kFullTurn * k / sides));
  return points;
}

PosedPart::PosedPart(const Part& part, PlaceKnown place, bool mirrored)
    : part_(part),
      place_(place),
      mirrored_(mirrored),
      outline_(coarse_outline(part, part_bounds(part).sizes().maxCoeff())) {}

std::vector<Vec2> PosedPart::in_world(const std::vector<Vec2>& points, const Pose& pose) const {
  return posed(points, place_ == PlaceKnown::unknown ? Pose{0, 0, pose.heading} : pose, mirrored_);
}

std::string PosedPart::frame_words() const {
  return place_ == PlaceKnown::unknown ? "turned as in the world; its place is not known" : "in the world";
}

void PosedPart::draw(Svg& svg, const World& world, std::size_t k, const Pose& pose,
                     const std::vector<Outline>& others) const {
  const std::vector<Vec2> points = world.path(at(pose));
  const bool is_first = k == 0;
  if (is_first && part_.closed() && !part_.outline().hole) svg.polygon(points, filled(kMaterial));
  svg.polyline(points, stroke(colour(k), is_first ? 1.8 : 1.1, "", is_first ? 1 : kOtherPose));
  if (!is_first) return;
  for (const Outline& other : others) {
    svg.polyline(world.path(in_world(polyline_of(other), pose)), stroke(kSoftInk, 0.6));
  }
}

LegendEntry PosedPart::entry(std::size_t k, const std::string& lead, const PoseWords& words) const {
  const auto place = [&](double value) {  // without what is rounding
    return pretty(std::abs(value) <= kPoseRounding * part_.perimeter() ? 0 : value);
  };
  const std::string where = place_ == PlaceKnown::unknown
                                ? "its place is not known"
                                : fmt::format("x {}, y {}", place(words.pose.x), place(words.pose.y));
  std::string text =
      fmt::format("{} {}, heading {}", lead, where, words.any_heading ? "any" : pretty_degrees(words.pose.heading));
  if (std::isfinite(words.probability)) text += ", " + percent(words.probability);
  if (words.continuum) text += ", one of a continuum";
  return {Sign::line, colour(k), {{text}}, ""};
}

}  // namespace rollfix::draw
