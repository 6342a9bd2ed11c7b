#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string_view>
#include <vector>

#include "rollfix/belief.hpp"
#include "rollfix/curve.hpp"
#include "rollfix/turning_function.hpp"

namespace rollfix::draw {

/// A density on equal bins of a stretch of the boundary: what each holds, by its length. Points, as in corners, count
/// as well. `range`: as wide as the perimeter at most; of a closed boundary it may go on beyond P.
std::vector<double> binned(const Density& density, const Boundary& places, const Interval& range, std::size_t count);

/// The highest density in each of so many equal parts: a peak that is narrower than a part is as high as it is,
/// wherever it falls between two. What is held at a point, at a pivot, is spread over its part.
std::vector<double> highest(const Density& density, const Boundary& places, const Interval& range, std::size_t count);

/// The same smoothed by a normal distribution of this many bins' standard deviation; `around`: the last bin's neighbour
/// is the first.
std::vector<double> smoothed(const std::vector<double>& bins, double sd, bool around);

/// A function of one variable at increasing places.
struct Samples {
  std::vector<double> at;
  std::vector<double> value;
};

/// The lines on which g(x) - h(y) = level, as polylines in (x, y); closed ones end where they begin. Marching squares
/// on the grid of the places: what is smaller than its cells is lost. Differences below 1e-12 are zero.
std::vector<std::vector<Vec2>> level_lines(const Samples& g, const Samples& h, double level);

/// An ellipse of a normal distribution in the plane that holds half of it, and 95 %: standard deviations, sqrt of the
/// chi-square's quantile with two degrees of freedom.
inline constexpr double kEllipseHalf = 1.17741;
inline constexpr double kEllipse95 = 2.44775;
/// What 95 % of one number lies within.
inline constexpr double kInterval95 = 1.95996;

inline constexpr std::string_view kEllipseFill = "#F0E442";

/// The points at this many standard deviations from the mean; where the covariance has no width a line there and back.
std::vector<Vec2> ellipse(const Vec2& mean, const Eigen::Matrix2d& covariance, double sigmas);

/// Half the lengths of its axes at one standard deviation, the longer one first.
Vec2 half_axes(const Eigen::Matrix2d& covariance);

}  // namespace rollfix::draw
