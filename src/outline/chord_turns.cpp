#include "outline/chord_turns.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>

#include "rollfix/outline.hpp"

namespace rollfix {

namespace {

/// On a curve that is sampled sparsely the points on both sides of one that turns by a corner's angle turn as well, the
/// same way and by this share of it (on ellipses up to 8:1, wherever the points fall); the sides of a corner that is
/// meant are far straighter, one of them at least.
constexpr double kNeighbourShare = 0.12;

/// From one point to the next a nose's curvature grows by this; that of arcs is the same.
constexpr double kNoseGrowth = 1.2;

/// A corner of an airfoil this near to its end, as a share of the chord, is at its trailing edge.
constexpr double kTrailingEdge = 0.02;

}  // namespace

double ChordTurns::at(std::size_t k) const {
  if (is_open_end(k)) return 0;
  const Vec2 before = points_[k] - points_[previous(k)];
  const Vec2 after = points_[next(k)] - points_[k];
  return std::atan2(cross(before, after), before.dot(after));
}

/// The turn, by the length that it takes.
double ChordTurns::curvature(std::size_t k) const {
  if (is_open_end(k)) return 0;
  const double length = (points_[k] - points_[previous(k)]).norm() + (points_[next(k)] - points_[k]).norm();
  return 2 * at(k) / length;
}

bool ChordTurns::goes_on(std::size_t k, double least) const {
  const auto bends_along = [&](const auto& step) {
    std::size_t neighbour = step(k);
    std::size_t steps = 0;
    while (std::abs(at(neighbour)) >= least && ++steps < points_.size()) neighbour = step(neighbour);
    return steps < points_.size() && at(neighbour) * at(k) > 0 &&
           std::abs(at(neighbour)) >= kNeighbourShare * std::abs(at(k));
  };
  return bends_along([this](std::size_t i) { return next(i); }) &&
         bends_along([this](std::size_t i) { return previous(i); });
}

bool ChordTurns::is_nose(std::size_t k, double least) const {
  if (!goes_on(k, least)) return false;
  const auto bends_more = [&](const auto& step) {
    std::size_t neighbour = step(k);
    while (std::abs(at(neighbour)) >= least) neighbour = step(neighbour);
    return std::abs(curvature(neighbour)) >= kNoseGrowth * std::abs(curvature(step(neighbour)));
  };
  return bends_more([this](std::size_t i) { return next(i); }) &&
         bends_more([this](std::size_t i) { return previous(i); });
}

std::vector<std::size_t> corners_of_points(const std::vector<Vec2>& points, bool closed, bool airfoil) {
  const ChordTurns turns(points, closed);
  const auto [nose, tail] =
      std::minmax_element(points.begin(), points.end(), [](const Vec2& a, const Vec2& b) { return a.x() < b.x(); });
  const double trailing_edge = tail->x() - kTrailingEdge * (tail->x() - nose->x());
  std::vector<std::size_t> corners;
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (!(std::abs(turns.at(k)) >= kCornerAngle)) continue;
    const bool is_corner = airfoil ? points[k].x() >= trailing_edge : !turns.is_nose(k, kCornerAngle);
    if (is_corner) corners.push_back(k);
  }
  return corners;
}

}  // namespace rollfix
