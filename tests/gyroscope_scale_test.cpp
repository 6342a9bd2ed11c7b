// A gyroscope whose turns are all off by one factor: with `gyro` that factor is one of the things the rows tell.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "belief_cases.hpp"
#include "noisy_pairs.hpp"
#include "rollfix/error.hpp"
#include "rollfix/solve.hpp"

namespace gyroscope_scale_test {
namespace {

using rollfix::Answer;
using rollfix::Noise;
using rollfix::Part;
using rollfix::Problem;

constexpr double kScale = 0.96;  // what it measures is larger by its inverse
constexpr double kStartShare = 0.3;

Part part() { return belief_cases::part_of("spline,n=9,seed=7,wobble=0.2"); }

Noise noise_with(double gyro, double contact, double angle) {
  Noise noise{contact * part().perimeter(), angle, 0, 0};
  noise.gyro = gyro;
  return noise;
}

/// Increments of nearly a lap.
Problem by_increments(double gyro) {
  const double P = part().perimeter();
  rollfix::Log log = rollfix::noisy_increments(part(), kStartShare * P, 0.9 * P, 400, noise_with(0, 1e-4, 1e-3), 5).log;
  for (double& turn : log.fingers[0].turn) turn /= kScale;
  return {part(), log, {}, noise_with(gyro, 1e-4, 1e-3)};
}

/// A disk whose psi a gyroscope measures.
Problem by_psi(double gyro) {
  const double P = part().perimeter();
  rollfix::RollPlan plan;
  plan.start = kStartShare * P;
  plan.distance = 0.6 * P;
  plan.rows = 300;
  rollfix::Log log = rollfix::noisy_roll(part(), rollfix::disk(0.03 * P), plan, noise_with(0, 1e-3, 5e-3), 5).log;
  const double first = log.fingers[0].psi.front();
  for (double& psi : log.fingers[0].psi) psi = first + (psi - first) / kScale;
  return {part(), log, {rollfix::disk(0.03 * P)}, noise_with(gyro, 1e-3, 5e-3)};
}

void expect_found(const Problem& problem) {
  const Answer answer = solve(problem);
  ASSERT_EQ(answer.verdict.text(), "unique");
  const rollfix::Placement& only = answer.placements.front();
  EXPECT_NEAR(only.start[0], kStartShare * part().perimeter(), 4 * only.sd[0]);
  const rollfix::Fit& fit = answer.weighing->fit;
  EXPECT_NEAR(fit.turn_scale, kScale, 4 * fit.turn_scale_sd);
  EXPECT_LT(fit.turn_scale_sd, 0.005);
}

}  // namespace

TEST(GyroscopeScale, of_increments_is_measured_and_moves_no_place) { expect_found(by_increments(0.03)); }

TEST(GyroscopeScale, of_psi_is_measured_and_moves_no_place) { expect_found(by_psi(0.03)); }

TEST(GyroscopeScale, that_nothing_was_said_of_is_what_may_be_wrong) {
  for (const Problem& problem : {by_increments(0), by_psi(0)}) {
    const Answer answer = solve(problem);
    ASSERT_FALSE(answer.diagnoses.empty());
    const rollfix::Diagnosis& likeliest = answer.diagnoses.front();
    EXPECT_EQ(likeliest.cause, rollfix::Cause::gyroscope);
    EXPECT_NEAR(likeliest.turn_scale, kScale, 4 * likeliest.turn_scale_sd);
  }
}

TEST(GyroscopeScale, that_is_exact_says_nothing_of_turns) {
  const Answer answer = solve(by_psi(0));
  EXPECT_EQ(answer.weighing->fit.turn_scale, 1);
  EXPECT_EQ(answer.weighing->fit.turn_scale_sd, 0);
}

TEST(GyroscopeScale, is_of_one_finger) {
  const double P = part().perimeter();
  rollfix::FreePlan plan = free_rolls::by_distances(0.02 * P, 0.1 * P, 0.6 * P, 0.02 * P, 0.5 * P, 0.3 * P, -0.3);
  plan.rows = 20;
  const rollfix::Log log = rollfix::noisy_roll_free(part(), plan, noise_with(0, 1e-3, 5e-3), 1).log;
  const Problem problem{part(), log, {rollfix::disk(0.02 * P)}, noise_with(0.03, 1e-3, 5e-3)};
  EXPECT_THROW(solve(problem), rollfix::InputError);
}

}  // namespace gyroscope_scale_test
