#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "hold_cases.hpp"
#include "noisy_holds.hpp"
#include "random.hpp"
#include "refusal.hpp"

// Three and more fingers that roll on a part that moves.
namespace hold_test {

using namespace hold_cases;
using rollfix::Status;
using rollfix::Verdict;
using testing::HasSubstr;

const Part& wavy() {
  static const Part part = rollfix::load_part("gallery:spline,n=9,seed=4,wobble=0.25");
  return part;
}

HoldCase on_wavy(bool centres = true) {
  Holding holding;
  holding.centres = centres;
  return hold_of(wavy(), {{1.0, 0.08}, {3.0, -0.06}, {5.0, 0.05}}, holding);
}

bool any_holds(const HoldAnswer& answer, const HoldCase& one) {
  return std::any_of(answer.placements.begin(), answer.placements.end(), [&](const HoldPlacement& placement) {
    return holds(placement, one, 1e-9 * one.problem.part.perimeter());
  });
}

void expect_found(const HoldCase& one) {
  const HoldAnswer answer = rollfix::solve(one.problem);
  EXPECT_EQ(answer.status, Status::complete);
  EXPECT_TRUE(any_holds(answer, one)) << answer.verdict_text();
}

double apart_in_heading(const Pose& one, const Pose& other) {
  return std::abs(rollfix::nearest_angle(one.heading - other.heading));
}

TEST(Hold, ThreeFingersWithCentresSayWhereTheyAreAndHowThePartMoved) {
  const HoldCase one = on_wavy();
  const HoldAnswer answer = rollfix::solve(one.problem);
  ASSERT_EQ(answer.verdict_text(), "unique");
  const HoldPlacement& found = answer.placements.front();
  EXPECT_LT(nearest_miss(answer, one), 1e-7);
  EXPECT_LT(std::hypot(found.first.x - one.first.x, found.first.y - one.first.y), 1e-6);
  EXPECT_LT(apart_in_heading(found.first, one.first), 1e-6);
  EXPECT_LT(std::hypot(found.last.x - one.last.x, found.last.y - one.last.y), 1e-6);
  EXPECT_LT(apart_in_heading(found.last, one.last), 1e-6);
}

TEST(Hold, WithoutCentresThePlacesAndTheHeadingAreKnown) {
  const HoldCase one = on_wavy(false);
  const HoldAnswer answer = rollfix::solve(one.problem);
  ASSERT_EQ(answer.verdict_text(), "unique");
  EXPECT_EQ(answer.place, rollfix::PlaceKnown::unknown);
  EXPECT_LT(nearest_miss(answer, one), 1e-7);
  EXPECT_LT(apart_in_heading(answer.placements.front().last, one.last), 1e-6);
}

TEST(Hold, EndsAreWhereTheContactsAreAtTheLastRow) {
  const HoldCase one = on_wavy();
  const HoldAnswer answer = rollfix::solve(one.problem);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_LT(wavy().distance(answer.placements.at(0).contacts[k].end, one.ends[k]), 1e-7);
  }
}

TEST(Hold, AFingerThatPivotsAtACornerStaysThere) {
  // The first one starts before the corner at s = 60 and ends behind it, the second ends in its pivot at 0.
  const HoldCase one = hold_of(bracket(), {{55, 0.06}, {8.5, -0.05}, {145, 0.03}});
  ASSERT_GT(one.ends[0], 60);
  ASSERT_NEAR(one.ends[1], 0, 1e-9);
  expect_found(one);
}

TEST(Hold, FingersMayStartAtACorner) { expect_found(hold_of(bracket(), {{60, 0.05}, {30, -0.03}, {145, 0.03}})); }

TEST(Hold, OnACircleOnlyTheDistancesOfTheFingersAreKnown) {
  const Part circle = rollfix::load_part("gallery:circle,r=1");
  const HoldCase one = hold_of(circle, {{1.0, 0.02}, {3.0, -0.02}, {5.0, 0.02}}, {.rows = 8});
  const HoldAnswer answer = rollfix::solve(one.problem);
  EXPECT_EQ(answer.verdict.name, Verdict::unobservable);
  ASSERT_EQ(answer.placements.size(), 1U);
  EXPECT_TRUE(answer.placements[0].continuum);
  EXPECT_NEAR(circle.boundary().ahead(answer.placements[0].contacts[0].start, answer.placements[0].contacts[1].start),
              2, 1e-6);
}

