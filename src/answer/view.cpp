#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "log/mirrored.hpp"
#include "rollfix/error.hpp"
#include "steps.hpp"

// The one place where signs are turned for a whole problem and its answer.
// Notation:
//   (L, theta)      a reading; in a mirror (-L, -theta), clockwise (-L, theta)
//   (u, psi)        a contact; in a mirror (-u, pi - psi), of a jaw (-u, -psi); a centre (x, y) becomes (-x, y)
// Follows docs/rolling.md, "Signs" and "Against the outline's direction".
namespace rollfix {
namespace {

void reverse(PerFinger<double>& lengths) {
  for (double& length : lengths) length = -length;
}

void reverse_lengths(Sensitivity& sensitivity) {
  for (auto& readings : sensitivity.per_length) {
    for (auto& lengths : readings) {
      for (double& value : lengths) value = -value;
    }
  }
}

Reading mirrored(Reading reading) {
  reverse(reading.length);
  reading.turn = -reading.turn;
  return reading;
}

Pose mirrored(const Pose& pose) { return {-pose.x, pose.y, -pose.heading}; }

void mirror(Sensitivity& sensitivity) {
  for (auto& readings : sensitivity.per_turn) {
    for (double& value : readings) value = -value;
  }
  reverse_lengths(sensitivity);
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

/// Sensitivities are to the lengths as they were given.
void count_clockwise(Placement& placement) {
  placement.clockwise = true;
  reverse_lengths(placement.sensitivity);
}

template <class Change>
void change_placements(const Change& change, Answer& answer) {
  for (Placement& placement : answer.placements) change(placement);
  for (Impossible& item : answer.impossible) change(item.placement);
  if (!answer.weighing) return;
  for (Placement& placement : answer.weighing->improbable) change(placement);
}

Problem in_mirror(Problem problem) {
  problem.mirrored = false;
  const std::vector<Finger> fingers = problem.fingers;
  for (Finger& finger : problem.fingers) finger = rollfix::mirrored(finger);
  for (Reading& reading : problem.measured.readings) reading = mirrored(reading);
  if (problem.facing) problem.facing = -*problem.facing;
  if (problem.pose) problem.pose->mean = mirrored(problem.pose->mean);
  if (!problem.measured.is_log()) return problem;
  std::vector<FingerRows>& rows = problem.measured.log->fingers;
  for (std::size_t which = 0; which < rows.size(); ++which) mirror(rows[which], finger_of(fingers, which));
  return problem;
}

void out_of_mirror(const Problem& problem, Answer& answer) {
  answer.mirrored = true;
  answer.fingers = problem.fingers;
  for (Reading& reading : answer.readings) reading = mirrored(reading);
  if (answer.facing) answer.facing = -*answer.facing;
  if (answer.weighing && answer.weighing->pose) answer.weighing->pose->mean = mirrored(answer.weighing->pose->mean);
  change_placements([](Placement& placement) { mirror(placement); }, answer);
}

Problem counted_clockwise(Problem problem) {
  problem.either_way = false;
  for (Reading& reading : problem.measured.readings) reverse(reading.length);
  if (!problem.measured.is_log()) return problem;
  for (FingerRows& rows : problem.measured.log->fingers) {
    for (double& length : rows.length) length = -length;
  }
  return problem;
}

}  // namespace

std::vector<View> views_of(const Problem& problem) {
  std::vector<View> views{{problem.mirrored, false}};
  if (!problem.either_way) return views;
  if (problem.measured.is_log() && problem.measured.log->kind == LogKind::contact) {
    throw InputError("`either_way`: " + problem.measured.log->name +
                     " has u and psi, which say themselves which way round it went: expected a log of lengths");
  }
  views.push_back({problem.mirrored, true});
  return views;
}

Problem View::of(const Problem& problem) const {
  const Problem seen = mirrored ? in_mirror(problem) : problem;
  return clockwise ? counted_clockwise(seen) : seen;
}

void View::undo(const Problem& problem, Answer& answer) const {
  if (clockwise) {
    for (Reading& reading : answer.readings) reverse(reading.length);
    change_placements(count_clockwise, answer);
  }
  if (mirrored) out_of_mirror(problem, answer);
}

}  // namespace rollfix
