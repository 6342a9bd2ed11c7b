#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numbers>
#include <random>
#include <vector>

#include "hold/rig_cases.hpp"
#include "random.hpp"

// A disk with skin and a wheel without an encoder on opposite sides of a trapezoid: many rows in which the wheel could
// as well touch behind a corner.
namespace rig_paths_test {

using namespace rig_cases;

constexpr double kRadius = 3;
constexpr double kContact = 0.2, kAngle = 0.0017, kPosition = 0.1;

Part trapezoid() { return touch_cases::polygon({{0, 0}, {60, 0}, {60, 40}, {0, 34}}); }

/// A length from about the middle of a side, rolled towards one of its ends, but not as far.
struct Roll {
  double start = 0;
  double length = 0;

  Roll(double corner, double side, std::mt19937_64& generator) {
    const double along = uniform(generator, 0.2, 0.8) * side;
    start = corner + along;
    length = uniform(generator, -0.7, 0.7) * std::min(along, side - along);
  }
};

/// The part goes evenly from here to there while it turns by 0.4.
RigCase rolled(const Part& part, const Roll& finger, const Roll& wheel, std::size_t rows) {
  std::vector<Held> instants;
  for (std::size_t row = 0; row < rows; ++row) {
    const double share = static_cast<double>(row) / static_cast<double>(rows - 1);
    const Pose pose{100 + 20 * share, 50 + 5 * share, 0.3 + 0.4 * share};
    instants.push_back({finger.start + share * finger.length, wheel.start + share * wheel.length, pose});
  }
  RigCase one{.problem = held_at(part, kRadius, instants), .first = {}, .last = {}};
  one.problem.fingers = {rollfix::disk(kRadius)};
  rollfix::FingerRows& disk = one.problem.logs.front().fingers.front();
  for (std::size_t row = 0; row < rows; ++row) {
    const Held& at = instants[row];
    const double tangent = part.tangent(at.s) + at.pose.heading;
    const Vec2 centre = at.pose.world(part.point(at.s)) + kRadius * normal_of(tangent);
    disk.u[row] = 0.3 - at.s / kRadius;
    disk.psi[row] = tangent + 0.5 * std::numbers::pi - disk.u[row];
    disk.x[row] = centre.x();
    disk.y[row] = centre.y();
  }
  one.start = finger.start;
  one.wheel_start = wheel.start;
  return one;
}

/// Where the disk felt the contact is off by an angle on it.
RigCase random_rolled(std::size_t rows, std::mt19937_64& generator) {
  const Part part = trapezoid();
  const Roll finger(0, 60, generator), wheel(100, std::hypot(60, 6), generator);
  RigCase one = noisy(rolled(part, finger, wheel, rows), {0, kAngle, kPosition}, generator);
  for (double& u : one.problem.logs.front().fingers.front().u) u += normal(generator, kContact / kRadius);
  one.problem.noise->contact = kContact;
  return one;
}

struct Counted {
  int logs = 0;
  int listed = 0;
  int sure_and_wrong = 0;
};

Counted counted(int count, std::size_t rows) {
  Counted result;
  for (int k = 0; k < count; ++k) {
    std::mt19937_64 generator = test_generator(static_cast<std::uint64_t>(k) + 60);
    const RigCase one = random_rolled(rows, generator);
    const HoldAnswer answer = rollfix::solve(one.problem);
    const auto is_true = [&](const HoldPlacement& found) {
      return one.problem.part.distance(found.contacts[0].mean, one.start) < 6 * found.contacts[0].sd;
    };
    const bool listed = std::ranges::any_of(answer.placements, is_true);
    ++result.logs;
    result.listed += listed ? 1 : 0;
    result.sure_and_wrong += !listed && answer.verdict.name == rollfix::Verdict::unique ? 1 : 0;
  }
  std::printf("%zu rows: of %d logs %d listed, %d sure and wrong\n", rows, result.logs, result.listed,
              result.sure_and_wrong);
  return result;
}

TEST(RigPaths, ExactRowsOfADiskFitTheirPoses) {
  std::mt19937_64 generator = test_generator(1);
  const RigCase one = rolled(trapezoid(), Roll(0, 60, generator), Roll(100, std::hypot(60, 6), generator), 12);
  EXPECT_TRUE(std::ranges::any_of(rollfix::solve(one.problem).placements, [&](const HoldPlacement& found) {
    return std::abs(found.contacts[0].start - one.start) < 1e-4;
  }));
}

TEST(RigPaths, OfFewRowsTheTruthIsListed) {
  const Counted few = counted(test_count(4), 20);
  EXPECT_GE(10 * few.listed, 9 * few.logs);
  EXPECT_EQ(few.sure_and_wrong, 0);
}

/// Not of all: where the disk could as well have pivoted at a corner all the time, docs/rig.md.
TEST(SlowRigPaths, OfManyRowsMostTruthsAreListed) {
  const Counted many = counted(test_count(12), 200);
  EXPECT_GE(3 * many.listed, 2 * many.logs);
  EXPECT_LE(4 * many.sure_and_wrong, many.logs);
}

}  // namespace rig_paths_test
