#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <vector>

#include "random.hpp"
#include "touch/free_space.hpp"
#include "touch/touch_cases.hpp"

// Paths on which nothing was felt, against a boundary of many points and paths of many places.
namespace touch_free_space_test {

using namespace touch_cases;
using rollfix::Clear;
using rollfix::touch::FreeSpace;

/// How far a point is from a polygon of many points, below 0 inside: by its winding number.
double signed_distance(const std::vector<Vec2>& boundary, const Vec2& point) {
  double least = std::numeric_limits<double>::infinity(), turn = 0;
  for (std::size_t k = 0; k < boundary.size(); ++k) {
    const Vec2 a = boundary[k] - point, b = boundary[(k + 1) % boundary.size()] - point;
    const Vec2 side = b - a;
    const double length = side.squaredNorm();
    const double share = length > 0 ? std::clamp(-a.dot(side) / length, 0.0, 1.0) : 0.0;
    least = std::min(least, (a + share * side).norm());
    turn += std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
  }
  return std::abs(turn) > 1 ? -least : least;
}

/// The least of it along a path, the part being in this pose.
double least_distance(const std::vector<Vec2>& boundary, const Pose& pose, const Clear& path, int places = 60) {
  const Pose back{0, 0, -pose.heading};
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k <= places; ++k) {
    const Vec2 place = path.from + static_cast<double>(k) / places * (path.to - path.from);
    least = std::min(least, signed_distance(boundary, back.turned(place - Vec2(pose.x, pose.y))));
  }
  return least;
}

Vec2 around(const Vec2& middle, double radius, std::mt19937_64& generator) {
  const double angle = uniform(generator, 0, 2 * std::numbers::pi);
  return middle + radius * Vec2(std::cos(angle), std::sin(angle));
}

/// Straight ways through the neighbourhood of the part that miss it, with the noise of their ends.
std::vector<Clear> misses(const Part& part, const Pose& truth, double radius, double sd, int count,
                          std::mt19937_64& generator) {
  const double size = diagonal(part);
  const std::vector<Vec2> boundary = part.polyline(0, part.perimeter(), 600);
  Vec2 middle(0, 0);
  for (const Vec2& point : boundary) middle += truth.world(point) / static_cast<double>(boundary.size());
  std::vector<Clear> paths;
  while (static_cast<int>(paths.size()) < count) {
    Clear path{around(middle, 0.8 * size, generator), around(middle, 0.8 * size, generator)};
    if (least_distance(boundary, truth, path) < radius + 0.02 * size) continue;
    path.from += Vec2(normal(generator, sd), normal(generator, sd));
    path.to += Vec2(normal(generator, sd), normal(generator, sd));
    paths.push_back(path);
  }
  return paths;
}

Part part_of(int which, std::mt19937_64& generator) {
  if (which % 3 == 0) return random_polygon(generator);
  if (which % 3 == 1) return bracket();
  return rollfix::load_part("gallery:spline,n=9,seed=" + std::to_string(which + 1) + ",wobble=0.25");
}

TEST(TouchFreeSpace, ABlockedPoseHasThePartInTheWayAndAFreeOneHasNot) {
  int blocked = 0, all = 0;
  for (int c = 0; c < test_count(30); ++c) {
    std::mt19937_64 generator = test_generator(static_cast<std::uint64_t>(c) + 300);
    const Part part = part_of(c, generator);
    const double size = diagonal(part);
    const std::vector<Vec2> boundary = part.polyline(0, part.perimeter(), 600);
    TouchProblem problem{part, {{{0, 0}}}};
    const double radius = c % 2 == 0 ? 0.05 * size : 0;
    if (radius > 0) problem.finger = rollfix::disk(radius);
    const double slack = 0.01 * size;
    problem.tolerance = rollfix::TouchTolerance{slack, 0};
    problem.clear = {{around({0, 0}, uniform(generator, 0, size), generator), around({0, 0}, size, generator)}};
    FreeSpace space(problem, rollfix::touch::measured(problem));
    for (int k = 0; k < 20; ++k) {
      const Pose pose{uniform(generator, -size, size), uniform(generator, -size, size), uniform(generator, -3, 3)};
      const double margin = least_distance(boundary, pose, problem.clear[0], 400) - (radius - slack);
      if (std::abs(margin) < 0.2 * slack) continue;  // the many points are no finer
      EXPECT_EQ(space.is_blocked(pose), margin < 0) << "case " << c << ", margin " << margin;
      blocked += margin < 0 ? 1 : 0;
      ++all;
    }
  }
  EXPECT_GT(blocked, all / 20);
  EXPECT_LT(blocked, all);
}

