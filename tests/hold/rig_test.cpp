#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "hold/rig_cases.hpp"
#include "hold/rig_scan.hpp"
#include "refusal.hpp"
#include "rollfix/files.hpp"

// A jaw with skin, and a wheel of which only the pin's place is known.
namespace rig_test {

using namespace rig_cases;
using rollfix::Status;
using rollfix::Verdict;
using testing::HasSubstr;

const Part& ellipse() {
  static const Part part = rollfix::load_part("gallery:ellipse,a=2,b=1");
  return part;
}
const Part& cam() {
  static const Part part = rollfix::load_part("gallery:cam");
  return part;
}

/// Whether an answer has both true first contacts, exactly.
bool has_truth(const HoldAnswer& answer, const RigCase& one, double slack = 1e-7) {
  const Part& part = one.problem.part;
  return std::any_of(answer.placements.begin(), answer.placements.end(), [&](const HoldPlacement& found) {
    return part.distance(found.contacts.at(0).start, one.start) < slack &&
           part.distance(found.contacts.at(1).start, one.wheel_start) < 10 * slack;
  });
}

void expect_found(const RigCase& one, std::size_t count) {
  const HoldAnswer answer = rollfix::solve(one.problem);
  EXPECT_EQ(answer.status, Status::complete);
  EXPECT_EQ(answer.placements.size(), count);
  EXPECT_TRUE(has_truth(answer, one)) << answer.verdict_text();
}

RigCase random_on(const Part& part, unsigned seed, bool encoder = false) {
  std::mt19937_64 generator(seed);
  return random_rig(part, 0.04 * part.perimeter(), generator, encoder, 16);
}

TEST(Rig, OnAnEllipseOnlyItsHalfTurnRemains) {
  for (unsigned seed = 0; seed < 3; ++seed) expect_found(random_on(ellipse(), seed), 2);
}

TEST(Rig, OnACamThePlaceIsUnique) {
  for (unsigned seed = 0; seed < 3; ++seed) expect_found(random_on(cam(), seed), 1);
}

TEST(Rig, ThePartsPosesAreThoseOfTheSimulation) {
  const RigCase one = random_on(cam(), 4);
  const HoldPlacement found = rollfix::solve(one.problem).placements.at(0);
  EXPECT_LT(std::hypot(found.first.x - one.first.x, found.first.y - one.first.y), 1e-6);
  EXPECT_LT(std::hypot(found.last.x - one.last.x, found.last.y - one.last.y), 1e-6);
  EXPECT_LT(std::abs(rollfix::nearest_angle(found.last.heading - one.last.heading)), 1e-6);
}

TEST(Rig, TheEncoderOfASimulatedWheelFits) { expect_found(random_on(cam(), 5, true), 1); }

TEST(Rig, AnEncoderThatTurnsOtherwiseIsContradicted) {
  RigCase one = random_on(cam(), 5, true);
  for (std::size_t k = 0; k < 17; ++k)
    one.problem.wheels[0].log.rows.fingers[0].psi[k] += 0.01 * static_cast<double>(k);
  one.problem.diagnose = false;
  EXPECT_EQ(rollfix::solve(one.problem).verdict.name, Verdict::inconsistent);
}

TEST(Rig, AWheelThatIsLargerIsContradicted) {
  RigCase one = random_on(cam(), 6);
  one.problem.wheels[0].radius *= 1.05;
  one.problem.diagnose = false;
  EXPECT_EQ(rollfix::solve(one.problem).verdict.name, Verdict::inconsistent);
}

TEST(Rig, SqueezedOneInstantLeavesTheHalfTurn) {
  // The normal at t goes through the contact at s: across the ellipse from one vertex to the other.
  const double half = 0.5 * ellipse().perimeter();
  const double s = 1.1, t = foot_across(ellipse(), s, s + half);
  const std::vector<Held> one{{s, t, {0.2, 0.1, 0.4}}, {s, t, {0.2, 0.1, 0.4}}};
  HoldProblem problem = held_at(ellipse(), 0.4, one);
  problem.squeezed = 1e-6;
  EXPECT_EQ(rollfix::solve(problem).verdict_text(), "ambiguous (2)");
}

TEST(Rig, AJawThatPivotsAtACornerStaysThere) {
  // The corner at s = 60 turns by a quarter.
  const HoldProblem problem = held_at(
      touch_cases::bracket(), 3,
      {{50, 145, {5, 3, 0.3}}, {60, 147, {6, 3, 0.2}, 0.3}, {60, 149, {6, 4, 0.1}, 1.0}, {66, 151, {7, 4, 0.2}}});
  const HoldAnswer answer = rollfix::solve(problem);
  ASSERT_EQ(answer.status, Status::complete) << answer.unresolved.size();
  EXPECT_TRUE(std::any_of(answer.placements.begin(), answer.placements.end(), [](const HoldPlacement& found) {
    return std::abs(found.contacts[0].start - 50) < 1e-4 && std::abs(found.contacts[1].start - 145) < 1e-3;
  }));
}

/// The jaw on the bracket's corner (60, 0) with the pin at (17, 48) of the part, and at (-3, y) as far from the corner:
/// turned from one to the other about it, the part touches as well.
const double kPinAt = 138 + 5 * std::numbers::sqrt2;  // the wheel is at (17, 45)
const Vec2 kCorner(60, 0), kPin(17, 48), kOtherPin(-3, std::sqrt(43.0 * 43 + 48 * 48 - 63 * 63));
const Pose kOnCorner{7, 4, 0.2};

Pose turned_to_the_other_pin() {
  const double heading = kOnCorner.heading - rollfix::angle_between(kPin - kCorner, kOtherPin - kCorner);
  const Vec2 origin = kOnCorner.world(kCorner) - turned(kCorner, heading);
  return {origin.x(), origin.y(), heading};
}

/// A roll towards the corner, or from it.
HoldProblem rolled_at_the_corner(bool ends_there, std::optional<rollfix::Noise> noise = {}) {
  std::vector<Held> instants{
      {40, 149, {5, 3, 0.3}}, {45, 148, {5, 3, 0.27}}, {50, 147, {6, 3, 0.25}}, {60, kPinAt, kOnCorner, 0.5}};
  if (!ends_there) std::reverse(instants.begin(), instants.end());
  HoldProblem problem = held_at(touch_cases::bracket(), 3, instants);
  problem.noise = noise;
  return problem;
}

/// How far a pose is off the nearest of a list: as far as the part moves at 60 from its origin, at most.
double off_nearest(const Pose& pose, const std::vector<Pose>& poses) {
  double least = std::numeric_limits<double>::infinity();
  for (const Pose& one : poses) {
    const double turn = std::abs(rollfix::nearest_angle(one.heading - pose.heading));
    least = std::min(least, std::hypot(one.x - pose.x, one.y - pose.y) + 60 * turn);
  }
  return least;
}

/// Where an answer has the part on the corner, at its first or at its last row.
std::vector<Pose> poses_on_corner(const HoldAnswer& answer, bool ends_there) {
  std::vector<Pose> poses;
  for (const HoldPlacement& found : answer.placements) poses.push_back(ends_there ? found.last : found.first);
  return poses;
}

void expect_both_poses(const HoldProblem& problem, bool ends_there, double slack) {
  const HoldAnswer answer = rollfix::solve(problem);
  EXPECT_EQ(answer.verdict.name, Verdict::ambiguous);
  EXPECT_LT(off_nearest(kOnCorner, poses_on_corner(answer, ends_there)), slack);
  EXPECT_LT(off_nearest(turned_to_the_other_pin(), poses_on_corner(answer, ends_there)), slack);
}

TEST(Rig, AJawThatEndsOnACornerHasBothPosesInWhichTheWheelTouches) {
  expect_both_poses(rolled_at_the_corner(true), true, 1e-3);
}

TEST(Rig, AJawThatStartsOnACornerHasBothPosesInWhichTheWheelTouches) {
  expect_both_poses(rolled_at_the_corner(false), false, 1e-3);
}

TEST(Rig, WithNoiseBothPosesOnACornerAreListed) {
  const rollfix::Noise noise{.contact = 0.02, .angle = 0.002, .position = 0.02};
  for (const bool ends_there : {true, false}) {
    expect_both_poses(rolled_at_the_corner(ends_there, noise), ends_there, 0.5);
  }
}

TEST(Rig, AWheelMayTouchAtACorner) {
  const HoldProblem problem =
      held_at(touch_cases::bracket(), 3, {{20, 171, {5, 3, 0.3}, {}}, {24, 172, {6, 3, 0.2}}, {30, 174, {6, 4, 0.1}}});
  const HoldAnswer answer = rollfix::solve(problem);
  ASSERT_EQ(answer.status, Status::complete);
  EXPECT_FALSE(answer.placements.empty());
}

TEST(Rig, OnACircleAnyPlaceFits) {
  const Part circle = rollfix::load_part("gallery:circle,r=1");
  const HoldAnswer answer =
      rollfix::solve(held_at(circle, 0.3, {{1, 3, {0.2, 0.1, 0.4}}, {1.4, 3.3, {0.2, 0.2, 0.3}}}));
  EXPECT_EQ(answer.verdict.name, Verdict::unobservable);
}

TEST(Rig, AnyFingerWithSkinTakesTheJawsPlace) {
  // A disk that touches where the jaw does.
  RigCase one = random_on(cam(), 7);
  const double radius = 0.2;
  rollfix::FingerRows& rows = one.problem.logs[0].fingers[0];
  for (std::size_t k = 0; k < rows.u.size(); ++k) {
    const Vec2 contact = Vec2(rows.x[k], rows.y[k]) + turned({rows.u[k], 0}, rows.psi[k]);
    const double travelled = 0.13 - rows.u[k];
    const double normal = rows.psi[k] - 0.5 * std::numbers::pi;  // out of the jaw, into the part
    const Vec2 centre = contact - radius * Vec2(std::cos(normal), std::sin(normal));
    rows.x[k] = centre.x();
    rows.y[k] = centre.y();
    rows.u[k] = 0.3 - travelled / radius;
    rows.psi[k] = normal - rows.u[k];
  }
  one.problem.fingers = {rollfix::disk(radius)};
  expect_found(one, 1);
}

TEST(Rig, FaceDownItIsFoundInTheMirror) {
  RigCase one = random_on(cam(), 8);
  rollfix::FingerRows& jaw = one.problem.logs[0].fingers[0];
  rollfix::FingerRows& pin = one.problem.wheels[0].log.rows.fingers[0];
  for (auto* column : {&jaw.u, &jaw.psi, &jaw.x, &pin.x}) {
    for (double& value : *column) value = -value;
  }
  one.problem.mirrored = true;
  expect_found(one, 1);
}

/// How far the pin is inside of the jaw's line, at most, less the wheel's radius; of the logs alone.
double depth_in_jaw(const HoldProblem& problem) {
  const rollfix::FingerRows& jaw = problem.logs[0].fingers[0];
  const rollfix::FingerRows& pin = problem.wheels[0].log.rows.fingers[0];
  double most = -1e300;
  for (std::size_t k = 0; k < jaw.x.size(); ++k) {
    const double above = -std::sin(jaw.psi[k]) * (pin.x[k] - jaw.x[k]) + std::cos(jaw.psi[k]) * (pin.y[k] - jaw.y[k]);
    most = std::max(most, above + problem.wheels[0].radius);
  }
  return most;
}

/// The first rigs that are drawn whose wheel is in the jaw, or isn't, by more than rounding.
std::vector<RigCase> rigs_whose_wheel_is_in_the_jaw(bool in, std::size_t count) {
  std::vector<RigCase> result;
  for (unsigned seed = 0; result.size() < count; ++seed) {
    RigCase one = random_on(cam(), seed);
    one.problem.may_overlap = false;
    const double depth = depth_in_jaw(one.problem);
    if (std::abs(depth) > 1e-3 && (depth > 0) == in) result.push_back(std::move(one));
  }
  return result;
}

TEST(Rig, AWheelThatIsInTheJawIsRefusedUnlessTheyMayOverlap) {
  for (const RigCase& one : rigs_whose_wheel_is_in_the_jaw(true, 2)) {
    EXPECT_THAT(refusal_of([&] { rollfix::solve(one.problem); }),
                testing::AllOf(HasSubstr("finger a and wheel b are apart"), HasSubstr("may overlap")));
  }
}

TEST(Rig, AWheelBesideTheJawIsNotRefused) {
  for (const RigCase& one : rigs_whose_wheel_is_in_the_jaw(false, 3)) EXPECT_NO_THROW(rollfix::solve(one.problem));
}

TEST(Rig, AFingerWithoutXAndYIsNotComparedWithAWheel) {
  RigCase one = rigs_whose_wheel_is_in_the_jaw(false, 1).front();
  Log other = one.problem.logs[0];
  other.fingers[0].x.clear();
  other.fingers[0].y.clear();
  one.problem.logs.push_back(other);
  EXPECT_NO_THROW(rollfix::solve(one.problem));
}

TEST(Rig, WithNoiseAWheelThatTouchesTheJawIsNotRefused) {
  // As deep in the jaw as the noise may make it.
  RigCase one = random_on(cam(), 1);
  one.problem.may_overlap = false;
  const double depth = depth_in_jaw(one.problem);
  one.problem.noise = rollfix::Noise{.contact = 0.01, .angle = 0.005, .position = std::abs(depth) + 0.01};
  EXPECT_NO_THROW(rollfix::solve(one.problem));
}

TEST(Rig, WithNoiseTheTruthIsInTheInterval) {
  std::mt19937_64 generator(3);
  const RigCase one = noisy(random_on(cam(), 9), {0.01, 0.005, 0.01, 0}, generator);
  const HoldAnswer answer = rollfix::solve(one.problem);
  ASSERT_FALSE(answer.placements.empty());
  const rollfix::HoldContact& jaw = answer.placements[0].contacts[0];
  EXPECT_LT(cam().distance(jaw.mean, one.start), 4 * jaw.sd);
  EXPECT_FALSE(answer.verdict.fits_badly);
}

TEST(Rig, WhatSaysNothingIsRefusedWithTheReason) {
  const RigCase one = random_on(cam(), 4);
  const auto refused = [&](const auto& change) {
    HoldProblem problem = one.problem;
    change(problem);
    return refusal_of([&] { rollfix::solve(problem); });
  };
  EXPECT_THAT(refused([](HoldProblem& p) {
                p.logs.clear();
                p.wheels.push_back(p.wheels[0]);
              }),
              HasSubstr("expected a finger with skin"));
  EXPECT_THAT(refused([](HoldProblem& p) {
                p.logs[0].fingers[0].x.clear();
                p.logs[0].fingers[0].y.clear();
              }),
              HasSubstr("without both any place on the part fits"));
  EXPECT_THAT(refused([](HoldProblem& p) { p.noise = rollfix::Noise{.contact = 0.1}; }), HasSubstr("position=SD"));
  EXPECT_THAT(refused([](HoldProblem& p) { p.squeezed = -1; }), HasSubstr("above 0"));
  EXPECT_THAT(refused([](HoldProblem& p) { p.wheels[0].radius = 0; }), HasSubstr("above 0"));
}

TEST(Rig, APinsLogHasXAndYAndNoSkin) {
  const auto read = [](const std::string& text) {
    return refusal_of([&] { rollfix::parse_pin_log(text, "pin.csv"); });
  };
  EXPECT_THAT(read("time,u,psi,x,y\n0,1,2,3,4\n1,1,2,3,4\n"), HasSubstr("a wheel has no skin"));
  EXPECT_THAT(read("time,psi\n0,1\n1,2\n"), HasSubstr("add where the pin was"));
  EXPECT_THAT(read("time,x\n0,1\n1,2\n"), HasSubstr("expected columns 'x' and 'y'"));
  const rollfix::PinLog log = rollfix::parse_pin_log("time,x [mm],y\n0,1,2\n1,3,4\n", "pin.csv", {.unit = "mm"});
  EXPECT_FALSE(log.has_encoder());
  EXPECT_EQ(log.rows.fingers[0].x, (std::vector<double>{1, 3}));
}

}  // namespace rig_test
