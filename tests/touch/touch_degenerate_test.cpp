#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "outline/turn.hpp"
#include "rollfix/curve.hpp"
#include "rollfix/touch.hpp"
#include "touch_cases.hpp"

namespace touch_degenerate_test {

using namespace touch_cases;
using rollfix::kDegree;
using rollfix::Verdict;

constexpr double kPi = std::numbers::pi;

/// A probe's ball at these places of the boundary while the part lies in this pose; without noise.
TouchProblem exact_problem(const Part& part, const Pose& pose, const std::vector<double>& places, double radius,
                           bool normals = false) {
  TouchProblem problem{part, {}};
  for (const double s : places) {
    MeasuredTouch touch;
    touch.at = Vec2(pose.x, pose.y) + pose.turned(part.point(s) + radius * outward(part.tangent(s)));
    if (normals) touch.normal = part.tangent(s) + pose.heading - 0.5 * kPi;
    problem.touches.push_back(touch);
  }
  if (radius > 0) problem.finger = rollfix::disk(radius);
  rollfix::Noise noise;
  noise.position = 1e-3 * diagonal(part);
  noise.angle = kDegree;
  problem.noise = noise;
  return problem;
}

TouchAnswer exact_answer(const Part& part, const Pose& pose, const std::vector<double>& places, double radius,
                         bool normals = false) {
  return rollfix::solve(exact_problem(part, pose, places, radius, normals));
}

bool is_listed(const TouchAnswer& answer, const Pose& truth, double slack) {
  return std::any_of(answer.poses.begin(), answer.poses.end(), [&](const TouchPose& pose) {
    return std::hypot(pose.pose.x - truth.x, pose.pose.y - truth.y) < slack &&
           std::abs(rollfix::nearest_angle(pose.pose.heading - truth.heading)) < slack / diagonal(answer.part);
  });
}

TEST(TouchDegenerate, ACircleHasAnyHeadingAndAKnownCentre) {
  const Part circle = rollfix::load_part("gallery:circle,r=10");
  const TouchAnswer answer = exact_answer(circle, {50, 20, 0.7}, {0, 20, 40, 55}, 3);
  EXPECT_EQ(answer.verdict.name, Verdict::unobservable);
  ASSERT_EQ(answer.poses.size(), 1U);
  EXPECT_TRUE(answer.poses[0].any_heading);
  EXPECT_NEAR(answer.poses[0].spread.mean.x, 50, 0.02);
  EXPECT_NEAR(answer.poses[0].spread.mean.y, 20, 0.02);
  EXPECT_GT(answer.poses[0].interval[2].width(), 0.9 * 2 * kPi);
  EXPECT_LT(answer.poses[0].interval[0].width(), 0.2);
}

TEST(TouchDegenerate, ASlotLiesEitherWayRound) {
  const Part slot = rollfix::load_part("gallery:stadium");
  const double P = slot.perimeter();
  const Pose truth{4, -7, 0.5};
  const TouchAnswer answer = exact_answer(slot, truth, {0.03 * P, 0.2 * P, 0.33 * P, 0.55 * P, 0.8 * P}, 0);
  EXPECT_EQ(answer.verdict.name, Verdict::ambiguous);
  ASSERT_EQ(answer.poses.size(), 2U);
  EXPECT_NEAR(answer.poses[0].probability, 0.5, 1e-3);
  EXPECT_NEAR(std::abs(rollfix::nearest_angle(answer.poses[0].pose.heading - answer.poses[1].pose.heading)), kPi, 1e-6);
  EXPECT_TRUE(is_listed(answer, truth, 0.01));
}

TEST(TouchDegenerate, TouchesOnTwoParallelSidesLetThePartSlideToTheSidesEnds) {
  const Part plate = polygon({{0, 0}, {60, 0}, {60, 20}, {0, 20}});
  const TouchAnswer answer = exact_answer(plate, {0, 0, 0}, {25, 35, 105, 115}, 0, true);
  ASSERT_EQ(answer.poses.size(), 2U);  // and upside down
  EXPECT_EQ(answer.verdict.name, Verdict::ambiguous);
  EXPECT_EQ(answer.verdict.stretches, 2U);
  const TouchPose& pose = answer.poses[std::abs(answer.poses[0].pose.heading) < 0.1 ? 0 : 1];
  EXPECT_TRUE(pose.continuum);
  // x from 25 to 35 of the world is on the side: the part's left end is at most at 25, its right end at least at 35.
  EXPECT_NEAR(pose.interval[0].lo, -25 + 0.025 * 50, 0.5);
  EXPECT_NEAR(pose.interval[0].hi, 25 - 0.025 * 50, 0.5);
  EXPECT_NEAR(std::sqrt(pose.spread.covariance(0, 0)), 50 / std::sqrt(12.0), 0.5);
  EXPECT_LT(pose.interval[1].width(), 1);  // as the heading is known
}

/// As exact as a measurement can be: a continuum has far too many of the finest cells.
TouchAnswer nearly_exact_answer(const Part& part, const Pose& pose, const std::vector<double>& places, double radius) {
  TouchProblem problem = exact_problem(part, pose, places, radius, true);
  problem.noise.reset();
  problem.tolerance = rollfix::TouchTolerance{1e-5, 1e-6};
  problem.budget = 3000000;
  return rollfix::solve(problem);
}

/// All of its poses slide along this line, by so much: no less, and hardly more.
void expect_slides(const TouchAnswer& answer, double direction, double length) {
  EXPECT_EQ(answer.status, rollfix::Status::complete);
  for (const TouchPose& pose : answer.poses) {
    const std::optional<rollfix::Slide> slide = rollfix::slide_of(answer, pose);
    ASSERT_TRUE(slide.has_value());
    EXPECT_NEAR(slide->direction, direction, 1e-5);
    EXPECT_GE(slide->length, length - 1e-5);
    EXPECT_LE(slide->length, 1.01 * length);
  }
}

TEST(TouchDegenerate, NearlyExactTouchesOnTwoParallelSidesLeaveStretchesToTheSidesEnds) {
  const Part plate = polygon({{0, 0}, {60, 0}, {50, 20}, {0, 20}});
  const double top = 60 + std::hypot(10, 20);
  // Of the world's x, before it is turned: 20 and 35 are on the lower side, 60 long, 30 and 45 on the upper one, 50
  // long.
  const TouchAnswer answer = nearly_exact_answer(plate, {5, -3, 0.4}, {20, 35, top + 50 - 45, top + 50 - 30}, 2);
  EXPECT_EQ(answer.verdict_text(), "ambiguous (2, of them 2 stretches)");  // it may be upside down
  expect_slides(answer, 0.4, 20 + 50 - 45);
}

TEST(TouchDegenerate, NearlyExactTouchesOnOneSideLeaveAStretchToItsEnds) {
  const Part wedge = polygon({{0, 0}, {60, 0}, {20, 15}});  // its other sides are shorter than the touches are apart
  const TouchAnswer answer = nearly_exact_answer(wedge, {5, -3, -0.7}, {8, 52}, 0);
  EXPECT_EQ(answer.verdict_text(), "ambiguous (1 stretch)");
  expect_slides(answer, -0.7, 8 + 60 - 52);
}

TEST(TouchDegenerate, OneTouchWithANormalLeavesTheWholeBoundary) {
  const TouchAnswer answer = exact_answer(bracket(), {0, 0, 0}, {10}, 0, true);
  EXPECT_EQ(answer.verdict.name, Verdict::unobservable);
  EXPECT_EQ(answer.status, rollfix::Status::complete);
  EXPECT_TRUE(answer.poses.empty());
}

TEST(TouchDegenerate, ManyTouchesAtOnePlaceSayWhatOneSays) {
  TouchProblem problem{bracket(), std::vector<MeasuredTouch>(40, {{10, 3}}), rollfix::disk(3)};
  problem.noise.emplace();
  problem.noise->position = 0.02;
  const TouchAnswer answer = rollfix::solve(problem);
  EXPECT_EQ(answer.verdict.name, rollfix::Verdict::unobservable);
  EXPECT_TRUE(answer.poses.empty());
}

TEST(TouchDegenerate, TwoPlacesLeaveACurveOfPoses) {
  const TouchAnswer answer = exact_answer(bracket(), {0, 0, 0}, {10, 90}, 0);
  EXPECT_EQ(answer.verdict.name, Verdict::ambiguous);
  EXPECT_GE(answer.verdict.stretches, 1U);
  const auto holds = [](const TouchPose& pose) { return in_extent(pose, Pose{}); };
  EXPECT_TRUE(std::any_of(answer.poses.begin(), answer.poses.end(), holds));
}

TEST(TouchDegenerate, TwoTouchesOfACircleThatAreNearlyExactLeaveTwoCentresWithinTheBudget) {
  const Part circle = rollfix::load_part("gallery:circle,r=10");
  TouchProblem problem = exact_problem(circle, {50, 20, 0.7}, {3, 21}, 0);
  problem.noise.reset();
  problem.tolerance = rollfix::TouchTolerance{2e-4, 0.1};
  problem.budget = 300000;  // finer cells would take more
  const TouchAnswer answer = rollfix::solve(problem);
  EXPECT_EQ(answer.status, rollfix::Status::complete);
  ASSERT_EQ(answer.poses.size(), 2U);
  EXPECT_TRUE(answer.poses[0].any_heading && answer.poses[1].any_heading);
  const Vec2 chord = problem.touches[1].at - problem.touches[0].at;
  const Vec2 other = Vec2(50, 20) + 2 * (problem.touches[0].at - Vec2(50, 20)) + chord;  // across the chord
  EXPECT_TRUE(is_listed(answer, {50, 20, answer.poses[0].pose.heading}, 1e-3) ||
              is_listed(answer, {50, 20, answer.poses[1].pose.heading}, 1e-3));
  EXPECT_TRUE(is_listed(answer, {other.x(), other.y(), answer.poses[0].pose.heading}, 1e-3) ||
              is_listed(answer, {other.x(), other.y(), answer.poses[1].pose.heading}, 1e-3));
}

TEST(TouchDegenerate, ABallOnACornerIsFoundOnItsArc) {
  const Part part = bracket();
  const Pose truth{5, 6, 1.2};
  TouchProblem problem = exact_problem(part, truth, {30, 70, 100, 150}, 4);
  const Vec2 corner = part.point(60) + 4 * Vec2(std::cos(-0.3), std::sin(-0.3));  // between the two sides' normals
  problem.touches.push_back({Vec2(truth.x, truth.y) + truth.turned(corner)});
  const TouchAnswer answer = rollfix::solve(problem);
  ASSERT_TRUE(is_listed(answer, truth, 0.1));
  EXPECT_EQ(answer.verdict.name, Verdict::unique);
  EXPECT_NEAR(answer.poses[0].contacts.back().s, 60, 1e-6);
  EXPECT_NEAR(answer.poses[0].contacts.back().tangent, kPi / 2 - 0.3, 0.1);
}

TEST(TouchDegenerate, APointOnACornerWithANormalOfItsConeIsFound) {
  const Part part = bracket();
  const Pose truth{5, 6, 1.2};
  TouchProblem problem = exact_problem(part, truth, {30, 70, 150}, 0, true);
  problem.touches.push_back({Vec2(truth.x, truth.y) + truth.turned(part.point(60)), truth.heading - kPi / 4});
  const TouchAnswer answer = rollfix::solve(problem);
  EXPECT_TRUE(is_listed(answer, truth, 0.1));
  EXPECT_EQ(answer.verdict.name, Verdict::unique);
}

TEST(TouchDegenerate, TwoPointsOnTwoCornersAreFound) {
  const Part part = bracket();
  const Pose truth{5, 6, 1.2};
  TouchProblem problem = exact_problem(part, truth, {30, 150}, 0);
  for (const double s : {60.0, 78.0}) {
    problem.touches.push_back({Vec2(truth.x, truth.y) + truth.turned(part.point(s))});
  }
  const TouchAnswer answer = rollfix::solve(problem);
  const auto holds = [&](const TouchPose& pose) { return in_extent(pose, truth); };
  EXPECT_TRUE(std::any_of(answer.poses.begin(), answer.poses.end(), holds));
}

TEST(TouchDegenerate, TouchesAtOnePlaceSayNoMoreThanOne) {
  const TouchProblem problem = exact_problem(bracket(), {0, 0, 0}, {10, 10, 10}, 0, true);
  const TouchAnswer answer = rollfix::solve(problem);
  EXPECT_EQ(answer.status, rollfix::Status::complete);
  EXPECT_TRUE(answer.verdict.name == Verdict::unobservable || answer.verdict.stretches > 0) << answer.verdict_text();
  for (const double heading : {-2.0, 0.0, 1.0, 3.0}) {
    const auto holds = [&](const TouchPose& pose) { return holds_heading(pose.extent[2], heading); };
    EXPECT_TRUE(std::any_of(answer.poses.begin(), answer.poses.end(), holds)) << heading;
  }
}

TEST(TouchDegenerate, AnOpenOutlineIsAWallThatIsTouchedFromTheRight) {
  rollfix::Outline outline;
  outline.closed = false;
  outline.curves.emplace_back(rollfix::Line({0, 0}, {50, 0}));
  outline.curves.emplace_back(rollfix::Line({50, 0}, {60, 30}));
  outline.curves.emplace_back(rollfix::Line({60, 30}, {30, 60}));
  const Part wall(outline);
  const Pose truth{-3, 8, -0.4};
  const TouchAnswer answer = exact_answer(wall, truth, {5, 30, 60, 75, 100, 120}, 2);
  EXPECT_TRUE(is_listed(answer, truth, 0.1));
  EXPECT_EQ(answer.verdict.name, Verdict::unique);
}

TEST(TouchDegenerate, AHoleIsTouchedFromInside) {
  rollfix::Outline outline = rollfix::load_part("gallery:ellipse,a=30,b=20").outline();
  outline.hole = true;
  const Part hole(outline);
  const Pose truth{12, 5, 0.3};
  const double P = hole.perimeter();
  const TouchAnswer answer = exact_answer(hole, truth, {0.05 * P, 0.3 * P, 0.5 * P, 0.62 * P, 0.9 * P}, 3);
  EXPECT_EQ(answer.poses.size(), 2U);  // an ellipse is twofold
  EXPECT_TRUE(is_listed(answer, truth, 0.1));
}

TEST(TouchDegenerate, WhereADiskCannotGoItIsNot) {
  // In the inner corner of the L at (25, 18) a ball of radius 6 touches both sides at once and no other place between.
  const Part part = bracket();
  const TouchAnswer answer = exact_answer(part, {0, 0, 0}, {10, 30, 70, 84, 130, 160}, 6);
  for (const TouchPose& pose : answer.poses) {
    for (std::size_t k = 0; k < pose.contacts.size(); ++k) {
      const Vec2 centre = pose.contacts[k].point + 6 * outward(pose.contacts[k].tangent);
      for (const Vec2& point : dense(part)) EXPECT_GT((point - centre).norm(), 6 - 1e-3);
    }
  }
}

TEST(TouchDegenerate, AFaceDownPartIsFoundInTheMirror) {
  const Part part = bracket();
  TouchProblem problem = exact_problem(part, {5, 6, 1.2}, {10, 30, 70, 100, 150}, 2, true);
  for (MeasuredTouch& touch : problem.touches) {
    touch.at.x() = -touch.at.x();
    touch.normal = kPi - *touch.normal;
  }
  EXPECT_TRUE(rollfix::solve(problem).poses.empty());
  problem.mirrored = true;
  const TouchAnswer answer = rollfix::solve(problem);
  EXPECT_EQ(answer.verdict.name, Verdict::unique);
  EXPECT_TRUE(is_listed(answer, {-5, 6, -1.2}, 0.1));
}

TEST(TouchDegenerate, ABudgetThatRunsOutIsTold) {
  TouchProblem problem = exact_problem(bracket(), {0, 0, 0}, {10, 30, 90, 140}, 0);
  problem.budget = 500;
  const TouchAnswer answer = rollfix::solve(problem);
  EXPECT_EQ(answer.status, rollfix::Status::incomplete);
  EXPECT_EQ(answer.verdict.name, Verdict::undecided);
  EXPECT_FALSE(answer.unresolved.empty());
}

TEST(TouchDegenerate, APriorChoosesAmongPosesThatFitAlike) {
  const Part plate = polygon({{0, 0}, {60, 0}, {60, 20}, {0, 20}});
  TouchProblem problem = exact_problem(plate, {0, 0, 0}, {10, 40, 70, 105, 150}, 2);
  EXPECT_EQ(rollfix::solve(problem).verdict.name, Verdict::ambiguous);
  problem.pose = rollfix::PosePrior{{0, 0, kPi}, 5 * kDegree};
  const TouchAnswer answer = rollfix::solve(problem);
  EXPECT_EQ(answer.verdict.name, Verdict::unique);
  EXPECT_NEAR(std::abs(answer.poses[0].pose.heading), kPi, 0.01);
}

}  // namespace touch_degenerate_test
