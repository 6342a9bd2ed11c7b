#pragma once

#include "rollfix/plan.hpp"

namespace rollfix {

/// Throws InputError: a problem that contradicts itself, or numbers that are none.
void require_valid(const PlanProblem& problem);

/// "finger a", of one finger "the finger".
const char* name_of_finger(const PlanProblem& problem, std::size_t which);

}  // namespace rollfix
