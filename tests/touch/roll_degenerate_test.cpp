#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "random.hpp"
#include "refusal.hpp"
#include "roll_cases.hpp"
#include "rollfix/solve.hpp"

// Several rolls where the part, the rolls or their logs are special.
namespace roll_degenerate_test {

using namespace roll_cases;
using rollfix::Verdict;

RollCase case_on(const Part& part, const std::vector<double>& starts, double length, const Rolling& rolling = {}) {
  std::mt19937_64 generator = test_generator(71);
  RollCase result{{part, {}}, {1, 2, 0.4}, starts, {}};
  const double size = diagonal(part);
  const double radius = rolling.radius * size;
  for (const double s : starts) {
    const auto roll = has_corners(part) ? pivoting_log : roll_log;
    result.problem.rolls.push_back(roll(part, result.truth, s, length, radius, rolling, size, generator));
    result.lengths.push_back(length);
  }
  result.problem.finger = rollfix::disk(radius);
  return result;
}

bool holds(const TouchAnswer& answer, const RollCase& one, double slack) {
  return std::any_of(answer.poses.begin(), answer.poses.end(), [&](const TouchPose& pose) {
    bool all = holds_heading(pose.extent[2], one.truth.heading, slack);
    for (std::size_t k = 0; k < one.starts.size(); ++k) {
      all = all && one.problem.part.boundary().contains(*pose.contacts[k].extent, one.starts[k],
                                                        slack * one.problem.part.perimeter());
    }
    return all;
  });
}

TEST(RollsOnSpecialParts, OnACircleAnyHeadingFits) {
  const RollCase one = case_on(rollfix::load_part("gallery:circle,r=2"), {1, 6}, 1.5);
  const TouchAnswer answer = rollfix::solve(one.problem);
  EXPECT_EQ(answer.verdict.name, Verdict::unobservable);
  ASSERT_EQ(answer.poses.size(), 1U);
  EXPECT_TRUE(answer.poses.front().any_heading);
  EXPECT_NEAR(answer.poses.front().pose.x, one.truth.x, 1e-3);
  EXPECT_NEAR(answer.poses.front().pose.y, one.truth.y, 1e-3);
}

TEST(RollsOnSpecialParts, OnAnEllipseTwoPosesAreLeft) {
  const RollCase one = case_on(rollfix::load_part("gallery:ellipse,a=3,b=2"), {1, 6}, 1.5);
  const TouchAnswer answer = rollfix::solve(one.problem);
  EXPECT_EQ(answer.verdict_text(), "ambiguous (2)");
  EXPECT_TRUE(holds(answer, one, 1e-6));
}

TEST(RollsOnSpecialParts, OnOneSideOfAPolygonThePartIsFreeToSlide) {
  const RollCase one = case_on(bracket(), {10, 40}, 8);
  const TouchAnswer answer = rollfix::solve(one.problem);
  EXPECT_EQ(answer.verdict.name, Verdict::ambiguous);
  EXPECT_GE(answer.verdict.stretches, 1U);
  EXPECT_TRUE(holds(answer, one, 1e-6));
}

TEST(RollsOnSpecialParts, OnTwoSidesOfAPolygonWithCentresThePoseIsKnown) {
  const RollCase one = case_on(bracket(), {10, 65}, 8);
  const TouchAnswer answer = rollfix::solve(one.problem);
  EXPECT_TRUE(holds(answer, one, 1e-6));
  for (const TouchPose& pose : answer.poses) EXPECT_FALSE(pose.continuum);
}

TEST(RollsOnSpecialParts, CentresThatAreWholeNumbersInOneColumnAreNoLessExact) {
  RollCase one = case_on(bracket(), {10, 65}, 8);
  rollfix::FingerRows& rows = one.problem.rolls.front().fingers.front();
  for (double& y : rows.y) y = 3;
  EXPECT_LE(rollfix::solve(one.problem).tolerance.front().length, 0.01);
}

TEST(RollsOnSpecialParts, ARollMayStartAtACornerAndEndPastAnother) {
  const RollCase one = case_on(bracket(), {0, 60}, 18.5);
  const TouchAnswer answer = rollfix::solve(one.problem);
  EXPECT_EQ(answer.status, rollfix::Status::complete);
  EXPECT_TRUE(holds(answer, one, 1e-6));
}

TEST(RollsOnSpecialParts, RollsMayBeLongerThanThePerimeter) {
  const Part part = rollfix::load_part("gallery:limacon");
  Rolling rolling;
  rolling.rows = 400;
  const RollCase one = case_on(part, {1, 4}, 1.3 * part.perimeter(), rolling);
  const TouchAnswer answer = rollfix::solve(one.problem);
  EXPECT_EQ(answer.verdict_text(), "unique");
  EXPECT_TRUE(holds(answer, one, 1e-6));
}

TEST(RollsOnSpecialParts, ARollOfLengthZeroIsATouchWithANormal) {
  const Part part = rollfix::load_part("gallery:spline,n=9,wobble=0.25,seed=3");
  RollCase one = case_on(part, {1, 3}, 0);
  one.problem.tolerance = {1e-3, 1e-3};
  RollCase touched = one;
  touched.problem.rolls.clear();
  for (const Log& log : one.problem.rolls) {
    const rollfix::FingerRows& rows = log.fingers.front();
    MeasuredTouch touch;
    touch.at = {rows.x.front(), rows.y.front()};
    touch.normal = rows.u.front() + rows.psi.front() + std::numbers::pi;
    touched.problem.touches.push_back(touch);
  }
  touched.problem.tolerance = {1e-3, 5e-4};  // of rolls: of one heading from another
  const TouchAnswer of_rolls = rollfix::solve(one.problem);
  const TouchAnswer of_touches = rollfix::solve(touched.problem);
  ASSERT_EQ(of_rolls.poses.size(), of_touches.poses.size());
  for (std::size_t k = 0; k < of_rolls.poses.size(); ++k) {
    const double off = apart(of_rolls.poses[k].pose, of_touches.poses[k].pose, part.point(0), diagonal(part));
    EXPECT_LE(off, 0.02 * diagonal(part));
  }
}

TEST(RollsOnSpecialParts, AnOpenOutlineIsRolledAsWell) {
  const Part part = rollfix::load_part("gallery:log-spiral");
  const double P = part.perimeter();
  const RollCase one = case_on(part, {0.2 * P, 0.6 * P}, 0.1 * P);
  const TouchAnswer answer = rollfix::solve(one.problem);
  EXPECT_EQ(answer.status, rollfix::Status::complete);
  EXPECT_TRUE(holds(answer, one, 1e-6));
}

TEST(RollsOnSpecialParts, APartThatLiesFaceDownIsFoundWithMirrored) {
  const Part part = rollfix::load_part("gallery:cam");
  RollCase one = case_on(part, {1, 4}, 0.9);
  for (Log& log : one.problem.rolls) {  // as a mirror shows them
    rollfix::FingerRows& rows = log.fingers.front();
    for (double& u : rows.u) u = -u;
    for (double& psi : rows.psi) psi = std::numbers::pi - psi;
    for (double& x : rows.x) x = -x;
  }
  one.problem.mirrored = true;
  const TouchAnswer answer = rollfix::solve(one.problem);
  EXPECT_EQ(answer.verdict_text(), "unique");
  EXPECT_NEAR(answer.poses.front().pose.x, -one.truth.x, 1e-6);
  EXPECT_NEAR(answer.poses.front().pose.y, one.truth.y, 1e-6);
  EXPECT_NEAR(answer.poses.front().pose.heading, -one.truth.heading, 1e-6);
}

TEST(RollsOnSpecialParts, OneRollIsWhatTheProblemOfARollSays) {
  const Part part = rollfix::load_part("gallery:limacon");
  const RollCase one = case_on(part, {1}, 1.1);
  const TouchAnswer poses = rollfix::solve(one.problem);
  const rollfix::Answer roll = rollfix::solve(rollfix::Problem{part, one.problem.rolls.front(), {*one.problem.finger}});
  EXPECT_EQ(poses.verdict, roll.verdict);
  const auto agreeing = std::count_if(roll.placements.begin(), roll.placements.end(),
                                      [](const auto& placement) { return !placement.is_contradicted; });
  ASSERT_EQ(poses.poses.size(), static_cast<std::size_t>(agreeing));
  EXPECT_EQ(poses.poses.front().contacts.front().s, roll.placements.front().start[0]);
  EXPECT_EQ(poses.poses.front().pose.heading, roll.placements.front().pose.front().heading);
}

TEST(RollsOnSpecialParts, WithoutCentresOnlyTheHeadingIsKnown) {
  Rolling rolling;
  rolling.centres = false;
  const RollCase one = case_on(rollfix::load_part("gallery:cam"), {1, 4}, 0.9, rolling);
  const TouchAnswer answer = rollfix::solve(one.problem);
  EXPECT_EQ(answer.place, rollfix::PlaceKnown::unknown);
  ASSERT_EQ(answer.poses.size(), 1U);
  EXPECT_TRUE(std::isnan(answer.poses.front().pose.x));
  EXPECT_NEAR(answer.poses.front().pose.heading, one.truth.heading, 1e-6);
}

TEST(RollsOnSpecialParts, CentresWithoutNoiseOfPositionAreAReferenceAlone) {
  Rolling rolling;
  rolling.contact_sd = 0.001;
  rolling.angle_sd = 0.002;
  RollCase one = case_on(rollfix::load_part("gallery:cam"), {1, 4}, 0.9, rolling);
  one.problem.noise = rollfix::Noise{};
  one.problem.noise->contact = 0.001 * diagonal(one.problem.part);
  one.problem.noise->angle = 0.002;
  const TouchAnswer answer = rollfix::solve(one.problem);
  EXPECT_EQ(answer.place, rollfix::PlaceKnown::reference);
  ASSERT_FALSE(answer.poses.empty());
  EXPECT_TRUE(answer.poses.front().interval[0].contains(one.truth.x));
}

TEST(RollsOnSpecialParts, LogsOfLengthsAndTurnsAreRefused) {
  RollCase one = case_on(rollfix::load_part("gallery:cam"), {1, 4}, 0.9);
  one.problem.rolls.front().kind = rollfix::LogKind::travelled;
  EXPECT_THAT(refusal_of([&] { rollfix::solve(one.problem); }),
              testing::HasSubstr("roll 1: expected columns u and psi"));
}

TEST(RollsOnSpecialParts, RollsNeedAFinger) {
  RollCase one = case_on(rollfix::load_part("gallery:cam"), {1, 4}, 0.9);
  one.problem.finger.reset();
  EXPECT_THAT(refusal_of([&] { rollfix::solve(one.problem); }), testing::HasSubstr("expected the finger"));
}

}  // namespace roll_degenerate_test
