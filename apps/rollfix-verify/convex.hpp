#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace rollfix_verify {

/// Both ends of an interval.
struct Interval {
  double lo = 0;
  double hi = 0;

  double width() const { return hi - lo; }
  /// Whether it holds all of the other one, beyond its ends by this at the most.
  bool holds(const Interval& other, double slack) const { return other.lo >= lo - slack && other.hi <= hi + slack; }
  bool meets(const Interval& other) const { return lo <= other.hi && other.lo <= hi; }
};

/// Pairs: first contacts of finger a and of finger b.
using Box = std::array<Interval, 2>;

/// The corners of a convex set of pairs in order; none: empty.
using Polygon = std::vector<std::array<double, 2>>;

/// What is left of it where a linear function, `at` + `slope` . pair, is no more than `most`.
/// A convex set stays convex. Doubles: the caller has slack for their rounding.
inline Polygon clipped(const Polygon& polygon, double at, const std::array<double, 2>& slope, double most) {
  // Above 0: cut off.
  const auto excess = [&](const std::array<double, 2>& p) { return at + slope[0] * p[0] + slope[1] * p[1] - most; };
  Polygon kept;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const auto& here = polygon[k];
    const auto& next = polygon[(k + 1) % polygon.size()];
    const double from = excess(here);
    const double to = excess(next);
    // Corners on the line stay; an edge that crosses it gives a new corner there.
    if (from <= 0) kept.push_back(here);
    if (!((from < 0 && to > 0) || (from > 0 && to < 0))) continue;
    const double share = from / (from - to);
    kept.push_back({here[0] + share * (next[0] - here[0]), here[1] + share * (next[1] - here[1])});
  }
  return kept;
}

/// Whether two of them, the other one moved by `shift`, are further apart than `slack` as seen along a direction.
inline bool are_apart_along(const std::array<double, 2>& direction, const Polygon& one, const Polygon& other,
                            const std::array<double, 2>& shift, double slack) {
  const auto& from = one.front();  // small ones keep their digits
  const auto along = [&](const std::array<double, 2>& p, double s, double t) {
    return direction[0] * (p[0] + s - from[0]) + direction[1] * (p[1] + t - from[1]);
  };
  double lo = 0;
  double hi = 0;
  for (const auto& p : one) {
    lo = std::min(lo, along(p, 0, 0));
    hi = std::max(hi, along(p, 0, 0));
  }
  const auto at = [&](const auto& p) { return along(p, shift[0], shift[1]); };
  // All of the other one is on one side.
  return std::all_of(other.begin(), other.end(), [&](const auto& p) { return at(p) > hi + slack; }) ||
         std::all_of(other.begin(), other.end(), [&](const auto& p) { return at(p) < lo - slack; });
}

/// Whether two come as near as `slack`: no direction along an edge or across one has them further apart. Nearly always
/// an axis settles it.
inline bool are_near(const Polygon& one, const Polygon& other, const std::array<double, 2>& shift, double slack) {
  if (are_apart_along({1, 0}, one, other, shift, slack) || are_apart_along({0, 1}, one, other, shift, slack))
    return false;
  // Convex sets that are apart are so across some edge of one of them (separating axis); along edges for sets without
  // area.
  std::vector<std::array<double, 2>> directions;
  for (const Polygon* polygon : {&one, &other}) {
    for (std::size_t k = 0; k < polygon->size(); ++k) {
      const auto& from = (*polygon)[k];
      const auto& to = (*polygon)[(k + 1) % polygon->size()];
      const double length = std::hypot(to[0] - from[0], to[1] - from[1]);
      if (!(length > 0)) continue;
      directions.push_back({(to[0] - from[0]) / length, (to[1] - from[1]) / length});
      directions.push_back({-directions.back()[1], directions.back()[0]});
    }
  }
  return std::none_of(directions.begin(), directions.end(),
                      [&](const auto& direction) { return are_apart_along(direction, one, other, shift, slack); });
}

}  // namespace rollfix_verify
