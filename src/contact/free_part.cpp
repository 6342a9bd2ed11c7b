#include "rollfix/contact/free_part.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "contact/motion.hpp"
#include "contact/track.hpp"
#include "contact/unwrap.hpp"
#include "rollfix/error.hpp"

namespace rollfix {

namespace {

using Rate = std::function<double(double)>;
using Solve = std::vector<RollState> (*)(const Track&, const Motion&, const std::vector<double>&);

/// Says which finger an error is about.
template <class Action>
auto naming(const char* finger, const Action& action) {
  try {
    return action();
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", finger, error.what()));
  }
}

bool is_by_distances(const FreePlan& plan) { return plan.a.distance.has_value(); }

void require_consistent(const FreePlan& plan) {
  const int distances = (plan.a.distance ? 1 : 0) + (plan.b.distance ? 1 : 0);
  const int omegas = (plan.a.omega ? 1 : 0) + (plan.b.omega ? 1 : 0);
  if (distances + omegas != 2 || distances * omegas != 0) {
    throw InputError(
        fmt::format("expected a distance for both fingers or an angular velocity by time for both, found {} distances "
                    "and {} angular velocities",
                    distances, omegas));
  }
  if (omegas == 2 && !plan.duration) {
    throw InputError("expected a duration together with the fingers' angular velocities, found none");
  }
  if (omegas == 2 && plan.part_rotation != 0) {
    throw InputError(
        "expected the part's angular velocity by time together with the fingers', found a rotation, which goes with "
        "distances");
  }
  if (distances == 2 && plan.omega_part) {
    throw InputError(
        "expected the part's rotation together with the fingers' distances, found an angular velocity by time");
  }
  if (plan.velocity_a && plan.velocity_part) {
    throw InputError("expected the velocity of finger a's centre or the part's, found both");
  }
  if (distances == 2 && *plan.a.distance == 0 && *plan.b.distance == 0) {
    throw InputError("expected a distance other than 0 of one finger at least, found 0 of both");
  }
  if (plan.duration && !(*plan.duration > 0 && std::isfinite(*plan.duration))) {
    throw InputError(fmt::format("expected a duration of a roll above 0, found {}", *plan.duration));
  }
  if (!(plan.speed > 0 && std::isfinite(plan.speed))) {
    throw InputError(fmt::format("expected a speed of a roll above 0, found {}", plan.speed));
  }
  if (!std::isfinite(plan.part_rotation)) {
    throw InputError(fmt::format("expected a finite rotation of the part, found {}", plan.part_rotation));
  }
  if (!std::isfinite(plan.pose.x) || !std::isfinite(plan.pose.y) || !std::isfinite(plan.pose.heading)) {
    throw InputError(fmt::format("expected a finite pose of the part at the start, found {}, {}, {}", plan.pose.x,
                                 plan.pose.y, plan.pose.heading));
  }
}

/// The finger's angular velocity as the part sees it: what stands in the numerators of eqs. (1) and (2).
Rate against_part(const Rate& omega, const Rate& omega_part) {
  if (!omega_part) return omega;
  return [omega, omega_part](double time) { return omega(time) - omega_part(time); };
}

/// The motion of a finger that stays where it is on the part.
Motion resting(const Track& track, RollPlan plan) {
  // Where an open part ends the only stretch to rest on lies behind.
  const double ahead = !track.part().closed() && plan.start >= track.part().perimeter() ? -1 : 1;
  plan.duration = 1;
  plan.omega = [ahead](double /*time*/) { return ahead; };
  Motion motion = plan_motion(track, plan);
  motion.omega = nullptr;
  return motion;
}

/// One finger's motion as the part sees it.
Motion motion_against_part(const Track& track, const FreeFinger& finger, const FreePlan& plan) {
  RollPlan roll;
  roll.start = finger.start;
  roll.psi = finger.psi - plan.pose.heading;
  roll.rows = plan.rows;
  if (!is_by_distances(plan)) {
    roll.duration = plan.duration;
    roll.omega = against_part(finger.omega, plan.omega_part);
    return plan_motion(track, roll);
  }
  if (*finger.distance == 0) return resting(track, roll);
  roll.distance = finger.distance;
  return plan_motion(track, roll);
}

/// Two even motions at once: both last as long as the longer one at the plan's speed, or as the plan says.
void share_duration(Motion& a, Motion& b, const FreePlan& plan) {
  const double rotation_a = a.velocity * a.duration;
  const double rotation_b = b.velocity * b.duration;
  const double longest = std::max(std::abs(rotation_a), std::abs(rotation_b));
  a.duration = b.duration = plan.duration.value_or(longest / plan.speed);
  a.velocity = rotation_a / a.duration;
  b.velocity = rotation_b / b.duration;
}

std::vector<double> headings_of(const FreePlan& plan, const std::vector<double>& times) {
  std::vector<double> headings(times.size());
  if (plan.omega_part) headings = integrals(plan.omega_part, times);
  for (std::size_t k = 0; k < times.size(); ++k) {
    if (is_by_distances(plan)) headings[k] = plan.part_rotation * (times[k] / times.back());
    headings[k] += plan.pose.heading;
  }
  return headings;
}

/// How far something with this velocity has come at each of the times.
std::vector<Vec2> displacements(const std::function<Vec2(double)>& velocity, const std::vector<double>& times) {
  std::vector<Vec2> result(times.size(), Vec2::Zero());
  if (!velocity) return result;
  const std::vector<double> x = integrals([&](double time) { return velocity(time).x(); }, times);
  const std::vector<double> y = integrals([&](double time) { return velocity(time).y(); }, times);
  for (std::size_t k = 0; k < times.size(); ++k) result[k] = {x[k], y[k]};
  return result;
}

/// One finger's roll as the part sees it.
struct FreeContact {
  std::shared_ptr<const Track> way;
  Motion motion;
  std::vector<RollState> states;

