#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "belief_cases.hpp"

// Over many simulated logs: what is claimed with 95 % is true 95 times of 100, by family of parts.
namespace belief_calibration_test {

using namespace belief_cases;

namespace {

// As many standard deviations of a binomial count are allowed: one test of ten thousand fails by chance.
constexpr double kSigmas = 4;

// After short rolls the interval is a little wide, because a mode ends where the density is least.
constexpr double kCaution = 0.02;

struct Family {
  std::string name;
  std::string shape;
  double radius_share;  // of the perimeter
};

void PrintTo(const Family& family, std::ostream* out) { *out << family.name; }

void expect_calibrated(const Tally& tally, const Family& family) {
  std::printf("%s: %d cases, %.1f %% within the 95 %% interval, %.1f %% listed, %.1f %% first (claimed %.1f %%)\n",
              family.name.c_str(), tally.cases, 100 * tally.share_inside(), 100.0 * tally.listed / tally.cases,
              100.0 * tally.first / tally.cases, 100 * tally.claimed / tally.cases);
  const double spread = kSigmas * std::sqrt(0.05 * 0.95 / tally.cases);
  EXPECT_GE(tally.share_inside(), 0.95 - spread);
  EXPECT_LE(tally.share_inside(), 0.95 + spread + kCaution);
  EXPECT_GE(tally.listed, 0.99 * tally.cases - 1);
}

}  // namespace

class BeliefCalibration : public testing::TestWithParam<Family> {};

TEST_P(BeliefCalibration, the_95_percent_interval_holds_the_truth_95_times_of_100) {
  const Part part = part_of(GetParam().shape);
  const double radius = GetParam().radius_share * part.perimeter();
  expect_calibrated(tally(part, radius, 0.4, noise_on(part, 1e-3, 5e-3, 5e-3), test_count(150), 1), GetParam());
}

TEST_P(BeliefCalibration, also_after_short_rolls) {
  const Part part = part_of(GetParam().shape);
  const double radius = GetParam().radius_share * part.perimeter();
  expect_calibrated(tally(part, radius, 0.05, noise_on(part, 1e-3, 5e-3, 1e-2), test_count(150), 2), GetParam());
}

TEST_P(BeliefCalibration, the_most_probable_place_is_true_as_often_as_it_is_claimed) {
  const Part part = part_of(GetParam().shape);
  const double radius = GetParam().radius_share * part.perimeter();
  const Tally found = tally(part, radius, 0.08, noise_on(part, 2e-3, 1e-2, 1e-2), test_count(150), 3);
  EXPECT_NEAR(found.first, found.claimed, kSigmas * std::sqrt(found.claimed_variance + 1));
}

INSTANTIATE_TEST_SUITE_P(Gallery, BeliefCalibration,
                         testing::Values(Family{"ellipse", "ellipse,a=2,b=1", 0.03}, Family{"cam", "cam", 0.03},
                                         Family{"spline", "spline,n=9,seed=7,wobble=0.2", 0.03},
                                         Family{"limacon", "limacon", 0.03}, Family{"gear", "gear", 0.002},
                                         Family{"stadium", "stadium", 0.03}, Family{"reuleaux", "reuleaux", 0.03},
                                         Family{"superellipse", "superellipse", 0.03}, Family{"naca", "naca", 0.03}),
                         [](const testing::TestParamInfo<Family>& of) { return of.param.name; });

TEST(BeliefCalibrationOfIncrements, a_wheel_and_a_gyroscope_are_known_as_well_as_they_say) {
  const Part part = part_of("spline,n=12,seed=5,wobble=0.3");
  const Noise noise{2e-4 * part.perimeter(), 2e-3, 5e-3, 0};
  std::mt19937_64 random = test_generator(4);
  std::uniform_real_distribution<double> unit;
  Tally result;
  for (int k = 0; k < test_count(150); ++k) {
    const double start = unit(random) * part.perimeter();
    const double length = 0.4 * part.perimeter() * (0.5 + unit(random));
    const rollfix::NoisyIncrements course = rollfix::noisy_increments(part, start, length, 200, noise, random());
    BeliefOptions options;
    options.noise = noise;
    Belief belief(part, rollfix::LogKind::increments, options);
    for (std::size_t row = 0; row < course.log.rows(); ++row) {
      rollfix::Sample sample;
      sample.reading = {course.log.fingers[0].length[row], course.log.fingers[0].turn[row]};
      belief.add(sample);
    }
    result.add(belief.modes(), start, part);
  }
  EXPECT_GE(result.share_inside(), 0.95 - kSigmas * std::sqrt(0.05 * 0.95 / result.cases));
  EXPECT_GE(result.listed, 0.99 * result.cases - 1);
}

}  // namespace belief_calibration_test
