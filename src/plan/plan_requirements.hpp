#pragma once

#include "rollfix/plan.hpp"

namespace rollfix::planning {

/// Throws InputError: a problem that contradicts itself, or numbers that are none.
void require_valid(const PlanProblem& problem);

/// "finger a", of one finger "the finger".
const char* name_of_finger(const PlanProblem& problem, std::size_t which);

/// The same problem as a mirror shows it, x with the other sign: there a part that lies face down lies as it was drawn.
PlanProblem in_mirror(const PlanProblem& problem);

/// Back again. `seen`: the problem in the mirror.
void out_of_mirror(const PlanProblem& seen, Plan& plan);

}  // namespace rollfix::planning