TEST(Hold, OnAnEllipseEachPlaceHasATwin) {
  const Part ellipse = rollfix::load_part("gallery:ellipse,a=2,b=1");
  const HoldCase one = hold_of(ellipse, {{1.0, 0.04}, {4.0, -0.03}, {7.0, 0.03}}, {.rows = 8});
  const HoldAnswer answer = rollfix::solve(one.problem);
  EXPECT_EQ(answer.verdict_text(), "ambiguous (2)");
  EXPECT_TRUE(any_holds(answer, one));
}

TEST(Hold, AnOpenOutlineIsRolledOnFromItsRight) {
  const Part spiral = rollfix::load_part("gallery:log-spiral");
  const double P = spiral.perimeter();
  expect_found(hold_of(spiral, {{0.3 * P, 0.1}, {0.6 * P, 0.1}, {0.9 * P, -0.1}}, {.rows = 8, .radius = 0.01}));
}

TEST(Hold, FingersOfOtherShapesAreTaken) {
  // A jaw touches where u says: it is a disk with a radius without end.
  HoldCase one = on_wavy();
  const rollfix::Pose& first = one.first;
  rollfix::FingerRows& rows = one.problem.logs[2].fingers.front();
  const Way way(wavy(), 0.03 * diagonal(wavy()), 5.0, 1);
  for (std::size_t k = 0; k < rows.u.size(); ++k) {
    const double share = static_cast<double>(k) / 40;
    const Pose pose = moved(first, share, diagonal(wavy()));
    const OnWay at = way.at(0.05 * wavy().perimeter() * share);
    // Its body is above its x axis, on the part's outside: it points against the part's tangent.
    rows.u[k] = 0.3 - (at.s - 5.0);
    rows.psi[k] = at.tangent + pose.heading + std::numbers::pi;
    const Vec2 along(std::cos(rows.psi[k]), std::sin(rows.psi[k]));
    const Vec2 centre = pose.world(wavy().point(at.s)) - rows.u[k] * along;
    rows.x[k] = centre.x();
    rows.y[k] = centre.y();
  }
  const rollfix::Finger disk = one.problem.fingers.front();
  one.problem.fingers = {disk, disk, rollfix::jaw()};
  const HoldAnswer answer = rollfix::solve(one.problem);
  EXPECT_EQ(answer.verdict_text(), "unique");
  EXPECT_LT(nearest_miss(answer, one), 1e-7);
}

TEST(Hold, WithOneInstantItIsTouchesWithNormals) {
  HoldCase one = hold_of(wavy(), {{1.0, 0}, {3.0, 0}, {5.0, 0}}, {.rows = 1});
  rollfix::TouchProblem touches{wavy(), {}, one.problem.fingers.front()};
  for (Log& log : one.problem.logs) {
    rollfix::FingerRows& rows = log.fingers.front();  // at rest
    for (std::vector<double>* column : {&rows.u, &rows.psi, &rows.x, &rows.y}) column->back() = column->front();
    touches.touches.push_back({{rows.x[0], rows.y[0]}, rows.u[0] + rows.psi[0] + std::numbers::pi});
  }
  one.problem.tolerance = {0.03, 0.06};
  touches.tolerance = {0.03, 0.06};
  const HoldAnswer answer = rollfix::solve(one.problem);
  const TouchAnswer expected = rollfix::solve(touches);
  ASSERT_GE(expected.poses.size(), 1U);
  EXPECT_EQ(answer.placements.size(), expected.poses.size());
  EXPECT_TRUE(any_holds(answer, one));
}

TEST(Hold, WithNoiseThePosteriorIsAboutTheTruth) {
  std::mt19937_64 generator = test_generator(3);
  const HoldCase one =
      random_hold(wavy(), {.rows = 20, .contact_sd = 0.002, .place_sd = 0.002, .angle_sd = 0.005}, generator);
  const HoldAnswer answer = rollfix::solve(one.problem);
  ASSERT_EQ(answer.verdict_text(), "unique");
  for (std::size_t k = 0; k < 3; ++k) {
    const rollfix::HoldContact& contact = answer.placements[0].contacts[k];
    EXPECT_LT(wavy().distance(contact.mean, one.starts[k]), 5 * contact.sd);
    EXPECT_LT(wavy().distance(contact.end_mean, one.ends[k]), 5 * contact.end_sd);
  }
}

