// A gyroscope whose rate is off by the same all along: with `drift` this bias is one of the things the rows tell.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "belief_cases.hpp"
#include "rollfix/rolling.hpp"
#include "rollfix/solve.hpp"

namespace gyroscope_bias_test {
namespace {

using rollfix::Answer;
using rollfix::Fit;
using rollfix::Log;
using rollfix::Noise;
using rollfix::Part;
using rollfix::Problem;

constexpr double kBias = 2e-3;  // radians per second
constexpr double kDrift = 3e-3;
constexpr double kStartShare = 0.3;

Part part() { return belief_cases::part_of("spline,n=9,seed=7,wobble=0.2"); }

Noise noise_with(double drift, double contact, double angle) {
  Noise noise{contact * part().perimeter(), angle, 0, 0};
  noise.drift = drift;
  return noise;
}

/// Increments of so many laps, a lap a minute.
Problem by_increments(double drift, double laps) {
  const double P = part().perimeter();
  const auto rows = static_cast<std::size_t>(400 * laps);
  Log log =
      rollfix::noisy_increments(part(), kStartShare * P, laps * P, rows, noise_with(0, 1e-4, 1e-3), 5, 60 * laps).log;
  for (std::size_t k = 0; k < rows; ++k) log.fingers[0].turn[k] += kBias * log.time[k];
  return {part(), log, {}, noise_with(drift, 1e-4, 1e-3)};
}

/// 35 rows of a lap in 400 s: over one row the bias comes to a hundred times what a row is off otherwise.
Problem by_few_long_rows() {
  const double P = part().perimeter();
  Log log = rollfix::noisy_increments(part(), kStartShare * P, P, 35, noise_with(0, 1e-5, 2e-4), 5, 400).log;
  for (std::size_t k = 0; k < log.time.size(); ++k) log.fingers[0].turn[k] += kBias * log.time[k];
  return {part(), log, {}, noise_with(kDrift, 1e-5, 2e-4)};
}

/// As a clock shows it.
Problem later(Problem problem, double seconds) {
  for (double& time : problem.measured.log->time) time += seconds;
  return problem;
}

/// A disk whose psi a gyroscope measures, in a minute.
Problem by_psi(double drift) {
  const double P = part().perimeter();
  rollfix::RollPlan plan;
  plan.start = kStartShare * P;
  plan.distance = 0.8 * P;
  plan.rows = 300;
  Log log = rollfix::noisy_roll(part(), rollfix::disk(0.03 * P), plan, noise_with(0, 1e-3, 5e-3), 5).log;
  for (double& time : log.time) time *= 60 / log.time.back();
  for (std::size_t k = 0; k < log.time.size(); ++k) log.fingers[0].psi[k] += kBias * log.time[k];
  return {part(), log, {rollfix::disk(0.03 * P)}, noise_with(drift, 1e-3, 5e-3)};
}

Fit expect_found(const Problem& problem) {
  const Answer answer = solve(problem);
  EXPECT_EQ(answer.verdict.text(), "unique");
  const rollfix::Placement& only = answer.placements.front();
  EXPECT_NEAR(only.start[0], kStartShare * part().perimeter(), 4 * only.sd[0]);
  const Fit fit = answer.weighing->fit;
  EXPECT_NEAR(fit.turn_bias, kBias, 4 * fit.turn_bias_sd);
  return fit;
}

}  // namespace

TEST(GyroscopeBias, of_increments_is_measured_and_moves_no_place) {
  EXPECT_LT(expect_found(by_increments(kDrift, 0.9)).turn_bias_sd, 0.2 * kDrift);
}

TEST(GyroscopeBias, is_in_the_first_row_as_in_the_second) { expect_found(by_few_long_rows()); }

TEST(GyroscopeBias, does_not_ask_when_a_clock_began) { expect_found(later(by_few_long_rows(), 1.7e9)); }

TEST(GyroscopeBias, of_psi_is_measured_and_moves_no_place) {
  EXPECT_LT(expect_found(by_psi(kDrift)).turn_bias_sd, 0.2 * kDrift);
}

TEST(GyroscopeBias, of_psi_is_measured_with_the_centres_as_well) {
  Problem problem = by_psi(kDrift);
  problem.noise->position = 1e-3 * part().perimeter();
  EXPECT_LT(expect_found(problem).turn_bias_sd, 0.2 * kDrift);
}

TEST(GyroscopeBias, is_known_the_better_the_longer_the_log_is) {
  const double of_a_lap = expect_found(by_increments(kDrift, 0.9)).turn_bias_sd;
  EXPECT_LT(expect_found(by_increments(kDrift, 3)).turn_bias_sd, 0.7 * of_a_lap);
}

TEST(GyroscopeBias, that_nothing_was_said_of_contradicts_the_noise) {
  const Answer answer = solve(by_psi(0));
  EXPECT_TRUE(answer.verdict.fits_badly || answer.verdict.name == rollfix::Verdict::inconsistent);
}

TEST(GyroscopeBias, that_is_exact_is_not_told) {
  const Answer answer = solve(by_psi(0));
  EXPECT_EQ(answer.weighing->fit.turn_bias, 0);
  EXPECT_EQ(answer.weighing->fit.turn_bias_sd, 0);
}

TEST(GyroscopeBias, on_a_circle_is_not_told_from_a_scale) {
  const Part circle = belief_cases::part_of("circle");
  Noise noise = noise_with(kDrift, 1e-4, 1e-3);
  noise.gyro = 0.1;
  const double P = circle.perimeter();
  const Log log = rollfix::noisy_increments(circle, 1, P, 100, noise, 5, 60).log;
  const Fit fit = rollfix::solve(Problem{circle, log, {}, noise}).weighing->fit;
  EXPECT_GT(fit.turn_bias_sd, 0.5 * kDrift);
  EXPECT_GT(fit.turn_scale_sd, 0.01);
}

}  // namespace gyroscope_bias_test
