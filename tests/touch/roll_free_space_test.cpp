// Paths on which nothing was felt beside rolls: the poses in which the part is in the way go, and no others.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "cli.hpp"
#include "random.hpp"
#include "refusal.hpp"
#include "touch/roll_cases.hpp"

namespace roll_free_space_test {

using namespace roll_cases;
using rollfix::Clear;
using testing::HasSubstr;

/// How far a place is from the part in its own frame, below 0 inside: by many points of its boundary.
double clearance(const std::vector<Vec2>& boundary, const Vec2& place) {
  double nearest = 1e300;
  bool is_inside = false;
  for (std::size_t k = 0; k + 1 < boundary.size(); ++k) {
    const Vec2& a = boundary[k];
    const Vec2& b = boundary[k + 1];
    nearest = std::min(nearest, (a - place).norm());
    const bool crosses = (a.y() > place.y()) != (b.y() > place.y());
    if (crosses && place.x() < a.x() + (b.x() - a.x()) * (place.y() - a.y()) / (b.y() - a.y())) is_inside = !is_inside;
  }
  return is_inside ? -nearest : nearest;
}

/// The least clearance of a disk along a path past the part in a pose.
double clearance(const std::vector<Vec2>& boundary, const Pose& pose, const Clear& path, double radius) {
  double least = 1e300;
  for (int k = 0; k <= 200; ++k) {
    const Vec2 at = path.from + k / 200.0 * (path.to - path.from) - Vec2(pose.x, pose.y);
    least = std::min(least, clearance(boundary, Pose{0, 0, -pose.heading}.turned(at)) - radius);
  }
  return least;
}

bool has(const TouchAnswer& answer, const Pose& pose, double size) {
  return std::any_of(answer.poses.begin(), answer.poses.end(),
                     [&](const TouchPose& one) { return apart(one.pose, pose, Vec2::Zero(), size) < 0.02 * size; });
}

/// A roll and a touch, which leave a few poses.
RollCase of_a_few_poses(const Part& part, std::mt19937_64& generator) {
  Rolling rolling;
  rolling.count = 1;
  rolling.length = 0.04;
  rolling.rows = 8;
  rolling.touches = 1;
  RollCase one = random_rolls(part, rolling, generator);
  one.problem.touches.front().normal.reset();
  one.problem.tolerance = {1e-3 * diagonal(part), 3e-3};
  return one;
}

/// With the boundary as many points: what becomes of each pose with some path past the parts.
void expect_as_by_points(const RollCase& one, const Clear& path) {
  const double size = diagonal(one.problem.part);
  const double radius = one.problem.finger->disk()->radius;
  const std::vector<Vec2> boundary = dense(one.problem.part);
  const TouchAnswer all = rollfix::solve(one.problem);
  TouchProblem problem = one.problem;
  problem.clear = {path};
  const TouchAnswer left = rollfix::solve(problem);
  for (const TouchPose& pose : all.poses) {
    if (pose.continuum) continue;
    const double free = clearance(boundary, pose.pose, path, radius);
    if (free > 0 || free < -0.02 * size) {
      EXPECT_EQ(has(left, pose.pose, size), free > 0) << free;
    }
  }
}

TEST(RollFreeSpace, LeavesThePosesThatManyPointsOfTheBoundaryLeave) {
  for (int k = 0; k < test_count(6); ++k) {
    SCOPED_TRACE(k);
    std::mt19937_64 generator = test_generator(static_cast<std::uint64_t>(k) + 300);
    const Part part = k % 2 == 0 ? rollfix::load_part("gallery:spline,n=9,wobble=0.25,seed=" + std::to_string(k + 1))
                                 : random_polygon(generator);
    const RollCase one = of_a_few_poses(part, generator);
    const double size = diagonal(part);
    const Vec2 about = one.truth.world({0, 0});
    const auto place = [&]() -> Vec2 {
      return about + size * Vec2(uniform(generator, -1, 1), uniform(generator, -1, 1));
    };
    expect_as_by_points(one, {place(), place()});
  }
}

TEST(RollFreeSpace, KeepsThePoseWhoseRollsThePathsLeadTo) {
  std::mt19937_64 generator = test_generator(310);
  RollCase one = of_a_few_poses(rollfix::load_part("gallery:cam"), generator);
  const rollfix::FingerRows& rows = one.problem.rolls.front().fingers.front();
  const Vec2 at(rows.x.front(), rows.y.front());
  const Vec2 out = outward(one.problem.part.tangent(one.starts.front()) + one.truth.heading);
  one.problem.clear = {{at + 3 * out, at}};
  EXPECT_TRUE(has(rollfix::solve(one.problem), one.truth, diagonal(one.problem.part)));
}

TEST(RollFreeSpace, WeighsPosesWithNoise) {
  std::mt19937_64 generator = test_generator(311);
  Rolling rolling;
  rolling.length = 0.05;
  rolling.contact_sd = rolling.place_sd = 0.003;
  rolling.angle_sd = 0.01;
  RollCase one = random_rolls(rollfix::load_part("gallery:spline,n=9,wobble=0.25,seed=4"), rolling, generator);
  const TouchAnswer all = rollfix::solve(one.problem);
  ASSERT_FALSE(all.poses.empty());
  const Vec2 middle = one.truth.world({0, 0});
  one.problem.clear = {{middle, middle + Vec2(0.05, 0)}};
  EXPECT_FALSE(has(rollfix::solve(one.problem), one.truth, diagonal(one.problem.part)));
  one.problem.clear = {{middle + Vec2(50, 0), middle + Vec2(60, 0)}};
  EXPECT_EQ(rollfix::solve(one.problem).poses.size(), all.poses.size());
}

TEST(RollFreeSpace, IsSaidToContradictRollsThatShareAPose) {
  std::mt19937_64 generator = test_generator(312);
  Rolling rolling;
  rolling.rows = 10;
  RollCase one = random_rolls(rollfix::load_part("gallery:cam"), rolling, generator);
  const Vec2 middle = one.truth.world({0, 0});
  one.problem.clear = {{middle, middle + Vec2(0.05, 0)}};
  one.problem.diagnose = true;
  const TouchAnswer answer = rollfix::solve(one.problem);
  EXPECT_EQ(answer.verdict.name, rollfix::Verdict::inconsistent);
  ASSERT_EQ(answer.diagnoses.size(), 1U);
  EXPECT_EQ(answer.diagnoses.front().cause, rollfix::TouchCause::clear);
}

TEST(RollFreeSpace, IsRefusedWhereNothingTellsThePlace) {
  std::mt19937_64 generator = test_generator(313);
  Rolling rolling;
  rolling.centres = false;
  TouchProblem headings = random_rolls(rollfix::load_part("gallery:cam"), rolling, generator).problem;
  headings.clear = {{{0, 0}, {1, 0}}};
  const auto refused = [](const TouchProblem& problem) { return refusal_of([&] { rollfix::solve(problem); }); };
  EXPECT_THAT(refused(headings), HasSubstr("give logs with x and y, or a touch"));
  rolling.centres = true;
  rolling.angle_sd = 0.01;
  rolling.contact_sd = 0.001;
  TouchProblem noisy = random_rolls(rollfix::load_part("gallery:cam"), rolling, generator).problem;
  noisy.clear = headings.clear;
  EXPECT_THAT(refused(noisy), HasSubstr("give position=SD"));
  noisy.noise->position = 0.01;
  noisy.rolls.resize(1);
  EXPECT_THAT(refused(noisy), HasSubstr("expected another roll or a touch beside one roll"));
}

}  // namespace roll_free_space_test
