#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "rollfix/curve.hpp"
#include "rollfix/part.hpp"
#include "rollfix/touch.hpp"

// Touches of a part that lies somewhere, drawn by a simulator that knows the outline's points and tangents alone.
namespace touch_cases {

using rollfix::MeasuredTouch;
using rollfix::Part;
using rollfix::Pose;
using rollfix::TouchAnswer;
using rollfix::TouchPose;
using rollfix::TouchProblem;
using rollfix::Vec2;

constexpr double kFullTurn = 2 * std::numbers::pi;

inline double uniform(std::mt19937_64& generator, double lo, double hi) {
  return std::uniform_real_distribution<double>(lo, hi)(generator);
}
inline double normal(std::mt19937_64& generator, double sd) {
  return std::normal_distribution<double>(0, 1)(generator) * sd;
}

/// By so much a place is off; one coordinate after the other, so that every compiler draws the same.
inline Vec2 scatter(std::mt19937_64& generator, double sd) {
  const double y = normal(generator, sd);
  return {normal(generator, sd), y};
}

inline Part polygon(const std::vector<Vec2>& corners, const std::string& name = "polygon") {
  rollfix::Outline outline;
  outline.name = name;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    outline.curves.emplace_back(rollfix::Line(corners[k], corners[(k + 1) % corners.size()]));
  }
  return Part(outline);
}

/// Around the origin, with 7 to 11 corners.
inline Part random_polygon(std::mt19937_64& generator) {
  const int count = std::uniform_int_distribution<int>(7, 11)(generator);
  std::vector<Vec2> corners;
  for (int k = 0; k < count; ++k) {
    const double angle = 2 * std::numbers::pi * (k + uniform(generator, -0.25, 0.25)) / count;
    corners.push_back(uniform(generator, 0.7, 1.2) * Vec2(std::cos(angle), std::sin(angle)));
  }
  return polygon(corners);
}

/// An L with one chamfer: no symmetry.
inline Part bracket() {
  return polygon({{0, 0}, {60, 0}, {60, 18}, {25, 18}, {20, 23}, {20, 45}, {8, 45}, {0, 37}}, "bracket");
}

/// "polygon", "bracket", or a shape of the gallery, whose '%' the seed takes the place of.
inline Part part_named(std::string name, int seed, std::mt19937_64& generator) {
  if (name == "polygon") return random_polygon(generator);
  if (name == "bracket") return bracket();
  const std::size_t at = name.find('%');
  if (at != std::string::npos) name.replace(at, 1, std::to_string(seed));
  return rollfix::load_part(name);
}

/// The boundary as many points: to look for what a disk would hit.
inline std::vector<Vec2> dense(const Part& part) { return part.polyline(0, part.perimeter(), 4000); }

inline double diagonal(const Part& part) {
  const std::vector<Vec2> points = part.polyline(0, part.perimeter(), 400);
  Vec2 least = points.front(), most = least;
  for (const Vec2& point : points) {
    least = least.cwiseMin(point);
    most = most.cwiseMax(point);
  }
  return (most - least).norm();
}

inline Vec2 outward(double tangent) { return {std::sin(tangent), -std::cos(tangent)}; }

/// Where a touch is made, and how the part's tangent points there.
struct Place {
  Vec2 point = Vec2::Zero();
  double tangent = 0;
};

/// Any place, one length of boundary as likely as another, that the disk can get to.
inline Place random_place(const Part& part, double radius, const std::vector<Vec2>& boundary,
                          std::mt19937_64& generator) {
  for (;;) {
    const double s = uniform(generator, 0, part.perimeter());
    const Place place{part.point(s), part.tangent(s)};
    const Vec2 centre = place.point + radius * outward(place.tangent);
    const bool is_free = std::all_of(boundary.begin(), boundary.end(),
                                     [&](const Vec2& point) { return (point - centre).norm() >= radius * (1 - 1e-3); });
    if (radius == 0 || is_free) return place;
  }
}

/// How touches are made and measured.
struct Making {
  std::size_t count = 3;
  std::size_t normals = 3;  // so many of them have one
  double radius = 0;
  double place_sd = 0;
  double angle_sd = 0;
};

struct Case {
  TouchProblem problem;
  Pose truth;
};

inline Case random_case(const Part& part, const Making& making, std::mt19937_64& generator) {
  const double size = diagonal(part);
  const std::vector<Vec2> boundary = making.radius > 0 ? dense(part) : std::vector<Vec2>{};
  Case result{{part, {}}, {}};
  result.truth = {uniform(generator, -size, size), uniform(generator, -size, size),
                  uniform(generator, -std::numbers::pi, std::numbers::pi)};
  for (std::size_t k = 0; k < making.count; ++k) {
    const Place place = random_place(part, making.radius, boundary, generator);
    const Vec2 centre = place.point + making.radius * outward(place.tangent);
    MeasuredTouch touch;
    touch.at = Vec2(result.truth.x, result.truth.y) + result.truth.turned(centre) + scatter(generator, making.place_sd);
    if (k < making.normals) {
      touch.normal = place.tangent - 0.5 * std::numbers::pi + result.truth.heading + normal(generator, making.angle_sd);
    }
    result.problem.touches.push_back(touch);
  }
  if (making.radius > 0) result.problem.finger = rollfix::disk(making.radius);
  rollfix::Noise noise;
  noise.position = making.place_sd;
  noise.angle = making.angle_sd;
  result.problem.noise = noise;
  return result;
}

/// Whether a value is in an interval of headings, which may be any number of turns off.
inline bool holds_heading(const rollfix::Interval& interval, double heading, double slack = 0) {
  return interval.width() >= kFullTurn ||
         std::abs(std::remainder(heading - interval.middle(), kFullTurn)) <= 0.5 * interval.width() + slack;
}

inline bool in_extent(const TouchPose& pose, const Pose& truth) {
  return pose.extent[0].contains(truth.x) && pose.extent[1].contains(truth.y) &&
         holds_heading(pose.extent[2], truth.heading);
}

/// How far a part of this size has to be moved from one pose to another, about.
inline double apart(const Pose& one, const Pose& other, const Vec2& middle, double size) {
  const Vec2 moved = Vec2(one.x, one.y) + one.turned(middle) - Vec2(other.x, other.y) - other.turned(middle);
  return moved.norm() + 0.5 * size * std::abs(std::remainder(one.heading - other.heading, kFullTurn));
}

}  // namespace touch_cases
