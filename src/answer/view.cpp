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

/// ds/dL with the other sign: L is stated so, s is not.
void reverse_lengths(Sensitivity& sensitivity) {
  for (auto& readings : sensitivity.per_length) {
    for (auto& lengths : readings) {
      for (double& value : lengths) value = -value;
    }
  }
}

/// (L, theta) to (-L, -theta).
Reading mirrored(Reading reading) {
  reverse(reading.length);
  reading.turn = -reading.turn;
  return reading;
}

/// ds/dtheta, ds/dL and ds/dfacing: s stays, the three measurements change their signs.
void mirror(Sensitivity& sensitivity) {
  for (auto& readings : sensitivity.per_turn) {
    for (double& value : readings) value = -value;
  }
  reverse_lengths(sensitivity);
  for (double& value : sensitivity.per_facing) value = -value;
}

/// Poses. s and the tangent are those of the stored outline.
void mirror(Placement& placement) {
  mirror(placement.sensitivity);
  // The pose of each row, and what all rows together say of it.
  for (Pose& pose : placement.pose) pose = mirrored(pose);
  if (placement.pose_spread) placement.pose_spread = mirrored(*placement.pose_spread);
}

/// Sensitivities are to the lengths as they were given.
void count_clockwise(Placement& placement) {
  placement.clockwise = true;
  reverse_lengths(placement.sensitivity);
}

/// All lists of an answer that have placements.
template <class Change>
void change_placements(const Change& change, Answer& answer) {
  for (Placement& placement : answer.placements) change(placement);
  for (Impossible& item : answer.impossible) change(item.placement);
  if (!answer.weighing) return;
  for (Placement& placement : answer.weighing->improbable) change(placement);
}

/// What is measured, and what was stated of facing and pose. The part stays as it is stored.
Problem in_mirror(Problem problem) {
  problem.mirrored = false;
  const std::vector<Finger> fingers = problem.fingers;
  for (Finger& finger : problem.fingers) finger = rollfix::mirrored(finger);
  // A mirror turns the direction of travel and of turning.
  for (Reading& reading : problem.measured.readings) reading = mirrored(reading);
  if (problem.facing) problem.facing = -*problem.facing;
  if (problem.pose) problem.pose->mean = mirrored(problem.pose->mean);
  if (!problem.measured.is_log()) return problem;
  std::vector<FingerRows>& rows = problem.measured.log->fingers;
  for (std::size_t which = 0; which < rows.size(); ++which) mirror(rows[which], finger_of(fingers, which));
  return problem;
}

/// Undoes `in_mirror` in all that the answer repeats or computes in the world.
void out_of_mirror(const Problem& problem, Answer& answer) {
  answer.mirrored = true;
  answer.fingers = problem.fingers;
  for (Reading& reading : answer.readings) reading = mirrored(reading);
  if (answer.facing) answer.facing = -*answer.facing;
  if (answer.weighing && answer.weighing->pose) answer.weighing->pose->mean = mirrored(answer.weighing->pose->mean);
  change_placements([](Placement& placement) { mirror(placement); }, answer);
}

/// Lengths with the other sign; turns are counter-clockwise either way.
Problem counted_clockwise(Problem problem) {
  problem.either_way = false;
  for (Reading& reading : problem.measured.readings) reverse(reading.length);
  if (!problem.measured.is_log()) return problem;
  for (FingerRows& rows : problem.measured.log->fingers) {
    // Empty in a log of u and psi.
    for (double& length : rows.length) length = -length;
  }
  return problem;
}

}  // namespace

std::vector<View> views_of(const Problem& problem) {
  std::vector<View> views{{problem.mirrored, false}};
  if (!problem.either_way) return views;
  // u and psi are counter-clockwise: they leave nothing open.
  if (problem.measured.is_log() && problem.measured.log->kind == LogKind::contact) {
    throw InputError("`either_way`: " + problem.measured.log->name +
                     " has u and psi, which say themselves which way round it went: expected a log of lengths");
  }
  views.push_back({problem.mirrored, true});
  return views;
}

Problem View::of(const Problem& problem) const {
  // The mirror first, then the direction along the outline, which the mirror also turns.
  const Problem seen = mirrored ? in_mirror(problem) : problem;
  return clockwise ? counted_clockwise(seen) : seen;
}

/// In the opposite order of `of`.
void View::undo(const Problem& problem, Answer& answer) const {
  if (clockwise) {
    for (Reading& reading : answer.readings) reverse(reading.length);
    change_placements(count_clockwise, answer);
  }
  if (mirrored) out_of_mirror(problem, answer);
}

}  // namespace rollfix
