#include "plan/planning.hpp"

#include <fmt/format.h>
#include <cmath>
#include <numbers>

#include "log/mirrored.hpp"
#include "rollfix/error.hpp"

// What a plan can't be asked, and a problem as a mirror shows it. In a mirror x, angles and angular velocities have the
// other sign, and what was turned one way turns the other; lengths along the outline as it was drawn, distances and
// friction stay.
namespace rollfix::planning {
namespace {

/// Throws InputError unless a value that is given is finite, and above 0 where it has to be.
void require_plan_number(std::optional<double> value, const std::string& what, bool above_zero) {
  if (!value) return;
  if (std::isfinite(*value) && (!above_zero || *value > 0)) return;
  throw InputError(
      fmt::format("expected a {}{} of a plan, found {}", what, above_zero ? " above 0" : " that is finite", *value));
}

/// What a finger needs: a start (a wheel finds its own), a valid shape, friction of at least 0; a wheel is finger b, a
/// disk, and has no length of its own.
void require_finger(const PlanProblem& problem, std::size_t which) {
  const PlanFinger& finger = problem.fingers[which];
  const std::string name = name_of_finger(problem, which);
  require_valid(finger.finger);
  require_plan_number(finger.start, "start of " + name, false);
  require_plan_number(finger.length, "length of " + name, false);
  require_plan_number(finger.psi, "orientation of " + name, false);
  // 0 is allowed. Without a friction any angle below a right one holds.
  if (finger.friction && !(std::isfinite(*finger.friction) && *finger.friction >= 0)) {
    throw InputError(fmt::format("expected a friction of {} of at least 0, found {}", name, *finger.friction));
  }
  // A wheel's first contact is where it is in balance.
  if (!finger.start && !finger.wheel) {
    throw InputError(fmt::format("expected a start of {}: s of its first contact, found none", name));
  }
  // The rest is about a wheel.
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

/// Something has to move: finger a needs a length, and one of the lengths has to be other than 0, or free.
void require_goal(const PlanProblem& problem) {
  const PlanFinger& a = problem.fingers[0];
  // Finger a leads: its length is always given.
  if (!a.length) throw InputError("expected how far finger a is to roll, `length`, found none");
  if (problem.fingers.size() == 1) {
    if (*a.length == 0) throw InputError("expected a length other than 0: nothing would move");
    return;
  }
  // nothing: finger b's length is free, and something moves
  const std::optional<double>& of_b = problem.fingers[1].length;
  if (*a.length == 0 && (!of_b || *of_b == 0)) {
    throw InputError("expected a length other than 0 of finger a or b: nothing would move");
  }
}

double opposite(double value) { return 0.0 - value; }  // no -0

/// x and the heading change their sign, y stays.
void mirror(Pose& pose) {
  pose.x = opposite(pose.x);
  pose.heading = opposite(pose.heading);
}

/// vx and the angular velocity change their sign, vy stays.
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
  // The margin is an angle inside a friction cone, which is at most a right angle.
  if (!(problem.margin >= 0 && problem.margin < 0.5 * std::numbers::pi)) {
    throw InputError(fmt::format("expected a margin from 0 to below a right angle, found {} rad", problem.margin));
  }
  if (!(problem.clearance >= 0 && std::isfinite(problem.clearance))) {
    throw InputError(fmt::format("expected a clearance of at least 0, found {}", problem.clearance));
  }
  // The two contradict each other.
  if (problem.may_overlap && problem.clearance > 0) {
    throw InputError("fingers that may overlap are at different heights: leave their clearance out");
  }
  // What only two fingers on a free part can be asked.
  if (problem.fingers.size() == 2) return;
  if (problem.part_rotation || problem.staying != Staying::middle) {
    throw InputError("one finger rolls on a part at rest: how that turns, or what stays, is of two fingers");
  }
}

PlanProblem in_mirror(const PlanProblem& problem) {
  PlanProblem seen = problem;
  // In the mirror the part lies as it was drawn: it stays, and so do starts and lengths along it.
  seen.mirrored = false;
  mirror(seen.pose);
  if (seen.part_rotation) seen.part_rotation = opposite(*seen.part_rotation);
  // u and psi are those of the mirrored finger.
  for (PlanFinger& finger : seen.fingers) {
    finger.psi = mirrored_psi(&finger.finger, finger.psi);
    if (finger.u) finger.u = mirrored_u(finger.finger, *finger.u);
    finger.finger = mirrored(finger.finger);
  }
  return seen;
}

/// The rows are in the mirror's world: everything of the plan that has a direction changes.
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
  // A direction in a mirror: cos changes its sign, sin stays.
  for (double& force : plan.force) force = std::remainder(std::numbers::pi - force, 2 * std::numbers::pi);
}

}  // namespace rollfix::planning
