#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "rollfix/touch.hpp"

namespace rollfix::touch {

/// A pose that stands for those about it.
struct LikelyPose {
  std::size_t placement = 0;  // its number in the answer; after one touch any
  double weight = 0;          // of all together 1
  Pose pose;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // of x, y, heading
};

/// The poses that an answer leaves: of each set one, of a continuum several along it; after one touch, which fits all
/// along the boundary, a sample of all of them.
std::vector<LikelyPose> likely_poses(const TouchAnswer& answer);

}  // namespace rollfix::touch
