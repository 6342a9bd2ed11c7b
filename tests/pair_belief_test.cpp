// Where two fingers can have started on a free part, given a whole noisy log: probabilities, spreads and verdicts.
#include "rollfix/belief.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "noisy_pairs.hpp"
#include "random.hpp"
#include "rollfix/error.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/rolling.hpp"
#include "shapes.hpp"

namespace pair_belief_test {

namespace {

using namespace noisy_pairs;
using free_rolls::part_of;
using rollfix::InputError;
using rollfix::LogKind;
using rollfix::Prior;

/// Of which nothing is known.
const rollfix::FingerGeometry kTwoFingers{{0.0, 0.0}, {}};

TEST(PairBelief, takes_both_halves_of_a_symmetric_part_as_equally_probable) {
  const Part part = part_of("ellipse");
  std::mt19937_64 generator = test_generator(5);
  const BeliefOptions options = options_with(0.002, 0.002, 0.002);
  const Case drawn = random_pair(part, 100, options.noise, generator);
  Belief belief = belief_of(part, drawn, options);
  ASSERT_EQ(belief.verdict().text(), "ambiguous (2)");
  EXPECT_NEAR(belief.modes()[0].probability, 0.5, 0.01);
  EXPECT_NEAR(part.boundary().distance(belief.modes()[0].start[0], belief.modes()[1].start[0]), part.perimeter() / 2,
              0.05 * belief.modes()[0].sd[0]);
}

TEST(PairBelief, takes_what_it_is_told_of_finger_a_before) {
  const Part part = part_of("ellipse");
  std::mt19937_64 generator = test_generator(6);
  BeliefOptions options = options_with(0.002, 0.002, 0.002);
  const Case drawn = random_pair(part, 100, options.noise, generator);
  options.prior = Prior{drawn.start[0], 0.5};
  Belief belief = belief_of(part, drawn, options);
  EXPECT_EQ(belief.verdict().text(), "unique");
  EXPECT_FALSE(modes_at(part, belief.modes(), drawn.start).empty());
}

TEST(PairBelief, a_prior_at_an_end_of_an_open_part_does_not_reach_around_to_the_other) {
  const Part part = shapes::open_waves();
  const double P = part.perimeter();
  std::mt19937_64 generator = test_generator(8);
  BeliefOptions options = options_with(0.01, 0.01, 0.002);
  options.prior = Prior{0, 0.06 * P};
  const Case drawn = noisy_case(part, {0.12 * P, 0.4 * P}, 0.1 * P, 0.1 * P, 100, 0.2, 0.2, options.noise, generator);
  Belief belief = belief_of(part, drawn, options);
  ASSERT_FALSE(belief.modes().empty());
  for (const Mode& mode : belief.modes()) EXPECT_LT(mode.start[0], 0.5 * P);
}

/// Some of the rows say anything.
void disturb(Case& drawn, double share, std::mt19937_64& generator) {
  std::uniform_real_distribution<double> unit(0, 1);
  for (std::size_t k = 1; k < drawn.log.rows(); ++k) {
    if (unit(generator) < share) drawn.log.fingers[0].psi[k] += 0.3 + unit(generator);
  }
}

TEST(PairBelief, does_not_follow_stray_rows_when_it_is_robust) {
  const Part part = part_of("spline,n=9,seed=7,wobble=0.2");
  std::mt19937_64 generator = test_generator(7);
  BeliefOptions options = options_with(0.002, 0.002, 0.002);
  options.robust = true;
  Calibration all;
  for (int k = 0; k < test_count(10); ++k) {
    Case drawn = random_pair(part, 100, options.noise, generator);
    disturb(drawn, 0.05, generator);
    all.add(part, drawn, belief_of(part, drawn, options));
  }
  EXPECT_EQ(all.top, all.cases) << "seed " << test_seed();
  EXPECT_GT(all.held / (2.0 * all.cases), 0.95 - 0.015 - 4 * std::sqrt(0.95 * 0.05 / all.cases));
}

TEST(PairBelief, calls_stray_rows_an_excess_when_it_is_not_robust) {
  const Part part = part_of("spline,n=9,seed=7,wobble=0.2");
  std::mt19937_64 generator = test_generator(8);
  const BeliefOptions options = options_with(0.002, 0.002, 0.002);
  Case drawn = random_pair(part, 100, options.noise, generator);
  disturb(drawn, 0.05, generator);
  EXPECT_EQ(belief_of(part, drawn, options).verdict().text(), "inconsistent");
}

TEST(PairBelief, widens_by_noise_that_is_larger_than_said) {
  const Part part = part_of("spline,n=9,seed=7,wobble=0.2");
  std::mt19937_64 generator = test_generator(9);
  const Case drawn = random_pair(part, 200, {0.004, 0.004, 0.002, 0}, generator);
  Belief belief = belief_of(part, drawn, options_with(0.002, 0.002, 0.001));
  EXPECT_NEAR(belief.excess(), 2, 0.4);
  EXPECT_FALSE(modes_at(part, belief.modes(), drawn.start).empty());
  Belief told = belief_of(part, drawn, options_with(0.004, 0.004, 0.002));
  EXPECT_NEAR(belief.modes().front().sd[0], told.modes().front().sd[0], 0.25 * told.modes().front().sd[0]);
}

TEST(PairBelief, can_not_tell_a_circles_places_apart) {
  const Part part = part_of("circle");
  std::mt19937_64 generator = test_generator(12);
  const BeliefOptions options = options_with(0.002, 0.002, 0.002);
  Belief belief = belief_of(part, random_pair(part, 50, options.noise, generator), options);
  ASSERT_EQ(belief.verdict().text(), "unobservable");
  // Uniform around the circle.
  EXPECT_NEAR(belief.modes().front().sd[0], part.perimeter() / std::sqrt(12.0), 0.05 * part.perimeter());
}

TEST(PairBelief, needs_no_facing) {
  const Part part = part_of("spline,n=9,seed=7,wobble=0.2");
  std::mt19937_64 generator = test_generator(13);
  const BeliefOptions options = options_with(0.001, 0.001, 0.002);
  Calibration all;
  for (int k = 0; k < test_count(25); ++k) {
    const Case drawn = random_pair(part, 100, options.noise, generator);
    rollfix::FingerGeometry contacts;
    contacts.finger_curvature = {1 / drawn.fingers[0].radius, 1 / drawn.fingers[1].radius};
    Belief belief(part, LogKind::contact, options, contacts);
    for (const Reading& row : rollfix::readings_as_given(drawn.log, drawn.pair())) belief.add(row);
    all.add(part, drawn, std::move(belief));
  }
  EXPECT_EQ(all.listed, all.cases) << "seed " << test_seed();
  EXPECT_NEAR(all.held / (2.0 * all.cases), 0.95, 0.02 + 4 * std::sqrt(0.95 * 0.05 / all.cases));
}

/// Increments with noise, summed as a log of increments is.
std::vector<Reading> increments(const Part& part, const std::array<double, 2>& start, double La, double Lb, int rows,
                                const Noise& noise, std::mt19937_64& generator) {
  std::normal_distribution<double> normal(0, 1);
  std::vector<Reading> result;
  double off_a = 0;
  double off_b = 0;
  double off_turn = 0;
  for (int k = 1; k <= rows; ++k) {
    const double share = static_cast<double>(k) / rows;
    off_a += noise.contact * normal(generator);
    off_b += noise.contact * normal(generator);
    off_turn += noise.angle * (normal(generator) + normal(generator));
    const auto turned = [&](double s, double length) {
      return part.turning().angle(s + length) - part.turning().angle(s);
    };
    result.push_back({share * La + off_a, share * Lb + off_b,
                      turned(start[0], share * La) - turned(start[1], share * Lb) + off_turn});
  }
  return result;
}

TEST(PairBelief, knows_that_increments_gather_errors) {
  const Part part = part_of("spline,n=9,seed=7,wobble=0.2");
  std::mt19937_64 generator = test_generator(14);
  std::uniform_real_distribution<double> unit(0, 1);
  const BeliefOptions options = options_with(0.001, 0.0005, 0);
  Calibration all;
  for (int k = 0; k < test_count(25); ++k) {
    Case drawn;
    drawn.start = {unit(generator) * part.perimeter(), unit(generator) * part.perimeter()};
    Belief belief(part, LogKind::increments, options, kTwoFingers);
    const double La = (1 + 2 * unit(generator)) * (unit(generator) < 0.5 ? -1 : 1);
    for (const Reading& row : increments(part, drawn.start, La, 2.2, 60, options.noise, generator)) {
      belief.add(row);
    }
    all.add(part, drawn, std::move(belief));
  }
  EXPECT_EQ(all.listed, all.cases) << "seed " << test_seed();
  EXPECT_NEAR(all.held / (2.0 * all.cases), 0.95, 0.03 + 4 * std::sqrt(0.95 * 0.05 / all.cases));
}

TEST(PairBelief, takes_long_logs_as_it_takes_short_ones) {
  const Part part = part_of("limacon");
  std::mt19937_64 generator = test_generator(15);
  const BeliefOptions options = options_with(0.01, 0.005, 0.002);
  Calibration all;
  for (int k = 0; k < test_count(5); ++k) {
    const Case drawn = random_pair(part, 3000, options.noise, generator);
    all.add(part, drawn, belief_of(part, drawn, options));
  }
  EXPECT_EQ(all.listed, all.cases) << "seed " << test_seed();
  EXPECT_NEAR(all.held / (2.0 * all.cases), 0.95, 0.02 + 4 * std::sqrt(0.95 * 0.05 / all.cases));
}

/// What the fingers measured at their first contacts.
rollfix::PerFinger<rollfix::MeasuredContact> felt_at_first(const Case& drawn) {
  rollfix::PerFinger<rollfix::MeasuredContact> felt = {rollfix::MeasuredContact{}, rollfix::MeasuredContact{}};
  for (const std::size_t finger : {0U, 1U}) {
    const rollfix::FingerRows& rows = drawn.log.fingers[finger];
    const double radius = drawn.fingers[finger].radius;
    felt[finger] = {free_rolls::felt_contact(rows, radius, 0), rows.u[0] + rows.psi[0], 1 / radius};
  }
  return felt;
}

TEST(PairBelief, knows_how_sure_the_parts_pose_is) {
  const Part part = part_of("spline,n=9,seed=7,wobble=0.2");
  std::mt19937_64 generator = test_generator(16);
  const BeliefOptions options = options_with(0.003, 0.003, 0.002);
  double sum = 0;
  int cases = 0;
  for (int k = 0; k < test_count(30); ++k) {
    const Case drawn = random_pair(part, 100, options.noise, generator);
    // Fingers that touch at the same place would be in each other's way, and tell less than any pose.
    if (part.boundary().distance(drawn.start[0], drawn.start[1]) < 0.4) continue;
    Belief belief = belief_of(part, drawn, options);
    const rollfix::PoseSpread spread = belief.pose_spread(0, felt_at_first(drawn));
    // free_rolls::by_distances puts the part there.
    const Eigen::Vector3d off(spread.mean.x - 0.4, spread.mean.y + 0.7,
                              std::remainder(spread.mean.heading - 2.1, 2 * std::numbers::pi));
    sum += off.dot(spread.covariance.inverse() * off);
    ++cases;
  }
  // The mean of chi-squares with three degrees of freedom.
  EXPECT_NEAR(sum / cases, 3, 0.3 + 4 * std::sqrt(6.0 / cases)) << "seed " << test_seed();
}

/// The roll itself is the same: only what is said of the slip differs.
TEST(PairBelief, slip_on_the_way_leaves_the_heading_that_the_first_contacts_tell) {
  const Part part = part_of("spline,n=9,seed=7,wobble=0.2");
  std::mt19937_64 generator = test_generator(20);
  const BeliefOptions hardly = options_with(0.003, 0.003, 0.0002);
  for (int k = 0; k < test_count(6); ++k) {
    const Case drawn = random_pair(part, 100, hardly.noise, generator);
    const auto heading_sd = [&](const BeliefOptions& options) {
      return std::sqrt(belief_of(part, drawn, options).pose_spread(0, felt_at_first(drawn)).covariance(2, 2));
    };
    EXPECT_LT(heading_sd(options_with(0.003, 0.003, 0.02)), 2.5 * heading_sd(hardly)) << k;
  }
}

TEST(PairBelief, says_the_same_twice) {
  const Part part = part_of("cam");
  std::mt19937_64 generator = test_generator(17);
  const BeliefOptions options = options_with(0.005, 0.003, 0.002);
  const Case drawn = random_pair(part, 60, options.noise, generator);
  Belief one = belief_of(part, drawn, options);
  Belief other = belief_of(part, drawn, options);
  ASSERT_EQ(one.modes().size(), other.modes().size());
  EXPECT_EQ(one.modes().front().start, other.modes().front().start);
  EXPECT_EQ(one.modes().front().probability, other.modes().front().probability);
}

TEST(PairBelief, bounds_what_it_leaves_out) {
  const Part part = part_of("cam");
  std::mt19937_64 generator = test_generator(18);
  const BeliefOptions options = options_with(0.005, 0.003, 0.002);
  Belief belief = belief_of(part, random_pair(part, 60, options.noise, generator), options);
  double listed = 0;
  for (const Mode& mode : belief.modes()) listed += mode.probability;
  EXPECT_GE(listed + belief.rest(), 1);
  EXPECT_LT(belief.rest(), 0.002);
}

TEST(PairBelief, refuses_noise_that_is_none) {
  EXPECT_THROW(Belief(part_of("cam"), LogKind::contact, BeliefOptions{}, kTwoFingers), InputError);
  EXPECT_THROW(Belief(part_of("cam"), LogKind::contact, options_with(-1, 0.1, 0), kTwoFingers), InputError);
}

}  // namespace

}  // namespace pair_belief_test
