// How far a finger travelled, from lengths that are noisy: what slip gathers over, however often a roll is sampled.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include "belief/nodes.hpp"
#include "belief_cases.hpp"
#include "random.hpp"

namespace travel_test {
namespace {

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
  if (nodes.pending()) gathered += nodes.pending()->gathered.length;
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

}  // namespace travel_test
