// Places and intervals across s = 0, and probabilities that are none beyond 1.
#include <gtest/gtest.h>

#include "random.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/part.hpp"
#include "rollfix/rolling.hpp"
#include "rollfix/solve.hpp"

namespace rollfix::seam_test {
namespace {

TEST(Seam, places_of_a_closed_part_are_apart_the_shorter_way) {
  const Part circle(gallery("circle,r=1"));
  const double P = circle.perimeter();
  EXPECT_NEAR(circle.distance(0.1, P - 0.2), 0.3, 1e-12);
  EXPECT_NEAR(circle.distance(P - 0.2, 0.1), 0.3, 1e-12);
  EXPECT_NEAR(circle.distance(3 * P + 0.1, -0.2), 0.3, 1e-12);
  EXPECT_NEAR(circle.distance(0, P / 2), P / 2, 1e-12);
}

TEST(Seam, places_of_an_open_part_are_apart_by_their_difference) {
  const Part spiral(gallery("log-spiral"));
  EXPECT_NEAR(spiral.distance(0.25, 1), 0.75, 1e-15);
}

TEST(Seam, an_extent_that_crosses_it_holds_the_places_on_both_sides) {
  Placement placement;
  placement.extent = Interval{9.5, 10.25};
  const Boundary boundary{10, true};
  for (const double inside : {9.5, 9.75, 0.0, 10.0, 0.25, -0.25, 20.1}) {
    EXPECT_TRUE(placement.contains(boundary, inside)) << inside;
  }
  for (const double outside : {9.4, 0.3, 5.0, 19.4}) EXPECT_FALSE(placement.contains(boundary, outside)) << outside;
}

TEST(Seam, with_noise_the_interval_counts_and_a_whole_loop_holds_everything) {
  Placement placement;
  placement.extent = Interval{2, 3};
  placement.interval = Interval{9.5, 10.25};
  placement.probability = 0.5;
  const Boundary boundary{10, true};
  EXPECT_TRUE(placement.contains(boundary, 0.1));
  EXPECT_FALSE(placement.contains(boundary, 2.5));
  placement.interval = Interval{0, 10};
  EXPECT_TRUE(placement.contains(boundary, 4));
}

TEST(Seam, of_two_fingers_both_places_count) {
  Placement placement;
  placement.extent = {Interval{9.5, 10.25}, Interval{1, 2}};
  const Boundary boundary{10, true};
  EXPECT_TRUE(placement.contains(boundary, {0.1, 1.5}));
  EXPECT_FALSE(placement.contains(boundary, {0.1, 2.5}));
}

TEST(Seam, no_probability_is_above_1) {
  const Part part(gallery("spline,n=9,seed=7,wobble=0.2"));
  const Noise noise{.contact = 0.002 * part.perimeter(), .angle = 0.02, .slip = 0.005};
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const double start = 0.1 * static_cast<double>(seed);
    const Log log = noisy_increments(part, start, 0.2 * part.perimeter(), 5 + seed, noise, seed).log;
    const Answer answer = solve({part, log, {}, noise});
    EXPECT_GE(answer.weighing->rest, 0);
    EXPECT_LE(answer.weighing->rest, 1);
    for (const Placement& placement : answer.placements) {
      EXPECT_GE(placement.probability, 0);
      EXPECT_LE(placement.probability, 1);
    }
  }
}

}  // namespace
}  // namespace rollfix::seam_test
