#include "files/point_notes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>

#include "outline/corners.hpp"
#include "text/text.hpp"

// What to tell of points that look noisy, or whose corners look sampled sparsely.
// Notation:
//   p_k, d_k        points in order, and their fourth differences p_k - 4 p_k+1 + 6 p_k+2 - 4 p_k+3 + p_k+4
//   scatter         standard deviation of a coordinate: |d_k|^2 has the mean 2 * 70 scatter^2, 70 being the sum of the
//                   squares of the weights
//   inflections     of the curve through the points: part.inflections()
//   turn            of the chords at a point: ChordTurns
// Follows docs/files.md, "Points and scans".
namespace rollfix::files {
namespace {

/// A curve through white noise has about 0.7 inflections a point; a shape that is sampled to be seen, with four points
/// for each of its bends, has 0.25 at most.
constexpr double kNoisyShare = 0.4;
constexpr std::size_t kLeastPoints = 20;  // fewer may be anything

/// No point of so many is further off its place than so many standard deviations.
constexpr double kFarthest = 3.5;

/// Of a scan the spacing is of the same order as the scatter where the curve crosses itself; what crosses itself and
/// scatters less than this share of its spacing was drawn so.
constexpr double kLeastScatter = 0.02;

/// Rounded digits of dense points bend a flat curve to and fro where noise of a scan would bend it everywhere. Of so
/// many inflections most follow on one another closer than a shape that is sampled to be seen has any, in mean
/// spacings.
constexpr std::size_t kFewestClose = 20;
constexpr double kClose = 2;
/// Of noise alone neighbouring fourth differences point opposite ways; of a smooth curve hardly any.
constexpr double kOppositeShare = 0.75;

double mean_spacing(const std::vector<Vec2>& points) {
  double length = 0;
  for (std::size_t k = 1; k < points.size(); ++k) length += (points[k] - points[k - 1]).norm();
  return length / static_cast<double>(points.size() - 1);
}

/// What `smooth` takes, in two digits.
std::string tolerance_for(double scatter) { return fmt::format("{:.2g}", kFarthest * scatter); }

constexpr std::array<double, 5> kWeights = {1, -4, 6, -4, 1};

/// How many fourth differences there are.
std::size_t differences_of(const std::vector<Vec2>& points, bool closed) {
  return closed ? points.size() : points.size() - (kWeights.size() - 1);
}

/// The one of the points from k on.
Vec2 fourth_difference(const std::vector<Vec2>& points, std::size_t k) {
  Vec2 sum = Vec2::Zero();
  for (std::size_t j = 0; j < kWeights.size(); ++j) sum += kWeights[j] * points[(k + j) % points.size()];
  return sum;
}

/// Whether most of the curve's inflections are made by the digits of its points.
bool is_bent_by_rounding(const std::vector<Vec2>& points, const Part& part) {
  const std::vector<double>& inflections = part.inflections();
  const double limit = kClose * mean_spacing(points);
  std::size_t close = 0;
  for (std::size_t k = 1; k < inflections.size(); ++k) {
    if (inflections[k] - inflections[k - 1] < limit) ++close;
  }
  if (close < kFewestClose || 2 * close < inflections.size()) return false;
  const std::size_t count = differences_of(points, part.closed());
  std::size_t opposite = 0;
  Vec2 last = fourth_difference(points, 0);
  for (std::size_t k = 1; k < count; ++k) {
    const Vec2 next = fourth_difference(points, k);
    if (next.dot(last) < 0) ++opposite;
    last = next;
  }
  return static_cast<double>(opposite) > kOppositeShare * static_cast<double>(count);
}

}  // namespace

double scatter_of(const std::vector<Vec2>& points, bool closed) {
  constexpr double kVariance = 70;  // the sum of the weights' squares
  if (points.size() < kLeastPoints) return 0;
  std::vector<double> sizes(differences_of(points, closed));
  for (std::size_t k = 0; k < sizes.size(); ++k) sizes[k] = fourth_difference(points, k).squaredNorm();
  // The median, for corners do not scatter. Of two coordinates the square is exponential: its median is ln 2 of its
  // mean, which is that of both.
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return std::sqrt(*middle / (2 * std::log(2.0) * kVariance));
}

std::string noisy_points_note(const std::vector<Vec2>& points, const OutlineOptions& options, const Part& part) {
  const auto count = static_cast<double>(points.size());
  const auto inflections = static_cast<double>(part.inflections().size());
  if (options.smooth || points.size() < kLeastPoints) return "";
  const bool is_scan = inflections >= kNoisyShare * count;
  if (!is_scan && !is_bent_by_rounding(points, part)) return "";
  const double scatter = scatter_of(points, part.closed());
  if (!(scatter > 0)) return "";
  if (!is_scan) {
    return fmt::format(
        "{}: most of the {} inflections of the curve through its {} points come of their rounded digits, and searches "
        "take long for it: `smooth` {} leaves them out",
        part.name(), part.inflections().size(), points.size(), tolerance_for(scatter));
  }
  return fmt::format(
      "{}: the curve through its {} points has {} inflections, as if they were a scan with noise of about {:.2g}: "
      "`smooth` {} leaves that out",
      part.name(), points.size(), part.inflections().size(), scatter, tolerance_for(scatter));
}

std::string noisy_crossing_hint(const std::vector<Vec2>& points, const OutlineOptions& options) {
  const double scatter = scatter_of(points, !options.open);
  if (options.smooth || !(scatter > kLeastScatter * mean_spacing(points))) return "";
  return fmt::format("; points of a scan are smoothed with `smooth`, here perhaps `smooth` {}", tolerance_for(scatter));
}

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

constexpr double kDegree = std::numbers::pi / 180;
constexpr int kStep = 5;  // of round angles, in degrees

/// A round number of degrees above it.
int whole_degrees_above(double angle) {
  const int degrees = kStep * (static_cast<int>(angle / kDegree) / kStep + 1);
  return std::min(degrees, 180);
}

/// A round number of degrees below it, for angles of more than kStep.
int whole_degrees_below(double angle) { return kStep * (static_cast<int>(std::ceil(angle / kDegree / kStep)) - 1); }

/// A curve whose chords turn by less is sampled well enough for a spline; above, a point beside a straight side is more
/// often a corner, of a chamfer or an octagon.
constexpr double kLeastRounded = 30 * kDegree;

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
      part.name(), counted(places.size(), "corner", "corners"), least / kDegree, where,
      places.size() > kMostNamed ? ", ..." : "", whole_degrees_above(most));
}

std::string rounded_corners_note(const std::vector<Vec2>& points, const OutlineOptions& options, const Part& part) {
  if (options.smooth || options.corner_angle || options.airfoil || points.size() < 3) return "";
  const ChordTurns turns(points, !options.open);
  std::size_t count = 0;
  std::size_t first = 0;
  double least = kCornerAngle;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const double turn = std::abs(turns.at(k));
    if (turn < kLeastRounded || turn >= kCornerAngle || !turns.has_straight_side(k, kLeastRounded)) continue;
    if (count++ == 0) first = k;
    least = std::min(least, turn);
  }
  if (count == 0) return "";
  return fmt::format(
      "{}: a smooth curve runs through {} whose chords turn by {:.3g}deg or more, first ({}, {}): if the part has "
      "corners there, `corner_angle` {}deg keeps them",
      part.name(), counted(count, "point", "points"), least / kDegree, points[first].x(), points[first].y(),
      whole_degrees_below(least));
}

}  // namespace rollfix::files
