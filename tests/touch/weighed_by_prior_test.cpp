// One touch, and how the part lies as it is known beforehand: against a measurement of one normal distribution by
// another.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>

#include "outline/turn.hpp"
#include "random.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/touch.hpp"
#include "touch/roll_cases.hpp"
#include "touch/touch_cases.hpp"

namespace weighed_by_prior_test {

namespace {

using namespace touch_cases;

constexpr double kPlaceSd = 0.1;
constexpr double kHeadingSd = 0.02;
constexpr double kTouchSd = 0.03;

/// A wide plate that lies on y >= 0 about the origin, touched below it at the origin's x.
TouchProblem on_the_long_side(double y, std::optional<double> normal) {
  TouchProblem problem{polygon({{-50, 0}, {50, 0}, {50, 30}, {-40, 40}}), {{{0, y}, normal}}};
  problem.noise.emplace();
  problem.noise->position = kTouchSd;
  problem.noise->angle = kHeadingSd;
  problem.pose = rollfix::PosePrior{{0, 0, 0}, kHeadingSd, kPlaceSd};
  return problem;
}

double sd(const TouchPose& pose, int axis) { return std::sqrt(pose.spread.covariance(axis, axis)); }

}  // namespace

TEST(TouchAndPrior, OnAStraightSideMeasureAcrossItAlone) {
  const TouchAnswer answer = solve(on_the_long_side(0.06, {}));
  ASSERT_EQ(answer.verdict_text(), "unique");
  const TouchPose& pose = answer.poses.front();
  const double by_touch = 1 / (kTouchSd * kTouchSd), before = 1 / (kPlaceSd * kPlaceSd);
  EXPECT_NEAR(pose.spread.mean.y, 0.06 * by_touch / (by_touch + before), 1e-3);
  EXPECT_NEAR(sd(pose, 1), 1 / std::sqrt(by_touch + before), 1e-3);
  EXPECT_NEAR(sd(pose, 0), kPlaceSd, 3e-3);
  EXPECT_NEAR(sd(pose, 2), kHeadingSd, 6e-4);
}

TEST(TouchAndPrior, WithItsNormalMeasureTheHeadingAsWell) {
  const TouchAnswer answer = solve(on_the_long_side(0, -0.5 * std::numbers::pi + 0.01));
  ASSERT_EQ(answer.poses.size(), 1U);
  EXPECT_NEAR(answer.poses.front().spread.mean.heading, 0.005, 5e-4);
  EXPECT_NEAR(sd(answer.poses.front(), 2), kHeadingSd / std::numbers::sqrt2, 6e-4);
}

TEST(TouchAndPrior, ThatContradictEachOtherFitNowhere) {
  const TouchAnswer answer = solve(on_the_long_side(-3, {}));
  EXPECT_EQ(answer.verdict_text(), "inconsistent");
  ASSERT_EQ(answer.diagnoses.size(), 1U);
  EXPECT_EQ(answer.diagnoses.front().cause, rollfix::TouchCause::pose);
}

TEST(TouchAndPrior, OfAPartFaceDownAreSeenInTheMirror) {
  TouchProblem problem = on_the_long_side(0.06, -0.5 * std::numbers::pi + 0.01);
  problem.mirrored = true;
  const TouchAnswer answer = solve(problem);
  ASSERT_EQ(answer.poses.size(), 1U);
  EXPECT_NEAR(answer.poses.front().spread.mean.heading, 0.005, 5e-4);
}

TEST(TouchAndPrior, OnEitherFaceOfAThinPlateAreTwoPoses) {
  TouchProblem problem = on_the_long_side(-0.5, {});
  problem.part = polygon({{-50, 0}, {50, 0}, {50, -1}, {-50, -1}});
  problem.part = Part(rollfix::reversed(problem.part.outline()));
  problem.pose->place_sd = 0.3;
  const TouchAnswer answer = solve(problem);
  ASSERT_EQ(answer.poses.size(), 2U);
  EXPECT_NEAR(answer.poses[0].probability, 0.5, 0.02);
}

TEST(TouchAndPrior, TwiceAtOnePlaceMeasureTwice) {
  TouchProblem problem = on_the_long_side(0.06, {});
  problem.touches.push_back(problem.touches.front());
  const TouchAnswer answer = solve(problem);
  ASSERT_EQ(answer.verdict_text(), "unique");
  const double by_touch = 2 / (kTouchSd * kTouchSd), before = 1 / (kPlaceSd * kPlaceSd);
  EXPECT_NEAR(sd(answer.poses.front(), 1), 1 / std::sqrt(by_touch + before), 1e-3);
  EXPECT_EQ(answer.poses.front().contacts.size(), 2U);
}

TEST(TouchAndPrior, LeaveAClearPathFree) {
  TouchProblem problem = on_the_long_side(0, {});
  problem.pose->place_sd = 1;
  problem.clear = {{{50, 0.5}, {53, 0.5}}};  // beside the plate's end, where it is about half of the time
  const TouchAnswer answer = solve(problem);
  ASSERT_FALSE(answer.poses.empty());
  for (const TouchPose& pose : answer.poses) EXPECT_LT(pose.pose.x, 0.2);
}

TEST(TouchAndPrior, OfTheHeadingAloneLeaveThePlaceOpen) {
  TouchProblem problem = on_the_long_side(0, {});
  problem.pose->place_sd = std::numeric_limits<double>::infinity();
  EXPECT_EQ(solve(problem).verdict_text(), "unobservable");
}

TEST(TouchAndPrior, OfARollInPlaceOfATouchAreCombinedAsWell) {
  std::mt19937_64 generator(3);
  roll_cases::Rolling rolling;
  rolling.count = 1;
  rolling.contact_sd = rolling.place_sd = 1e-4;
  rolling.angle_sd = 1e-3;
  TouchProblem problem = roll_cases::random_rolls(rollfix::load_part("gallery:cam"), rolling, generator).problem;
  const TouchPose before = solve(problem).poses.front();
  problem.pose = rollfix::PosePrior{before.spread.mean, 0.5 * sd(before, 2)};
  EXPECT_LT(sd(solve(problem).poses.front(), 2), 0.5 * sd(before, 2));
}

TEST(TouchAndPrior, HoldTheTruthAsOftenAsTheirIntervalsSay) {
  const int count = test_count(400);
  int held = 0, cases = 0;
  for (int c = 0; c < count; ++c) {
    std::mt19937_64 generator = test_generator(static_cast<std::uint64_t>(c) + 9100);
    const Part part = rollfix::load_part("gallery:spline,n=9,wobble=0.2,seed=" + std::to_string(c % 20 + 1));
    Case one = random_case(part, {1, static_cast<std::size_t>(c % 2), 0, 0.02, 0.05}, generator);
    const Vec2 off = scatter(generator, kPlaceSd);
    one.problem.pose = rollfix::PosePrior{
        {one.truth.x + off.x(), one.truth.y + off.y(), one.truth.heading + normal(generator, 0.1)}, 0.1, kPlaceSd};
    for (const TouchPose& pose : solve(one.problem).poses) {
      if (pose.probability < 0.9) continue;
      ++cases;
      held += pose.interval[0].contains(one.truth.x) ? 1 : 0;
    }
  }
  EXPECT_GT(cases, count / 2);
  EXPECT_NEAR(static_cast<double>(held) / cases, 0.95, 4 * std::sqrt(0.05 * 0.95 / cases));
}

}  // namespace weighed_by_prior_test
