#include "hold_facts.hpp"

#include "log/mirrored.hpp"

namespace rollfix {

const char* name_of(HoldCause cause) {
  switch (cause) {
    case HoldCause::radius:
      return "radius";
    case HoldCause::unit:
      return "unit";
    case HoldCause::late:
      return "late";
    case HoldCause::mirrored:
      return "mirrored";
    case HoldCause::u_clockwise:
      return "u_clockwise";
    case HoldCause::psi_clockwise:
      return "psi_clockwise";
    case HoldCause::both_clockwise:
      return "both_clockwise";
    case HoldCause::u_degrees:
      return "u_degrees";
    case HoldCause::psi_degrees:
      return "psi_degrees";
    case HoldCause::angles_degrees:
      return "angles_degrees";
    case HoldCause::u_psi_swapped:
      return "u_psi_swapped";
    case HoldCause::fingers_swapped:
      return "fingers_swapped";
    case HoldCause::prior:
      return "prior";
    case HoldCause::stray:
      return "stray";
    case HoldCause::slip:
      return "slip";
    case HoldCause::x_y_swapped:
      return "x_y_swapped";
    case HoldCause::squeezed:
      return "squeezed";
    case HoldCause::noise:
      break;
  }
  return "noise";
}

namespace hold {

const Finger& finger_of_log(const HoldProblem& problem, std::size_t log) {
  return problem.fingers[problem.fingers.size() == 1 ? 0 : log];
}

Finger shape_of(const HoldProblem& problem, std::size_t number) {
  const std::size_t fingers = problem.logs.size();
  return number < fingers ? finger_of_log(problem, number) : disk(problem.wheels[number - fingers].radius);
}

std::size_t count_of_logs(const HoldProblem& problem) { return problem.logs.size() + problem.wheels.size(); }

const Log& log_of(const HoldProblem& problem, std::size_t number) {
  const std::size_t fingers = problem.logs.size();
  return number < fingers ? problem.logs[number] : problem.wheels[number - fingers].log.rows;
}

Log& log_of(HoldProblem& problem, std::size_t number) {
  const std::size_t fingers = problem.logs.size();
  return number < fingers ? problem.logs[number] : problem.wheels[number - fingers].log.rows;
}

HoldRoll roll_of(const HoldProblem& problem, const Log& log, std::size_t number) {
  const FingerRows& rows = log.fingers.front();
  const Finger finger = shape_of(problem, number);
  HoldRoll roll;
  roll.is_jaw = finger.is_jaw();
  roll.is_wheel = number >= problem.logs.size();
  roll.has_encoder = roll.is_wheel && !rows.psi.empty();
  if (!rows.psi.empty()) {
    roll.psi = {rows.psi.front(), rows.psi.back()};
    roll.u = {rows.u.front(), rows.u.back()};
  }
  roll.name = log.name;
  if (!rows.line.empty()) roll.lines = {rows.line.front(), rows.line.back()};
  roll.has_centre = !rows.x.empty();
  for (std::size_t row = 0; row < rows.x.size(); ++row) roll.track.emplace_back(rows.x[row], rows.y[row]);
  if (finger.is_disk()) roll.radius = finger.disk()->radius;
  return roll;
}

HoldProblem in_mirror(const HoldProblem& problem, std::vector<Log>& logs) {
  HoldProblem result = problem;
  for (std::size_t k = 0; k < logs.size(); ++k) {
    const Finger finger = shape_of(problem, k);
    mirror(logs[k].fingers.front(), &finger);
  }
  for (Finger& finger : result.fingers) finger = rollfix::mirrored(finger);
  if (result.pose) result.pose->mean = {-result.pose->mean.x, result.pose->mean.y, -result.pose->mean.heading};
  return result;
}

void out_of_mirror(HoldAnswer& answer) {
  const Eigen::Vector3d signs(-1, 1, -1);
  for (HoldPlacement& placement : answer.placements) {
    for (Pose* pose : {&placement.first, &placement.last, &placement.first_spread.mean, &placement.last_spread.mean}) {
      *pose = {-pose->x, pose->y, -pose->heading};
    }
    for (PoseSpread* spread : {&placement.first_spread, &placement.last_spread}) {
      spread->covariance = Eigen::Matrix3d(signs.asDiagonal() * spread->covariance * signs.asDiagonal());
    }
  }
}

}  // namespace hold
}  // namespace rollfix
