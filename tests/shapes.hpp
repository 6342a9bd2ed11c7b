#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "rollfix/curve.hpp"
#include "rollfix/locate.hpp"
#include "rollfix/outline.hpp"

/// Small words for tests about parts and placements.
namespace shapes {

inline constexpr double kPi = std::numbers::pi;

/// The name of a parametrized test: what its shape is called.
inline std::string as_identifier(const testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  for (char& letter : name) letter = std::isalnum(static_cast<unsigned char>(letter)) != 0 ? letter : '_';
  return name;
}

inline rollfix::Vec2 random_point(std::mt19937_64& generator) {
  std::uniform_real_distribution<double> coordinate(-10, 10);
  const double x = coordinate(generator);
  return {x, coordinate(generator)};
}

inline rollfix::Outline polygon(const std::vector<rollfix::Vec2>& corners, bool closed = true) {
  rollfix::Outline outline{"polygon", {}, closed};
  const std::size_t count = corners.size();
  for (std::size_t k = 0; k + (closed ? 0 : 1) < count; ++k) {
    outline.curves.emplace_back(rollfix::Line(corners[k], corners[(k + 1) % count]));
  }
  return outline;
}

inline rollfix::Part unit_square() { return rollfix::Part(polygon({{0, 0}, {1, 0}, {1, 1}, {0, 1}})); }

/// What a finger would read that rolls from s by this length.
inline rollfix::Reading reading_from(const rollfix::Part& part, double s, double length) {
  return {length, part.turning().angle(s + length) - part.turning().angle(s)};
}

inline std::vector<double> starts(const rollfix::Search& search) {
  std::vector<double> found;
  for (const rollfix::Placement& placement : search.placements) found.push_back(placement.start[0]);
  return found;
}

inline std::vector<rollfix::Kind> kinds(const rollfix::Search& search) {
  std::vector<rollfix::Kind> found;
  for (const rollfix::Placement& placement : search.placements) found.push_back(placement.kind);
  return found;
}

/// Four equal waves with two ends: what is felt of one is felt of all.
inline rollfix::Part open_waves() {
  std::vector<rollfix::Vec2> points;
  for (int k = 0; k <= 160; ++k) {
    const double x = 8 * std::numbers::pi * k / 160;
    points.emplace_back(x, 0.5 * std::sin(x));
  }
  rollfix::OutlineOptions options;
  options.open = true;
  return rollfix::Part(rollfix::outline_through(points, "waves", options));
}

/// Is there a placement whose extent holds s, give or take `slack`?
inline bool holds(const rollfix::Part& part, const rollfix::Search& search, double s, double slack) {
  return std::any_of(search.placements.begin(), search.placements.end(), [&](const rollfix::Placement& placement) {
    return part.boundary().contains(placement.extent[0], s, slack);
  });
}

/// As drawings are now and then: handles that lie on their end points, of a rational curve as well.
inline rollfix::Part drawn_with_rests() {
  rollfix::Outline outline;
  outline.name = "rests";
  const auto add = [&](std::vector<rollfix::Vec2> points, std::vector<double> weights = {}) {
    for (const rollfix::Curve& curve : rollfix::bezier_curves(std::move(points), std::move(weights))) {
      outline.curves.push_back(curve);
    }
  };
  add({{0, 0}, {0, 0}, {0, 0}, {1.5, -0.8}, {3, 0}});
  add({{3, 0}, {3.5, 1}, {3, 2}, {3, 2}});
  add({{3, 2}, {3, 2}, {2, 3}, {0, 2.2}, {0, 2.2}});
  add({{0, 2.2}, {0, 2.2}, {-0.8, 1}, {0, 0}}, {1, 0.7, 1.3, 1});
  return rollfix::Part(outline);
}

}  // namespace shapes
