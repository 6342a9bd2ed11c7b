#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "rollfix/curve.hpp"
#include "rollfix/finger.hpp"
#include "rollfix/log.hpp"
#include "rollfix/part.hpp"
#include "shapes.hpp"

// Fingers with corners, and what they feel by the corners alone: written apart from the library.
namespace corner_fingers {

using rollfix::Vec2;

/// A convex polygon, counter-clockwise from the middle of its first side: u = 0 is there.
struct Polygon {
  std::vector<Vec2> corners;

  rollfix::Finger finger() const {
    std::vector<Vec2> points = corners;
    points.insert(points.begin(), 0.5 * (corners.front() + corners.back()));
    return rollfix::Finger::outlined(shapes::polygon(points));
  }
  Vec2 from(std::size_t side) const { return side == 0 ? 0.5 * (corners.front() + corners.back()) : corners[side - 1]; }
  Vec2 to(std::size_t side) const { return side == corners.size() ? from(0) : corners[side]; }
  double length(std::size_t side) const { return (to(side) - from(side)).norm(); }
  double around() const {
    double sum = 0;
    for (std::size_t side = 0; side <= corners.size(); ++side) sum += length(side);
    return sum;
  }
  /// Of each corner, up to whole laps.
  std::vector<double> places() const {
    std::vector<double> found;
    double sum = 0;
    for (std::size_t side = 0; side < corners.size(); ++side) found.push_back(sum += length(side));
    return found;
  }
  double gap_to_corner(double u) const {
    double least = around();
    for (const double place : places()) least = std::min(least, std::abs(std::remainder(u - place, around())));
    return least;
  }
  /// Direction of the outward normal of the side that holds u, up to whole turns.
  double normal(double u) const {
    double left = std::fmod(std::fmod(u, around()) + around(), around());
    std::size_t side = 0;
    while (side < corners.size() && left > length(side)) left -= length(side++);
    const Vec2 along = to(side) - from(side);
    return std::atan2(-along.x(), along.y());
  }
};

/// A square fingertip, its lower side in the middle of the x axis.
inline Polygon square(double half) { return {{{half, 0}, {half, 2 * half}, {-half, 2 * half}, {-half, 0}}}; }

/// A flat tip with two chamfers, and a triangle.
inline Polygon chamfered(double size) {
  return {{{0.5 * size, 0},
           {size, 0.4 * size},
           {size, 2 * size},
           {-size, 2 * size},
           {-size, 0.4 * size},
           {-0.5 * size, 0}}};
}
inline Polygon triangle(double size) { return {{{size, 0}, {0, 1.7 * size}, {-size, 0}}}; }

/// The square with corners rounded by this radius; u = 0 is still in the middle of the lower side.
inline rollfix::Finger rounded_square(double half, double radius) {
  using rollfix::Arc;
  using rollfix::Line;
  constexpr double kQuarter = 0.5 * std::numbers::pi;
  const double in = half - radius;
  const double top = 2 * half;
  rollfix::Outline outline{"rounded square", {}, true};
  outline.curves.emplace_back(Line({0, 0}, {in, 0}));
  outline.curves.emplace_back(Arc({in, radius}, radius, -kQuarter, kQuarter));
  outline.curves.emplace_back(Line({half, radius}, {half, top - radius}));
  outline.curves.emplace_back(Arc({in, top - radius}, radius, 0, kQuarter));
  outline.curves.emplace_back(Line({in, top}, {-in, top}));
  outline.curves.emplace_back(Arc({-in, top - radius}, radius, kQuarter, kQuarter));
  outline.curves.emplace_back(Line({-half, top - radius}, {-half, radius}));
  outline.curves.emplace_back(Arc({-in, radius}, radius, 2 * kQuarter, kQuarter));
  outline.curves.emplace_back(Line({-in, 0}, {0, 0}));
  return rollfix::Finger::outlined(outline);
}

/// Direction of the part's tangent by two of its points.
inline double tangent_of(const rollfix::Part& part, double s) {
  const double h = 1e-6 * part.perimeter();
  const Vec2 chord = part.point(s + h) - part.point(s - h);
  return std::atan2(chord.y(), chord.x());
}

/// By how much the part's headings differ that the rows off the finger's corners ask for, if the first contact was at
/// s: 0 where the roll can have started there.
inline double disagreement(const rollfix::Part& part, const Polygon& polygon, const rollfix::Log& log, double s) {
  const std::vector<double>& u = log.fingers[0].u;
  const std::vector<double>& psi = log.fingers[0].psi;
  std::vector<double> headings;
  double most = 0;
  for (std::size_t row = 0; row < u.size(); ++row) {
    if (polygon.gap_to_corner(u[row]) < 1e-7) continue;
    headings.push_back(polygon.normal(u[row]) + psi[row] - tangent_of(part, s - (u[row] - u[0])));
    most = std::max(most, std::abs(std::remainder(headings.back() - headings.front(), 2 * std::numbers::pi)));
  }
  return most;
}

}  // namespace corner_fingers
