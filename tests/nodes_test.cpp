// How many nodes a roll's rows are joined to: as many as there are, but where what gathers on the way shows in them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "belief/nodes.hpp"
#include "random.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/rolling.hpp"
#include "rollfix/solve.hpp"

namespace nodes_test {
namespace {

using rollfix::belief::Nodes;

/// Nodes of a roll over this share of a perimeter of 1.
std::size_t nodes_of(std::size_t rows, double laps, double slip, double turns = 1) {
  rollfix::BeliefOptions options;
  options.noise = rollfix::Noise{1e-3, 5e-3, slip, 0};
  Nodes nodes(rollfix::belief::ErrorModel(options, rollfix::LogKind::contact, 30, 1), 30, false,
              rollfix::belief::kMostNodes, true, turns);
  std::mt19937_64 random = test_generator(rows);
  std::normal_distribution<double> normal;
  for (std::size_t k = 1; k <= rows; ++k) {
    const double length = laps * static_cast<double>(k) / static_cast<double>(rows);
    nodes.add({{length + 1e-3 * normal(random), 5e-3 * normal(random)}, 30});
  }
  return nodes.complete().size();
}

/// An honest log over so much of a gear, and its answer.
void expect_true_place(const char* shape, double radius, const rollfix::Noise& noise, double share, std::size_t rows,
                       std::uint64_t seed) {
  const rollfix::Part part(rollfix::gallery(shape));
  std::mt19937_64 generator = test_generator(seed);
  rollfix::RollPlan plan;
  plan.start = std::uniform_real_distribution<double>(0, part.perimeter())(generator);
  plan.distance = share * part.perimeter();
  plan.rows = rows;
  const rollfix::NoisyRoll roll = rollfix::noisy_roll(part, rollfix::disk(radius), plan, noise, seed);
  const rollfix::Answer answer = solve(rollfix::Problem{part, roll.log, {rollfix::disk(radius)}, noise});
  EXPECT_FALSE(answer.verdict.fits_badly) << shape;
  const auto is_true = [&](const rollfix::Placement& one) {
    return std::abs(part.boundary().offset(one.mean[0], plan.start)) < 6 * one.sd[0];
  };
  EXPECT_TRUE(std::any_of(answer.placements.begin(), answer.placements.end(), is_true))
      << shape << ": " << answer.verdict.text();
}

}  // namespace

TEST(Nodes, rows_stay_what_they_are_where_slip_does_not_show_in_them) {
  EXPECT_EQ(nodes_of(200, 0.4, 0), 200U);
  EXPECT_EQ(nodes_of(200, 0.4, 0.005), 200U);
  EXPECT_GE(nodes_of(100000, 0.4, 0), rollfix::belief::kMostNodes / 2);
}

TEST(Nodes, there_are_forty_for_a_lap_where_slip_shows_and_two_dozen_for_less) {
  EXPECT_NEAR(static_cast<double>(nodes_of(20000, 2, 0.05)), 80, 12);
  EXPECT_NEAR(static_cast<double>(nodes_of(100000, 2, 0.05)), 80, 12);
  EXPECT_NEAR(static_cast<double>(nodes_of(20000, 0.4, 0.05)), 24, 4);
}

TEST(Nodes, there_are_more_on_a_boundary_that_turns_to_and_fro) {
  EXPECT_EQ(nodes_of(20000, 2, 0.05, 3), nodes_of(20000, 2, 0.05));
  EXPECT_NEAR(static_cast<double>(nodes_of(20000, 2, 0.05, 8)), 4 * 80, 48);
  EXPECT_GE(nodes_of(20000, 2, 0.05, 30), rollfix::belief::kMostNodes / 2);
}

TEST(Nodes, a_mean_of_rows_that_a_walk_goes_through_is_weighed_as_what_it_is) {
  // Of a walk of n steps of variance 1 the mean of its places has, with the last place, this covariance and this
  // variance: sums of min(j, k) and of k over all rows.
  for (const double n : {1.0, 2.0, 7.0, 100.0}) {
    double variance = 0;
    double with_last = 0;
    for (double j = 1; j <= n; ++j) {
      with_last += j / n;
      for (double k = 1; k <= n; ++k) variance += std::min(j, k) / (n * n);
    }
    rollfix::belief::Node node;
    node.rows = n;
    EXPECT_NEAR(node.share_in_mean() * n, with_last, 1e-9 * n);
    EXPECT_NEAR((node.share_in_mean() - node.share_averaged()) * n, variance, 1e-9 * n);
  }
}

TEST(Nodes, do_not_let_an_honest_log_of_a_gear_with_many_teeth_be_contradicted) {
  const rollfix::Noise fine{.contact = 2e-4, .angle = 0.0017, .slip = 0.001};
  expect_true_place("gear,teeth=40", 0.004, fine, 0.5, 400, 1);
  expect_true_place("gear,teeth=30", 0.005, {.contact = 5e-4, .angle = 0.0035, .slip = 0.001}, 0.4, 400, 2);
}

}  // namespace nodes_test
