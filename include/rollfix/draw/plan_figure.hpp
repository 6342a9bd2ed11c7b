#pragma once

#include <string>

#include "rollfix/draw/svg.hpp"
#include "rollfix/plan/plan.hpp"

namespace rollfix {

/// The world: the part and the fingers where a plan ends, or where it first fails, with the friction cones and the line
/// of the force there; dashed where they start; the ways of the fingers' frames.
struct PlanFigure {
  const Plan* plan = nullptr;            // not owned; required
  const PlanProblem* problem = nullptr;  // that it is of; required
  std::string title{};                   // empty: the part's name
  double width = 640;                    // pixels
};

/// Throws InputError: no plan.
Svg draw_plan(const PlanFigure& figure);

}  // namespace rollfix
