// Simulated noise: what it is said to be, the same for the same seed, and nothing where it is 0.
#include "rollfix/rolling.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "refusal.hpp"
#include "roll/noise.hpp"
#include "rollfix/error.hpp"
#include "rollfix/outline.hpp"
#include "shapes.hpp"

namespace rollfix::noisy_test {
namespace {

using shapes::kPi;
using testing::HasSubstr;

const Part& egg_part() {
  static const Part part(gallery("ellipse"));
  return part;
}

RollPlan long_roll(std::size_t rows = 5001) {
  RollPlan plan;
  plan.start = 1;
  plan.distance = 6;
  plan.rows = rows;
  return plan;
}

Noise only_contact(double sd) { return {sd, 0, 0, 0}; }
Noise only_slip(double sd) { return {0, 0, sd, 0}; }

/// The mean and the standard deviation of some errors.
struct Spread {
  double mean = 0;
  double deviation = 0;
};

Spread spread_of(const std::vector<double>& values) {
  Spread spread;
  for (const double value : values) spread.mean += value / static_cast<double>(values.size());
  for (const double value : values) spread.deviation += (value - spread.mean) * (value - spread.mean);
  spread.deviation = std::sqrt(spread.deviation / static_cast<double>(values.size()));
  return spread;
}

std::vector<double> differences(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> result(a.size());
  for (std::size_t k = 0; k < a.size(); ++k) result[k] = a[k] - b[k];
  return result;
}

TEST(NormalNumbers, have_the_moments_and_the_tails_of_a_normal) {
  rolling::NormalNumbers normal(5);
  constexpr int kCount = 400000;
  std::array<double, 5> moments{};
  int beyond_two = 0;
  for (int k = 0; k < kCount; ++k) {
    const double x = normal.next(1);
    for (std::size_t power = 1; power < 5; ++power) moments[power] += std::pow(x, static_cast<double>(power)) / kCount;
    if (std::abs(x) > 2) ++beyond_two;
  }
  EXPECT_NEAR(moments[1], 0, 0.01);
  EXPECT_NEAR(moments[2], 1, 0.01);
  EXPECT_NEAR(moments[3], 0, 0.03);
  EXPECT_NEAR(moments[4], 3, 0.08);
  EXPECT_NEAR(static_cast<double>(beyond_two) / kCount, std::erfc(std::sqrt(2.0)), 0.001);
}

TEST(NormalNumbers, are_the_same_everywhere) {
  // From the first words of mt19937_64 seeded with 5489, 14514284786278117030 and 4620546740167642908: standard.
  const double x = 14514284786278117030.0 / std::ldexp(1.0, 63) - 1;
  const double y = 4620546740167642908.0 / std::ldexp(1.0, 63) - 1;
  const double square = x * x + y * y;
  ASSERT_LT(square, 1);
  rolling::NormalNumbers normal(5489);
  EXPECT_NEAR(normal.next(2), 2 * x * std::sqrt(-2 * std::log(square) / square), 1e-12);
  EXPECT_NEAR(normal.next(1), y * std::sqrt(-2 * std::log(square) / square), 1e-12);
}

TEST(Noisy, without_noise_it_is_the_roll) {
  const NoisyRoll found = noisy_roll(egg_part(), 0.2, long_roll(), {}, 7);
  const Roll plain = roll(egg_part(), 0.2, long_roll());
  EXPECT_EQ(found.log.fingers[0].u, plain.log.fingers[0].u);
  EXPECT_EQ(found.log.fingers[0].psi, plain.log.fingers[0].psi);
  EXPECT_EQ(found.truth.s, plain.s);
}

TEST(Noisy, the_same_seed_gives_the_same_log_and_another_one_another) {
  const Noise noise{0.01, 0.02, 0.01, 0.001};
  const NoisyRoll one = noisy_roll(egg_part(), 0.2, long_roll(), noise, 7);
  EXPECT_EQ(noisy_roll(egg_part(), 0.2, long_roll(), noise, 7).log.fingers[0].u, one.log.fingers[0].u);
  EXPECT_NE(noisy_roll(egg_part(), 0.2, long_roll(), noise, 8).log.fingers[0].u, one.log.fingers[0].u);
}

TEST(Noisy, contact_and_angle_are_off_by_what_was_said_in_each_row) {
  const NoisyRoll found = noisy_roll(egg_part(), 0.2, long_roll(), {0.01, 0.03, 0, 0}, 7);
  const Spread u = spread_of(differences(found.log.fingers[0].u, found.truth.log.fingers[0].u));
  const Spread psi = spread_of(differences(found.log.fingers[0].psi, found.truth.log.fingers[0].psi));
  EXPECT_NEAR(0.2 * u.deviation, 0.01, 0.0005) << "along the finger";
  EXPECT_NEAR(0.2 * u.mean, 0, 0.0006);
  EXPECT_NEAR(psi.deviation, 0.03, 0.0015);
  EXPECT_NEAR(psi.mean, 0, 0.002);
}

TEST(Noisy, centres_are_off_by_what_was_said_in_each_row) {
  const NoisyRoll found = noisy_roll(egg_part(), 0.2, long_roll(), {.position = 0.02}, 7);
  const FingerRows& felt = found.log.fingers[0];
  const FingerRows& true_rows = found.truth.log.fingers[0];
  EXPECT_NEAR(spread_of(differences(felt.x, true_rows.x)).deviation, 0.02, 0.001);
  EXPECT_NEAR(spread_of(differences(felt.y, true_rows.y)).deviation, 0.02, 0.001);
  EXPECT_EQ(felt.u, true_rows.u);
}

/// Of errors: their mean product `rows` rows apart, over their variance.
double correlation_of(const std::vector<double>& errors, std::size_t rows) {
  double product = 0;
  double square = 0;
  for (std::size_t k = 0; k + rows < errors.size(); ++k) {
    product += errors[k] * errors[k + rows];
    square += errors[k] * errors[k];
  }
  return product / square;
}

TEST(Noisy, errors_are_alike_over_the_length_that_was_said) {
  RollPlan plan = long_roll(60001);
  plan.distance = 120;  // many of these lengths
  const NoisyRoll found = noisy_roll(egg_part(), 0.2, plan, {.contact = 0.01, .angle = 0.03, .correlation = 0.05}, 7);
  const std::vector<double> psi = differences(found.log.fingers[0].psi, found.truth.log.fingers[0].psi);
  const std::vector<double> u = differences(found.log.fingers[0].u, found.truth.log.fingers[0].u);
  EXPECT_NEAR(spread_of(psi).deviation, 0.03, 0.0015);
  EXPECT_NEAR(0.2 * spread_of(u).deviation, 0.01, 0.0005);
  // The finger turns evenly, so that the lengths between rows differ: of all rows on average about this.
  const double length = 120 / 60000.0;
  for (const std::size_t rows : {5U, 25U, 50U}) {
    const double expected = std::exp(-length * static_cast<double>(rows) / 0.05);
    EXPECT_NEAR(correlation_of(psi, rows), expected, 0.06) << rows;
    EXPECT_NEAR(correlation_of(u, rows), expected, 0.06) << rows;
  }
}

TEST(Noisy, increments_have_no_centres) {
  EXPECT_THAT(refusal_of([] { noisy_increments(egg_part(), 1, 2, 9, {.position = 0.1}, 1); }),
              HasSubstr("noise of simulated increments is contact, angle, slip, drift, walk and gyro"));
}

TEST(Noisy, of_an_outline_the_contact_is_off_in_length) {
  RollPlan plan = long_roll();
  plan.u = 0.1;
  const NoisyRoll found = noisy_roll(egg_part(), rollfix::jaw(), plan, only_contact(0.01), 7);
  EXPECT_NEAR(spread_of(differences(found.log.fingers[0].u, found.truth.log.fingers[0].u)).deviation, 0.01, 0.0005);
}

TEST(Noisy, slip_is_length_that_the_finger_did_not_roll) {
  for (const Finger& finger : {rollfix::disk(0.2), rollfix::jaw(), Finger::outlined(gallery("ellipse,a=0.3,b=0.2"))}) {
    const NoisyRoll found = noisy_roll(egg_part(), finger, long_roll(100), only_slip(0.05), 3);
    ASSERT_NE(found.error[0].slip, 0);
    const std::vector<Reading> felt = readings_as_given(found.log, {finger});
    for (std::size_t row = 0; row < felt.size(); ++row) {
      EXPECT_NEAR((1 + found.error[0].slip) * felt[row].length[0], found.truth.s[0][row] - 1, 1e-12);
      EXPECT_NEAR(felt[row].turn, found.truth.angle[0][row] - found.truth.angle[0][0], 1e-12) << "the normals know";
    }
  }
}

TEST(Noisy, what_slips_still_touches_where_it_is) {
  const Finger finger = Finger::outlined(gallery("ellipse,a=0.3,b=0.2"));
  const NoisyRoll found = noisy_roll(egg_part(), finger, long_roll(100), only_slip(0.05), 3);
  for (std::size_t row = 0; row < found.log.rows(); ++row) {
    const Vec2 touching = egg_part().point(found.truth.s[0][row]);
    const Vec2 centre = centre_of(finger, touching, {found.log.fingers[0].u[row], found.log.fingers[0].psi[row]});
    EXPECT_NEAR(centre.x(), found.log.fingers[0].x[row], 1e-12);
    EXPECT_NEAR(centre.y(), found.log.fingers[0].y[row], 1e-12);
  }
}

TEST(Noisy, the_slips_of_many_rolls_have_the_spread_that_was_said) {
  std::vector<double> slips;
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    slips.push_back(noisy_increments(egg_part(), 1, 2, 1, only_slip(0.02), seed).error.slip);
  }
  EXPECT_NEAR(spread_of(slips).deviation, 0.02, 0.002);
  EXPECT_NEAR(spread_of(slips).mean, 0, 0.002);
}

TEST(Noisy, a_reader_with_the_wrong_radius_gets_lengths_in_its_proportion) {
  const NoisyRoll found = noisy_roll(egg_part(), 0.2, long_roll(100), {0, 0, 0, 0.01}, 3);
  ASSERT_NE(found.error[0].radius, 0);
  const std::vector<Reading> felt = readings_as_given(found.log, {rollfix::disk(0.2)});
  EXPECT_NEAR(felt.back().length[0] * (0.2 + found.error[0].radius) / 0.2, 6, 1e-9);
  EXPECT_NEAR(felt.back().turn, found.truth.angle[0].back() - found.truth.angle[0].front(), 1e-9);
}

TEST(Noisy, two_fingers_err_independently) {
  FreePlan plan;
  plan.fingers[0] = {{0.2}, 1, 0, 2.0, {}};
  plan.fingers[1] = {{0.3}, 5, 0, -1.0, {}};
  plan.part_rotation = 0.3;
  const NoisyRoll found = noisy_roll_free(egg_part(), plan, {0, 0, 0.03, 0.01}, 4);
  EXPECT_NE(found.error[0].slip, found.error[1].slip);
  const std::vector<Reading> felt = readings_as_given(
      found.log, {rollfix::disk(0.2 + found.error[0].radius), rollfix::disk(0.3 + found.error[1].radius)});
  EXPECT_NEAR((1 + found.error[0].slip) * felt.back().length[0], 2, 1e-9);
  EXPECT_NEAR((1 + found.error[1].slip) * felt.back().length[1], -1, 1e-9);
  const double turn =
      (found.truth.angle[0].back() - found.truth.angle[0][0]) - (found.truth.angle[1].back() - found.truth.angle[1][0]);
  EXPECT_NEAR(felt.back().turn, turn, 1e-9);
}

TEST(Noisy, increments_walk_away_from_the_truth) {
  std::vector<double> length_errors;
  std::vector<double> turn_errors;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    const NoisyIncrements found = noisy_increments(egg_part(), 1, 2, 100, {0.01, 0.02, 0, 0}, seed);
    EXPECT_DOUBLE_EQ(found.s.back(), 3);
    length_errors.push_back(found.log.fingers[0].length.back() - 2);
    turn_errors.push_back(found.log.fingers[0].turn.back() - shapes::reading_from(egg_part(), 1, 2).turn);
  }
  EXPECT_NEAR(spread_of(length_errors).deviation, 0.1, 0.01) << "ten steps' deviation after a hundred";
  EXPECT_NEAR(spread_of(turn_errors).deviation, 0.2, 0.02);
}