  Vec2 centre(std::size_t row) const {
    return centre_of(track().finger(), track().part().point(states[row].s), states[row].contact);
  }
  const Track& track() const { return *way; }
};

std::vector<Pose> poses_of(const FreePlan& plan, const FreeContact& a, const std::vector<double>& times) {
  const std::vector<double> headings = headings_of(plan, times);
  const std::vector<Vec2> moved = displacements(plan.velocity_part ? plan.velocity_part : plan.velocity_a, times);
  const Vec2 centre = plan.pose.world(a.centre(0));
  std::vector<Pose> poses;
  for (std::size_t k = 0; k < times.size(); ++k) {
    Pose pose{0, 0, headings[k]};
    const Vec2 origin = plan.velocity_part ? Vec2(plan.pose.x, plan.pose.y) + moved[k]
                                           : Vec2(centre + moved[k] - pose.turned(a.centre(k)));
    pose.x = origin.x();
    pose.y = origin.y();
    poses.push_back(pose);
  }
  return poses;
}

/// What the finger's sensors say in the world.
Log log_of(const FreeContact& rolling, const FreeFinger& finger, const std::vector<Pose>& poses,
           const std::vector<double>& times) {
  Log log;
  log.name = fmt::format("the roll on {}", rolling.track().part().name());
  log.time = times;
  for (std::size_t k = 0; k < times.size(); ++k) {
    const Contact& contact = rolling.states[k].contact;
    const Vec2 centre = poses[k].world(rolling.centre(k));
    log.u.push_back(contact.u);
    log.psi.push_back(finger.psi + (contact.psi - rolling.motion.first.psi) + (poses[k].heading - poses[0].heading));
    log.x.push_back(centre.x());
    log.y.push_back(centre.y());
  }
  require_readable(log);
  return log;
}

FreeContact contact_of(const Part& part, const FreeFinger& finger, const FreePlan& plan) {
  std::shared_ptr<const Track> way = track_of(part, finger.disk, finger.start, std::nullopt);
  Motion motion = motion_against_part(*way, finger, plan);
  return {std::move(way), std::move(motion), {}};
}

FreeRoll roll_with(Solve solve, const Part& part, const FreePlan& plan) {
  require_consistent(plan);
  FreeContact a = naming("finger a", [&] { return contact_of(part, plan.a, plan); });
  FreeContact b = naming("finger b", [&] { return contact_of(part, plan.b, plan); });
  if (is_by_distances(plan)) share_duration(a.motion, b.motion, plan);
  const std::vector<double> times = times_of(a.motion, plan.rows);
  a.states = naming("finger a", [&] { return solve(a.track(), a.motion, times); });
  b.states = naming("finger b", [&] { return solve(b.track(), b.motion, times); });

  FreeRoll roll;
  roll.pose = poses_of(plan, a, times);
  roll.log.a = naming("finger a", [&] { return log_of(a, plan.a, roll.pose, times); });
  roll.log.b = naming("finger b", [&] { return log_of(b, plan.b, roll.pose, times); });
  for (const RollState& state : a.states) {
    roll.s.push_back(state.s);
    roll.angle_a.push_back(state.angle);
  }
  for (const RollState& state : b.states) {
    roll.t.push_back(state.s);
    roll.angle_b.push_back(state.angle);
  }
  return roll;
}

}  // namespace

FreeRoll roll_free(const Part& part, const FreePlan& plan) { return roll_with(&integrated, part, plan); }

FreeRoll roll_free_in_closed_form(const Part& part, const FreePlan& plan) {
  return roll_with(&in_closed_form, part, plan);
}

}  // namespace rollfix
