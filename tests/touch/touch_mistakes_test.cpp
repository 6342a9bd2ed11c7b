#include <gtest/gtest.h>

#include <numbers>

#include "outline/turn.hpp"
#include "refusal.hpp"
#include "touch_cases.hpp"

namespace touch_mistakes_test {

using namespace touch_cases;
using rollfix::TouchCause;
using rollfix::TouchDiagnosis;

/// Six touches of the bracket with normals, 0.05 mm and 1 degree.
TouchProblem honest(double radius = 3, std::size_t normals = 6) {
  std::mt19937_64 generator(3);
  return random_case(bracket(), {6, normals, radius, 0.05, rollfix::kDegree}, generator).problem;
}

const TouchDiagnosis* diagnosis_of(const TouchAnswer& answer, TouchCause cause) {
  for (const TouchDiagnosis& one : answer.diagnoses) {
    if (one.cause == cause) return &one;
  }
  return nullptr;
}

TEST(TouchMistakes, HonestTouchesHaveNone) {
  const TouchAnswer answer = rollfix::solve(honest());
  EXPECT_EQ(answer.verdict_text(), "unique");
  EXPECT_TRUE(answer.diagnoses.empty());
  ASSERT_TRUE(answer.fit.has_value());
  EXPECT_EQ(answer.fit->freedom, 9);
  EXPECT_GT(answer.fit->p, 0.001);
}

TEST(TouchMistakes, InchesForMillimetresAreFound) {
  TouchProblem problem = honest();
  for (MeasuredTouch& touch : problem.touches) touch.at /= 25.4;
  const TouchAnswer answer = rollfix::solve(problem);
  EXPECT_EQ(answer.verdict.name, rollfix::Verdict::inconsistent);
  const TouchDiagnosis* const found = diagnosis_of(answer, TouchCause::unit);
  ASSERT_NE(found, nullptr);
  EXPECT_EQ(found->factor, 25.4);
  EXPECT_EQ(found->unit, "in");
}

TEST(TouchMistakes, OneWrongTouchIsNamed) {
  TouchProblem problem = honest();
  problem.touches[4].at += 2 * Vec2(std::cos(*problem.touches[4].normal), std::sin(*problem.touches[4].normal));
  const TouchAnswer answer = rollfix::solve(problem);
  const TouchDiagnosis* const found = diagnosis_of(answer, TouchCause::outlier);
  ASSERT_NE(found, nullptr);
  EXPECT_EQ(found->touch, 4U);
}

TEST(TouchMistakes, ADiameterForTheRadiusIsFound) {
  TouchProblem problem = honest();
  problem.finger = rollfix::disk(6);
  const TouchAnswer answer = rollfix::solve(problem);
  const TouchDiagnosis* const found = diagnosis_of(answer, TouchCause::radius);
  ASSERT_NE(found, nullptr);
  EXPECT_EQ(found->radius, 3);
}

TEST(TouchMistakes, NormalsIntoThePartAreFound) {
  TouchProblem problem = honest();
  for (MeasuredTouch& touch : problem.touches) touch.normal = *touch.normal + std::numbers::pi;
  const TouchAnswer answer = rollfix::solve(problem);
  EXPECT_NE(diagnosis_of(answer, TouchCause::normals_reversed), nullptr);
}

TEST(TouchMistakes, AFaceDownPartIsFound) {
  TouchProblem problem = honest();
  for (MeasuredTouch& touch : problem.touches) {
    touch.at.x() = -touch.at.x();
    touch.normal = std::numbers::pi - *touch.normal;
  }
  EXPECT_NE(diagnosis_of(rollfix::solve(problem), TouchCause::mirrored), nullptr);
}

TEST(TouchMistakes, ARadiusThatIsTenPercentOffIsFound) {
  TouchProblem problem = honest();
  problem.finger = rollfix::disk(3.3);
  const TouchAnswer answer = rollfix::solve(problem);
  const TouchDiagnosis* const found = diagnosis_of(answer, TouchCause::radius);
  ASSERT_NE(found, nullptr);
  EXPECT_NEAR(found->radius, 3, 0.1);
  EXPECT_EQ(found->fit.freedom, 8);  // one less: the radius was fitted
}

TEST(TouchMistakes, AFingerThatWasForgottenIsFound) {
  TouchProblem problem = honest();
  problem.finger.reset();
  const TouchAnswer answer = rollfix::solve(problem);
  const TouchDiagnosis* const found = diagnosis_of(answer, TouchCause::radius);
  ASSERT_NE(found, nullptr);
  EXPECT_NEAR(found->radius, 3, 0.15);
}

TEST(TouchMistakes, SwappedCoordinatesAreFound) {
  TouchProblem problem = honest();
  for (MeasuredTouch& touch : problem.touches) std::swap(touch.at.x(), touch.at.y());
  EXPECT_NE(diagnosis_of(rollfix::solve(problem), TouchCause::swapped), nullptr);
  TouchProblem places = honest(3, 0);
  for (MeasuredTouch& touch : places.touches) std::swap(touch.at.x(), touch.at.y());
  EXPECT_NE(diagnosis_of(rollfix::solve(places), TouchCause::mirrored), nullptr);
}

TEST(TouchMistakes, AHeadingThatTheTouchesContradictIsTold) {
  TouchProblem problem = honest();
  const TouchAnswer right = rollfix::solve(problem);
  problem.pose.emplace();
  problem.pose->mean.heading = right.poses.front().pose.heading + 1;
  problem.pose->heading_sd = rollfix::kDegree;
  const TouchAnswer answer = rollfix::solve(problem);
  const TouchDiagnosis* const found = diagnosis_of(answer, TouchCause::pose);
  ASSERT_NE(found, nullptr);
  EXPECT_NEAR(found->pose.heading, right.poses.front().pose.heading, 1e-6);
}

TEST(TouchMistakes, TheLeftSideOfAnOpenOutlineIsFound) {
  std::mt19937_64 generator(5);
  const Part part = rollfix::load_part("gallery:log-spiral");
  TouchProblem problem =
      random_case(part, {5, 5, 0.02 * diagonal(part), 0.001 * diagonal(part), rollfix::kDegree}, generator).problem;
  EXPECT_TRUE(rollfix::solve(problem).diagnoses.empty());
  problem.part = Part(rollfix::reversed(part.outline()));
  EXPECT_NE(diagnosis_of(rollfix::solve(problem), TouchCause::other_side), nullptr);
}

TEST(TouchMistakes, NoiseThatIsLargerThanSaidIsTold) {
  TouchProblem problem = honest(3, 0);
  problem.noise->position = 0.05 / 2.5;
  const TouchAnswer answer = rollfix::solve(problem);
  EXPECT_TRUE(answer.verdict.fits_badly || answer.poses.empty());
  const TouchDiagnosis* const found = diagnosis_of(answer, TouchCause::noise);
  ASSERT_NE(found, nullptr);
  EXPECT_GT(found->factor, 1.2);
  EXPECT_LT(found->factor, 6);
}

TEST(TouchRefusals, SayWhatIsWrongAndWhatToGive) {
  const auto refused = [](const auto& change) {
    TouchProblem problem = honest();
    change(problem);
    return refusal_of([&] { rollfix::solve(problem); });
  };
  EXPECT_EQ(refused([](TouchProblem& problem) { problem.touches.clear(); }),
            "touches: expected at least one, found none");
  EXPECT_EQ(refused([](TouchProblem& problem) { problem.finger = rollfix::jaw(); }),
            "touches: expected a round finger, disk,r=R, or none for a point, found jaw");
  EXPECT_EQ(refused([](TouchProblem& problem) { problem.noise.reset(); }),
            "touches: expected how exact they are, found neither `noise` nor `tolerance`; standard "
            "deviations are given with `noise` position=0.05,angle=1deg");
  EXPECT_EQ(refused([](TouchProblem& problem) { problem.noise->position = 0; }),
            "touches: touch 1: expected a standard deviation above 0 of its place, found 0; give `noise` with "
            "position=SD");
  EXPECT_EQ(refused([](TouchProblem& problem) { problem.noise->slip = 0.01; }),
            "noise of touches is position and angle, found slip=0.01; leave it out");
  EXPECT_EQ(refused([](TouchProblem& problem) { problem.touches[1].at.x() = NAN; }).substr(0, 33),
            "touches: touch 2: expected a plac");
  EXPECT_EQ(refused([](TouchProblem& problem) { problem.touches[1].normal = 90; }),
            "touches: touch 2: expected a normal in radians, found 90; degrees are written 90deg");
}

}  // namespace touch_mistakes_test
