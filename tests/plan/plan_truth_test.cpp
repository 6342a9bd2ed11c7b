// Plans against a search of every pair of contacts, and against looking closely at what was proved.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include "plans.hpp"
#include "random.hpp"

namespace rollfix::plan_truth_test {
namespace {

using namespace plans;  // NOLINT(google-build-using-namespace): the words of this test

PlanProblem random_problem(std::mt19937_64& generator, double friction) {
  std::uniform_real_distribution<double> share(0, 1);
  const Part part = roundish(generator);
  const double P = part.perimeter();
  const double s = share(generator) * P;
  const double t = s + (0.42 + 0.16 * share(generator)) * P;
  const double length = (share(generator) < 0.5 ? -1 : 1) * (0.05 + 0.15 * share(generator)) * P;
  return two(part, finger(disk(0.25), s, length, friction), finger(disk(0.2), t, {}, friction));
}

/// The smaller distance to a cone's edge, from points of the outline alone.
double margin_at(const Part& part, double s, double t, double friction) {
  return std::atan(friction) - std::max(std::abs(tilt(part, s, t)), std::abs(tilt(part, t, s)));
}

/// The best worst margin of any way of pairing the contacts in which a rolls on: a flood from column to column of a
/// fine grid. Slower for b than a plan may be, it is allowed any jump.
double exhaustive(const PlanProblem& problem, int columns, int rows) {
  const Part& part = problem.part;
  const double P = part.perimeter();
  const double mu = *problem.fingers[0].friction;
  std::vector<double> worst(static_cast<std::size_t>(rows), -10);
  for (int i = 0; i <= columns; ++i) {
    const double s = *problem.fingers[0].start + *problem.fingers[0].length * i / columns;
    std::vector<double> margin;
    for (int j = 0; j < rows; ++j) {
      margin.push_back(margin_at(part, s, *problem.fingers[1].start + P * (static_cast<double>(j) / rows - 0.5), mu));
    }
    if (i == 0) {
      worst[static_cast<std::size_t>(rows / 2)] = margin[static_cast<std::size_t>(rows / 2)];
    }
    // Within a column b may roll on alone: from both sides.
    for (std::size_t j = 0; j < margin.size(); ++j) worst[j] = std::min(worst[j], margin[j]);
    for (std::size_t j = 1; j < margin.size(); ++j) worst[j] = std::max(worst[j], std::min(worst[j - 1], margin[j]));
    for (std::size_t j = margin.size() - 1; j > 0; --j) {
      worst[j - 1] = std::max(worst[j - 1], std::min(worst[j], margin[j - 1]));
    }
  }
  return *std::max_element(worst.begin(), worst.end());
}

TEST(PlanTruth, finds_a_way_wherever_a_search_of_all_pairs_does) {
  std::mt19937_64 generator = test_generator(81);
  for (int k = 0; k < test_count(4); ++k) {
    const PlanProblem problem = random_problem(generator, 0.5);
    const double best = exhaustive(problem, 60, 240);
    if (std::abs(best) < 0.03) continue;  // the grid can't tell
    const Plan plan = solve(problem);
    EXPECT_EQ(plan.feasible(), best > 0) << verdict_text(plan, problem) << ", best " << best;
  }
}

TEST(PlanTruth, has_no_margin_smaller_than_it_says_between_its_rows) {
  std::mt19937_64 generator = test_generator(82);
  for (int k = 0; k < test_count(4); ++k) {
    PlanProblem problem = random_problem(generator, 0.9);
    problem.rows = 2001;
    const Plan plan = solve(problem);
    if (!plan.feasible()) continue;
    const double told =
        std::min(margin_of(plan, Condition::friction, 0).value, margin_of(plan, Condition::friction, 1).value);
    double least = 10;
    for (std::size_t row = 0; row < problem.rows; row += 5) {
      least = std::min(least, margin_at(problem.part, plan.roll.s[0][row], plan.roll.s[1][row], 0.9));
    }
    EXPECT_NEAR(least, told, 1e-3);
    EXPECT_GE(least, told - 1e-6);
  }
}

TEST(PlanTruth, tells_the_friction_with_which_it_just_can_be_done) {
  std::mt19937_64 generator = test_generator(83);
  for (int k = 0; k < test_count(4); ++k) {
    PlanProblem problem = random_problem(generator, 2);
    problem.fingers[1].length = *problem.fingers[0].length;
    const Plan plan = solve(problem);
    if (plan.failure || plan.path != PlanPath::even) continue;
    const double needed = std::max(plan.friction_needed[0], plan.friction_needed[1]);
    problem.fingers[0].friction = problem.fingers[1].friction = needed * 1.001;
    EXPECT_TRUE(solve(problem).feasible());
  }
}

}  // namespace
}  // namespace rollfix::plan_truth_test
