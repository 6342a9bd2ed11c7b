#include "files/sparse_corners.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>

#include "text/text.hpp"

namespace rollfix {

namespace {

/// On a curve that is sampled sparsely the points on both sides of one that turns by a corner's angle turn as well, the
/// same way and by this share of it (on ellipses up to 8:1, wherever the points fall); the sides of a corner that is
/// meant are far straighter, one of them at least.
constexpr double kNeighbourShare = 0.12;

/// So many places are named.
constexpr std::size_t kMostNamed = 4;

/// By how much the chords turn at a point, to the left; 0 at an open end.
class ChordTurns {
 public:
  ChordTurns(const std::vector<Vec2>& points, bool closed) : points_(points), closed_(closed) {}

  double at(std::size_t k) const {
    if (!closed_ && (k == 0 || k + 1 == points_.size())) return 0;
    const Vec2 before = points_[k] - points_[previous(k)];
    const Vec2 after = points_[next(k)] - points_[k];
    return std::atan2(cross(before, after), before.dot(after));
  }
  /// Whether the curve bends on both sides of this corner as it does here, behind those that are corners as well.
  bool goes_on(std::size_t k, double least) const {
    const auto bends_along = [&](std::size_t neighbour, auto step) {
      std::size_t steps = 0;
      while (std::abs(at(neighbour)) >= least && ++steps < points_.size()) neighbour = step(neighbour);
      return steps < points_.size() && at(neighbour) * at(k) > 0 &&
             std::abs(at(neighbour)) >= kNeighbourShare * std::abs(at(k));
    };
    return bends_along(next(k), [this](std::size_t i) { return next(i); }) &&
           bends_along(previous(k), [this](std::size_t i) { return previous(i); });
  }

 private:
  std::size_t next(std::size_t k) const { return (k + 1) % points_.size(); }
  std::size_t previous(std::size_t k) const { return (k + points_.size() - 1) % points_.size(); }

  const std::vector<Vec2>& points_;
  bool closed_;
};

/// Where on the part a corner was made of this point.
std::optional<double> place_of(const Vec2& point, const Part& part) {
  const std::vector<Corner>& corners = part.corners();
  const auto distance = [&](const Corner& corner) { return (part.point(corner.s) - point).squaredNorm(); };
  const auto nearest = std::min_element(corners.begin(), corners.end(),
                                        [&](const Corner& a, const Corner& b) { return distance(a) < distance(b); });
  return nearest == corners.end() ? std::nullopt : std::optional<double>(nearest->s);
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
  for (std::size_t k = 0; k < points.size(); ++k) {
    const double turn = turns.at(k);
    if (std::abs(turn) < least) continue;
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
