#pragma once

#include <string>

#include "rollfix/plan.hpp"

namespace rollfix::app {

/// What the program prints of a plan: the verdict, what each finger does, what is left of each condition.
std::string plan_text(const Plan& plan, const PlanProblem& problem);

}  // namespace rollfix::app
