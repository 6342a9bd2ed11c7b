#pragma once

#include <memory>

#include "handles.hpp"
#include "rollfix/plan.hpp"

namespace rollfix::python {

/// A plan and what it is of.
struct PlanHandle {
  std::shared_ptr<const PlanProblem> problem;
  std::shared_ptr<const Plan> plan;
};

template <>
inline constexpr bool kIsPythonClass<PlanHandle> = true;

}  // namespace rollfix::python