TEST(Hold, UnderstatedNoiseIsTold) {
  std::mt19937_64 generator = test_generator(4);
  HoldCase one =
      random_hold(wavy(), {.rows = 20, .contact_sd = 0.002, .place_sd = 0.002, .angle_sd = 0.005}, generator);
  one.problem.noise->contact *= 0.6;
  one.problem.noise->angle *= 0.6;
  one.problem.noise->position *= 0.6;
  one.problem.diagnose = false;
  EXPECT_THAT(rollfix::solve(one.problem).verdict_text(), testing::AnyOf(HasSubstr("contradict"), "inconsistent"));
}

/// Boxes of this log hang together all around the part, and hold many places that fit nearly as well.
TEST(Hold, TheTruthIsListedWhereOneSetHoldsManyPlaces) {
  std::mt19937_64 generator = test_generator(920);
  const HoldCase one = random_hold(noisy_holds::smooth(20), noisy_holds::noisy(false), generator);
  EXPECT_LT(nearest_miss(rollfix::solve(one.problem), one), 0.02 * one.problem.part.perimeter());
}

TEST(Hold, TheOrderOfTheFingersDoesNotMatter) {
  HoldCase one = on_wavy();
  std::rotate(one.problem.logs.begin(), one.problem.logs.begin() + 1, one.problem.logs.end());
  std::rotate(one.starts.begin(), one.starts.begin() + 1, one.starts.end());
  expect_found(one);
}

TEST(Hold, TheSameLogOfTwoFingersIsRefused) {
  HoldProblem problem = hold_of(bracket(), {{60, 0.05}, {30, -0.03}, {145, 0.03}}).problem;
  problem.logs[1] = problem.logs[0];
  EXPECT_THAT(refusal_of([&] { rollfix::solve(problem); }),
              HasSubstr("the logs of fingers a and b have the same rows"));
}

TEST(Hold, APartFaceDownIsFoundWithMirror) {
  HoldCase one = on_wavy();
  for (Log& log : one.problem.logs) {
    rollfix::FingerRows& rows = log.fingers.front();
    for (std::size_t k = 0; k < rows.u.size(); ++k) {
      rows.u[k] = std::numbers::pi - rows.u[k];
      rows.psi[k] = -rows.psi[k];
      rows.x[k] = -rows.x[k];
    }
  }
  EXPECT_EQ(rollfix::solve(one.problem).verdict.name, Verdict::inconsistent);
  one.problem.mirrored = true;
  const HoldAnswer answer = rollfix::solve(one.problem);
  EXPECT_TRUE(any_holds(answer, one));
  EXPECT_LT(apart_in_heading(answer.placements.at(0).first, {0, 0, -one.first.heading}), 1e-6);
}

TEST(Hold, WhatIsMissingIsNamed) {
  const HoldCase one = on_wavy();
  const auto refusal = [&](const auto& change) {
    HoldProblem problem = one.problem;
    change(problem);
    return refusal_of([&] { rollfix::solve(problem); });
  };
  EXPECT_THAT(refusal([](HoldProblem& problem) { problem.fingers.clear(); }), HasSubstr("expected the fingers"));
  EXPECT_THAT(refusal([](HoldProblem& problem) { problem.logs.resize(1); }), HasSubstr("2 to 8 fingers, found 1"));
  EXPECT_THAT(refusal([](HoldProblem& problem) { problem.logs[1].time[3] += 0.05; }), HasSubstr("the same times"));
  EXPECT_THAT(refusal([](HoldProblem& problem) { problem.noise = rollfix::Noise{.angle = 0.01, .walk = 0.1}; }),
              HasSubstr("found walk=0.1"));
  EXPECT_THAT(refusal([](HoldProblem& problem) {
                problem.fingers = {rollfix::disk(0.1), rollfix::disk(0.1)};
              }),
              HasSubstr("expected one finger for all logs, or 3"));
}

TEST(Hold, ASearchWithoutBudgetSaysSo) {
  HoldCase one = on_wavy();
  one.problem.budget = 50;
  const HoldAnswer answer = rollfix::solve(one.problem);
  EXPECT_EQ(answer.status, Status::incomplete);
  ASSERT_FALSE(answer.unresolved.empty());
  EXPECT_EQ(answer.unresolved[0].size(), 3U);
}

}  // namespace hold_test
