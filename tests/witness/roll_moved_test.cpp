#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <string>

#include "random.hpp"
#include "touch/roll_cases.hpp"

// The part was moved between two rolls: told where it was, and not where it was not.
namespace roll_moved_test {

using namespace roll_cases;
using rollfix::TouchCause;

/// The roll on the part after it was turned and pushed.
void move(Log& log, const Pose& by) {
  rollfix::FingerRows& rows = log.fingers.front();
  for (std::size_t row = 0; row < rows.x.size(); ++row) {
    const Vec2 centre = by.world({rows.x[row], rows.y[row]});
    rows.x[row] = centre.x();
    rows.y[row] = centre.y();
    rows.psi[row] += by.heading;
  }
}

/// Rolls of which the last one is made after the part was moved.
RollCase moved_case(int number, bool has_moved, std::size_t count) {
  std::mt19937_64 generator = test_generator(static_cast<std::uint64_t>(number) + 9500);
  const Part part = rollfix::load_part("gallery:spline,n=9,wobble=0.25,seed=" + std::to_string(1 + number % 20));
  Rolling rolling;
  rolling.count = count;
  rolling.contact_sd = rolling.place_sd = 0.002;
  rolling.angle_sd = 0.005;
  RollCase one = random_rolls(part, rolling, generator);
  one.problem.diagnose = true;
  if (!has_moved) return one;
  const double size = diagonal(part);
  const Pose by{uniform(generator, 0.1, 0.3) * size, uniform(generator, 0.1, 0.3) * size, uniform(generator, 0.3, 0.8)};
  move(one.problem.rolls.back(), by);
  return one;
}

TEST(RollMoved, APartThatWasMovedIsTold) {
  int told = 0;
  const int count = test_count(30);
  for (int number = 0; number < count; ++number) {
    const std::size_t rolls = 2 + static_cast<std::size_t>(number % 2);
    const TouchAnswer answer = rollfix::solve(moved_case(number, true, rolls).problem);
    for (const rollfix::TouchDiagnosis& one : answer.diagnoses) {
      told += one.cause == TouchCause::moved && one.roll == rolls - 2 ? 1 : 0;
    }
  }
  std::printf("told %d of %d\n", told, count);
  EXPECT_GE(told, 0.9 * count);
}

TEST(RollMoved, APartAtRestIsHardlyEverSaidToBeMoved) {
  int told = 0;
  const int count = test_count(40);
  for (int number = 0; number < count; ++number) {
    told += rollfix::solve(moved_case(number, false, 2).problem).diagnoses.empty() ? 0 : 1;
  }
  std::printf("false alarms %d of %d\n", told, count);
  EXPECT_LE(told, 1 + count / 50);
}

std::vector<TouchCause> causes(const TouchAnswer& answer) {
  std::vector<TouchCause> result;
  for (const rollfix::TouchDiagnosis& one : answer.diagnoses) result.push_back(one.cause);
  return result;
}

TEST(RollMoved, ATouchThatIsWrongIsNotTakenForIt) {
  RollCase one = moved_case(8, false, 2);
  const double size = diagonal(one.problem.part);
  one.problem.touches = {{Vec2(one.truth.x + 3 * size, one.truth.y)}};
  one.problem.touches.front().position_sd = 0.002;
  const TouchAnswer answer = rollfix::solve(one.problem);
  EXPECT_THAT(causes(answer), testing::ElementsAre(TouchCause::outlier));
}

TEST(RollMoved, AWrongHeadingIsNotTakenForIt) {
  RollCase one = moved_case(6, false, 2);
  rollfix::PosePrior prior;
  prior.mean.heading = one.truth.heading + 1;
  prior.heading_sd = 0.01;
  one.problem.pose = prior;
  EXPECT_THAT(causes(rollfix::solve(one.problem)), testing::ElementsAre(TouchCause::pose));
}

TEST(RollMoved, ARollThatFitsNowhereByItselfLeavesNoPose) {
  RollCase one = moved_case(7, false, 2);
  for (double& psi : one.problem.rolls[1].fingers.front().psi) psi = -psi;
  const TouchAnswer answer = rollfix::solve(one.problem);
  ASSERT_EQ(answer.rolls[1].alone.name, rollfix::Verdict::inconsistent);
  EXPECT_EQ(answer.verdict.name, rollfix::Verdict::inconsistent);
  EXPECT_TRUE(answer.poses.empty());
}

TEST(RollMoved, ExactLogsOfAMovedPartFitNowhereTogether) {
  RollCase one = moved_case(3, false, 2);
  std::mt19937_64 generator = test_generator(9501);
  one = random_rolls(one.problem.part, Rolling{}, generator);
  one.problem.diagnose = true;
  move(one.problem.rolls[1], {0.2, 0.1, 0.3});
  const TouchAnswer answer = rollfix::solve(one.problem);
  EXPECT_EQ(answer.verdict_text(), "inconsistent");
  ASSERT_EQ(answer.diagnoses.size(), 1U);
  EXPECT_EQ(answer.diagnoses.front().cause, TouchCause::moved);
  EXPECT_EQ(answer.diagnoses.front().roll, 0U);
}

}  // namespace roll_moved_test
