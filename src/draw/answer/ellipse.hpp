#pragma once

#include <Eigen/Core>
#include <string_view>
#include <vector>

#include "rollfix/curve.hpp"

namespace rollfix::draw {

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
