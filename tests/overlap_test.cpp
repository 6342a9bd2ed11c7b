// How deep two fingers are in one another, of every shape: against a scan of all directions over points of both.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "finger/convex_body.hpp"
#include "random.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/rolling.hpp"

namespace rollfix::overlap_test {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

/// A roll of two fingers with a single row: their places and orientations.
Roll at(const Pose& a, const Pose& b) {
  Roll roll;
  roll.log.fingers.resize(2);
  for (const std::size_t k : {0U, 1U}) {
    const Pose& pose = k == 0 ? a : b;
    roll.log.fingers[k].x = {pose.x};
    roll.log.fingers[k].y = {pose.y};
    roll.log.fingers[k].psi = {pose.heading};
  }
  return roll;
}

double depth(const Finger& a, const Pose& of_a, const Finger& b, const Pose& of_b) {
  const auto overlap = overlap_of(at(of_a, of_b), a, b);
  return overlap ? overlap->depth : 0;
}

/// Many points of a finger's boundary, in the world; of a jaw of a piece of it that is long.
std::vector<Vec2> points_of(const Finger& finger, const Pose& pose) {
  constexpr int kPoints = 400;
  std::vector<Vec2> points;
  const double whole = finger.outline() ? finger.outline()->perimeter() : kTurn;
  for (int k = 0; k <= kPoints; ++k) points.push_back(pose.world(finger.point(whole * k / kPoints)));
  return points;
}

/// The shift in this direction that gets the points of one off those of the other.
double depth_towards(double angle, const std::vector<Vec2>& a, const std::vector<Vec2>& b) {
  const double x = std::cos(angle);
  const double y = std::sin(angle);
  double most_a = -std::numeric_limits<double>::infinity();
  double least_b = std::numeric_limits<double>::infinity();
  for (const Vec2& point : a) most_a = std::max(most_a, x * point[0] + y * point[1]);
  for (const Vec2& point : b) least_b = std::min(least_b, x * point[0] + y * point[1]);
  return most_a - least_b;
}

/// The least shift: over directions, and over finer ones about each that may lead to it.
double scanned_depth(const std::vector<Vec2>& a, const std::vector<Vec2>& b) {
  constexpr int kDirections = 400;
  constexpr int kFiner = 10;
  const double step = kTurn / kDirections;
  std::vector<double> depths;
  for (int k = 0; k < kDirections; ++k) depths.push_back(depth_towards(step * k, a, b));
  double least = *std::min_element(depths.begin(), depths.end());
  const double near = least + 6 * step;  // nothing is farther away than 6
  for (int k = 0; k < kDirections; ++k) {
    if (depths[static_cast<std::size_t>(k)] > near) continue;
    for (int finer = -kFiner; finer <= kFiner; ++finer) {
      least = std::min(least, depth_towards(step * (k + 0.5 * finer / kFiner), a, b));
    }
  }
  return least;
}

Finger arc() {
  std::vector<Vec2> points;
  for (int k = 0; k <= 40; ++k) {
    const double angle = -2.4 + 1.7 * k / 40;
    points.emplace_back(1.2 * std::cos(angle), 0.7 * std::sin(angle));
  }
  OutlineOptions options;
  options.open = true;
  return Finger::outlined(outline_through(points, "arc", options));
}

std::vector<Finger> bodies() {
  return {disk(0.7), Finger::outlined(gallery("ellipse,a=1,b=0.5")), Finger::outlined(gallery("stadium")),
          Finger::outlined(gallery("cam")), arc()};
}

}  // namespace

TEST(OverlapOf, two_bodies_is_what_a_scan_of_all_directions_finds) {
  std::mt19937_64 generator = test_generator(811);
  std::uniform_real_distribution<double> unit(-1, 1);
  int deep = 0;
  int apart = 0;
  const std::vector<Finger> all = bodies();
  for (int round = 0; round < test_count(25); ++round) {
    const auto number = static_cast<std::size_t>(round);
    const Finger& a = all[number % all.size()];
    const Finger& b = all[(number / all.size() + number) % all.size()];
    const Pose of_a{0, 0, 3 * unit(generator)};
    const Pose of_b{2.5 * unit(generator), 2 * unit(generator), 3 * unit(generator)};
    const double scanned = scanned_depth(points_of(a, of_a), points_of(b, of_b));
    const double found = depth(a, of_a, b, of_b);
    EXPECT_LE(found, std::max(0.0, scanned) + 1e-4);
    EXPECT_NEAR(found, std::max(0.0, scanned), 1e-3) << a.name() << " " << b.name() << ", seed " << test_seed();
    EXPECT_NEAR(found, depth(b, of_b, a, of_a), 1e-12);
    (found > 0 ? deep : apart) += 1;
  }
  EXPECT_GT(deep, 3);
  EXPECT_GT(apart, 3);
}

