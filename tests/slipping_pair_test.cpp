// Two fingers that slip while they roll on a free part: what flat sides and roundings tell of where they started.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <random>
#include <vector>

#include "random.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/rolling.hpp"
#include "rollfix/solve.hpp"

namespace rollfix::slipping_pair_test {
namespace {

constexpr Noise kNoise{.contact = 0.003, .angle = 0.004, .slip = 0.02};
constexpr std::array<double, 2> kRadius = {0.1, 0.3};
/// Beside the one factor of a roll, slip is so many times as large over stretches of this share of the perimeter.
constexpr double kLocal = 5;
constexpr double kStretch = 0.01;

/// Finger a rolls far along a flat side and into the rounding at its end, finger b a short way around another one.
NoisyRoll without_slip(const Part& part, std::uint64_t seed) {
  FreePlan plan;
  plan.rows = 200;
  for (std::size_t finger : {0U, 1U}) plan.fingers[finger].finger = disk(kRadius[finger]);
  plan.fingers[0].start = 3.67;
  plan.fingers[0].distance = -3.72;
  plan.fingers[1].start = 13;
  plan.fingers[1].distance = 1.62;
  return noisy_roll_free(part, plan, {.contact = kNoise.contact, .angle = kNoise.angle}, seed);
}

/// The finger was rolled so far while its contact travelled from one place to the next; u and psi say it, their sum
/// stays.
void slip(FingerRows& rows, const std::vector<double>& places, double radius, double perimeter,
          std::mt19937_64& generator) {
  std::normal_distribution<double> normal(0, kNoise.slip);
  const double whole = normal(generator);
  double off = 0;
  double factor = 0;
  double left = 0;
  for (std::size_t k = 1; k < places.size(); ++k) {
    const double step = places[k] - places[k - 1];
    if (left <= 0) {
      factor = 1 / (1 + whole + kLocal * normal(generator)) - 1;
      left = kStretch * perimeter;
    }
    left -= std::abs(step);
    off += factor * step;
    rows.u[k] -= off / radius;
    rows.psi[k] += off / radius;
  }
}

TEST(SlippingPair, a_flat_side_leaves_open_when_its_rounding_comes) {
  const Part part(gallery("rounded-rectangle,width=6,height=2,r=0.3"));
  int held = 0;
  const int count = test_count(12);
  for (int k = 0; k < count; ++k) {
    std::mt19937_64 generator = test_generator(static_cast<std::uint64_t>(k) + 1);
    NoisyRoll roll = without_slip(part, generator());
    for (std::size_t finger : {0U, 1U}) {
      slip(roll.log.fingers[finger], roll.truth.s[finger], kRadius[finger], part.perimeter(), generator);
    }
    const Answer answer = solve({part, roll.log, {disk(kRadius[0]), disk(kRadius[1])}, kNoise});
    const double truth = roll.truth.s[0][0];
    const auto holds = [&](const Placement& place) {
      return place.interval[0].lo <= truth && truth <= place.interval[0].hi;
    };
    if (std::any_of(answer.placements.begin(), answer.placements.end(), holds)) ++held;
  }
  std::printf("of %d logs %d hold the truth\n", count, held);
  EXPECT_GE(held, 0.75 * count);
}

}  // namespace
}  // namespace rollfix::slipping_pair_test
