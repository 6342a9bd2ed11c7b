#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "random.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/part.hpp"
#include "shapes.hpp"

/// Points as a scanner gives them, of closed curves.
namespace scans {

using rollfix::Part;
using rollfix::Smoothing;
using rollfix::Vec2;
using shapes::kPi;

using Formula = Vec2 (*)(double);

inline Vec2 ellipse(double u) { return {2 * std::cos(u), std::sin(u)}; }
inline Vec2 limacon(double u) { return (3 + 1.8 * std::cos(u)) * Vec2(std::cos(u), std::sin(u)); }
inline Vec2 square(double u) {
  const std::vector<Vec2> corners = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}};
  const double along = 2 * u / kPi;
  const auto side = std::min<std::size_t>(3, static_cast<std::size_t>(along));
  return corners[side] + (along - static_cast<double>(side)) * (corners[side + 1] - corners[side]);
}

/// Points of a closed curve, each moved to anywhere in a square of this half width.
inline std::vector<Vec2> scan(Formula formula, int count, double noise, std::uint64_t stream = 0) {
  auto generator = test_generator(stream);
  std::uniform_real_distribution<double> error(-noise, noise);
  std::vector<Vec2> points;
  for (int k = 0; k < count; ++k) {
    const Vec2 exact = formula(2 * kPi * k / count);
    points.push_back(exact + Vec2(error(generator), error(generator)));
  }
  return points;
}

inline Part part_of(const Smoothing& smooth, bool closed = true) { return Part({"scan", smooth.curves, closed}); }

inline double length_of(Formula formula) {
  double sum = 0;
  for (int k = 0; k < 100000; ++k) sum += (formula(2 * kPi * (k + 1) / 100000) - formula(2 * kPi * k / 100000)).norm();
  return sum;
}

}  // namespace scans
