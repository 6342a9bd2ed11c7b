// A finger without size, with normals, on a part whose sides are no longer than what places are off by: next to a place
// there are corners, on which a point has any normal and no length.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "outline/turn.hpp"
#include "rollfix/touch.hpp"
#include "touch/touch_cases.hpp"

namespace touch_point_test {

namespace {

using namespace touch_cases;

// A plate with a tab of 3 by 3.
Part plate() { return polygon({{0, 0}, {40, 0}, {40, 20}, {22, 20}, {22, 23}, {19, 23}, {19, 20}, {0, 20}}); }

rollfix::MeasuredTouch touch_at(double x, double y, double degrees) {
  rollfix::MeasuredTouch touch;
  touch.at = {x, y};
  touch.normal = degrees * rollfix::kDegree;
  return touch;
}

/// Places known to 1, normals to half a degree.
TouchAnswer answer_of(const std::vector<rollfix::MeasuredTouch>& touches) {
  TouchProblem problem{plate(), touches};
  problem.noise.emplace();
  problem.noise->position = 1;
  problem.noise->angle = 0.5 * rollfix::kDegree;
  return rollfix::solve(problem);
}

bool lists_the_origin(const TouchAnswer& answer) {
  return std::any_of(answer.poses.begin(), answer.poses.end(), [](const TouchPose& pose) {
    return pose.interval[0].contains(0) && pose.interval[1].contains(0);
  });
}

}  // namespace

// The tab is as it was when it is turned by half a turn: all else is too far away to matter.
TEST(TouchPoint, OnOppositeFacesOfATabIsAsProbableEitherWay) {
  const std::vector<rollfix::MeasuredTouch> touches{touch_at(17.7, 23.8, -180.4), touch_at(21.7, 20.7, 0.5)};
  for (const TouchAnswer& answer : {answer_of(touches), answer_of({touches[1], touches[0]})}) {
    ASSERT_EQ(answer.poses.size(), 2U);
    EXPECT_NEAR(answer.poses[0].probability, 0.5, 0.02);
    EXPECT_NEAR(answer.poses[0].spread.covariance(2, 2), 0.5 * std::pow(0.5 * rollfix::kDegree, 2), 2e-6);
  }
}

TEST(TouchPoint, IsFoundWhereItsPlacesAreBeyondTheFacesThatItTouched) {
  EXPECT_TRUE(
      lists_the_origin(answer_of({touch_at(20.9, 22.4, 89.9), touch_at(23, 24, -0.1), touch_at(19.3, 19.1, -179.8)})));
  EXPECT_TRUE(
      lists_the_origin(answer_of({touch_at(17.7, 23.8, -180.4), touch_at(21.7, 20.7, 0.5), touch_at(0, 2.1, -180.7)})));
}

}  // namespace touch_point_test
