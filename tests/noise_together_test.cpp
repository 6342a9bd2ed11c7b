// Kinds of noise that meet: each is told of the others.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "outline/turn.hpp"
#include "single_rolls.hpp"

namespace noise_together_test {
namespace {

using namespace single_rolls;

constexpr std::array kShapes = {"cam", "limacon,a=1.5,b=1", "spline,n=9,seed=4,wobble=0.2"};

void expect_right(const Rolling& rolling) {
  int bad = 0, held = 0;
  const int count = test_count(30);
  for (int k = 0; k < count; ++k) {
    const Part part(gallery(kShapes[static_cast<std::size_t>(k) % kShapes.size()]));
    const Drawn one = drawn(part, rolling, static_cast<std::uint64_t>(k) + 1);
    const Answer answer = solve(one.problem);
    bad += answer.verdict.fits_badly || answer.placements.empty() ? 1 : 0;
    for (const Placement& placement : answer.placements) {
      held += part.boundary().contains(placement.interval[0], one.start) ? 1 : 0;
    }
  }
  EXPECT_LE(bad, 1 + count / 30);
  EXPECT_GE(held, 0.8 * count);
}

TEST(NoiseTogether, centres_of_rows_that_are_off_alike_are_off_alike) {
  expect_right({.noise = {.contact = 1e-3, .angle = 0.005, .position = 1e-3, .correlation = 0.02}, .places = true});
}

TEST(NoiseTogether, a_gyroscope_that_walks_does_not_turn_the_part) {
  expect_right({.noise = {.contact = 1e-3, .angle = 0.005, .position = 1e-3, .walk = 0.01}, .places = true});
}

/// Each row at a corner would tell the start to nothing, and a grid as fine about each takes a gigabyte.
TEST(NoiseTogether, angles_alone_are_answered_on_a_polygon) {
  const Part part(gallery("polygon,n=5"));
  const Drawn one = drawn(part, {.noise = {.angle = 0.005}, .rows = 100}, 1);
  EXPECT_TRUE(lists(solve(one.problem), one.start));
}

}  // namespace
}  // namespace noise_together_test
