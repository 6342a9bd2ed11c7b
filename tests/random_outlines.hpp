#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <random>
#include <vector>

#include "pair_cases.hpp"
#include "rollfix/curve.hpp"
#include "rollfix/error.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/part.hpp"
#include "shapes.hpp"

// Random outlines of lines and arcs, with corners both ways, and questions on them.
namespace random_outlines {

using rollfix::Part;
using rollfix::Reading;
using rollfix::Vec2;

inline double uniform(std::mt19937_64& generator, double lo, double hi) {
  return std::uniform_real_distribution<double>(lo, hi)(generator);
}
inline bool chance(std::mt19937_64& generator, double share) { return uniform(generator, 0, 1) < share; }

/// A line; or where the bulge is not 0 an arc, whose middle is that share of the chord off it.
inline rollfix::Curve edge(const Vec2& from, const Vec2& to, double bulge) {
  if (bulge == 0) return rollfix::Line(from, to);
  const Vec2 chord = to - from;
  const double sweep = 4 * std::atan(2 * bulge);
  const double height = 0.5 * chord.norm() / std::tan(0.5 * sweep);
  const Vec2 centre = 0.5 * (from + to) + height * Vec2(-chord.y(), chord.x()).normalized();
  const Vec2 first = from - centre;
  return rollfix::Arc(centre, first.norm(), std::atan2(first.y(), first.x()), sweep);
}

/// Around the origin; one in three has a symmetry, one in three is open.
inline std::optional<Part> outline(std::mt19937_64& generator) {
  const int n = std::uniform_int_distribution<int>(3, 8)(generator);
  const bool is_symmetric = chance(generator, 0.33);
  const auto bulge = [&] { return chance(generator, 0.4) ? 0.0 : uniform(generator, -0.12, 0.2); };
  const double all = bulge();
  std::vector<Vec2> points;
  for (int k = 0; k < n; ++k) {
    const double angle = 2 * shapes::kPi * k / n;
    points.push_back((is_symmetric ? 1 : uniform(generator, 0.6, 1.3)) * Vec2(std::cos(angle), std::sin(angle)));
  }
  rollfix::Outline result;
  result.name = "lines and arcs";
  result.closed = !chance(generator, 0.33);
  const std::size_t edges = result.closed ? points.size() : points.size() - 1;
  for (std::size_t k = 0; k < edges; ++k) {
    const Vec2& next = points[(k + 1) % points.size()];
    result.curves.push_back(edge(points[k], next, is_symmetric ? all : bulge()));
  }
  try {
    return Part(result);
  } catch (const rollfix::InputError&) {  // it crosses itself
    return std::nullopt;
  }
}

struct Question {
  Part part;
  std::vector<Reading> readings;
  double tolerance = 1e-9;
};

/// Rolls from one start, at a corner at times, of up to three laps, of none, of whole ones, or to an end.
inline Question question(std::mt19937_64& generator) {
  for (;;) {
    const std::optional<Part> drawn = outline(generator);
    if (!drawn) continue;
    const Part& part = *drawn;
    const double period = part.perimeter();
    double start = uniform(generator, 0, period);
    double pivot = 0;
    if (!part.corners().empty() && chance(generator, 0.25)) {
      const rollfix::Corner& corner = part.corners()[0];
      start = corner.s + 1e-9 * period;
      if (!corner.is_concave()) pivot = corner.turn * uniform(generator, 0, 1);
    }
    Question result{part, {}, std::pow(10, uniform(generator, -10, -2.5))};
    const int count = chance(generator, 0.6) ? 1 : std::uniform_int_distribution<int>(2, 4)(generator);
    for (int k = 0; k < count; ++k) {
      double length = part.closed() ? uniform(generator, -1, 1) * period : uniform(generator, -start, period - start);
      if (part.closed() && chance(generator, 0.15)) length = std::round(uniform(generator, -3.4, 3.4)) * period;
      if (!part.closed() && chance(generator, 0.1)) length = 0.999999 * (period - start);
      Reading reading = shapes::reading_from(part, start, length);
      reading.turn += pivot;
      result.readings.push_back(reading);
    }
    return result;
  }
}

/// Of two fingers, closed parts or open ones.
inline Question question_of_two(std::mt19937_64& generator) {
  for (;;) {
    const std::optional<Part> drawn = outline(generator);
    if (!drawn) continue;
    return {*drawn, pair_cases::random_case(*drawn, 2, generator).readings, std::pow(10, uniform(generator, -10, -4))};
  }
}

}  // namespace random_outlines
