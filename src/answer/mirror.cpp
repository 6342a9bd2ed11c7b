#include "mirror.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "rollfix/error.hpp"

namespace rollfix {
namespace {

Reading mirrored(Reading reading) {
  for (double& length : reading.length) length = -length;
  reading.turn = -reading.turn;
  return reading;
}

void negate(std::vector<double>& values) {
  for (double& value : values) value = -value;
}

/// Of angles that may be wrapped to [0, 2 pi], which stay there.
void negate_angles(std::vector<double>& angles) {
  const bool is_above = std::all_of(angles.begin(), angles.end(), [](double angle) { return angle >= 0; });
  const double most = is_above ? 2 * std::numbers::pi : 0;
  for (double& angle : angles) angle = most - angle;
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
  for (const Finger& finger : problem.fingers) {
    if (finger.outline() == nullptr) continue;
    throw InputError(fmt::format(
        "`mirror`: the finger {} has an outline: expected a disk or a jaw, or the mirror image of the part's outline "
        "and no `mirror`",
        finger.name()));
  }
  Problem result = problem;
  for (Reading& reading : result.felt.readings) reading = mirrored(reading);
  if (result.facing) result.facing = -*result.facing;
  if (result.pose) result.pose->mean = mirrored(result.pose->mean);
  if (!result.felt.is_log()) return result;
  for (FingerRows& rows : result.felt.log->fingers) {
    negate_angles(rows.u);
    for (double& psi : rows.psi) psi = std::numbers::pi - psi;
    negate(rows.length);
    negate(rows.turn);
    negate(rows.x);
  }
  return result;
}

void out_of_mirror(Answer& answer) {
  answer.mirrored = true;
  for (Reading& reading : answer.readings) reading = mirrored(reading);
  if (answer.facing) answer.facing = -*answer.facing;
  for (Placement& placement : answer.placements) mirror(placement);
  for (Impossible& item : answer.impossible) mirror(item.placement);
  if (!answer.weighing) return;
  if (answer.weighing->pose) answer.weighing->pose->mean = mirrored(answer.weighing->pose->mean);
  for (Placement& placement : answer.weighing->improbable) mirror(placement);
}

}  // namespace rollfix
