#pragma once

#include <optional>
#include <vector>

#include "plan/roll_path.hpp"
#include "rollfix/part.hpp"
#include "rollfix/plan.hpp"

namespace rollfix::planning {

/// Half the angle of a finger's friction cone, radians: a right angle where its friction is not known, 0 of a wheel.
double cone_of(const PlanFinger& finger);

/// One condition all along a path: what is left where it is worst.
struct Looked {
  PlanMargin margin;  // without its time and row
  double at = 0;      // lambda
};

/// What two fingers' contacts say of friction, of fingers that enter each other, and of the balance on a wheel. Between
/// instants it is proved.
struct SqueezeLook {
  std::vector<Looked> looked;
  PerFinger<double> tilt;  // the largest angle of the force to each normal, radians
  /// false: a margin is too near 0 to be proved
  bool decided = true;
};
SqueezeLook look_at_squeeze(const PlanProblem& problem, const RollPath& path, bool expanding);

/// Where a finger would enter the part; nothing: nowhere. `which`: 0 for finger a.
std::optional<Looked> look_at_reach(const Reach& reach, const RollPath& path, std::size_t which);

/// A path made a motion of the fingers and the part, in time from 0 to 1: how far along the path, rest at both ends.
double eased(double time);
/// Its derivative by time.
double eased_rate(double time);
/// Its inverse.
double time_of(double along);

/// One instant of the motion: where each body's frame is, and its rates by time.
struct BodyState {
  Pose pose;
  /// of the frame's origin, length per time
  double vx = 0;
  double vy = 0;
  /// radians per time
  double omega = 0;
};
struct MotionState {
  /// both contacts, in the part's frame
  PairPlace place;
  BodyState part;
  PerFinger<BodyState> finger;
  double force = 0;  // direction in which finger a presses
};

/// The motion at these times; rates are by a time in which the whole roll takes 1.
std::vector<MotionState> motion_at(const PlanProblem& problem, const RollPath& path, const std::vector<double>& times,
                                   bool expanding);

/// Which duration the limits, or what is usual, ask for; then what the limits leave.
double duration_of(const PlanProblem& problem, const std::vector<MotionState>& states);
std::vector<Looked> look_at_limits(const PlanProblem& problem, const std::vector<MotionState>& states,
                                   const std::vector<double>& times, double duration);

/// Rows of the plan at equal times.
void write_rows(const PlanProblem& problem, const RollPath& path, bool expanding, Plan& plan);

}  // namespace rollfix::planning
