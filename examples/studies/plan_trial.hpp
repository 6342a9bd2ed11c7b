#pragma once

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "plan_physics.hpp"
#include "rollfix/error.hpp"
#include "rollfix/outline.hpp"

/// Random rolls of two disks, planned or refused, and how they go in a physics engine.
namespace plan_trial {

using plan_physics::Played;
using rollfix::Part;
using rollfix::Plan;
using rollfix::PlanProblem;
using rollfix::Vec2;

inline constexpr double kFriction = 0.5;
inline constexpr double kMargin = 3 * std::numbers::pi / 180;  // for the floor's friction and inertia
inline constexpr double kSlips = 2e-3;                         // of the perimeter: beyond this a contact has slipped
inline constexpr double kApart = 0.05;  // s: a disk that goes over a vertex is off for a step or two

inline double uniform(std::mt19937_64& generator, double lo, double hi) {
  return std::uniform_real_distribution<double>(lo, hi)(generator);
}

/// In turn wavy closed splines through 7 to 12 points, and shapes of the gallery with random parameters.
inline Part random_part(std::mt19937_64& generator, std::size_t k) {
  if (k % 2 == 0) {
    const int count = static_cast<int>(uniform(generator, 7, 13));
    std::vector<Vec2> points;
    for (int j = 0; j < count; ++j) {
      const double r = uniform(generator, 0.8, 1.2);
      const double angle = 2 * std::numbers::pi * j / count;
      points.emplace_back(r * std::cos(angle), uniform(generator, 0.7, 1.0) * r * std::sin(angle));
    }
    return Part(rollfix::outline_through(points, "spline"));
  }
  switch (k / 2 % 5) {
    case 0:
      return Part(rollfix::gallery(fmt::format("ellipse,a={},b=1", uniform(generator, 1, 2.2))));
    case 1:
      return Part(rollfix::gallery(fmt::format("limacon,a={},b=1", uniform(generator, 2, 4))));
    case 2:
      return Part(rollfix::gallery("superellipse"));
    case 3:
      return Part(rollfix::gallery("stadium"));
    default:
      return Part(rollfix::gallery("cam"));
  }
}

inline PlanProblem random_problem(std::mt19937_64& generator, const Part& part) {
  const double P = part.perimeter();
  PlanProblem problem{part, rollfix::PerFinger<rollfix::PlanFinger>::of(2)};
  for (rollfix::PlanFinger& finger : problem.fingers) {
    finger.finger = rollfix::disk(uniform(generator, 0.03, 0.06) * P);
    finger.friction = kFriction;
  }
  problem.fingers[0].start = uniform(generator, 0, P);
  problem.fingers[1].start = *problem.fingers[0].start + uniform(generator, 0.42, 0.58) * P;
  problem.fingers[0].length = (uniform(generator, 0, 1) < 0.5 ? -1 : 1) * uniform(generator, 0.08, 0.2) * P;
  problem.margin = kMargin;
  problem.rows = 1001;
  return problem;
}

inline std::optional<Plan> planned(const PlanProblem& problem) {
  try {
    return solve(problem);
  } catch (const rollfix::InputError&) {
    return std::nullopt;  // the disks do not fit there
  }
}

struct Case {
  PlanProblem problem;
  Plan plan;
};

/// A roll that can be done.
inline Case feasible_case(std::mt19937_64& generator, std::size_t k) {
  while (true) {
    const Part part = random_part(generator, k);
    const PlanProblem problem = random_problem(generator, part);
    const auto plan = planned(problem);
    if (plan && plan->feasible()) return {problem, *plan};
  }
}

/// The same start, and finger b's length such that the force leaves a cone by 5 degrees or more at the end.
inline std::optional<Case> refused_case(const Case& done) {
  PlanProblem problem = done.problem;
  problem.margin = 0;
  for (const double more : {0.08, -0.08, 0.12, -0.12, 0.16, -0.16, 0.2, -0.2}) {
    problem.fingers[1].length = done.plan.length[1] + more * problem.part.perimeter();
    const auto plan = planned(problem);
    if (!plan || !plan->failure) continue;
    const rollfix::PlanMargin& failed = plan->margins[*plan->failure];
    const bool slips = failed.condition == rollfix::Condition::friction && failed.value < -5 * std::numbers::pi / 180;
    if (slips) return Case{problem, *plan};
  }
  return std::nullopt;
}

inline Played play(const Case& one, double friction = kFriction) {
  return plan_physics::Stage(one.problem, one.plan, {friction, friction}).play();
}

inline double slip_of(const Played& played) { return std::max(played.slip[0], played.slip[1]); }

/// Whether both contacts lasted.
inline bool holds(const Played& played) { return slip_of(played) < kSlips && played.apart < kApart; }

}  // namespace plan_trial