TEST(TouchFreeSpace, NoTruePoseIsLost) {
  int lost = 0, cases = 0;
  for (int c = 0; c < test_count(40); ++c) {
    std::mt19937_64 generator = test_generator(static_cast<std::uint64_t>(c) + 400);
    const Part part = part_of(c, generator);
    const double size = diagonal(part), sd = 0.002 * size;
    const double radius = c % 2 == 0 ? 0.03 * size : 0;
    const std::size_t count = 3 + static_cast<std::size_t>(c) % 2;
    Case one = random_case(part, {count, c % 4 < 2 ? count : 0, radius, sd, rollfix::kDegree}, generator);
    one.problem.diagnose = false;
    one.problem.clear = misses(part, one.truth, radius, sd, 3, generator);
    const auto holds_truth = [&](const TouchPose& pose) { return in_extent(pose, one.truth); };
    const TouchAnswer with = rollfix::solve(one.problem);
    one.problem.clear.clear();
    const TouchAnswer without = rollfix::solve(one.problem);
    const bool was_in = std::any_of(without.poses.begin(), without.poses.end(), holds_truth);
    if (!was_in) continue;
    ++cases;
    lost += std::any_of(with.poses.begin(), with.poses.end(), holds_truth) ? 0 : 1;
  }
  EXPECT_EQ(lost, 0) << "of " << cases;
}

TEST(TouchFreeSpace, WithoutNoiseEveryListedPoseLeavesThePathsFree) {
  int gone = 0;
  for (int c = 0; c < full_count(8); ++c) {
    std::mt19937_64 generator = test_generator(static_cast<std::uint64_t>(c) + 500);
    const Part part = part_of(c, generator);
    const double size = diagonal(part), radius = 0.03 * size, slack = 0.004 * size;
    Case one = random_case(part, {3, 0, radius, 1e-4 * size, 0}, generator);
    one.problem.noise.reset();
    one.problem.tolerance = rollfix::TouchTolerance{slack, 0};
    const std::size_t all = rollfix::solve(one.problem).poses.size();
    one.problem.clear = misses(part, one.truth, radius, 1e-4 * size, 4, generator);
    const TouchAnswer answer = rollfix::solve(one.problem);
    const std::vector<Vec2> boundary = part.polyline(0, part.perimeter(), 600);
    for (const TouchPose& pose : answer.poses) {
      for (const Clear& path : one.problem.clear) {
        EXPECT_GE(least_distance(boundary, pose.pose, path, 200), radius - 1.2 * slack) << "case " << c;
      }
    }
    const bool has_truth = std::any_of(answer.poses.begin(), answer.poses.end(),
                                       [&](const TouchPose& pose) { return in_extent(pose, one.truth); });
    EXPECT_TRUE(has_truth || answer.status == rollfix::Status::incomplete) << "case " << c;
    gone += static_cast<int>(all) - static_cast<int>(answer.poses.size());
  }
  EXPECT_GT(gone, 0);
}

TEST(TouchFreeSpace, ThePathToATouchSaysOnWhichSideThePartIs) {
  TouchProblem problem{bracket(), {{{30, -2}}, {{-2, 20}}, {{62, 9}}}, rollfix::disk(2)};
  problem.noise.emplace();
  problem.noise->position = 0.02;
  const TouchAnswer without = rollfix::solve(problem);
  problem.clear = {{{30, -20}, {30, -2}}, {{-20, 20}, {-2, 20}}, {{80, 9}, {62, 9}}};
  const TouchAnswer with = rollfix::solve(problem);
  EXPECT_LT(with.poses.size(), without.poses.size());
  ASSERT_FALSE(with.poses.empty());
  const bool has_truth = std::any_of(with.poses.begin(), with.poses.end(), [](const TouchPose& pose) {
    return in_extent(pose, {0, 0, 0});
  });
  EXPECT_TRUE(has_truth);
}

