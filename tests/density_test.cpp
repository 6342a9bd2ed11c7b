// The density along the boundary: it holds what the modes say, and it is known in closed form where nothing is known.
#include <gtest/gtest.h>

#include <cmath>

#include "belief_cases.hpp"
#include "noisy_pairs.hpp"

namespace density_test {
namespace {

using namespace belief_cases;
using rollfix::Density;
using rollfix::DensityPiece;
using rollfix::Interval;

double total(const Density& density) {
  double sum = 0;
  for (const DensityPiece& piece : density) sum += piece.probability;
  return sum;
}

/// What a density holds between two places, on a closed part.
double held(const Density& density, const Part& part, const Interval& arc) {
  double sum = 0;
  for (const DensityPiece& piece : density) {
    for (const double laps : {-1, 0, 1}) {
      const double lo = std::max(arc.lo, piece.s.lo + laps * part.perimeter());
      const double hi = std::min(arc.hi, piece.s.hi + laps * part.perimeter());
      if (hi > lo) sum += piece.probability * (hi - lo) / piece.s.width();
    }
  }
  return sum;
}

TEST(Density, before_anything_was_felt_there_is_none) {
  const Part part = part_of("ellipse");
  Belief belief(part, rollfix::LogKind::contact, {noise_on(part, 1e-3, 0.01, 0)});
  EXPECT_TRUE(belief.density()[0].empty());
}

TEST(Density, is_even_where_every_place_is_as_probable) {
  const Part part = part_of("circle");
  const Noise noise = noise_on(part, 1e-3, 0.01, 0);
  const NoisyRoll roll = roll_on(part, 0.2, 1, 2, 20, noise, 3);
  Belief belief = belief_in(part, roll.log, 0.2, {noise});
  const Density density = belief.density()[0];
  EXPECT_NEAR(total(density), 1, 1e-9);
  for (const DensityPiece& piece : density) {
    EXPECT_NEAR(piece.probability / piece.s.width(), 1 / part.perimeter(), 1e-6 / part.perimeter());
  }
}

TEST(Density, holds_as_much_as_the_modes_and_their_intervals_say) {
  for (const std::string shape : {"ellipse", "limacon", "cam", "spline,seed=3"}) {
    const Part part = part_of(shape);
    const Noise noise = noise_on(part, 1e-3, 0.02, 0.002);
    const NoisyRoll roll = roll_on(part, 0.05, 0.3 * part.perimeter(), 0.2 * part.perimeter(), 60, noise, 5);
    Belief belief = belief_in(part, roll.log, 0.05, {noise});
    const Density density = belief.density()[0];
    EXPECT_NEAR(total(density), 1, 1e-6) << shape;
    for (const Mode& mode : belief.modes()) {
      EXPECT_NEAR(held(density, part, mode.interval[0]), 0.95 * mode.probability, 1e-4) << shape;
    }
  }
}

TEST(Density, is_a_point_in_a_corner) {
  const Part part = part_of("reuleaux");
  const double turn = part.corners()[1].turn;
  Belief belief(part, rollfix::LogKind::contact, {noise_on(part, 1e-3, 5e-3, 0)});
  for (int k = 0; k <= 50; ++k)
    belief.add(rollfix::Reading(0, 0.5 * turn * k / 50));  // the finger pivots, and stays there
  std::size_t points = 0;
  const Density density = belief.density()[0];
  for (const DensityPiece& piece : density) points += piece.s.width() == 0 ? 1 : 0;
  EXPECT_GE(points, 3U);
}

TEST(Density, of_two_fingers_is_that_of_each_by_itself) {
  std::mt19937_64 generator = test_generator(4);
  const Part part = part_of("cam");
  const Noise noise = noise_on(part, 1e-3, 0.01, 0.001);
  const noisy_pairs::Case drawn = noisy_pairs::noisy_case(part, {1.0, 4.0}, 1.5, -0.8, 80, 0.2, 0.2, noise, generator);
  Belief belief = noisy_pairs::belief_of(part, drawn, {noise});
  ASSERT_FALSE(belief.modes().empty());
  const rollfix::PerFinger<Density> density = belief.density();
  for (const std::size_t finger : {0U, 1U}) {
    EXPECT_NEAR(total(density[finger]), 1, 1e-3) << "seed " << test_seed();
    double inside = 0;
    for (const Mode& mode : belief.modes()) inside += held(density[finger], part, mode.interval[finger]);
    EXPECT_NEAR(inside, 0.95, 0.04) << "seed " << test_seed();
  }
}

}  // namespace
}  // namespace density_test
