#include "files/noisy_points.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace rollfix {

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

double mean_spacing(const std::vector<Vec2>& points) {
  double length = 0;
  for (std::size_t k = 1; k < points.size(); ++k) length += (points[k] - points[k - 1]).norm();
  return length / static_cast<double>(points.size() - 1);
}

/// What `smooth` takes, in two digits.
std::string tolerance_for(double scatter) { return fmt::format("{:.2g}", kFarthest * scatter); }

}  // namespace

double scatter_of(const std::vector<Vec2>& points, bool closed) {
  constexpr std::array<double, 5> kWeights = {1, -4, 6, -4, 1};
  constexpr double kVariance = 70;  // the sum of their squares
  const std::size_t count = points.size();
  if (count < kLeastPoints) return 0;
  std::vector<double> sizes;
  const std::size_t last = closed ? count : count - (kWeights.size() - 1);
  for (std::size_t k = 0; k < last; ++k) {
    Vec2 sum = Vec2::Zero();
    for (std::size_t j = 0; j < kWeights.size(); ++j) sum += kWeights[j] * points[(k + j) % count];
    sizes.push_back(sum.squaredNorm());
  }
  // The median, for corners do not scatter. Of two coordinates the square is exponential: its median is ln 2 of its
  // mean, which is that of both.
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return std::sqrt(*middle / (2 * std::log(2.0) * kVariance));
}

std::string noisy_points_note(const std::vector<Vec2>& points, const OutlineOptions& options, const Part& part) {
  const auto count = static_cast<double>(points.size());
  const auto inflections = static_cast<double>(part.inflections().size());
  if (options.smooth || points.size() < kLeastPoints || inflections < kNoisyShare * count) return "";
  const double scatter = scatter_of(points, part.closed());
  if (!(scatter > 0)) return "";
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

}  // namespace rollfix
