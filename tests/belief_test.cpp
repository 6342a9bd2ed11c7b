#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "belief/nodes.hpp"
#include "belief_cases.hpp"
#include "rollfix/error.hpp"
#include "rollfix/locate.hpp"
#include "shapes.hpp"

// The posterior over the whole boundary: in the cases that are special.
namespace belief_test {

using namespace belief_cases;
using rollfix::InputError;
using rollfix::LogKind;
using rollfix::Reading;
using rollfix::Sample;

TEST(Belief, on_a_part_that_looks_the_same_twice_both_places_are_as_probable) {
  const Part part = part_of("ellipse,a=2,b=1");
  const Noise noise = noise_on(part, 1e-3, 5e-3, 5e-3);
  Belief belief = belief_in(part, roll_on(part, 0.2, 1, 3, 200, noise, 1).log, 0.2, with(noise));
  ASSERT_EQ(belief.modes().size(), 2U);
  EXPECT_NEAR(belief.modes()[0].probability, 0.5, 1e-3);
  EXPECT_NEAR(distance(part, belief.modes()[0].start[0], belief.modes()[1].start[0]), 0.5 * part.perimeter(), 1e-3);
  EXPECT_EQ(belief.verdict().text(), "ambiguous (2)");
}

TEST(Belief, a_prior_decides_between_places_that_look_alike) {
  const Part part = part_of("ellipse,a=2,b=1");
  BeliefOptions options = with(noise_on(part, 1e-3, 5e-3, 5e-3));
  options.prior = rollfix::Prior{1.2, 0.5};
  Belief belief = belief_in(part, roll_on(part, 0.2, 1, 3, 200, options.noise, 1).log, 0.2, options);
  EXPECT_EQ(belief.verdict().text(), "unique");
  EXPECT_LT(distance(part, belief.modes().front().start[0], 1), 5 * belief.modes().front().sd[0]);
}

TEST(Belief, on_a_circle_nothing_is_known_of_the_place) {
  const Part part = part_of("circle");
  const Noise noise = noise_on(part, 1e-3, 5e-3, 5e-3);
  Belief belief = belief_in(part, roll_on(part, 0.2, 1, 3, 200, noise, 1).log, 0.2, with(noise));
  EXPECT_EQ(belief.verdict().text(), "unobservable");
  EXPECT_NEAR(belief.modes().front().sd[0], part.perimeter() / std::sqrt(12), 0.01 * part.perimeter());
}

TEST(Belief, before_anything_was_rolled_every_place_is_as_probable) {
  const Part part = part_of("cam");
  Belief belief(part, LogKind::contact, with(noise_on(part, 1e-3, 5e-3, 0)));
  EXPECT_EQ(belief.verdict().text(), "unobservable");
  belief.add(sample_of({0, 0}, 5));
  belief.add(sample_of({0, 0}, 5));
  EXPECT_EQ(belief.verdict().text(), "unobservable");
}

TEST(Belief, more_than_a_lap_is_no_different) {
  const Part part = part_of("cam");
  const Noise noise = noise_on(part, 1e-3, 5e-3, 5e-3);
  Belief belief = belief_in(part, roll_on(part, 0.2, 2, 1.7 * part.perimeter(), 400, noise, 1).log, 0.2, with(noise));
  EXPECT_EQ(belief.verdict().text(), "unique");
  EXPECT_LT(distance(part, belief.modes().front().start[0], 2), 5 * belief.modes().front().sd[0]);
}

TEST(Belief, an_open_part_is_not_left_at_its_ends) {
  const Part part = part_of("log-spiral");
  const double P = part.perimeter();
  const Noise noise = noise_on(part, 1e-3, 1e-2, 5e-3);
  Belief belief = belief_in(part, roll_on(part, 0.02 * P, 0.02 * P, 0.9 * P, 200, noise, 1).log, 0.02 * P, with(noise));
  ASSERT_FALSE(belief.modes().empty());
  const Mode& mode = belief.modes().front();
  EXPECT_GE(mode.interval[0].lo, 0);
  EXPECT_LE(mode.interval[0].hi, P);
  EXPECT_LT(std::abs(mode.start[0] - 0.02 * P), 5 * mode.sd[0]);
}

// 2026-11-22: the far end of an open part was as near to a prior at s = 0 as if the part were closed.
TEST(Belief, a_prior_at_an_end_of_an_open_part_does_not_reach_around_to_the_other) {
  const Part part = shapes::open_waves();
  const double P = part.perimeter();
  for (const bool at_end : {false, true}) {
    BeliefOptions options = with({0.01, 0.01, 0, 0});
    options.prior = rollfix::Prior{at_end ? P : 0, 0.06 * P};
    const double start = at_end ? 0.87 * P : 0.12 * P;
    Belief belief = belief_in(part, roll_on(part, 0.2, start, 0.1 * P, 99, options.noise, 1).log, 0.2, options);
    EXPECT_EQ(belief.verdict().text(), "unique");
    EXPECT_LT(std::abs(belief.modes().front().start[0] - start), 5 * belief.modes().front().sd[0]);
    EXPECT_GT(belief.modes().front().probability, 0.99);
  }
}

TEST(Belief, a_finger_that_pivots_at_a_corner_is_at_the_corner) {
  const Part part = part_of("reuleaux");
  const double radius = 0.1;
  const double corner = part.corners()[1].s;
  const Noise noise = noise_on(part, 1e-3, 5e-3, 5e-3);
  // From the corner's middle on: half of the pivot, and then a piece of the arc.
  const double turn = part.corners()[1].turn;
  Belief belief(part, LogKind::contact, with(noise));
  for (int k = 0; k <= 50; ++k) belief.add(sample_of({0, 0.5 * turn * k / 50}, 1 / radius));
  for (int k = 1; k <= 50; ++k) {
    const double L = 0.3 * k / 50;
    belief.add(sample_of({L, 0.5 * turn + L * part.turning().curvature(corner + L)}, 1 / radius));
  }
  ASSERT_EQ(belief.modes().size(), 3U);
  for (const Mode& mode : belief.modes()) {
    double least = part.perimeter();
    for (const rollfix::Corner& c : part.corners()) least = std::min(least, distance(part, c.s, mode.start[0]));
    EXPECT_LT(least, 5 * noise.contact);
    EXPECT_NEAR(mode.probability, 1.0 / 3, 0.01);
  }
}

TEST(Belief, stray_rows_do_not_sink_a_robust_one) {
  const Part part = part_of("cam");
  BeliefOptions options = with(noise_on(part, 1e-3, 5e-3, 5e-3));
  NoisyRoll roll = roll_on(part, 0.2, 2, 3, 300, options.noise, 1);
  for (std::size_t row = 7; row < roll.log.rows(); row += 19) roll.log.fingers[0].psi[row] += 0.6;
  Belief plain = belief_in(part, roll.log, 0.2, options);
  EXPECT_GT(plain.excess(), 3);
  options.robust = true;
  Belief robust = belief_in(part, roll.log, 0.2, options);
  ASSERT_EQ(robust.verdict().text(), "unique");
  EXPECT_LT(distance(part, robust.modes().front().start[0], 2), 5 * robust.modes().front().sd[0]);
}

TEST(Belief, noise_that_is_understated_widens_the_answer) {
  const Part part = part_of("cam");
  const Noise noise = noise_on(part, 1e-3, 5e-3, 0);
  const Noise understated = noise_on(part, 5e-4, 2.5e-3, 0);
  const rollfix::Log log = roll_on(part, 0.2, 2, 3, 300, noise, 1).log;
  Belief right = belief_in(part, log, 0.2, with(noise));
  Belief wrong = belief_in(part, log, 0.2, with(understated));
  EXPECT_NEAR(right.excess(), 1, 0.1);
  EXPECT_NEAR(wrong.excess(), 2, 0.2);
  EXPECT_NEAR(wrong.modes().front().sd[0], right.modes().front().sd[0], 0.2 * right.modes().front().sd[0]);
}

TEST(Belief, a_million_rows_are_few_nodes) {
  const Noise noise{1e-3, 1e-3, 0, 0};
  rollfix::belief::Nodes nodes(rollfix::belief::ErrorModel(with(noise), LogKind::contact, 5, 6), 5, false);
  for (int k = 0; k < 1000000; ++k) nodes.add({{1e-6 * k, 2e-6 * k}, 5});
  EXPECT_EQ(nodes.rows(), 1000000U);
  EXPECT_LE(nodes.complete().size(), rollfix::belief::kMostNodes);
  EXPECT_NEAR(nodes.complete().front().own.length * static_cast<double>(nodes.rows() / nodes.complete().size()), 1e-6,
              5e-7);
}

TEST(Belief, joined_rows_say_the_same_as_all_of_them) {
  const Part part = part_of("cam");
  const Noise noise = noise_on(part, 1e-3, 5e-3, 5e-3);
  const rollfix::Log log = roll_on(part, 0.2, 2, 3, 5000, noise, 1).log;
  Belief belief = belief_in(part, log, 0.2, with(noise));
  EXPECT_EQ(belief.samples(), 4999U);
  EXPECT_EQ(belief.verdict().text(), "unique");
  EXPECT_LT(distance(part, belief.modes().front().start[0], 2), 4 * belief.modes().front().sd[0]);
  EXPECT_LT(belief.excess(), 1.2);
}

TEST(Belief, the_probabilities_of_all_modes_and_the_rest_are_one) {
  const Part part = part_of("spline,n=12,seed=5,wobble=0.4");
  const Noise noise = noise_on(part, 2e-3, 1e-2, 1e-2);
  Belief belief = belief_in(part, roll_on(part, 0.05, 2, 0.3, 100, noise, 1).log, 0.05, with(noise));
  double total = belief.rest();
  for (const Mode& mode : belief.modes()) total += mode.probability;
  EXPECT_NEAR(total, 1, 1e-6);
}

TEST(Belief, noise_that_makes_no_sense_is_refused) {
  const Part part = part_of("cam");
  EXPECT_THROW(Belief(part, LogKind::contact, with({})), InputError);
  EXPECT_THROW(Belief(part, LogKind::contact, with({-1, 0.1, 0, 0})), InputError);
  EXPECT_THROW(Belief(part, LogKind::contact, with({NAN, 0.1, 0, 0})), InputError);
  BeliefOptions options = with({1e-3, 1e-3, 0, 0});
  options.prior = rollfix::Prior{1, 0};
  EXPECT_THROW(Belief(part, LogKind::contact, options), InputError);
}

TEST(Weigh, every_placement_of_the_search_is_listed_or_improbable) {
  const Part part = part_of("spline,n=9,seed=7,wobble=0.2");
  const Noise noise = noise_on(part, 1e-3, 5e-3, 5e-3);
  const NoisyRoll roll = roll_on(part, 0.1, 2, 1, 100, noise, 1);
  Belief belief = belief_in(part, roll.log, 0.1, with(noise));
  const std::vector<Reading> readings{rollfix::readings_as_given(roll.log, {DiskFinger{0.1}}).back()};
  rollfix::LocateOptions options;
  options.tolerance = belief.tolerance(readings);
  const rollfix::Search found = rollfix::locate(part, readings, options);
  const rollfix::Weighed weighed = rollfix::weigh(part, readings, {}, found.placements, belief);
  ASSERT_EQ(weighed.placements.size(), belief.modes().size());
  EXPECT_GE(weighed.placements.size() + weighed.improbable.size(), found.placements.size());
  EXPECT_LT(distance(part, weighed.placements.front().start[0], 2), 5 * weighed.placements.front().sd[0]);
}

TEST(PoseSpread, holds_the_true_pose_as_often_as_it_should) {
  const Part part = part_of("cam");
  const double radius = 0.2;
  const Noise noise = noise_on(part, 1e-3, 5e-3, 5e-3);
  std::mt19937_64 random = test_generator();
  Eigen::Vector3i within = Eigen::Vector3i::Zero();
  const int count = test_count(60);
  for (int k = 0; k < count; ++k) {
    const double start = part.perimeter() * static_cast<double>(k) / count;
    const rollfix::Log log = roll_on(part, radius, start, 3, 100, noise, random()).log;
    Belief belief = belief_in(part, log, radius, with(noise));
    const rollfix::Contact first{log.fingers[0].u.front(), log.fingers[0].psi.front()};
    const double towards = first.normal_direction();
    const rollfix::Vec2 where = rollfix::Vec2(log.fingers[0].x.front(), log.fingers[0].y.front()) +
                                radius * rollfix::Vec2(std::cos(towards), std::sin(towards));
    const Mode* mode = mode_at(belief.modes(), start, part);
    ASSERT_NE(mode, nullptr);
    const auto index = static_cast<std::size_t>(mode - belief.modes().data());
    const rollfix::PoseSpread spread = belief.pose_spread(index, rollfix::MeasuredContact{where, towards, 1 / radius});
    // The part was simulated with its frame as the world's. Two errors make all three: the covariance is singular.
    const Eigen::Array3d off(spread.mean.x, spread.mean.y, std::remainder(spread.mean.heading, 2 * M_PI));
    within += (off.abs() < 1.96 * spread.covariance.diagonal().array().sqrt()).cast<int>().matrix();
  }
  for (const int inside : within) EXPECT_GE(inside, 0.95 * count - 4 * std::sqrt(0.95 * 0.05 * count));
}

TEST(PoseSpread, of_a_disk_whose_orientation_is_off_at_first_is_the_arc_that_its_rim_moves) {
  const Part part = part_of("cam");
  const double radius = 5;
  const double angle = 0.01;
  const rollfix::Log log = roll_on(part, radius, 1, 2, 50, {}, 1).log;
  BeliefOptions options = with(Noise{1e-6, angle});
  options.prior = rollfix::Prior{1, 1e-6};
  Belief belief = belief_in(part, log, radius, options);
  const rollfix::Vec2 point = part.point(1);
  const double tangent = part.turning().angle(1);
  const rollfix::MeasuredContact felt{point, tangent + M_PI / 2, 1 / radius};
  const Eigen::Matrix3d covariance = belief.pose_spread(0, felt).covariance;
  // How the part's point of contact goes along the tangent with x, y and the heading.
  const Eigen::Vector3d by_pose(std::cos(tangent), std::sin(tangent),
                                std::sin(tangent) * point.x() - std::cos(tangent) * point.y());
  EXPECT_NEAR(std::sqrt(by_pose.dot(covariance * by_pose)), radius * angle, 0.02 * radius * angle);
}

}  // namespace belief_test
