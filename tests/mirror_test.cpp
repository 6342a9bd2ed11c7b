// A part face down. The witness is the outline's mirror image: what was felt of that one is what was felt of the part.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "rollfix/outline.hpp"
#include "rollfix/rolling.hpp"
#include "rollfix/solve.hpp"

namespace mirror_test {
namespace {

using rollfix::Answer;
using rollfix::Part;
using rollfix::Placement;
using rollfix::Problem;

/// A loop without any symmetry, or its image in x = 0 with the same first point.
Part loop(bool is_image) {
  std::vector<rollfix::Vec2> points;
  for (int k = 0; k < 60; ++k) {
    const double angle = k * std::numbers::pi / 30;
    const double r = 10 + 1.5 * std::cos(2 * angle + 0.4) + 0.8 * std::cos(3 * angle + 1.1);
    points.emplace_back((is_image ? -r : r) * std::cos(angle), r * std::sin(angle));
  }
  return Part(rollfix::outline_through(points, "loop", {}));
}

/// Of a roll on the image: as it is, and of the part face down.
Answer answer(bool is_image, const rollfix::Noise& noise) {
  rollfix::RollPlan plan;
  plan.start = 12.5;
  plan.distance = 30;
  const rollfix::Finger finger = rollfix::disk(1);
  Problem problem{loop(is_image), rollfix::roll(loop(true), finger, plan).log, {finger}, noise};
  problem.mirrored = !is_image;
  return rollfix::solve(problem);
}

double correlation(const Eigen::Matrix3d& covariance, int i, int j) {
  return covariance(i, j) / std::sqrt(covariance(i, i) * covariance(j, j));
}

/// What the turn's error does to the start, by the start along the part's outline.
std::vector<double> slopes_by_start(const Answer& answer, bool is_image) {
  std::vector<Placement> placements = answer.weighing->improbable;
  std::sort(placements.begin(), placements.end(), [&](const Placement& a, const Placement& b) {
    return is_image ? a.start[0] > b.start[0] : a.start[0] < b.start[0];
  });
  std::vector<double> slopes;
  for (const Placement& placement : placements) {
    const double slope = placement.sensitivity.per_turn[0][0];
    slopes.push_back(is_image ? -slope : slope);  // the image's outline runs the other way
  }
  return slopes;
}

TEST(Mirror, the_pose_is_spread_as_that_of_the_image) {
  const rollfix::Noise noise{0.02, 0.01, 0, 0};
  const Eigen::Matrix3d found = answer(false, noise).placements.at(0).pose_spread->covariance;
  const Eigen::Matrix3d image = answer(true, noise).placements.at(0).pose_spread->covariance;
  for (const auto& [i, j] : {std::pair(0, 1), std::pair(0, 2), std::pair(1, 2)}) {
    EXPECT_GT(std::abs(correlation(image, i, j)), 0.02) << i << j;
    EXPECT_NEAR(correlation(found, i, j), correlation(image, i, j), 1e-3) << i << j;
  }
}

TEST(Mirror, what_the_rows_rule_out_is_along_the_part_as_well) {
  const rollfix::Noise noise{0.001, 1e-4, 0, 0};
  const std::vector<double> image = slopes_by_start(answer(true, noise), true);
  ASSERT_FALSE(image.empty());
  EXPECT_GT(std::abs(image.front()), 0.1);
  EXPECT_THAT(slopes_by_start(answer(false, noise), false), testing::Pointwise(testing::DoubleNear(1e-6), image));
}

}  // namespace
}  // namespace mirror_test
