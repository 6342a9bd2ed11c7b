// What the posterior says of a placement besides its start, where it is known in closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "free_roll.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/rolling.hpp"
#include "rollfix/solve.hpp"

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
  return {ellipse, rollfix::roll(ellipse, finger, plan).log, {finger}, noise};
}

/// Two disks on a cam that lies turned by 2.1 at first.
Problem roll_of_two(const Noise& noise) {
  const Part cam(rollfix::gallery("cam"));
  const rollfix::FreePlan plan = free_rolls::by_distances(0.2, 1, 1.5, 0.2, 4, 1.2, 0.8);
  Problem problem{cam, rollfix::roll_free(cam, plan).log, {rollfix::disk(0.2)}, noise};
  problem.diagnose = false;
  return problem;
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
  problem.measured.readings[0].length[0] += step;
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
  const double arc = radius * angle / std::sqrt(static_cast<double>(problem.measured.log->rows()));
  EXPECT_NEAR(std::sqrt(by_pose.dot(covariance * by_pose)), arc, 0.02 * arc);
}

TEST(WeighedPlacement, of_two_fingers_fits_each_fingers_own_centres) {
  Noise noise{0.002, 0.003};
  noise.position = 0.002;
  const rollfix::Answer answer = rollfix::solve(roll_of_two(noise));
  EXPECT_EQ(answer.verdict.text(), "unique");
  ASSERT_FALSE(answer.placements.empty());
  EXPECT_NEAR(answer.placements[0].start[0], 1, 0.01);
  EXPECT_NEAR(answer.placements[0].start[1], 4, 0.01);
}

TEST(WeighedPlacement, of_two_fingers_is_placed_half_as_uncertainly_as_one_centre_is_known) {
  Noise noise{1e-5, 1e-5};
  noise.position = 0.01;
  const Placement placement = rollfix::solve(roll_of_two(noise)).placements.at(0);
  // Where the middle of both contacts goes with x, y and the heading.
  const rollfix::Vec2 middle = 0.5 * (placement.point[0] + placement.point[1]);
  const double heading = placement.pose_spread->mean.heading;
  const double up = std::sin(heading) * middle.x() + std::cos(heading) * middle.y();
  const Eigen::Vector3d by_pose(1, 0, -up);
  const double variance = by_pose.dot(placement.pose_spread->covariance * by_pose);
  EXPECT_NEAR(variance, 0.5 * noise.position * noise.position, 0.02 * variance);
}

TEST(WeighedPlacement, is_turned_as_surely_where_the_first_contact_is_off) {
  const auto heading_sd = [](double off) {
    Problem problem = roll_of_two(Noise{0.01, 0.002});
    problem.measured.log->fingers[0].u.front() += off / 0.2;
    return std::sqrt(rollfix::solve(problem).placements.at(0).pose_spread->covariance(2, 2));
  };
  EXPECT_NEAR(heading_sd(0.02), heading_sd(0), 0.1 * heading_sd(0));
  EXPECT_LT(heading_sd(0), 1);
}

/// A disk that pivots by that much at a corner, whichever it is, and rolls on along the side behind it.
Problem pivot_and_roll(const Part& part, double radius, double pivot, double length, const Noise& noise) {
  constexpr int kRows = 40;
  rollfix::Log log;
  log.fingers.resize(1);
  for (int k = 0; k <= kRows; ++k) {
    const double turn = pivot * std::min(1.0, 2.0 * k / kRows);
    const double rolled = length * std::max(0.0, 2.0 * k / kRows - 1);
    log.fingers[0].u.push_back(-rolled / radius);
    log.fingers[0].psi.push_back(turn + rolled / radius);
  }
  return {part, log, {rollfix::disk(radius)}, noise};
}

// Corners at six angles of a circle: a disk reaches all of it. With so wide an angle all corners are one placement of
// the search, whose pivot is of one of them.
TEST(WeighedPlacement, of_a_convex_part_is_never_out_of_reach_however_wide_the_noise) {
  std::vector<rollfix::Vec2> corners;
  for (const double angle : {0.0, 0.7, 1.9, 3.1, 4.1, 5.2}) corners.emplace_back(std::cos(angle), std::sin(angle));
  rollfix::OutlineOptions options;
  options.corner_angle = 0.1;
  const Part part(rollfix::outline_through(corners, "hexagon", options));
  ASSERT_EQ(part.corners().size(), 6U);
  const rollfix::Answer answer = rollfix::solve(pivot_and_roll(part, 0.2, 0.5, 0.4, Noise{0.006, 0.1}));
  EXPECT_EQ(answer.dropped.reach, 0U);
  for (const rollfix::Corner& corner : part.corners()) {
    EXPECT_TRUE(std::any_of(answer.placements.begin(), answer.placements.end(), [&](const Placement& placement) {
      return placement.probability > 0.05 && part.distance(placement.start[0], corner.s) < 0.01;
    })) << corner.s;
  }
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
