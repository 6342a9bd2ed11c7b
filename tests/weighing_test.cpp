// What remains of an answer's weights once fingers rule places out, and once what was said of the noise is in doubt.
#include "answer/steps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "rollfix/solve.hpp"
#include "shapes.hpp"

namespace weighing_test {
namespace {

using rollfix::Answer;
using rollfix::Belief;
using rollfix::Problem;

/// Eight corners to pivot at; a jaw pivots at the four at the outside.
rollfix::Part comb() {
  return rollfix::Part(shapes::polygon(
      {{0, 0}, {5, 0}, {5, 2}, {4, 2}, {4, 1}, {3, 1}, {3, 1.5}, {2, 1.5}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}));
}

Problem pivot_on(const rollfix::Part& part) { return {part, {{0, 0.5}}, {}, rollfix::Noise{0.001, 0.01}}; }

TEST(Weighing, places_that_a_jaw_does_not_get_to_are_no_evidence) {
  Problem problem = pivot_on(comb());
  const Answer any = rollfix::solve(problem);
  problem.fingers = {rollfix::jaw()};
  const Answer possible = rollfix::solve(problem);
  ASSERT_EQ(any.placements.size(), 8U);
  ASSERT_EQ(possible.placements.size(), 4U);
  for (const rollfix::Placement& placement : possible.placements) EXPECT_NEAR(placement.probability, 0.25, 1e-3);
  const double odds = possible.weighing->evidence.with(1) - any.weighing->evidence.with(1);
  EXPECT_NEAR(odds, std::log(0.5), 0.01);
}

TEST(Weighing, rows_of_which_four_are_worth_one_are_a_quarter_of_the_evidence_against_what_was_said) {
  const Problem problem = pivot_on(shapes::unit_square());
  Answer answer = rollfix::solve(problem);
  answer.placements.resize(1);
  answer.placements[0].probability = 1;
  answer.weighing->fit.excess = 1.5;
  answer.weighing->fit.widened = 2 * answer.weighing->fit.excess;  // the mean of four is known twice as well as one
  answer.diagnoses.emplace_back();
  answer.diagnoses[0].cause = rollfix::Cause::radius;
  answer.diagnoses[0].log_odds = 2;
  std::optional<Belief> belief = rollfix::believe(problem, rollfix::observe(problem));
  rollfix::answer::conclude(*belief, answer, false, false);
  EXPECT_NEAR(answer.placements[0].probability, 1 / (1 + std::exp(0.5)), 1e-12);
  EXPECT_NEAR(answer.weighing->rest, 1 - answer.placements[0].probability, 1e-12);
}

}  // namespace
}  // namespace weighing_test