TEST(TouchFreeSpace, APathThroughThePartIsToldToBeWrong) {
  std::mt19937_64 generator(3);
  Case one = random_case(bracket(), {6, 6, 3, 0.05, rollfix::kDegree}, generator);
  one.problem.clear = {{one.truth.world({-20, 9}), one.truth.world({70, 9})}};
  const TouchAnswer answer = rollfix::solve(one.problem);
  EXPECT_EQ(answer.verdict.name, rollfix::Verdict::inconsistent);
  ASSERT_FALSE(answer.diagnoses.empty());
  EXPECT_EQ(answer.diagnoses.front().cause, rollfix::TouchCause::clear);
}

TEST(TouchFreeSpace, APathOfNoLengthIsAPlace) {
  std::mt19937_64 generator(4);
  Case one = random_case(bracket(), {5, 5, 3, 0.05, rollfix::kDegree}, generator);
  one.problem.clear = {{one.truth.world({-20, 9}), one.truth.world({-20, 9})}};
  EXPECT_EQ(rollfix::solve(one.problem).verdict_text(), "unique");
  one.problem.clear = {{one.truth.world({9, 9}), one.truth.world({9, 9})}};
  EXPECT_EQ(rollfix::solve(one.problem).verdict.name, rollfix::Verdict::inconsistent);
}

TEST(TouchFreeSpace, AHoleIsPassedInsideAndAnOpenOutlineOnBothSides) {
  rollfix::Outline outline = polygon({{0, 0}, {0, 10}, {10, 10}, {10, 0}}).outline();
  outline = rollfix::reversed(outline);
  outline.hole = true;
  TouchProblem problem{Part(outline), {{{0, 0}}}};
  problem.tolerance = rollfix::TouchTolerance{0.1, 0};
  problem.clear = {{{2, 5}, {8, 5}}};
  ASSERT_LT(problem.part.turns(), 0);
  EXPECT_FALSE(FreeSpace(problem, rollfix::touch::measured(problem)).is_blocked({}));
  problem.part = rollfix::load_part("gallery:exponential");
  EXPECT_TRUE(FreeSpace(problem, rollfix::touch::measured(problem))
                  .is_empty());  // a point passes an outline that has no inside
  problem.finger = rollfix::disk(1);
  EXPECT_FALSE(FreeSpace(problem, rollfix::touch::measured(problem)).is_empty());
}

/// The table of docs/touch.md: --count=60.
TEST(TouchFreeSpace, PathsThatMissLeaveFewerPoses) {
  double before = 0;
  for (const bool with_normals : {true, false}) {
    for (const int count : {0, 3, 10}) {
      double poses = 0;
      int unique = 0, truth = 0, cases = 0;
      for (int c = 0; c < test_count(6); ++c) {
        std::mt19937_64 generator = test_generator(static_cast<std::uint64_t>(c) + 600);
        const Part part = part_of(c, generator);
        const double size = diagonal(part), sd = 0.001 * size;
        const std::size_t touches = with_normals ? 2 : 3;
        Case one =
            random_case(part, {touches, with_normals ? touches : 0, 0.03 * size, sd, rollfix::kDegree}, generator);
        one.problem.diagnose = false;
        one.problem.clear = misses(part, one.truth, 0.03 * size, sd, count, generator);
        const TouchAnswer answer = rollfix::solve(one.problem);
        poses += static_cast<double>(answer.poses.size());
        unique += answer.verdict.name == rollfix::Verdict::unique ? 1 : 0;
        truth += std::any_of(answer.poses.begin(), answer.poses.end(),
                             [&](const TouchPose& pose) { return in_extent(pose, one.truth); })
                     ? 1
                     : 0;
        ++cases;
      }
      std::printf("| %s | %d | %.2f | %.0f %% | %d of %d |\n", with_normals ? "2 with normals" : "3 without", count,
                  poses / cases, 100.0 * unique / cases, truth, cases);
      if (count == 0) before = poses;
      EXPECT_LE(poses, before + 1);
    }
  }
}

}  // namespace touch_free_space_test
