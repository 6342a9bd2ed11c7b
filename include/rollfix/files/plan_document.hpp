#pragma once

#include <string>

#include "rollfix/files/documents.hpp"
#include "rollfix/plan/plan.hpp"

namespace rollfix {

/// "rollfix/plan/1": docs/json.md lists its fields.
std::string format_plan_document(const Plan& plan, const PlanProblem& problem, Layout layout = Layout::lines);

}  // namespace rollfix
