// How sure two fingers are on flat sides, where what each sensor tells has a closed form.
#include <gtest/gtest.h>

#include <cmath>

#include "belief/posterior.hpp"
#include "free_roll.hpp"
#include "rollfix/solve.hpp"
#include "shapes.hpp"

namespace pair_closed_forms_test {
namespace {

using rollfix::Noise;
using rollfix::Part;
using shapes::kPi;

constexpr double kRadius = 0.1;
constexpr double kAcross = 1 + 2 * kRadius;  // from centre to centre

Noise noise_of(double angle, double position) {
  Noise noise{1e-5, angle};
  noise.position = position;
  return noise;
}

/// Variances of a direction from one point to another, and of the mean of two angles.
double by_ends(double position, double apart) { return 2 * position * position / (apart * apart); }
double by_angles(double angle) { return 0.5 * angle * angle; }

/// Two disks across from each other that roll along opposite sides of a square, of which finger a's place is known.
rollfix::Problem grip(const Noise& noise) {
  const Part square = shapes::unit_square();
  const rollfix::FreePlan plan = free_rolls::by_distances(kRadius, 0.4, 0.2, kRadius, 2.6, -0.2);
  rollfix::Problem problem{square, rollfix::roll_free(square, plan).log, {rollfix::disk(kRadius)}, noise};
  problem.prior = rollfix::Prior{0.4, 1e-5};
  return problem;
}

/// As each of so many rows tells by itself how far finger b is along its side.
void expect_place_of_b(const Noise& noise, double sd_of_row) {
  const rollfix::Problem problem = grip(noise);
  const rollfix::Answer answer = rollfix::solve(problem);
  ASSERT_FALSE(answer.placements.empty());
  const double sd = sd_of_row / std::sqrt(static_cast<double>(problem.measured.log->rows()));
  EXPECT_NEAR(answer.placements[0].start[1], 2.6, 4 * sd);
  EXPECT_NEAR(answer.placements[0].sd[1], sd, 0.03 * sd);
}

TEST(PairClosedForms, centres_across_a_grip_tell_the_place_as_well_as_each_is_known) {
  const Noise noise = noise_of(1e-4, 0.01);
  expect_place_of_b(noise, kAcross * std::sqrt(by_ends(noise.position, kAcross)));
}

TEST(PairClosedForms, orientations_tell_it_as_well_as_the_mean_of_both_is_known) {
  const Noise noise = noise_of(0.02, 1e-4);
  expect_place_of_b(noise, kAcross * std::sqrt(by_angles(noise.angle)));
}

TEST(PairClosedForms, a_finger_that_rolled_along_a_wall_began_anywhere_but_so_near_its_end) {
  const Part wall(shapes::polygon({{0, 0}, {10, 0}}, false));
  for (const double length : {-3.0, -2.0, -1.0, 1.0, 2.5}) {
    rollfix::Problem problem{wall, {{0.5, length / 2, 0}, {1, length, 0}}, {}, Noise{0.01, 0.01}};
    problem.prior = rollfix::Prior{5, 0.05};
    const rollfix::Placement placement = rollfix::solve(problem).placements.at(0);
    EXPECT_NEAR(placement.mean[1], (10 - length) / 2, 0.02) << length;
    EXPECT_NEAR(placement.sd[1], (10 - std::abs(length)) / std::sqrt(12.0), 0.01) << length;
  }
}

TEST(PairClosedForms, a_heading_told_by_normals_and_by_the_line_between_both_contacts_is_as_sure_as_their_best_mean) {
  const Noise noise = noise_of(0.02, 0.01);
  rollfix::belief::MassPiece piece{{0.5, 2.5}, {0.0, kPi}};
  piece.share = 1;
  const rollfix::PerFinger<rollfix::MeasuredContact> felt{rollfix::MeasuredContact{{0.5, 0}, kPi / 2},
                                                          rollfix::MeasuredContact{{0.5, 1}, -kPi / 2}};
  const double information = 1 / by_angles(noise.angle) + 1 / by_ends(noise.position, 1);
  const Eigen::Matrix3d covariance =
      rollfix::belief::pose_spread_of(shapes::unit_square(), {piece}, felt, noise).covariance;
  EXPECT_NEAR(std::sqrt(covariance(2, 2)), 1 / std::sqrt(information), 0.001 / std::sqrt(information));
}

}  // namespace
}  // namespace pair_closed_forms_test
