#include "plan/plan_requirements.hpp"

#include <fmt/format.h>
#include <cmath>
#include <numbers>

#include "log/mirrored.hpp"
#include "rollfix/error.hpp"

// What a plan can't be asked, and a problem as a mirror shows it. In a mirror x, angles and angular velocities have the
// other sign, and what was turned one way turns the other; lengths along the outline as it was drawn, distances and
// friction are what they were.
namespace rollfix::planning {
namespace {

void require_plan_number(std::optional<double> value, const std::string& what, bool above_zero) {
  if (!value) return;
  if (std::isfinite(*value) && (!above_zero || *value > 0)) return;
  throw InputError(
      fmt::format("expected a {}{} of a plan, found {}", what, above_zero ? " above 0" : " that is finite", *value));
}

void require_finger(const PlanProblem& problem, std::size_t which) {
  const PlanFinger& finger = problem.fingers[which];
  const std::string name = name_of_finger(problem, which);
  require_valid(finger.finger);
  require_plan_number(finger.start, "start of " + name, false);
  require_plan_number(finger.length, "length of " + name, false);
  require_plan_number(finger.psi, "orientation of " + name, false);
  if (finger.friction && !(std::isfinite(*finger.friction) && *finger.friction >= 0)) {
    throw InputError(fmt::format("expected a friction of {} of at least 0, found {}", name, *finger.friction));
  }
  if (!finger.start && !finger.wheel) {
    throw InputError(fmt::format("expected a start of {}: s of its first contact, found none", name));
  }
  if (!finger.wheel) return;
  if (problem.fingers.size() != 2 || which != 1) {
    throw InputError("a wheel is finger b of two: a part between a finger that is turned and a wheel on a free pin");
  }
  if (!finger.finger.is_disk()) throw InputError("a wheel is a disk, found the finger " + finger.finger.name());
  if (finger.length) {
    throw InputError(
        "the length of a wheel follows from finger a's, since nothing turns it: leave the second length out");
  }
}

void require_goal(const PlanProblem& problem) {
  const PlanFinger& a = problem.fingers[0];
  if (!a.length) throw InputError("expected how far finger a is to roll, `length`, found none");
  if (problem.fingers.size() == 1) {
    if (*a.length == 0) throw InputError("expected a length other than 0: nothing would move");
    return;
  }
  const std::optional<double>& of_b = problem.fingers[1].length;
  if (*a.length == 0 && (!of_b || *of_b == 0)) {
    throw InputError("expected a length other than 0 of finger a or b: nothing would move");
  }
}

double opposite(double value) { return 0.0 - value; }  // no -0

void mirror(Pose& pose) {
  pose.x = opposite(pose.x);
  pose.heading = opposite(pose.heading);
}

void mirror(PlanRates& rates) {
  for (double& vx : rates.vx) vx = opposite(vx);
  for (double& omega : rates.omega) omega = opposite(omega);
}

}  // namespace

const char* name_of_finger(const PlanProblem& problem, std::size_t which) {
  if (problem.fingers.size() == 1) return "the finger";
  if (problem.fingers[which].wheel) return "the wheel";
  return which == 0 ? "finger a" : "finger b";
}

void require_valid(const PlanProblem& problem) {
  for (std::size_t which = 0; which < problem.fingers.size(); ++which) require_finger(problem, which);
  require_goal(problem);
  if (problem.rows < 2) throw InputError(fmt::format("expected at least 2 rows of a plan, found {}", problem.rows));
  if (!std::isfinite(problem.pose.x) || !std::isfinite(problem.pose.y) || !std::isfinite(problem.pose.heading)) {
    throw InputError("expected a finite pose of the part");
  }
  require_plan_number(problem.part_rotation, "rotation of the part", false);
  require_plan_number(problem.duration, "duration", true);
  require_plan_number(problem.limits.speed, "limit of the speed", true);
  require_plan_number(problem.limits.turn, "limit of the turning rate", true);
  require_plan_number(problem.limits.travel, "limit of the travel", true);
  require_plan_number(problem.limits.rotation, "limit of the rotation", true);
  if (!(problem.margin >= 0 && problem.margin < 0.5 * std::numbers::pi)) {
    throw InputError(fmt::format("expected a margin from 0 to below a right angle, found {} rad", problem.margin));
  }
  if (!(problem.clearance >= 0 && std::isfinite(problem.clearance))) {
    throw InputError(fmt::format("expected a clearance of at least 0, found {}", problem.clearance));
  }
  if (problem.may_overlap && problem.clearance > 0) {
    throw InputError("fingers that may overlap are at different heights: leave their clearance out");
  }
  if (problem.fingers.size() == 2) return;
  if (problem.part_rotation || problem.staying != Staying::middle) {
    throw InputError("one finger rolls on a part at rest: how that turns, or what stays, is of two fingers");
  }
}

PlanProblem in_mirror(const PlanProblem& problem) {
  PlanProblem seen = problem;
  seen.mirrored = false;
  mirror(seen.pose);
  if (seen.part_rotation) seen.part_rotation = opposite(*seen.part_rotation);
  for (PlanFinger& finger : seen.fingers) {
    finger.psi = mirrored_psi(&finger.finger, finger.psi);
    if (finger.u) finger.u = mirrored_u(finger.finger, *finger.u);
    finger.finger = mirrored(finger.finger);
  }
  return seen;
}

void out_of_mirror(const PlanProblem& seen, Plan& plan) {
  for (std::size_t which = 0; which < plan.roll.log.fingers.size(); ++which) {
    const Finger& finger = seen.fingers[which].finger;
    FingerRows& rows = plan.roll.log.fingers[which];
    for (double& u : rows.u) u = mirrored_u(finger, u);
    for (double& psi : rows.psi) psi = mirrored_psi(&finger, psi);
    for (double& x : rows.x) x = opposite(x);
    mirror(plan.rates[which]);
  }
  mirror(plan.part_rates);
  for (Pose& pose : plan.roll.pose) mirror(pose);
  for (double& force : plan.force) force = std::remainder(std::numbers::pi - force, 2 * std::numbers::pi);
}

}  // namespace rollfix::planning
