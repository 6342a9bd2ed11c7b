// A finger that stops, hops and goes on: rows that are joined are not spread evenly over the way.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

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

}  // namespace
}  // namespace uneven_motion_test
