#pragma once

#include "pose_fit.hpp"

namespace rollfix::touch {

/// A touch's likelihood in a pose, wherever near a place its contact is: contacts are as likely on every length of the
/// boundary, so it is the integral along it, which ends and turns at corners with the boundary.
struct TiltedTouch {
  double log_likelihood = 0;
  Normals normals;  // its first two derivatives by the pose: mean and spread of what the single places say
};

TiltedTouch tilted_touch(const PoseFit& fit, const Pose& pose, std::size_t touch, const PathPlace& nearest);

/// Length of boundary that u is worth: none at a corner for a point.
inline double length_per_u(const CentrePath& path, std::size_t stretch) {
  return path.stretches()[stretch].corner ? path.radius() : 1;
}

}  // namespace rollfix::touch
