#include "mirror.hpp"

#include <cstddef>
#include <vector>

#include "log/mirrored.hpp"

namespace rollfix {
namespace {

Reading mirrored(Reading reading) {
  for (double& length : reading.length) length = -length;
  reading.turn = -reading.turn;
  return reading;
}

Pose mirrored(const Pose& pose) { return {-pose.x, pose.y, -pose.heading}; }

void mirror(Sensitivity& sensitivity) {
  for (auto& readings : sensitivity.per_turn) {
    for (double& value : readings) value = -value;
  }
  for (auto& readings : sensitivity.per_length) {
    for (auto& lengths : readings) {
      for (double& value : lengths) value = -value;
    }
  }
  for (double& value : sensitivity.per_facing) value = -value;
}

void mirror(Placement& placement) {
  mirror(placement.sensitivity);
  for (Pose& pose : placement.pose) pose = mirrored(pose);
  if (!placement.pose_spread) return;
  placement.pose_spread->mean = mirrored(placement.pose_spread->mean);
  const Eigen::Vector3d signs(-1, 1, -1);
  placement.pose_spread->covariance =
      Eigen::Matrix3d(signs.asDiagonal() * placement.pose_spread->covariance * signs.asDiagonal());
}

}  // namespace

Problem in_mirror(const Problem& problem) {
  Problem result = problem;
  for (Finger& finger : result.fingers) finger = rollfix::mirrored(finger);
  for (Reading& reading : result.felt.readings) reading = mirrored(reading);
  if (result.facing) result.facing = -*result.facing;
  if (result.pose) result.pose->mean = mirrored(result.pose->mean);
  if (!result.felt.is_log()) return result;
  std::vector<FingerRows>& fingers = result.felt.log->fingers;
  for (std::size_t which = 0; which < fingers.size(); ++which) {
    mirror(fingers[which], finger_of(problem.fingers, which));
  }
  return result;
}

void out_of_mirror(const Problem& problem, Answer& answer) {
  answer.mirrored = true;
  answer.fingers = problem.fingers;
  for (Reading& reading : answer.readings) reading = mirrored(reading);
  if (answer.facing) answer.facing = -*answer.facing;
  for (Placement& placement : answer.placements) mirror(placement);
  for (Impossible& item : answer.impossible) mirror(item.placement);
  if (!answer.weighing) return;
  if (answer.weighing->pose) answer.weighing->pose->mean = mirrored(answer.weighing->pose->mean);
  for (Placement& placement : answer.weighing->improbable) mirror(placement);
}

}  // namespace rollfix
