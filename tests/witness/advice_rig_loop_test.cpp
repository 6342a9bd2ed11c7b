// A jaw beside a wheel without skin: move a little, locate, move the pin as advised, locate. Is one place left, more
// often than after a motion as far in a direction drawn at random?
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <numbers>
#include <optional>
#include <random>
#include <string>

#include "random.hpp"
#include "rollfix/advise.hpp"
#include "rollfix/error.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/rolling.hpp"

namespace advice_rig_loop_test {
namespace {

using rollfix::HoldAnswer;
using rollfix::HoldProblem;
using rollfix::Log;
using rollfix::NextPin;
using rollfix::Noise;
using rollfix::Part;
using rollfix::PerFinger;
using rollfix::RigPlan;
using rollfix::Vec2;

constexpr double kRadius = 0.05;  // of the perimeter, as are these
constexpr double kFirstMotion = 0.01;
constexpr double kTravel = 0.05;
constexpr double kError = 5e-4;
constexpr double kAngle = 3e-3;
constexpr std::size_t kRows = 21;  // of each motion

struct Rig {
  Part part;
  PerFinger<double> start;
  Vec2 first;  // motion of the pin
  std::uint64_t seed = 0;

  Noise noise() const {
    Noise noise;
    noise.contact = noise.position = kError * part.perimeter();
    noise.angle = kAngle;
    return noise;
  }

  /// What both measured while the pin went there, and then there; nothing: it can't go so.
  std::optional<HoldProblem> moved(const std::optional<Vec2>& then) const {
    RigPlan plan;
    plan.radius = kRadius * part.perimeter();
    plan.start = start;
    plan.rows = then ? 2 * kRows - 1 : kRows;
    plan.pin = [this, &then](double time) -> Vec2 {
      if (!then) return time * first;
      return std::min(1.0, 2 * time) * first + std::max(0.0, 2 * time - 1) * *then;
    };
    try {
      const Log log = sensed_by(rollfix::WheelSensors::pin, noisy_roll_rig(part, plan, noise(), seed).log);
      HoldProblem problem{part, {one_finger(log, 0)}, {rollfix::jaw()}, noise()};
      const rollfix::FingerRows& pin = log.fingers[1];
      problem.may_overlap = true;  // the jaw has no ends here
      problem.wheels = {{rollfix::pin_log("pin", pin.x, pin.y, {}, log.time), plan.radius}};
      return problem;
    } catch (const rollfix::InputError&) {
      return std::nullopt;
    }
  }
};

/// Whether the one place that is left is the true one.
bool is_found(const Rig& rig, const HoldProblem& problem) {
  const HoldAnswer answer = solve(problem);
  if (answer.verdict.name != rollfix::Verdict::unique || answer.placements.empty()) return false;
  return rig.part.distance(answer.placements.front().contacts[0].start, rig.start[0]) < 0.05 * rig.part.perimeter();
}

struct Count {
  int cases = 0;
  int advised = 0;  // that end in the true place alone
  int random = 0;
};

void try_one(const Rig& rig, double direction, Count& count) {
  const std::optional<HoldProblem> before = rig.moved(std::nullopt);
  if (!before) return;
  const HoldAnswer answer = solve(*before);
  const double travel = kTravel * rig.part.perimeter();
  if (answer.verdict.name != rollfix::Verdict::ambiguous) return;
  const NextPin next = next_pin(answer, rollfix::Interval{-travel, travel});
  if (!next.helps()) return;
  const Vec2 by(next.advice->lengths()[0], next.advice->lengths()[1]);
  const std::optional<HoldProblem> as_advised = rig.moved(by);
  const std::optional<HoldProblem> anyhow = rig.moved(by.norm() * Vec2(std::cos(direction), std::sin(direction)));
  ++count.cases;
  if (as_advised && is_found(rig, *as_advised)) ++count.advised;
  if (anyhow && is_found(rig, *anyhow)) ++count.random;
}

}  // namespace

TEST(AdviceRigLoop, a_motion_that_is_advised_leaves_one_place_more_often_than_a_random_one) {
  std::mt19937_64 random = test_generator();
  std::uniform_real_distribution<double> share(0, 1);
  Count count;
  for (const std::string shape : {"cam", "limacon,a=2,b=0.8", "spline,n=9,seed=7,wobble=0.05"}) {
    const Part part(rollfix::gallery(shape));
    const double P = part.perimeter();
    const int most = count.cases + test_count(10);
    for (int tries = 0; count.cases < most && tries < 20 * test_count(10); ++tries) {
      const double way = 2 * std::numbers::pi * share(random);
      const double jaw = P * share(random);
      const double wheel = part.boundary().base(jaw + P * (0.3 + 0.4 * share(random)));  // opposite
      const Rig rig{part, {jaw, wheel}, kFirstMotion * P * Vec2(std::cos(way), std::sin(way)), random()};
      try_one(rig, 2 * std::numbers::pi * share(random), count);
    }
  }
  std::cout << count.cases << " rigs: " << count.advised << " found as advised, " << count.random << " at random\n";
  ASSERT_GT(count.cases, 0);
  EXPECT_GE(count.advised, count.random);
  EXPECT_GE(2 * count.advised, count.cases);
}

}  // namespace advice_rig_loop_test
