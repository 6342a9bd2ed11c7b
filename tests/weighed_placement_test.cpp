// What the posterior says of a placement besides its start, where it is known in closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "free_roll.hpp"
#include "rollfix/answer/solve.hpp"
#include "rollfix/contact/rolling.hpp"
#include "rollfix/outline/gallery.hpp"

namespace weighed_placement_test {
namespace {

using rollfix::Noise;
using rollfix::Part;
using rollfix::Placement;
using rollfix::Problem;

Problem reading_on(const Part& part, double s, double length, const Noise& noise) {
  return {part, rollfix::Reading(length, part.turning().angle(s + length) - part.turning().angle(s)), {}, noise};
}

/// A disk that rolled from s = 1 on an ellipse.
Problem roll_on_ellipse(double radius, const Noise& noise) {
  const Part ellipse(rollfix::gallery("ellipse,a=2,b=1"));
  rollfix::RollPlan plan;
  plan.start = 1;
  plan.distance = 2;
  const rollfix::Finger finger = rollfix::disk(radius);
  return {ellipse, rollfix::roll_in_closed_form(ellipse, finger, plan).log, {finger}, noise};
}

TEST(WeighedPlacement, ends_where_the_roll_from_a_known_start_ends_as_surely_as_length_and_turn_tell) {
  const Part cam(rollfix::gallery("cam"));
  Problem problem = reading_on(cam, 1, 2, Noise{0.01, 0.02});
  problem.prior = rollfix::Prior{1, 1e-5};
  const Placement placement = rollfix::solve(problem).placements.at(0);
  const double by_length = 1 / 0.01;
  const double by_turn = cam.turning().curvature(3) / 0.02;
  EXPECT_NEAR(placement.mean[0], 1, 1e-4);
  EXPECT_NEAR(placement.end_mean[0], 3, 1e-3);
  EXPECT_NEAR(placement.end_sd[0], 1 / std::hypot(by_length, by_turn), 2e-4);
}

TEST(WeighedPlacement, moves_with_the_length_as_its_sensitivity_says) {
  const Part cam(rollfix::gallery("cam"));
  const double step = 1e-3;
  Problem problem = reading_on(cam, 1, 0.7, Noise{1e-3, 1e-3});
  const Placement before = rollfix::solve(problem).placements.at(0);
  problem.felt.readings[0].length[0] += step;
  const Placement after = rollfix::solve(problem).placements.at(0);
  const double moved = (after.start[0] - before.start[0]) / step;
  EXPECT_NEAR(before.sensitivity.per_length[0][0][0], moved, 0.02 * std::abs(moved));
}

TEST(WeighedPlacement, of_a_disk_whose_orientation_is_off_in_each_row_is_moved_by_the_arc_of_its_rim) {
  const double radius = 5;
  const double angle = 0.01;
  Problem problem = roll_on_ellipse(radius, Noise{1e-6, angle});
  problem.prior = rollfix::Prior{1, 1e-6};
  const Placement placement = rollfix::solve(problem).placements.at(0);
  // At rest in its own frame: where the part's point of contact goes with x, y and the heading.
  const rollfix::Vec2 point = placement.point[0];
  const rollfix::Vec2 along(std::cos(placement.tangent[0]), std::sin(placement.tangent[0]));
  const Eigen::Vector3d by_pose(along.x(), along.y(), along.dot(rollfix::Vec2(-point.y(), point.x())));
  const Eigen::Matrix3d& covariance = placement.pose_spread->covariance;
  const double arc = radius * angle / std::sqrt(static_cast<double>(problem.felt.log->rows()));
  EXPECT_NEAR(std::sqrt(by_pose.dot(covariance * by_pose)), arc, 0.02 * arc);
}

TEST(WeighedPlacement, of_two_fingers_fits_each_fingers_own_centres) {
  const Part cam(rollfix::gallery("cam"));
  const rollfix::FreePlan plan = free_rolls::by_distances(0.2, 1, 1.5, 0.2, 4, 1.2, 0.8);
  Noise noise{0.002, 0.003};
  noise.position = 0.002;
  const rollfix::Log log = rollfix::roll_free_in_closed_form(cam, plan).log;
  Problem problem{cam, log, {rollfix::disk(0.2)}, noise};
  problem.diagnose = false;
  const rollfix::Answer answer = rollfix::solve(problem);
  EXPECT_EQ(answer.verdict.text(), "unique");
  ASSERT_FALSE(answer.placements.empty());
  EXPECT_NEAR(answer.placements[0].start[0], 1, 0.01);
  EXPECT_NEAR(answer.placements[0].start[1], 4, 0.01);
}

TEST(WeighedPlacement, of_two_that_look_alike_is_as_probable_as_a_vague_heading_has_it) {
  Problem problem = roll_on_ellipse(0.2, Noise{0.002, 0.003});
  const double off = 0.3;
  const double sd = 2;
  problem.pose = rollfix::PosePrior{{0, 0, off}, sd};
  const double other = std::numbers::pi - off;
  const double odds = std::exp(0.5 * (other * other - off * off) / (sd * sd));
  const rollfix::Answer answer = rollfix::solve(problem);
  ASSERT_EQ(answer.placements.size(), 2U);
  EXPECT_NEAR(answer.placements[0].start[0], 1, 0.05);
  EXPECT_NEAR(answer.placements[0].probability, odds / (1 + odds), 0.005);
}

}  // namespace
}  // namespace weighed_placement_test
