#pragma once

#include <Eigen/Core>
#include <vector>

#include "rollfix/belief/belief.hpp"
#include "rollfix/contact/pose.hpp"

namespace rollfix {

/// Where a part at rest is, and how sure: of x, y and heading.
struct PoseSpread {
  Pose mean;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // length^2, length times radians, radians^2
};

/// The part's pose from its first contact, given that this is one of a mode's places: contact `where` in the world,
/// with the part's inward normal at `facing` (radians) there. `mass`: of the whole posterior; what lies in the mode
/// counts. `finger_curvature`: where it touches. The sensors' own errors at the first contact add theirs.
PoseSpread pose_spread(const Part& part, const Mode& mode, const std::vector<Mass>& mass, const Vec2& where,
                       double facing, double finger_curvature, const Noise& noise);

}  // namespace rollfix
