#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "belief_cases.hpp"

namespace belief_wide_noise_test {
namespace {

using belief_cases::belief_in;
using rollfix::Belief;
using rollfix::BeliefOptions;
using rollfix::Mode;
using rollfix::Noise;
using rollfix::NoisyRoll;
using rollfix::Part;

// Each row far off, and so many of them that the answer is sharp.
constexpr std::size_t kRows = 20000;

/// A log ends so many rows after the contact came to a place.
void leave_out_after(NoisyRoll& roll, double s, std::ptrdiff_t rows) {
  const std::vector<double>& way = roll.truth.s[0];
  const auto end = std::lower_bound(way.begin(), way.end(), s - 1e-9) - way.begin() + rows;
  for (std::vector<double>* column : {&roll.log.fingers[0].u, &roll.log.fingers[0].psi}) {
    column->resize(std::min(column->size(), static_cast<std::size_t>(end)));
  }
}

struct Count {
  int logs = 0;
  int listed = 0;
  int inside = 0;
  int misfits = 0;
};

void add(Belief& belief, double start, const Part& part, Count& count) {
  const Mode* mode = belief_cases::mode_at(belief.modes(), start, part);
  ++count.logs;
  count.listed += mode != nullptr ? 1 : 0;
  count.inside += mode != nullptr && belief_cases::holds(mode->interval[0], start, part) ? 1 : 0;
  count.misfits += belief.fit().is_bad() ? 1 : 0;
}

/// Rolls from all around a part, of a share of its perimeter.
Count count_of(const std::string& shape, double share, double angle, int logs) {
  const Part part = belief_cases::part_of(shape);
  const double P = part.perimeter();
  BeliefOptions options;
  options.noise = belief_cases::noise_on(part, 1e-3, angle, 0);
  Count count;
  for (int k = 0; k < logs; ++k) {
    const double start = P * (k + 0.3) / logs;
    const NoisyRoll roll =
        belief_cases::roll_on(part, 0.03 * P, start, share * P, kRows, options.noise, static_cast<std::uint64_t>(k));
    Belief belief = belief_in(part, roll.log, 0.03 * P, options);
    add(belief, start, part, count);
  }
  return count;
}

}  // namespace

TEST(BeliefWideNoise, of_angles_half_a_radian_off_in_each_row_loses_no_place) {
  for (const char* shape : {"rounded-rectangle,width=2,height=1,r=0.2", "spline,seed=3"}) {
    const Count count = count_of(shape, 0.4, 0.5, 60);
    EXPECT_EQ(count.listed, count.logs) << shape;
    EXPECT_LE(count.misfits, 1) << shape;
    EXPECT_GE(count.inside, 52) << shape;  // of 95 %: less by chance once in 500 times
  }
}

// Angles are so noisy that no row tells whether it is still on the side or already pivots: all of them together do.
TEST(BeliefWideNoise, of_a_roll_that_ends_on_a_corner_leaves_the_start_as_uncertain_as_it_is) {
  const Part part = belief_cases::part_of("polygon,n=5");
  const double P = part.perimeter();
  const double radius = 0.03 * P;
  BeliefOptions options;
  options.noise = belief_cases::noise_on(part, 1e-3, 0.1, 0);
  Count count;
  for (std::uint64_t seed = 1; seed <= 150; ++seed) {
    const double start = (0.11 + 1e-4 * static_cast<double>(seed)) * P;
    NoisyRoll roll = belief_cases::roll_on(part, radius, start, 0.22 * P - start, 400, options.noise, seed);
    leave_out_after(roll, 0.2 * P, 60);
    Belief belief = belief_in(part, roll.log, radius, options);
    add(belief, start, part, count);
  }
  EXPECT_EQ(count.listed, count.logs);
  EXPECT_GE(count.inside, 135);  // of 95 %: less by chance once in 400 times
}

}  // namespace belief_wide_noise_test
