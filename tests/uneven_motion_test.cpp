// A finger that stops, hops and goes on: rows that are joined are not spread evenly over the way.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "rollfix/curve.hpp"
#include "single_rolls.hpp"

namespace uneven_motion_test {
namespace {

using namespace single_rolls;

constexpr std::array kShapes = {"polygon,n=5", "reuleaux", "spline,n=9,seed=4,wobble=0.2", "rounded-rectangle"};

/// Now and then fast, and in between nearly at rest.
double in_bursts(double time) { return 0.02 + 40 * std::pow(std::abs(std::sin(2.1 * time)), 24); }

void expect_right(Noise noise) {
  int listed = 0, bad = 0;
  const int count = test_count(40);
  for (int k = 0; k < count; ++k) {
    const Part part(gallery(kShapes[static_cast<std::size_t>(k) % kShapes.size()]));
    const Drawn one = drawn(part, {.noise = noise, .omega = in_bursts}, static_cast<std::uint64_t>(k) + 1);
    const Answer answer = solve(one.problem);
    listed += lists(answer, one.start) ? 1 : 0;
    bad += answer.verdict.fits_badly ? 1 : 0;
  }
  EXPECT_EQ(listed, count);
  EXPECT_LE(bad, 1 + count / 40);
}

TEST(UnevenMotion, of_a_finger_that_slips_loses_no_place) {
  expect_right({.contact = 1e-4, .angle = 0.001, .slip = 0.01});
}

TEST(UnevenMotion, of_a_gyroscope_that_walks_loses_no_place) {
  expect_right({.contact = 1e-4, .angle = 0.001, .walk = 0.003});
}

/// A bracket whose concave fillet is little wider than the finger: there the contact runs five times as fast.
Part filleted_bracket() {
  const double right_angle = std::acos(0.0);
  return Part(Outline{"bracket",
                      {Line({0, 0}, {60, 0}), Line({60, 0}, {60, 15}), Line({60, 15}, {20, 15}),
                       Arc({20, 20}, 5, 3 * right_angle, -right_angle), Line({15, 20}, {15, 40}),
                       Line({15, 40}, {0, 40}), Line({0, 40}, {0, 0})},
                      true});
}

/// From 134.9 the finger would be on a straight side or at a corner, and its turn 180 degrees at least: the last rows'
/// turn falls to 147. In a mean over the fillet's beginning they would not show.
TEST(UnevenMotion, of_a_roll_that_ends_in_a_fillet_tells_the_place) {
  for (const std::size_t rows : {292U, 296U, 300U, 308U}) {
    const Noise noise{.contact = 0.05, .angle = 0.0035, .slip = 0.003};
    const Part part = filleted_bracket();
    RollPlan plan;
    plan.start = 52;
    plan.distance = 66;
    plan.rows = rows;
    const NoisyRoll roll = noisy_roll(part, disk(4), plan, noise, 5);
    const Answer answer = solve({part, roll.log, {disk(4)}, noise});
    EXPECT_EQ(answer.verdict.text(), "unique") << rows << " rows";
    EXPECT_TRUE(lists(answer, 52)) << rows << " rows";
  }
}

}  // namespace
}  // namespace uneven_motion_test
