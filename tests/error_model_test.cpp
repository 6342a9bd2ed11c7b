// What rows are off by together, against sums over the rows and the rules that variances add up by.
#include "belief/error_model.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "rollfix/belief.hpp"

namespace error_model_test {
namespace {

using rollfix::BeliefOptions;
using rollfix::LogKind;
using rollfix::belief::ErrorModel;
using rollfix::belief::PairErrors;

constexpr double kPerimeter = 10;

ErrorModel of_one(const BeliefOptions& options) { return {options, LogKind::contact, 0.5, kPerimeter}; }
PairErrors of_two(const BeliefOptions& options, LogKind kind = LogKind::contact) {
  return {options, kind, {0, 0}, false, kPerimeter};
}

BeliefOptions options(double contact = 0.01, double angle = 0.01) {
  BeliefOptions options;
  options.noise.contact = contact;
  options.noise.angle = angle;
  return options;
}

TEST(ErrorModel, rows_near_together_are_worth_what_their_mean_is_known_better) {
  BeliefOptions alike = options();
  alike.noise.correlation = 0.5;
  const double step = 0.01;
  const double rows = 20000;
  double variance = rows;  // of the sum of rows of variance 1 whose correlation falls off exponentially
  for (int lag = 1; lag < rows; ++lag) variance += 2 * (rows - lag) * std::exp(-lag * step / 0.5);
  const double worth = rows * rows / variance;
  EXPECT_NEAR(of_one(alike).worth(rows * step, rows), worth, 0.02 * worth);
}

TEST(ErrorModel, a_part_that_is_rolled_over_again_is_off_as_it_was) {
  BeliefOptions measured = options();
  measured.noise.part.turn = 0.01;
  measured.noise.part.alike = 1;
  EXPECT_DOUBLE_EQ(of_one(measured).rows_alike(300, 0.5 * kPerimeter), 60);  // a fifth of five lengths that are alike
  EXPECT_DOUBLE_EQ(of_one(measured).rows_alike(300, kPerimeter), 30);
  EXPECT_DOUBLE_EQ(of_one(measured).rows_alike(300, 7 * kPerimeter), 30);
}

TEST(ErrorModel, all_that_makes_lengths_too_long_by_a_share_adds_up) {
  BeliefOptions all = options();
  all.noise.slip = 0.01;
  all.noise.radius = 0.04;  // of a radius of 2
  all.scale_sd = 0.03;
  all.noise.part.length = 0.05;
  const double variance = 0.01 * 0.01 + 0.02 * 0.02 + 0.03 * 0.03 + 0.05 * 0.05;
  EXPECT_NEAR(of_one(all).start()(2, 2), variance, 1e-15);
}

TEST(PairErrors, what_makes_all_lengths_too_long_does_so_under_both_fingers) {
  BeliefOptions both = options();
  both.scale_sd = 0.03;
  both.noise.slip = 0.01;  // each finger's own
  const auto start = of_two(both).start();
  EXPECT_NEAR(start(2, 3), 0.03 * 0.03, 1e-15);
  EXPECT_NEAR(start(3, 2), 0.03 * 0.03, 1e-15);
  EXPECT_NEAR(start(2, 2), 0.03 * 0.03 + 0.01 * 0.01, 1e-15);
}

TEST(PairErrors, increments_of_the_turn_are_off_by_both_fingers_angles_in_every_row) {
  EXPECT_NEAR(of_two(options(0.02, 0.01), LogKind::increments).gathered(7, {0, 0})[4], 7 * 2 * 0.01 * 0.01, 1e-15);
  EXPECT_NEAR(of_two(options(0.02, 0.01), LogKind::increments).gathered(7, {0, 0})[1], 7 * 0.02 * 0.02, 1e-15);
}

TEST(PairErrors, a_part_drifts_under_both_fingers) {
  BeliefOptions drifting = options();
  drifting.noise.part.walk = 0.1;
  EXPECT_NEAR(of_two(drifting).gathered(1, {2, -3})[4], 0.1 * 0.1 * (2 + 3), 1e-15);
}

}  // namespace
}  // namespace error_model_test
