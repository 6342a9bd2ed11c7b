#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include "belief/error_model.hpp"
#include "belief/nodes.hpp"
#include "belief_cases.hpp"
#include "random.hpp"
#include "rollfix/belief.hpp"

// What rows are off by together, against sums over the rows and the rules that variances add up by.
// How far a finger travelled, from lengths that are noisy: what slip gathers over, however often a roll is sampled.
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

using rollfix::LogKind;
using rollfix::Noise;
using rollfix::Part;
using rollfix::belief::Node;
using rollfix::belief::Nodes;

constexpr double kSd = 1e-3;     // of a contact
constexpr double kSlip = 0.01;   // five times as much here and there, ...
constexpr double kPatch = 0.01;  // ... on its own over this length: of a perimeter of 1

/// What slip gathers over a roll of so many rows is that of this length.
double travelled(std::size_t rows, LogKind kind, const std::function<double(double)>& length_at) {
  rollfix::BeliefOptions options;
  options.noise = Noise{kSd, 1e-3, kSlip, 0};
  if (kind == LogKind::increments) options.noise.contact = 1e-5;
  Nodes nodes(rollfix::belief::ErrorModel(options, kind, 5, 1), 5, false);
  std::mt19937_64 random = test_generator(rows);
  std::normal_distribution<double> normal;
  double wandered = 0;
  for (std::size_t k = 1; k <= rows; ++k) {
    const double n = options.noise.contact * normal(random);
    wandered += n;
    const double off = kind == LogKind::increments ? wandered : n;
    nodes.add({{length_at(static_cast<double>(k) / static_cast<double>(rows)) + off, 0}, 5});
  }
  double gathered = 0;
  for (const Node& node : nodes.complete()) gathered += node.gathered.length;
  for (const Node& node : nodes.pending()) gathered += node.gathered.length;
  if (kind == LogKind::increments) gathered -= static_cast<double>(rows) * std::pow(options.noise.contact, 2);
  return gathered / (std::pow(5 * kSlip, 2) * kPatch);
}

class TravelOfRows : public ::testing::TestWithParam<std::size_t> {};

}  // namespace

TEST_P(TravelOfRows, a_roll_travels_its_length) {
  EXPECT_NEAR(travelled(GetParam(), LogKind::contact, [](double t) { return 0.4 * t; }), 0.4, 0.04);
}

TEST_P(TravelOfRows, a_roll_back_travels_its_length) {
  EXPECT_NEAR(travelled(GetParam(), LogKind::travelled, [](double t) { return -0.4 * t; }), 0.4, 0.04);
}

TEST_P(TravelOfRows, a_roll_of_increments_travels_its_length) {
  EXPECT_NEAR(travelled(GetParam(), LogKind::increments, [](double t) { return 0.4 * t; }), 0.4, 0.04);
}

TEST_P(TravelOfRows, to_and_fro_is_both_ways) {
  const auto to_and_fro = [](double t) { return 0.2 - 0.2 * std::cos(10 * t); };
  EXPECT_NEAR(travelled(GetParam(), LogKind::contact, to_and_fro), 0.2 * (7 - std::cos(10 - 3 * std::numbers::pi)),
              0.12);
}

TEST_P(TravelOfRows, a_finger_at_rest_hardly_travels) {
  EXPECT_LT(travelled(GetParam(), LogKind::contact, [](double) { return 0.0; }), 10 * kSd);
}

TEST_P(TravelOfRows, a_rest_after_a_roll_adds_little) {
  const auto roll_and_rest = [](double t) { return std::min(0.4, 4 * t); };
  EXPECT_NEAR(travelled(GetParam(), LogKind::contact, roll_and_rest), 0.4, 0.04);
}

TEST_P(TravelOfRows, stop_and_go_travels_what_it_goes) {
  const auto stop_and_go = [](double t) { return 0.02 * std::round(20 * t); };
  EXPECT_NEAR(travelled(GetParam(), LogKind::contact, stop_and_go), 0.4, 0.08);
}

INSTANTIATE_TEST_SUITE_P(Rows, TravelOfRows, ::testing::Values(100, 1000, 10000, 100000, 1000000));

TEST(Travel, of_more_rows_the_start_is_known_better_not_worse) {
  const Part part = belief_cases::part_of("cam");
  const Noise noise{0.005, 0.005, 0.02, 0};
  double before = 1;
  for (const std::size_t rows : {200U, 1000U, 10000U, 100000U}) {
    rollfix::BeliefOptions options;
    options.noise = noise;
    const rollfix::Log log = belief_cases::roll_on(part, 0.2, 2, 3, rows, noise, 3).log;
    rollfix::Belief belief = belief_cases::belief_in(part, log, 0.2, options);
    const rollfix::Mode& first = belief.modes().front();
    EXPECT_EQ(belief.verdict().text(), "unique") << rows;
    EXPECT_LT(belief_cases::distance(part, first.start[0], 2), 4 * first.sd[0]) << rows;
    EXPECT_LT(first.sd[0], 1.05 * before) << rows;
    before = first.sd[0];
  }
}

}  // namespace error_model_test
