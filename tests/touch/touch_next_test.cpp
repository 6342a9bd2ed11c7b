#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "outline/turn.hpp"
#include "random.hpp"
#include "refusal.hpp"
#include "rollfix/advise.hpp"
#include "touch_cases.hpp"

// What to touch next, where it is known and where there is nothing to ask.
namespace touch_next_test {

using namespace touch_cases;
using rollfix::NextTouch;

TouchProblem of_part(const char* name, const std::vector<MeasuredTouch>& touches) {
  TouchProblem problem{rollfix::load_part(name), touches, rollfix::disk(0.1)};
  problem.noise.emplace();
  problem.noise->position = 0.002;
  return problem;
}

TEST(TouchNext, APartThatLooksTheSameInAllPosesHasNone) {
  const TouchAnswer answer =
      rollfix::solve(of_part("gallery:ellipse", {{{2.1, 0}}, {{1.1112, 0.9367}}, {{-1.6579, 0.6816}}, {{0, -1.1}}}));
  ASSERT_EQ(answer.poses.size(), 2U);
  const NextTouch next = rollfix::next_touch(answer);
  EXPECT_FALSE(next.helps);
  EXPECT_EQ(next.why, "no touch tells these poses apart: the part looks the same in each, within the noise");
  EXPECT_NEAR(next.bits_wanted, 1, 0.1);
}

TEST(TouchNext, WhereOnePoseIsLeftThereIsNothingToAdvise) {
  std::mt19937_64 generator(3);
  const Case one = random_case(bracket(), {6, 6, 3, 0.05, rollfix::kDegree}, generator);
  const NextTouch next = rollfix::next_touch(rollfix::solve(one.problem));
  EXPECT_FALSE(next.helps);
  EXPECT_EQ(next.why, "one pose is left");
  EXPECT_TRUE(next.gains.empty());
}

TEST(TouchNext, AfterOneTouchWithItsNormalSaysWhereTheNextOneTellsMost) {
  TouchProblem problem = of_part("gallery:cam", {{{2, 1}, 0.5}});
  problem.noise->angle = rollfix::kDegree;
  const TouchAnswer answer = rollfix::solve(problem);
  const NextTouch next = rollfix::next_touch(answer);
  ASSERT_TRUE(next.helps);
  EXPECT_TRUE(next.expected.empty());
  EXPECT_GT(next.advised().bits, 0.5 * next.bits_wanted);
  const Vec2 away(std::cos(0.5), std::sin(0.5));
  const rollfix::Approach from_outside{Vec2(2, 1) + 50 * away + 20 * Vec2(-away.y(), away.x()), 0.5};
  EXPECT_EQ(rollfix::next_touch(answer, {from_outside}).advised().bits, 0) << "it goes off, where the part can't be";
}

TEST(TouchNext, AfterOneTouchPosesInWhichThePartIsInAClearPathDoNotCount) {
  TouchProblem problem = of_part("gallery:cam", {{{2, 1}, 0.5}});
  problem.noise->angle = rollfix::kDegree;
  const NextTouch plain = rollfix::next_touch(rollfix::solve(problem));
  // Beside the touch and a little behind it: only a side that goes on for so long is there.
  const Vec2 away(std::cos(0.5), std::sin(0.5)), along(-away.y(), away.x());
  problem.clear = {{Vec2(2, 1) - 0.5 * away + along, Vec2(2, 1) - 0.5 * away + 9 * along}};
  EXPECT_LT(rollfix::next_touch(rollfix::solve(problem)).bits_wanted, plain.bits_wanted - 0.2);
}

TEST(TouchNext, AfterOneTouchOfAPointNothingTellsPlacesOfACircleApart) {
  TouchProblem problem = of_part("gallery:circle", {{{3, 2}, -1.7}});
  problem.finger.reset();
  problem.noise->angle = 0.1 * rollfix::kDegree;
  EXPECT_FALSE(rollfix::next_touch(rollfix::solve(problem)).helps);
}

TEST(TouchNext, AfterOnePlaceWithoutNormalTheAdviceIsToTouchElsewhere) {
  const NextTouch next = rollfix::next_touch(rollfix::solve(of_part("gallery:cam", {{{2, 1}}})));
  EXPECT_FALSE(next.helps);
  EXPECT_EQ(next.why, "one place leaves every pose that touches it: touch the part elsewhere first");
}

TEST(TouchNext, AWayThatMissesThePartInEveryPoseGainsNothing) {
  const TouchAnswer answer =
      rollfix::solve(of_part("gallery:spline,n=9,seed=3", {{{1.1, 0}}, {{0, 1.1}}, {{-1.1, 0}}}));
  if (answer.poses.size() < 2) return;
  const NextTouch next = rollfix::next_touch(answer, {{{100, 100}, 0}});
  EXPECT_FALSE(next.helps);
  EXPECT_NEAR(next.advised().bits, 0, 1e-9);
  EXPECT_EQ(next.why, "none of these approaches tells the poses apart");
}

TEST(TouchNext, APartFreeToSlideIsTouchedAcross) {
  // Two touches on one side of the bracket: it can slide along it.
  TouchProblem problem{
      bracket(), {{{10, -3}, -0.5 * std::numbers::pi}, {{30, -3}, -0.5 * std::numbers::pi}}, rollfix::disk(3)};
  problem.noise.emplace();
  problem.noise->position = 0.02;
  problem.noise->angle = rollfix::kDegree;
  const TouchAnswer answer = rollfix::solve(problem);
  ASSERT_TRUE(answer.poses.front().continuum);
  const NextTouch next = rollfix::next_touch(answer);
  ASSERT_TRUE(next.helps);
  EXPECT_GT(std::abs(std::cos(next.advised().approach.direction)), 0.3);
}

TEST(TouchNext, InAPocketTheWayBeginsInside) {
  rollfix::Outline pocket = polygon({{0, 0}, {60, 0}, {60, 20}, {40, 20}, {40, 30}, {0, 30}}).outline();
  pocket.hole = true;
  TouchProblem problem{Part(pocket), {{{2, 10}, 0}, {{30, 2}, 0.5 * std::numbers::pi}}, rollfix::disk(2)};
  problem.noise.emplace();
  problem.noise->position = 0.02;
  problem.noise->angle = rollfix::kDegree;
  const TouchAnswer answer = rollfix::solve(problem);
  ASSERT_GT(answer.poses.size(), 1U);
  const NextTouch next = rollfix::next_touch(answer);
  ASSERT_TRUE(next.helps);
  double touched = 0;
  for (const rollfix::ExpectedTouch& one : next.expected) {
    if (one.hits && one.travel > 0) touched += one.probability;
  }
  EXPECT_GT(touched, 0.5) << "the finger is free where it starts, and there are sides all around";
}

TEST(TouchNext, RefusesWhatItCannotMean) {
  std::mt19937_64 generator(3);
  Case one = random_case(bracket(), {3, 0, 3, 0.05, rollfix::kDegree}, generator);
  const TouchAnswer answer = rollfix::solve(one.problem);
  EXPECT_EQ(refusal_of([&] {
              rollfix::next_touch(answer, {{{NAN, 0}, 0}});
            }).substr(0, 35),
            "approach 1: expected finite numbers");
  one.problem.budget = 10;
  const TouchAnswer incomplete = rollfix::solve(one.problem);
  EXPECT_EQ(refusal_of([&] { rollfix::next_touch(incomplete); }).substr(0, 38),
            "next touch: expected a complete answer");
}

}  // namespace touch_next_test
