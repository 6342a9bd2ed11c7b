#include "belief/even_rows.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "random.hpp"

// Rows of a smooth motion, averaged, and what tells that a motion is not smooth.
namespace even_rows_test {
namespace {

using rollfix::belief::at_middles;
using rollfix::belief::Course;
using rollfix::belief::is_even;

constexpr std::size_t kRows = 200;
constexpr double kNoise = 0.01;

/// A measurement over a time from 0 to 1.
Course measured(const std::function<double(double)>& motion, double noise = kNoise) {
  std::mt19937_64 generator = test_generator(1);
  std::normal_distribution<double> off(0, noise);
  Course rows{{}, kNoise};
  for (std::size_t k = 0; k < kRows; ++k)
    rows.values.push_back(motion(static_cast<double>(k) / kRows) + off(generator));
  return rows;
}

/// Exact means over twelve twelfths of it, as of so many rows.
Course means_of(const std::function<double(double)>& integral, double rows) {
  Course means{{}, kNoise / std::sqrt(rows)};
  for (int k = 0; k < 12; ++k) means.values.push_back(12 * (integral((k + 1) / 12.0) - integral(k / 12.0)));
  return means;
}

double arc(double time) { return std::sin(2 * time); }
double integral_of_arc(double time) { return -0.5 * std::cos(2 * time); }
/// Goes evenly, from the middle on twice as fast, in `steepness`.
double integral_of_kink(double time, double steepness) {
  const double after = std::max(0.0, time - 0.54);
  return 0.5 * steepness * (time * time + after * after);
}

TEST(EvenRows, OfASmoothMotionWithItsNoiseAreEven) { EXPECT_TRUE(is_even(measured(arc))); }

TEST(EvenRows, ThatAreTwiceAsNoisyAreNot) { EXPECT_FALSE(is_even(measured(arc, 2 * kNoise))); }

TEST(EvenRows, WithOneThatIsFarOffAreNot) {
  Course rows = measured(arc);
  rows.values[77] += 30 * kNoise;
  EXPECT_FALSE(is_even(rows));
}

TEST(EvenRows, AreAsTheyWereInTheMiddleOfEachMean) {
  const auto middles = at_middles(means_of(integral_of_arc, 16));
  ASSERT_TRUE(middles);
  // Left is 3/640 of the fourth difference, 16 / 12^4; at both ends a 24th of the third.
  for (std::size_t k = 0; k < 12; ++k) {
    EXPECT_NEAR((*middles)[k], arc((static_cast<double>(k) + 0.5) / 12), k == 0 || k == 11 ? 2e-4 : 4e-6) << k;
  }
}

TEST(EvenRows, OfLotsThatAreNotEquallyLongAreAsTheyWereInTheMiddleOfEach) {
  Course means{{}, kNoise, {}};
  std::vector<double> middles;
  double from = 0;
  for (int k = 0; k < 13; ++k) {
    const double rows = k % 3 == 0 ? 2 : 3;
    const double to = from + rows / 35;
    means.values.push_back((integral_of_arc(to) - integral_of_arc(from)) / (to - from));
    means.rows.push_back(rows);
    middles.push_back(0.5 * (from + to));
    from = to;
  }
  const std::vector<double> found = at_middles(means).value();
  for (std::size_t k = 1; k < 12; ++k) EXPECT_NEAR(found[k], arc(middles[k]), 1e-4) << k;
}

TEST(EvenRows, AcrossAKinkThatNoiseDoesNotHideAreNotAveraged) {
  EXPECT_FALSE(at_middles(means_of([](double time) { return integral_of_kink(time, 2); }, 100)));
  EXPECT_TRUE(at_middles(means_of([](double time) { return integral_of_kink(time, 0.1); }, 100)));
}

}  // namespace
}  // namespace even_rows_test
