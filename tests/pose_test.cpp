// Where a part is in the world, from what fingers feel on it.
#include "rollfix/rolling.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <ostream>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "free_roll.hpp"
#include "random.hpp"
#include "rollfix/locate.hpp"

namespace rollfix::pose_test {
namespace {

using free_rolls::by_distances;
using free_rolls::by_profiles;
using free_rolls::part_of;
constexpr double kPi = std::numbers::pi;

std::vector<std::size_t> all_rows(std::size_t count) {
  std::vector<std::size_t> rows(count);
  std::iota(rows.begin(), rows.end(), 0);
  return rows;
}

double most(const std::vector<double>& values) { return *std::max_element(values.begin(), values.end()); }

/// The larger of the distance between two poses and the angle between them.
double difference(const Pose& one, const Pose& two) {
  return std::max(
      {std::abs(one.x - two.x), std::abs(one.y - two.y), std::abs(std::remainder(one.heading - two.heading, 2 * kPi))});
}

double largest_difference(const std::vector<Pose>& some, const std::vector<Pose>& others) {
  double largest = some.size() == others.size() ? 0 : 1e300;
  for (std::size_t k = 0; k < some.size() && largest < 1e300; ++k) {
    largest = std::max(largest, difference(some[k], others[k]));
  }
  return largest;
}

Poses poses_of(const Part& part, const FreePlan& plan, const Roll& roll, double s, double t) {
  return *poses(part, {plan.fingers[0].finger, plan.fingers[1].finger}, roll.log, {s, t}, all_rows(roll.s[0].size()));
}

/// What a log looks like when the part lies elsewhere in the world.
Log moved(Log log, const Pose& pose) {
  for (std::size_t k = 0; k < log.fingers[0].u.size(); ++k) {
    const Vec2 centre = pose.world({log.fingers[0].x[k], log.fingers[0].y[k]});
    log.fingers[0].x[k] = centre.x();
    log.fingers[0].y[k] = centre.y();
    log.fingers[0].psi[k] += pose.heading;
  }
  return log;
}

TEST(Pose, turns_and_moves_points) {
  const Pose pose{1, 2, kPi / 2};
  EXPECT_LT((pose.world({3, 4}) - Vec2(1 - 4, 2 + 3)).norm(), 1e-15);
  EXPECT_LT((pose.turned({3, 4}) - Vec2(-4, 3)).norm(), 1e-15);
}

// --- Two fingers on a part that moves.

struct Case {
  const char* shape;
  double ra;
  double rb;
};

void PrintTo(const Case& one, std::ostream* out) { *out << one.shape << " ra=" << one.ra << " rb=" << one.rb; }

class PoseCases : public testing::TestWithParam<Case> {
 protected:
  Part part_ = part_of(GetParam().shape);
  double P_ = part_.perimeter();
  FreePlan plan_ = by_distances(GetParam().ra, 0.15 * P_, 0.6 * P_, GetParam().rb, 0.61 * P_, -0.45 * P_, 2.5);
  Roll roll_ = roll_free(part_, plan_);
};

TEST_P(PoseCases, of_two_fingers_is_the_simulated_one_at_every_instant) {
  const Poses found = poses_of(part_, plan_, roll_, plan_.fingers[0].start, plan_.fingers[1].start);
  EXPECT_LT(largest_difference(found.pose, roll_.pose), 1e-9 * P_);
  EXPECT_LT(most(found.residual), 1e-9 * P_);
  EXPECT_LT(most(found.turn_residual), 1e-9);
}

TEST_P(PoseCases, does_not_jump_and_starts_near_0) {
  const Poses found = poses_of(part_, plan_, roll_, plan_.fingers[0].start, plan_.fingers[1].start);
  EXPECT_LE(std::abs(found.pose.front().heading), kPi);
  EXPECT_NEAR(found.pose.back().heading - found.pose.front().heading, 2.5, 1e-9);
}

TEST_P(PoseCases, of_one_finger_on_a_part_at_rest_is_where_it_lies) {
  RollPlan plan;
  plan.start = 0.15 * P_;
  plan.distance = 0.6 * P_;
  const Roll rolled = roll(part_, plan_.fingers[0].finger, plan);
  const Pose pose{0.3, -2, 2.75};
  const Log log = moved(rolled.log, pose);
  const Poses found = *poses(part_, {plan_.fingers[0].finger}, log, plan.start, all_rows(log.rows()));
  EXPECT_LT(largest_difference(found.pose, std::vector<Pose>(log.rows(), pose)), 1e-9 * P_);
  EXPECT_LT(most(found.residual), 1e-9 * P_);
  EXPECT_LT(most(found.turn_residual), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Gallery, PoseCases,
                         testing::Values(Case{"ellipse", 0.3, 0.1}, Case{"limacon", 0.1, 0.05}, Case{"cam", 0.2, 0.5},
                                         Case{"spline,seed=3", 0.1, 0.06}, Case{"gear", 0.02, 0.01},
                                         Case{"stadium", 0.5, 0.2}, Case{"polygon", 0.1, 0.3},
                                         Case{"reuleaux", 0.2, 0.1}, Case{"log-spiral", 0.1, 0.2}));

TEST(Pose, is_right_while_both_fingers_pivot_at_corners) {
  const Part square = part_of("polygon,n=4,r=1.4142135623730951");  // sides of length 2
  // Both come to their corners after the same share of a way that is the same for both, and pivot together.
  FreePlan plan = by_distances(0.5, 1, 2, 0.5, 5, 2, 0.4);
  const Roll roll = roll_free(square, plan);
  const Poses found = poses_of(square, plan, roll, 1, 5);
  std::size_t pivoting = 0;
  for (std::size_t row = 0; row < roll.s[0].size(); ++row) {
    if (std::abs(roll.s[0][row] - 2) < 1e-12 && std::abs(roll.s[1][row] - 6) < 1e-12) ++pivoting;
  }
  ASSERT_GT(pivoting, 10U);
  EXPECT_LT(largest_difference(found.pose, roll.pose), 1e-9);
}

TEST(Pose, of_a_roll_that_starts_at_a_corner_is_right) {
  const Part square = part_of("polygon,n=4,r=1.4142135623730951");
  for (const double distance : {1.0, -1.0, 3.0}) {
    RollPlan plan;
    plan.start = 2;
    plan.distance = distance;
    const Roll rolled = roll(square, {0.5}, plan);
    const Poses found = *poses(square, {0.5}, rolled.log, 2, all_rows(rolled.s[0].size()));
    EXPECT_LT(largest_difference(found.pose, std::vector<Pose>(rolled.s[0].size())), 1e-9) << distance;
  }
}

TEST(Pose, of_a_part_at_rest_stays_through_laps_over_its_corners) {
  const Part square = part_of("polygon,n=4,r=1.4142135623730951");
  for (const double distance : {20.0, -20.0}) {
    RollPlan plan;
    plan.start = 1;
    plan.distance = distance;
    const Roll rolled = roll(square, {0.5}, plan);
    const Poses found = *poses(square, {0.5}, rolled.log, 1, all_rows(rolled.s[0].size()));
    EXPECT_LT(largest_difference(found.pose, std::vector<Pose>(rolled.s[0].size())), 1e-9) << distance;
  }
}

TEST(Pose, of_a_part_on_which_a_finger_only_pivots_keeps_the_corner_in_place) {
  const Part square = part_of("polygon,n=4,r=1.4142135623730951");
  RollPlan plan;
  plan.start = 1;
  plan.rotation = 1 / 0.5 + 1.0;  // 1 rad into the pivot of pi / 2
  const Roll rolled = roll(square, {0.5}, plan);
  Log pivot;
  for (std::size_t row = 70; row < rolled.s[0].size(); ++row) {
    pivot.fingers[0].u.push_back(rolled.log.fingers[0].u[row]);
    pivot.fingers[0].psi.push_back(rolled.log.fingers[0].psi[row]);
    pivot.fingers[0].x.push_back(rolled.log.fingers[0].x[row]);
    pivot.fingers[0].y.push_back(rolled.log.fingers[0].y[row]);
  }
  const Poses found = *poses(square, {0.5}, pivot, 2, all_rows(pivot.rows()));
  for (const Pose& pose : found.pose) {
    EXPECT_LT((pose.world(square.point(2)) - square.point(2)).norm(), 1e-9);
    EXPECT_LT(std::abs(pose.heading), (kPi / 2 - 0.9) / 2 + 1e-9);  // about 0.9 of the pivot are felt
    EXPECT_EQ(pose.heading, found.pose.front().heading);
  }
}

TEST(Pose, of_another_turn_of_the_first_contacts_is_the_same) {
  for (const char* shape : {"ellipse", "polygon"}) {
    const Part part = part_of(shape);
    const double P = part.perimeter();
    const FreePlan plan = by_distances(0.1, 0.15 * P, 0.6 * P, 0.2, 0.61 * P, -0.45 * P, 2.5);
    const Roll roll = roll_free(part, plan);
    const Poses once = poses_of(part, plan, roll, 0.15 * P, 0.61 * P);
    const Poses again = poses_of(part, plan, roll, 0.15 * P - P, 0.61 * P + 2 * P);
    EXPECT_LT(largest_difference(once.pose, again.pose), 1e-9 * P) << shape;
    EXPECT_LT(most(again.turn_residual), 1e-9) << shape;
  }
}

TEST(Pose, of_random_rolls_is_the_simulated_one) {
  std::mt19937_64 generator = test_generator(81);
  std::uniform_real_distribution<double> share(0, 1);
  for (int k = 0; k < test_count(10); ++k) {
    const Part part = part_of("spline,n=12,wobble=0.1,seed=" + std::to_string(generator() % 100000));
    const double s = share(generator) * part.perimeter();
    const double t = share(generator) * part.perimeter();
    const FreePlan plan =
        by_distances(0.05, s, 4 * share(generator) - 2, 0.03, t, 4 * share(generator) - 2, 4 * share(generator) - 2);
    const Roll roll = roll_free(part, plan);
    const Poses found = poses_of(part, plan, roll, s, t);
    EXPECT_LT(largest_difference(found.pose, roll.pose), 1e-9 * part.perimeter())
        << part.name() << " s=" << s << " La=" << *plan.fingers[0].distance << " t=" << t
        << " Lb=" << *plan.fingers[1].distance << " rotation=" << plan.part_rotation;
  }
}

// --- Wrong placements give themselves away.

TEST(Pose, of_a_wrong_pair_of_first_contacts_leaves_large_residuals) {
  const Part part = part_of("spline,seed=3");
  const FreePlan plan = by_profiles(0.1, 1, 0.06, 4);
  const Roll roll = roll_free(part, plan);
  for (const auto& [s, t] : {std::pair(1.3, 4.0), std::pair(1.0, 4.4), std::pair(4.0, 1.0), std::pair(2.0, 5.0)}) {
    const Poses wrong = poses_of(part, plan, roll, s, t);
    EXPECT_GT(most(wrong.residual), 0.02 * part.perimeter()) << s << " " << t;
  }
}

TEST(Pose, tells_the_true_one_of_ten_placements_that_fit_the_reading) {
  const Part part = part_of("spline,seed=3");
  RollPlan plan;
  plan.start = 5;
  plan.distance = 2;
  const Roll rolled = roll(part, {0.1}, plan);
  const std::size_t last = rolled.s[0].size() - 1;
  const Search search = locate(part, readings(rolled.log, part, {DiskFinger{0.1}}));
  ASSERT_EQ(search.placements.size(), 10U);
  std::size_t fitting = 0;
  for (const Placement& placement : search.placements) {
    const Poses found = *poses(part, {0.1}, rolled.log, placement.start[0], {0, last});
    EXPECT_LT(found.residual[0], 1e-14);
    EXPECT_LT(found.turn_residual[1], 1e-8);  // the reading fits everywhere
    if (found.residual[1] > 1e-8) continue;
    ++fitting;
    EXPECT_NEAR(placement.start[0], 5, 1e-8);
  }
  EXPECT_EQ(fitting, 1U);
}

TEST(Pose, a_wrong_facing_shows_in_the_turn) {
  const Part part = part_of("ellipse");
  const FreePlan plan = by_distances(0.3, 1, 2, 0.3, 5, 1, 0.5);
  Roll roll = roll_free(part, plan);
  for (double& psi : roll.log.fingers[1].psi) psi += 0.01;
  const Poses found = poses_of(part, plan, roll, 1, 5);
  for (const double gap : found.turn_residual) EXPECT_NEAR(gap, 0.01, 1e-9);
  EXPECT_NEAR(std::remainder(found.pose[0].heading - roll.pose[0].heading, 2 * kPi), 0.005, 1e-9);
}

TEST(Pose, of_fingers_that_disagree_is_in_the_middle) {
  const Part part = part_of("ellipse");
  const FreePlan plan = by_distances(0.3, 1, 2, 0.3, 5, 1, 0.5);
  Roll roll = roll_free(part, plan);
  for (double& x : roll.log.fingers[1].x) x += 0.03;
  for (double& y : roll.log.fingers[1].y) y -= 0.04;
  const Poses found = poses_of(part, plan, roll, 1, 5);
  for (std::size_t row = 0; row < found.pose.size(); ++row) {
    EXPECT_NEAR(found.residual[row], 0.05, 1e-9);
    EXPECT_NEAR(found.pose[row].x - roll.pose[row].x, 0.015, 1e-9);
    EXPECT_NEAR(found.pose[row].y - roll.pose[row].y, -0.02, 1e-9);
  }
}

// --- Rows and columns.

TEST(Pose, is_given_for_the_rows_asked_for) {
  const Part part = part_of("ellipse");
  const FreePlan plan = by_profiles(0.3, 1, 0.2, 5);
  const Roll roll = roll_free(part, plan);
  const Poses found = *poses(part, {DiskFinger{0.3}, DiskFinger{0.2}}, roll.log, {1, 5}, {200, 0, 77});
  ASSERT_EQ(found.pose.size(), 3U);
  EXPECT_LT(difference(found.pose[0], roll.pose[200]), 1e-9);
  EXPECT_LT(difference(found.pose[1], roll.pose[0]), 1e-9);
  EXPECT_LT(difference(found.pose[2], roll.pose[77]), 1e-9);
}

TEST(Pose, is_unknown_without_the_fingers_centres_and_orientations) {
  const Part part = part_of("ellipse");
  const Log no_centre = parse_log("u,psi\n0,0\n1,1\n", "a");
  const Log no_angles = parse_log("length,turn,x,y\n1,2,3,4\n", "b");
  EXPECT_FALSE(poses(part, {DiskFinger{1}}, no_centre, 0, {1}));
  EXPECT_FALSE(poses(part, {DiskFinger{1}}, no_angles, 0, {0}));
  const Log whole = parse_log("u,psi,x,y\n0,0,1,1\n1,1,1,1\n", "c");
  EXPECT_FALSE(poses(part, {}, whole, 0, {0})) << "nor without a finger";
  EXPECT_TRUE(poses(part, {DiskFinger{1}}, paired(whole, whole), {0, 0}, {1}));
  EXPECT_FALSE(poses(part, {DiskFinger{1}}, paired(whole, no_centre), {0, 0}, {1}));
  EXPECT_FALSE(poses(part, {DiskFinger{1}}, paired(no_angles, no_angles), {0, 0}, {0}));
}

}  // namespace
}  // namespace rollfix::pose_test