TEST(DistanceBetween, two_bodies_is_what_a_scan_of_all_directions_finds_and_below_zero_their_depth) {
  std::mt19937_64 generator = test_generator(812);
  std::uniform_real_distribution<double> unit(-1, 1);
  const std::vector<Finger> all = bodies();
  constexpr double kExact = std::numeric_limits<double>::infinity();
  int apart = 0;
  for (int round = 0; round < test_count(25); ++round) {
    const auto number = static_cast<std::size_t>(round);
    const Finger& a = all[number % all.size()];
    const Finger& b = all[(number / all.size() + number) % all.size()];
    const Pose of_a{0, 0, 3 * unit(generator)};
    const Pose of_b{4 * unit(generator), 4 * unit(generator), 3 * unit(generator)};
    const double found = distance_between(ConvexBody(a, of_a), ConvexBody(b, of_b), kExact);
    EXPECT_NEAR(found, -scanned_depth(points_of(a, of_a), points_of(b, of_b)), 1e-3)
        << a.name() << " " << b.name() << ", seed " << test_seed();
    EXPECT_GE(distance_between(ConvexBody(a, of_a), ConvexBody(b, of_b), 0.5 * found), std::min(found, 0.5 * found));
    apart += found > 0 ? 1 : 0;
  }
  EXPECT_GT(apart, 10);
}

TEST(DistanceBetween, circles_and_corners_is_that_of_closed_forms) {
  constexpr double kExact = std::numeric_limits<double>::infinity();
  const Finger round = Finger::outlined(gallery("circle,r=0.7"));
  const ConvexBody left(round, {0, 0, 1});
  EXPECT_NEAR(distance_between(left, ConvexBody(disk(0.5), {3, 4, 0}), kExact), 5 - 1.2, 1e-12);
  // A corner against a circle, and against a flat side.
  OutlineOptions corners;
  corners.corner_angle = 0;
  const Finger square = Finger::outlined(outline_through({{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}, "square", corners));
  const double diagonal = std::sqrt(2.0);
  EXPECT_NEAR(distance_between(ConvexBody(square, {}), ConvexBody(round, {4, 4, 0}), kExact),
              4 * diagonal - diagonal - 0.7, 1e-12);
  EXPECT_NEAR(distance_between(ConvexBody(square, {}), ConvexBody(square, {3, 0.2, kTurn / 8}), kExact),
              3 - 1 - diagonal, 1e-12);
  EXPECT_NEAR(distance_between(ConvexBody(square, {}), ConvexBody(square, {3, 0.4, 0}), kExact), 1, 1e-12);
}

TEST(OverlapOf, two_outlines_that_are_circles_is_that_of_disks) {
  const Finger round = Finger::outlined(gallery("circle,r=0.7"));
  const Pose near{0.9, 0.3, 2};
  EXPECT_NEAR(depth(round, {0, 0, 1}, round, near), depth(disk(0.7), {}, disk(0.7), near), 1e-12);
  EXPECT_NEAR(depth(round, {0, 0, 1}, disk(0.7), near), 1.4 - std::hypot(0.9, 0.3), 1e-12);
}

TEST(OverlapOf, a_jaw_and_a_body_is_how_far_that_is_beyond_the_jaws_line) {
  // The jaw's body lies above its line, which goes up to the right here.
  const Pose jaw_pose{1, 0.5, 0.4};
  for (const Finger& body : bodies()) {
    const Pose pose{0.2, 0.1, -1.1};
    double most = 0;
    for (const Vec2& point : points_of(body, pose)) {
      most = std::max(most, (point - Vec2(1, 0.5)).dot(Vec2(-std::sin(0.4), std::cos(0.4))));
    }
    EXPECT_NEAR(depth(jaw(), jaw_pose, body, pose), most, 1e-4) << body.name();
    EXPECT_EQ(depth(jaw(), jaw_pose, body, pose), depth(body, pose, jaw(), jaw_pose));
  }
}

TEST(OverlapOf, two_jaws_is_not_told_because_they_have_no_ends) {
  EXPECT_EQ(depth(jaw(), {0, 0, 0}, jaw(), {0, 0, 0.3}), 0);
}

TEST(OverlapOf, fingers_that_only_touch_is_none) {
  EXPECT_EQ(depth(disk(0.5), {0, 0, 0}, Finger::outlined(gallery("circle,r=0.5")), {1, 0, 0.3}), 0);
  EXPECT_EQ(depth(jaw(), {0, 0.5, 0}, disk(0.5), {3, 0, 0}), 0);
}

TEST(OverlapOf, a_roll_is_that_of_its_deepest_row) {
  Roll roll = at({}, {0.9, 0, 0});
  for (const double x : {0.4, 0.6}) {
    for (const std::size_t k : {0U, 1U}) {
      roll.log.fingers[k].x.push_back(k == 0 ? 0 : x);
      roll.log.fingers[k].y.push_back(0);
      roll.log.fingers[k].psi.push_back(0);
    }
  }
  const auto found = overlap_of(roll, disk(0.5), Finger::outlined(gallery("circle,r=0.5")));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->row, 1U);
  EXPECT_NEAR(found->depth, 0.6, 1e-12);
}

}  // namespace rollfix::overlap_test
