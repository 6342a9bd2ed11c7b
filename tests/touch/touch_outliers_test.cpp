// Touches any of which may be an outlier, which says nothing.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "outline/turn.hpp"
#include "rollfix/certify.hpp"
#include "rollfix/error.hpp"
#include "rollfix/touch.hpp"
#include "touch/roll_cases.hpp"
#include "touch/touch_cases.hpp"

namespace touch_outliers_test {

namespace {

using namespace touch_cases;

/// Balls of 3 on the bracket of 60 by 45 where it was drawn, places known to 0.02: seven touches that fit.
TouchProblem seven_touches() {
  TouchProblem problem{bracket(), {{{20, -3}}, {{63, 9}}, {{40, 21}}, {{14, 48}}, {{-3, 20}}, {{50, -3}}, {{-3, 8}}}};
  problem.finger = rollfix::disk(3);
  problem.noise.emplace();
  problem.noise->position = 0.02;
  problem.robust = true;
  return problem;
}

}  // namespace

TEST(TouchOutliers, AreNoneWhereAllTouchesFit) {
  const TouchAnswer answer = solve(seven_touches());
  EXPECT_EQ(answer.verdict_text(), "unique");
  EXPECT_LT(*std::max_element(answer.outlier.begin(), answer.outlier.end()), 0.01);
  EXPECT_TRUE(answer.poses.front().outliers.empty());
}

TEST(TouchOutliers, AreNamedAndDoNotMoveThePart) {
  for (std::size_t k = 0; k < 7; ++k) {
    TouchProblem problem = seven_touches();
    problem.touches[k].at += Vec2(1.3, 1.1);
    const TouchAnswer answer = solve(problem);
    ASSERT_EQ(answer.verdict_text(), "unique") << k;
    EXPECT_EQ(answer.poses.front().outliers, std::vector<std::size_t>{k});
    EXPECT_GT(answer.outlier[k], 0.99);
    ASSERT_EQ(answer.poses.front().contacts.size(), 7U);
    EXPECT_GT(answer.poses.front().contacts[k].distance, 0.8);
    EXPECT_NEAR(answer.poses.front().pose.x, 0, 0.1);
  }
}

TEST(TouchOutliers, OfAPartFaceDownAreNamedAsWell) {
  TouchProblem problem = seven_touches();
  for (MeasuredTouch& touch : problem.touches) touch.at.x() = -touch.at.x();
  problem.touches[2].at += Vec2(1.3, 1.1);
  problem.mirrored = true;
  const TouchAnswer answer = solve(problem);
  EXPECT_EQ(answer.verdict_text(), "unique");
  EXPECT_EQ(answer.poses.front().outliers, std::vector<std::size_t>{2});
}

TEST(TouchOutliers, AmongManyTouchesAreFoundByGroups) {
  for (const std::size_t count : {12U, 20U, 40U}) {
    std::mt19937_64 generator(count);
    Case one =
        random_case(rollfix::load_part("gallery:spline,n=9,seed=5,wobble=0.2"), {count, 0, 0, 0.006, 0.02}, generator);
    one.problem.robust = true;
    std::vector<std::size_t> outliers{1, 4, 5};
    for (const std::size_t k : outliers) one.problem.touches[k].at += Vec2(uniform(generator, 0.3, 1), 0.5);
    const TouchAnswer answer = solve(one.problem);
    ASSERT_EQ(answer.poses.size(), 1U) << count;
    EXPECT_EQ(answer.poses.front().outliers, outliers);
    EXPECT_TRUE(in_extent(answer.poses.front(), one.truth));
  }
}

TEST(TouchOutliers, ThatAreMoreThanChanceMakesContradictTheNoise) {
  TouchProblem problem = seven_touches();
  for (const std::size_t k : {0U, 2U, 3U}) problem.touches[k].at += Vec2(1.3, 1.1 * (1.0 + static_cast<double>(k)));
  const TouchAnswer answer = solve(problem);
  EXPECT_TRUE(answer.verdict.fits_badly) << answer.verdict_text();
}

TEST(TouchOutliers, LeaveThePoseOpenWhereTwoTouchesHardlyFitTogether) {
  TouchProblem problem{polygon({{0, 0}, {40, 0}, {40, 20}, {0, 25}}),
                       {{{10, 0}, -0.5 * std::numbers::pi}, {{30, 0.7}, -0.5 * std::numbers::pi}}};
  problem.noise.emplace();
  problem.noise->position = 0.05;
  problem.noise->angle = 0.5 * rollfix::kDegree;
  problem.robust = true;
  const TouchAnswer answer = solve(problem);
  EXPECT_EQ(answer.verdict.name, rollfix::Verdict::unobservable);
  EXPECT_NEAR(answer.outlier[0], 0.5 * answer.anywhere, 0.02);  // one of them as likely as the other, hardly ever both
}

TEST(TouchOutliers, LeaveThePoseOpenWhereNoTwoTouchesFit) {
  TouchProblem problem{polygon({{0, 0}, {40, 0}, {40, 20}, {0, 25}}), {{{20, 0}}, {{400, 0}}}};
  problem.noise.emplace();
  problem.noise->position = 0.05;
  problem.robust = true;
  const TouchAnswer answer = solve(problem);
  EXPECT_EQ(answer.verdict_text(), "unobservable");
  EXPECT_NEAR(answer.anywhere, 1, 1e-9);
}

TEST(TouchOutliers, BesideARollLeaveThePoseToIt) {
  const auto problem = [](Vec2 at) {
    std::mt19937_64 generator(3);
    roll_cases::Rolling rolling;
    rolling.count = 1;
    rolling.contact_sd = rolling.place_sd = 1e-4;
    rolling.angle_sd = 1e-3;
    TouchProblem result = roll_cases::random_rolls(rollfix::load_part("gallery:cam"), rolling, generator).problem;
    result.robust = true;
    result.touches = {{at}};
    return result;
  };
  const TouchAnswer alone = solve(problem({1e3, 0}));
  ASSERT_EQ(alone.poses.front().contacts.size(), 2U);
  EXPECT_GT(alone.outlier[0], 0.999);
  const rollfix::TouchContact& on_part = alone.poses.front().contacts[0];
  const double radius = problem({0, 0}).finger->disk()->radius;
  const Vec2 centre = on_part.point + radius * outward(on_part.tangent);
  EXPECT_LT(solve(problem(alone.poses.front().pose.world(centre))).outlier[0], 0.01);
}

TEST(TouchOutliers, BesideARollLeaveItsPosesToAClearPath) {
  std::mt19937_64 generator(3);
  roll_cases::Rolling rolling;
  rolling.count = 1;
  rolling.length = 0.05;
  rolling.contact_sd = rolling.place_sd = 1e-3;
  rolling.angle_sd = 0.02;
  const Part part = rollfix::load_part("gallery:spline,n=9,seed=4,wobble=0.25");
  TouchProblem problem = roll_cases::random_rolls(part, rolling, generator).problem;
  problem.robust = true;
  problem.touches = {{{1e3, 0}}};
  const TouchAnswer before = solve(problem);
  ASSERT_GT(before.poses.size(), 1U);
  const Vec2 origin(before.poses[0].pose.x, before.poses[0].pose.y);  // it is inside the part
  problem.clear = {{origin, origin}};
  const TouchAnswer answer = solve(problem);
  ASSERT_FALSE(answer.poses.empty());
  for (const TouchPose& pose : answer.poses) EXPECT_GT((Vec2(pose.pose.x, pose.pose.y) - origin).norm(), 0.3);
}

TEST(TouchOutliers, GetNoCertificate) { EXPECT_THROW(certify_touches(solve(seven_touches())), rollfix::InputError); }

}  // namespace touch_outliers_test
