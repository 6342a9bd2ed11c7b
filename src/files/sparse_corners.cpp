#include "files/sparse_corners.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>

#include "outline/chord_turns.hpp"
#include "text/text.hpp"

namespace rollfix {

namespace {

/// So many places are named.
constexpr std::size_t kMostNamed = 4;

/// Where on the part a corner was made of this point.
std::optional<double> place_of(const Vec2& point, const Part& part) {
  const std::vector<Corner>& corners = part.corners();
  const auto distance = [&](const Corner& corner) { return (part.point(corner.s) - point).squaredNorm(); };
  const auto nearest = std::min_element(corners.begin(), corners.end(),
                                        [&](const Corner& a, const Corner& b) { return distance(a) < distance(b); });
  return nearest == corners.end() ? std::nullopt : std::optional<double>(nearest->s);
}

/// The points that corners were made of.
std::vector<std::size_t> corners_of(const std::vector<Vec2>& points, const OutlineOptions& options,
                                    const ChordTurns& turns) {
  if (!options.corner_angle) return corners_of_points(points, !options.open, options.airfoil);
  std::vector<std::size_t> corners;
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (std::abs(turns.at(k)) >= *options.corner_angle) corners.push_back(k);
  }
  return corners;
}

/// A round number of degrees above it.
int whole_degrees_above(double angle) {
  constexpr int kStep = 5;
  const int degrees = kStep * (static_cast<int>(angle * 180 / std::numbers::pi) / kStep + 1);
  return std::min(degrees, 180);
}

}  // namespace

std::string sparse_corners_note(const std::vector<Vec2>& points, const OutlineOptions& options, const Part& part) {
  const double least = options.corner_angle.value_or(kCornerAngle);
  if (options.smooth || points.size() < 3 || least == 0) return "";  // of 0 a polygon is meant
  const ChordTurns turns(points, !options.open);
  std::vector<double> places;
  double most = 0;
  const std::vector<std::size_t> corners = corners_of(points, options, turns);
  for (const std::size_t k : corners) {
    const double turn = turns.at(k);
    if (!turns.goes_on(k, least)) continue;
    const std::optional<double> place = place_of(points[k], part);
    if (!place) continue;
    places.push_back(*place);
    most = std::max(most, std::abs(turn));
  }
  if (places.empty()) return "";
  std::sort(places.begin(), places.end());
  std::string where;
  for (std::size_t k = 0; k < std::min(places.size(), kMostNamed); ++k) {
    where += fmt::format("{}{:.6g}", k == 0 ? "" : ", ", places[k]);
  }
  return fmt::format(
      "{}: made {} of points where a sparsely sampled curve turns by {:.3g}deg or more: at s = {}{}; `corner_angle` "
      "{}deg makes a curve of them",
      part.name(), counted(places.size(), "corner", "corners"), least * 180 / std::numbers::pi, where,
      places.size() > kMostNamed ? ", ..." : "", whole_degrees_above(most));
}

}  // namespace rollfix
