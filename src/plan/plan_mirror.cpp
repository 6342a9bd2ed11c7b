#include "plan/plan_mirror.hpp"

#include <cmath>
#include <numbers>

#include "log/mirrored.hpp"

// Idea: in a mirror x, angles and angular velocities have the other sign, and what was turned one way turns the other;
// lengths along the outline as it was drawn, distances and friction are what they were.
namespace rollfix {
namespace {

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

}  // namespace rollfix
