#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "hold_spoilt.hpp"
#include "refusal.hpp"

// Three fingers: those that enter each other, mistakes, outliers, and what is known beforehand.
namespace hold_doubt_test {

using namespace hold_cases;
using rollfix::HoldCause;
using rollfix::HoldDiagnosis;
using rollfix::Verdict;
using testing::HasSubstr;

const Part& wavy() {
  static const Part part = rollfix::load_part("gallery:spline,n=9,seed=4,wobble=0.25");
  return part;
}

/// Three disks that roll over about a tenth of the perimeter, with or without noise.
HoldCase on_wavy(bool centres, double sd = 0, std::vector<Rolled> rolled = {{1.0, 0.1}, {3.0, -0.1}, {5.0, 0.08}}) {
  Holding holding;
  holding.centres = centres;
  holding.contact_sd = holding.place_sd = sd;
  holding.angle_sd = 2 * sd;
  HoldCase one = hold_of(wavy(), rolled, holding);
  if (sd == 0) return one;
  const double size = diagonal(wavy());
  one.problem.noise = rollfix::Noise{.contact = sd * size, .angle = 2 * sd, .position = centres ? sd * size : 0};
  return one;
}

bool is_near(const HoldPlacement& placement, const HoldCase& one) {
  for (std::size_t k = 0; k < one.starts.size(); ++k) {
    if (wavy().distance(placement.contacts[k].start, one.starts[k]) > 0.01 * wavy().perimeter()) return false;
  }
  return true;
}

HoldAnswer with_cause(const HoldCase& one, HoldCause cause) {
  HoldAnswer answer = rollfix::solve(one.problem);
  EXPECT_TRUE(answer.was_diagnosed) << answer.verdict_text();
  if (answer.diagnoses.empty()) {
    ADD_FAILURE() << "nothing is named";
    return answer;
  }
  EXPECT_STREQ(name_of(answer.diagnoses.front().cause), name_of(cause));
  EXPECT_TRUE(is_near(answer.diagnoses.front().placements.front(), one));
  return answer;
}

/// Two of the fingers start half a radius from each other.
HoldCase in_each_other(bool centres, double sd = 0) {
  return on_wavy(centres, sd, {{1.0, 0.05}, {1.05, 0.05}, {4.0, 0.05}});
}

TEST(HoldOverlap, CentresThatAreTooNearAreAContradictionOfTheInput) {
  HoldCase one = in_each_other(true);
  EXPECT_THAT(refusal_of([&] { rollfix::solve(one.problem); }), HasSubstr("fingers a and b are apart"));
  one.problem.may_overlap = true;
  EXPECT_TRUE(is_near(rollfix::solve(one.problem).placements.at(0), one));
}

TEST(HoldOverlap, WithoutCentresPlacesWhereFingersEnterEachOtherAreDroppedAndCounted) {
  HoldCase one = in_each_other(false);
  one.problem.diagnose = false;
  const HoldAnswer answer = rollfix::solve(one.problem);
  EXPECT_GE(answer.overlap, 1U);
  for (const HoldPlacement& placement : answer.placements) EXPECT_FALSE(is_near(placement, one));
  one.problem.may_overlap = true;
  const HoldAnswer allowed = rollfix::solve(one.problem);
  EXPECT_EQ(allowed.overlap, 0U);
  EXPECT_TRUE(std::any_of(allowed.placements.begin(), allowed.placements.end(),
                          [&](const HoldPlacement& placement) { return is_near(placement, one); }));
}

TEST(HoldOverlap, WithNoiseAsWell) {
  HoldCase one = in_each_other(false, 0.001);
  one.problem.diagnose = false;
  EXPECT_GE(rollfix::solve(one.problem).overlap, 1U);
}

TEST(HoldOverlap, FingersThatTouchTheSamePlaceAfterEachOtherAreApart) {
  // b goes where a was: never at the same time.
  const HoldCase one = on_wavy(false, 0, {{1.0, 0.1}, {0.3, 0.1}, {4.0, 0.05}});
  const HoldAnswer answer = rollfix::solve(one.problem);
  EXPECT_TRUE(std::any_of(answer.placements.begin(), answer.placements.end(),
                          [&](const HoldPlacement& placement) { return is_near(placement, one); }));
}

/// Whether the sum of all squares is as large as one of a thousand honest logs has.
bool is_odd_in_all(const HoldAnswer& answer) {
  const double freedom = answer.fit->freedom;
  return answer.fit->chi_square > freedom + 3.1 * std::sqrt(2 * freedom);
}

void expect_noticed_alone(HoldCase one) {
  one.problem.diagnose = false;
  const HoldAnswer answer = rollfix::solve(one.problem);
  EXPECT_FALSE(is_odd_in_all(answer)) << answer.fit->chi_square << " of " << answer.fit->freedom;
  EXPECT_TRUE(answer.is_contradicted());
}

TEST(HoldMisfit, OneMeasurementThatTheSumOfSquaresHidesIsNoticed) {
  HoldCase one = on_wavy(true, 0.002);
  rows_of(one, 1).psi[17] += 0.3;
  expect_noticed_alone(one);
}

TEST(HoldMisfit, ARadiusThatTheSumOfSquaresHidesIsNoticed) {
  HoldCase one = on_wavy(true, 0.002);
  say_radius(one, 1.03, 1);
  expect_noticed_alone(one);
}

TEST(HoldMisfit, HonestRowsHaveNone) {
  HoldCase one = on_wavy(true, 0.002);
  EXPECT_FALSE(rollfix::solve(one.problem).is_contradicted());
}

TEST(SlowHoldMistakes, XForYIsNamed) {
  HoldCase one = on_wavy(true, 0.002);
  for (std::size_t k = 0; k < 3; ++k) std::swap(rows_of(one, k).x, rows_of(one, k).y);
  with_cause(one, HoldCause::x_y_swapped);
}

TEST(SlowHoldMistakes, ADiameterForTheRadiusIsNamed) {
  HoldCase one = on_wavy(false, 0.002);
  say_radius(one, 2);
  const HoldAnswer answer = with_cause(one, HoldCause::radius);
  EXPECT_NEAR(answer.diagnoses.front().factor, 0.5, 0.03);
}

TEST(SlowHoldMistakes, APartFaceDownIsNamedWithoutNoise) {
  HoldCase one = on_wavy(true);
  turn_over(one);
  with_cause(one, HoldCause::mirrored);
}

TEST(SlowHoldMistakes, APriorThatTheRowsContradictIsNamed) {
  HoldCase one = on_wavy(true, 0.002);
  one.problem.prior = rollfix::Prior{2.5, 0.05};
  with_cause(one, HoldCause::prior);
}

TEST(HoldRobust, OutliersDoNotCount) {
  HoldCase one = on_wavy(true, 0.002);
  rows_of(one, 1).psi[20] += 0.4;
  rows_of(one, 0).y[10] += 0.5;
  one.problem.diagnose = false;
  const HoldAnswer plain = rollfix::solve(one.problem);
  EXPECT_TRUE(plain.placements.empty() || plain.verdict.fits_badly);
  one.problem.robust = true;
  const HoldAnswer answer = rollfix::solve(one.problem);
  EXPECT_EQ(answer.verdict_text(), "unique");
  EXPECT_GE(answer.strays, 2U);
  EXPECT_LE(answer.strays, 5U);
  EXPECT_TRUE(is_near(answer.placements.at(0), one));
}

TEST(HoldPrior, TellsTwinsOfASymmetricPartApart) {
  const Part ellipse = rollfix::load_part("gallery:ellipse,a=2,b=1");
  HoldCase one = hold_of(ellipse, {{1.0, 0.06}, {4.0, -0.05}, {7.0, 0.05}}, {.rows = 10});
  one.problem.noise = rollfix::Noise{.contact = 0.005, .angle = 0.005, .position = 0.005};
  ASSERT_EQ(rollfix::solve(one.problem).verdict_text(), "ambiguous (2)");
  one.problem.prior = rollfix::Prior{1.0, 0.5};
  EXPECT_EQ(rollfix::solve(one.problem).verdict_text(), "unique");
  one.problem.prior.reset();
  one.problem.pose = rollfix::PosePrior{one.first, 0.3};
  const HoldAnswer by_heading = rollfix::solve(one.problem);
  EXPECT_EQ(by_heading.verdict_text(), "unique");
  EXPECT_LT(ellipse.distance(by_heading.placements.at(0).contacts[0].start, 1.0), 0.05);
}

TEST(HoldPrior, APoseSharpensWhereThePartIs) {
  HoldCase one = on_wavy(true, 0.002);
  const HoldAnswer without = rollfix::solve(one.problem);
  one.problem.pose = rollfix::PosePrior{one.first, 1e-4, 1e-4};
  const HoldAnswer with = rollfix::solve(one.problem);
  EXPECT_LT(with.placements.at(0).first_spread.covariance(0, 0), 1.1e-8);
  EXPECT_GT(without.placements.at(0).first_spread.covariance(0, 0), 1.1e-8);
}

TEST(HoldPrior, WhatCanNotBeWeighedIsRefused) {
  HoldCase one = on_wavy(false);
  one.problem.robust = true;
  EXPECT_THAT(refusal_of([&] { rollfix::solve(one.problem); }), HasSubstr("expected noise as well"));
  one = on_wavy(false, 0.002);
  one.problem.pose = rollfix::PosePrior{one.first, 0.1, 0.1};
  EXPECT_THAT(refusal_of([&] { rollfix::solve(one.problem); }), HasSubstr("noise with position=SD"));
}

}  // namespace hold_doubt_test
