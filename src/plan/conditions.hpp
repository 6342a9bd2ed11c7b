#pragma once

#include <optional>
#include <vector>

#include "plan/roll_path.hpp"
#include "rollfix/part.hpp"
#include "rollfix/plan.hpp"

namespace rollfix {

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
  bool decided = true;
};
SqueezeLook look_at_squeeze(const PlanProblem& problem, const RollPath& path, bool expanding);

/// Where a finger would enter the part; nothing: nowhere. `which`: 0 for finger a.
std::optional<Looked> look_at_reach(const Reach& reach, const RollPath& path, std::size_t which);

}  // namespace rollfix
