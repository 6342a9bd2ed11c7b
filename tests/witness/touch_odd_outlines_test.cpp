#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "outline/turn.hpp"
#include "random.hpp"
#include "random_outlines.hpp"
#include "touch/touch_cases.hpp"

// Lines and arcs with corners both ways, symmetric or open, far away, hardly noisy or very: the truth stays listed.
namespace touch_odd_outlines_test {

using namespace touch_cases;

struct Odd {
  Making making;
  double far = 1;  // world coordinates are this many sizes of the part
};

Odd random_making(std::mt19937_64& generator, double size) {
  Odd odd;
  odd.making.count = std::uniform_int_distribution<std::size_t>(3, 6)(generator);
  odd.making.normals = std::uniform_int_distribution<std::size_t>(0, odd.making.count)(generator);
  odd.making.radius = uniform(generator, 0, 1) < 0.5 ? 0 : uniform(generator, 0.01, 0.1) * size;
  odd.making.place_sd = std::pow(10, uniform(generator, -4.5, -2)) * size;
  odd.making.angle_sd = std::pow(10, uniform(generator, -3.5, -1.2));
  odd.far = std::pow(10, uniform(generator, 0, 4));
  return odd;
}

TEST(TouchOddOutlines, HoldTheTruth) {
  int cases = 0;
  for (int c = 0; cases < test_count(120); ++c) {
    std::mt19937_64 generator = test_generator(static_cast<std::uint64_t>(c) + 9000);
    const std::optional<Part> drawn = random_outlines::outline(generator);
    if (!drawn) continue;
    ++cases;
    const double size = diagonal(*drawn);
    const Odd odd = random_making(generator, size);
    Case one = random_case(*drawn, odd.making, generator);
    const Vec2 off = odd.far * size * Vec2(1, -0.5);
    for (MeasuredTouch& touch : one.problem.touches) touch.at += off;
    one.truth.x += off.x();
    one.truth.y += off.y();
    one.problem.diagnose = false;
    const TouchAnswer answer = rollfix::solve(one.problem);
    const bool is_listed = std::any_of(answer.poses.begin(), answer.poses.end(),
                                       [&](const TouchPose& pose) { return in_extent(pose, one.truth); });
    EXPECT_TRUE(is_listed || answer.status == rollfix::Status::incomplete)
        << "case " << c << ": " << answer.poses.size() << " poses, " << answer.verdict_text();
    for (const TouchPose& pose : answer.poses) {
      EXPECT_LE(pose.worst, 1);
      EXPECT_TRUE(std::isfinite(pose.probability) && std::isfinite(pose.spread.covariance.sum())) << "case " << c;
      for (std::size_t k = 0; k < 3; ++k) EXPECT_LT(pose.interval[k].lo, pose.interval[k].hi);
    }
  }
}

/// What is worth a look of one answer is in the other, moved. Of a continuum any pose stands for all, and where it ends
/// and another pose begins depends on the touch that is summed over.
void expect_alike(const TouchAnswer& here, const TouchAnswer& there, const Pose& moved, double least,
                  double probability) {
  for (const TouchAnswer* answer : {&here, &there}) {
    for (const TouchPose& pose : answer->poses) {
      if (pose.continuum) return;
    }
  }
  for (const TouchPose& one : here.poses) {
    if (one.probability < least) continue;
    const Vec2 place = moved.world({one.pose.x, one.pose.y});
    const Pose expected{place.x(), place.y(), one.pose.heading + moved.heading};
    const auto is_same = [&](const TouchPose& other) {
      return apart(other.pose, expected, here.part.point(0), diagonal(here.part)) < 0.01 &&
             std::abs(other.probability - one.probability) < probability;
    };
    EXPECT_TRUE(std::any_of(there.poses.begin(), there.poses.end(), is_same))
        << one.probability << " at " << expected.x << ", " << expected.y << ", " << expected.heading;
  }
}

TEST(TouchOddOutlines, GiveTheSameAnswerTurnedAndShifted) {
  for (int c = 0; c < test_count(10); ++c) {
    std::mt19937_64 generator = test_generator(static_cast<std::uint64_t>(c) + 9500);
    const Case one = random_case(bracket(), {5, 2, 2, 0.05, rollfix::kDegree}, generator);
    const Pose moved{300, -200, uniform(generator, -3, 3)};
    TouchProblem again = one.problem;
    for (MeasuredTouch& touch : again.touches) {
      touch.at = moved.world(touch.at);
      if (touch.normal) touch.normal = rollfix::nearest_angle(*touch.normal + moved.heading);
    }
    SCOPED_TRACE(c);
    expect_alike(rollfix::solve(one.problem), rollfix::solve(again), moved, 0.02, 0.005);
  }
}

TEST(TouchOddOutlines, GiveTheSameAnswerInAnyOrder) {
  for (int c = 0; c < test_count(10); ++c) {
    std::mt19937_64 generator = test_generator(static_cast<std::uint64_t>(c) + 9600);
    const Case one = random_case(bracket(), {5, 0, 2, 0.05, 0}, generator);
    TouchProblem again = one.problem;
    std::reverse(again.touches.begin(), again.touches.end());
    SCOPED_TRACE(c);
    // Another touch is summed over: the same but for what Laplace's method leaves, and small modes may be one or two.
    expect_alike(rollfix::solve(one.problem), rollfix::solve(again), {}, 0.5, 0.05);
  }
}

TEST(TouchOddOutlines, TouchesWithTheirOwnNoiseCountByIt) {
  std::mt19937_64 generator = test_generator(9700);
  const Case one = random_case(bracket(), {6, 0, 2, 0.01, 0}, generator);
  TouchProblem problem = one.problem;
  problem.touches[2].at += Vec2(1, 1);
  problem.touches[2].position_sd = 5;
  const TouchAnswer answer = rollfix::solve(problem);
  EXPECT_FALSE(answer.verdict.fits_badly);
  const auto holds = [&](const TouchPose& pose) { return in_extent(pose, one.truth); };
  EXPECT_TRUE(std::any_of(answer.poses.begin(), answer.poses.end(), holds));
}

}  // namespace touch_odd_outlines_test