TEST(Noisy, increments_slip_as_lengths_do) {
  const NoisyIncrements found = noisy_increments(egg_part(), 1, 2, 100, only_slip(0.05), 3);
  ASSERT_NE(found.error.slip, 0);
  EXPECT_NEAR((1 + found.error.slip) * found.log.fingers[0].length.back(), 2, 1e-12);
}

TEST(Noisy, a_gyroscope_walks_by_the_root_of_the_time_however_often_it_is_read) {
  Noise noise;
  noise.walk = 0.02;
  for (const std::size_t rows : {11U, 101U}) {
    std::vector<double> off;
    double seconds = 0;
    for (std::uint64_t seed = 0; seed < 1000; ++seed) {
      const NoisyRoll found = noisy_roll(egg_part(), 0.2, long_roll(rows), noise, seed);
      off.push_back(found.log.fingers[0].psi.back() - found.truth.log.fingers[0].psi.back());
      seconds = found.log.time.back() - found.log.time.front();
    }
    EXPECT_NEAR(spread_of(off).deviation, noise.walk * std::sqrt(seconds), 0.1 * noise.walk * std::sqrt(seconds));
  }
}

TEST(Noisy, what_can_not_be_is_refused) {
  EXPECT_THAT(refusal_of([] { noisy_roll(egg_part(), 0.2, long_roll(), only_contact(-1), 1); }),
              HasSubstr("at least 0"));
  EXPECT_THAT(refusal_of([] { noisy_roll(egg_part(), 0.2, long_roll(), only_contact(NAN), 1); }), HasSubstr("nan"));
  EXPECT_THAT(refusal_of([] {
                noisy_roll(egg_part(), rollfix::jaw(), long_roll(), {0, 0, 0, 0.1}, 1);
              }),
              HasSubstr("leave the radius out"));
  EXPECT_THAT(refusal_of([] { noisy_increments(egg_part(), 1, 2, 0, {}, 1); }), HasSubstr("at least 1 row"));
  EXPECT_THAT(refusal_of([] { noisy_increments(Part(gallery("exponential")), 1, 200, 9, {}, 1); }),
              HasSubstr("stays in"));
}

}  // namespace
}  // namespace rollfix::noisy_test
