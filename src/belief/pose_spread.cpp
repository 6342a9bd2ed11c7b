#include "rollfix/belief/pose_spread.hpp"

#include <cmath>
#include <numbers>

#include "part/angle.hpp"
#include "rollfix/part/period.hpp"

namespace rollfix {

namespace {

/// u + psi = heading + tangent + pi/2, and the contact is at the same place in both frames.
Pose pose_with(const Part& part, double s, double tangent, const Vec2& where, double facing) {
  Pose pose{0, 0, facing - 0.5 * std::numbers::pi - tangent};
  const Vec2 origin = where - pose.turned(part.point(s));
  pose.x = origin.x();
  pose.y = origin.y();
  return pose;
}

bool holds(const Interval& region, double s, const Part& part) {
  if (!part.closed()) return s >= region.lo && s <= region.hi;
  return wrap(s - region.lo, part.perimeter()).base <= region.width();
}

}  // namespace

PoseSpread pose_spread(const Part& part, const Mode& mode, const std::vector<Mass>& mass, const Vec2& where,
                       double facing, double finger_curvature, const Noise& noise) {
  const Pose at_mode = pose_with(part, mode.start, mode.tangent, where, facing);
  const double heading = nearest_angle(at_mode.heading);
  double total = 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const Mass& piece : mass) {
    if (!holds(mode.region, piece.s.middle(), part)) continue;
    const Pose pose = pose_with(part, piece.s.middle(), piece.tangent.middle(), where, facing);
    const Eigen::Vector3d off(pose.x - at_mode.x, pose.y - at_mode.y, nearest_angle(pose.heading - at_mode.heading));
    total += piece.share;
    sum += piece.share * off;
    squares += piece.share * off * off.transpose();
  }
  PoseSpread spread;
  const Eigen::Vector3d mean = total > 0 ? Eigen::Vector3d(sum / total) : Eigen::Vector3d::Zero();
  spread.mean = {at_mode.x + mean.x(), at_mode.y + mean.y(), heading + mean.z()};
  if (total > 0) spread.covariance = squares / total - mean * mean.transpose();

  // The contact's error moves it along the tangent and turns the normal, the orientation's turns it about the contact.
  const Vec2 arm = where - Vec2(spread.mean.x, spread.mean.y);  // from the contact to the origin, turned back
  const Eigen::Vector3d by_turn(arm.y(), -arm.x(), 1);
  const Eigen::Vector3d along(-std::sin(facing), std::cos(facing), 0);  // counter-clockwise around the finger
  const Eigen::Vector3d by_contact = along + finger_curvature * by_turn;
  Eigen::Vector3d by_angle = by_turn;
  if (finger_curvature > 0) by_angle += along / finger_curvature;
  spread.covariance += noise.contact * noise.contact * by_contact * by_contact.transpose();
  spread.covariance += noise.angle * noise.angle * by_angle * by_angle.transpose();
  return spread;
}

}  // namespace rollfix
