#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "belief/nodes.hpp"
#include "random.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/rolling.hpp"
#include "rollfix/solve.hpp"

// How many nodes a roll's rows are joined to: as many as there are, but where what gathers on the way shows in them.
// Rows of a smooth motion, averaged, and what tells that a motion is not smooth.
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

using rollfix::belief::at_middles;
using rollfix::belief::Course;
using rollfix::belief::is_even;

constexpr std::size_t kRows = 200;
constexpr double kNoise = 0.01;

/// A measurement over a time from 0 to 1.
Course measured(const std::function<double(double)>& motion, double noise = kNoise) {
  std::mt19937_64 generator = test_generator(1);
  std::normal_distribution<double> off(0, noise);
  Course rows{{}, kNoise};
  for (std::size_t k = 0; k < kRows; ++k)
    rows.values.push_back(motion(static_cast<double>(k) / kRows) + off(generator));
  return rows;
}

/// Exact means over twelve twelfths of it, as of so many rows.
Course means_of(const std::function<double(double)>& integral, double rows) {
  Course means{{}, kNoise / std::sqrt(rows)};
  for (int k = 0; k < 12; ++k) means.values.push_back(12 * (integral((k + 1) / 12.0) - integral(k / 12.0)));
  return means;
}

double arc(double time) { return std::sin(2 * time); }
double integral_of_arc(double time) { return -0.5 * std::cos(2 * time); }
/// Goes evenly, from the middle on twice as fast, in `steepness`.
double integral_of_kink(double time, double steepness) {
  const double after = std::max(0.0, time - 0.54);
  return 0.5 * steepness * (time * time + after * after);
}

TEST(EvenRows, OfASmoothMotionWithItsNoiseAreEven) { EXPECT_TRUE(is_even(measured(arc))); }

TEST(EvenRows, ThatAreTwiceAsNoisyAreNot) { EXPECT_FALSE(is_even(measured(arc, 2 * kNoise))); }

TEST(EvenRows, WithOneThatIsFarOffAreNot) {
  Course rows = measured(arc);
  rows.values[77] += 30 * kNoise;
  EXPECT_FALSE(is_even(rows));
}

TEST(EvenRows, AreAsTheyWereInTheMiddleOfEachMean) {
  const auto middles = at_middles(means_of(integral_of_arc, 16));
  ASSERT_TRUE(middles);
  // Left is 3/640 of the fourth difference, 16 / 12^4; at both ends a 24th of the third.
  for (std::size_t k = 0; k < 12; ++k) {
    EXPECT_NEAR((*middles)[k], arc((static_cast<double>(k) + 0.5) / 12), k == 0 || k == 11 ? 2e-4 : 4e-6) << k;
  }
}

TEST(EvenRows, OfLotsThatAreNotEquallyLongAreAsTheyWereInTheMiddleOfEach) {
  Course means{{}, kNoise, {}};
  std::vector<double> middles;
  double from = 0;
  for (int k = 0; k < 13; ++k) {
    const double rows = k % 3 == 0 ? 2 : 3;
    const double to = from + rows / 35;
    means.values.push_back((integral_of_arc(to) - integral_of_arc(from)) / (to - from));
    means.rows.push_back(rows);
    middles.push_back(0.5 * (from + to));
    from = to;
  }
  const std::vector<double> found = at_middles(means).value();
  for (std::size_t k = 1; k < 12; ++k) EXPECT_NEAR(found[k], arc(middles[k]), 1e-4) << k;
}

TEST(EvenRows, AcrossAKinkThatNoiseDoesNotHideAreNotAveraged) {
  EXPECT_FALSE(at_middles(means_of([](double time) { return integral_of_kink(time, 2); }, 100)));
  EXPECT_TRUE(at_middles(means_of([](double time) { return integral_of_kink(time, 0.1); }, 100)));
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

TEST(Nodes, there_are_more_on_a_boundary_that_turns_either_way) {
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
