// Parts taught from noisy rows, from more than one lap, and how accurate they say they are.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "random.hpp"
#include "refusal.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/part.hpp"
#include "rollfix/rolling.hpp"
#include "rollfix/solve.hpp"
#include "rollfix/teach.hpp"
#include "shapes.hpp"

namespace teach_noise_test {
namespace {

using rollfix::Accuracy;
using rollfix::Closing;
using rollfix::Log;
using rollfix::LogKind;
using rollfix::Noise;
using rollfix::Part;
using rollfix::Taught;
using rollfix::TeachOptions;
using testing::HasSubstr;

constexpr double kDegree = shapes::kPi / 180;

Part shape(const std::string& name) { return Part(rollfix::gallery(name)); }

/// Length and turn of a drive from s = 0 on, in equal steps, each turn with noise of its own.
Log drive(const Part& part, double laps, int rows, double noise, std::uint64_t seed = 1) {
  std::mt19937_64 random = test_generator(seed);
  std::normal_distribution<double> normal;
  Log log;
  log.name = "drive.csv";
  log.kind = LogKind::travelled;
  for (int k = 1; k <= rows; ++k) {
    const double s = laps * part.perimeter() * k / rows;
    log.fingers[0].length.push_back(s);
    log.fingers[0].turn.push_back(part.turning().angle(s) - part.turning().angle(0) + noise * normal(random));
  }
  return log;
}

Taught taught_by(const Log& log, const Noise& noise = {}) {
  TeachOptions options;
  if (noise.angle > 0) options.noise = noise;
  return rollfix::teach(log, options);
}

/// Of tangents at equal shares of the perimeter, less what they have in common: root mean square, radians.
double error_of(const Part& taught, const Part& truth) {
  std::vector<double> off;
  double mean = 0;
  for (int k = 0; k < 500; ++k) {
    const double share = (k + 0.5) / 500;
    off.push_back(taught.turning().angle(share * taught.perimeter()) -
                  truth.turning().angle(share * truth.perimeter()));
    mean += off.back() / 500;
  }
  double sum = 0;
  for (const double each : off) sum += (each - mean) * (each - mean) / 500;
  return std::sqrt(sum);
}

// ---- Laps.

class TeachLaps : public testing::TestWithParam<double> {};

TEST_P(TeachLaps, exact_ones_give_the_part_whatever_they_go_on) {
  for (const char* const name : {"ellipse", "cam", "limacon", "stadium", "spline,n=9,seed=7,wobble=0.2"}) {
    const Part truth = shape(name);
    const Taught taught = taught_by(drive(truth, GetParam(), static_cast<int>(800 * GetParam()) + 7, 0));
    EXPECT_EQ(taught.closing, Closing::spread) << name;
    EXPECT_NEAR(taught.lap, truth.perimeter(), 1e-6 * truth.perimeter()) << name;
    EXPECT_NEAR(taught.overlap, (GetParam() - 1) * truth.perimeter(), 1e-6 * truth.perimeter()) << name;
    EXPECT_LT(error_of(Part(taught.outline), truth), 2e-4) << name;
  }
}

TEST_P(TeachLaps, of_a_square_keep_its_corners) {
  rollfix::RollPlan plan;
  plan.start = 0.4;
  plan.distance = 4 * GetParam();
  plan.rows = static_cast<std::size_t>(500 * GetParam());
  TeachOptions options;
  options.finger = rollfix::disk(0.1);
  const Taught taught =
      rollfix::teach(rollfix::roll(shapes::unit_square(), rollfix::DiskFinger{0.1}, plan).log, options);
  const Part part(taught.outline);
  EXPECT_NEAR(part.perimeter(), 4, 1e-6);
  ASSERT_EQ(part.corners().size(), 4U);
  for (const rollfix::Corner& corner : part.corners()) EXPECT_NEAR(corner.turn, shapes::kPi / 2, 1e-6);
}

TEST_P(TeachLaps, are_found_by_what_their_noisy_overlap_says) {
  const Part truth = shape("cam");
  const Taught taught = taught_by(drive(truth, GetParam(), 2000, kDegree), {0, kDegree, 0, 0});
  EXPECT_NEAR(taught.lap, truth.perimeter(), 2e-3 * truth.perimeter());
  EXPECT_EQ(taught.rows, 2001U);  // all passes', and the start
}

INSTANTIATE_TEST_SUITE_P(Laps, TeachLaps, testing::Values(1.1, 1.5, 2.3),
                         [](const auto& of) { return fmt::format("times_{:.0f}_tenths", 10 * of.param); });

// ---- Noise.

class TeachNoise : public testing::TestWithParam<std::string> {};

TEST_P(TeachNoise, of_a_degree_over_a_thousand_rows_leaves_a_fifth_of_it) {
  const Part truth = shape(GetParam());
  double sum = 0;
  double said = 0;
  const int count = test_count(8);
  for (int k = 0; k < count; ++k) {
    const Taught taught =
        taught_by(drive(truth, 1, 1000, kDegree, 10 + static_cast<std::uint64_t>(k)), {0, kDegree, 0, 0});
    ASSERT_EQ(taught.closing, Closing::spread);
    EXPECT_NEAR(taught.row_sd, kDegree, 0.1 * kDegree);
    const double error = error_of(Part(taught.outline), truth);
    sum += error * error / count;
    said += taught.outline.accuracy.turn / count;
  }
  EXPECT_LT(std::sqrt(sum), 0.25 * kDegree);
  EXPECT_LT(std::sqrt(sum), 1.6 * said);
  EXPECT_GT(std::sqrt(sum), 0.4 * said);
}

INSTANTIATE_TEST_SUITE_P(Gallery, TeachNoise, testing::Values("ellipse,a=2,b=1", "cam", "ellipse,a=1.2,b=1"),
                         shapes::as_identifier);

TEST(TeachAccuracy, of_a_second_lap_is_better_by_the_root_of_two) {
  const Part truth = shape("cam");
  const double once = taught_by(drive(truth, 1, 1000, kDegree), {0, kDegree, 0, 0}).outline.accuracy.turn;
  const double twice = taught_by(drive(truth, 2, 2000, kDegree), {0, kDegree, 0, 0}).outline.accuracy.turn;
  EXPECT_NEAR(once / twice, std::sqrt(2), 0.35);
}

TEST(TeachAccuracy, of_rows_that_are_noisier_than_said_is_as_found) {
  const Taught taught = taught_by(drive(shape("cam"), 1, 1000, 3 * kDegree), {0, kDegree, 0, 0});
  EXPECT_NEAR(taught.row_sd, 3 * kDegree, 0.4 * kDegree);
  EXPECT_THAT(fmt::format("{}", fmt::join(taught.notes, "\n")), HasSubstr("more than the noise given"));
}

TEST(TeachAccuracy, of_exact_rows_is_as_good_as_their_distance) {
  const Part truth = shape("cam");
  const Accuracy accuracy = taught_by(drive(truth, 1, 400, 0)).outline.accuracy;
  EXPECT_GE(6.4 * accuracy.turn, error_of(Part(taught_by(drive(truth, 1, 400, 0)).outline), truth));
  EXPECT_LT(accuracy.turn, 1e-4);
}

TEST(TeachAccuracy, widens_the_search_without_noise_so_that_it_finds_the_place) {
  const Part truth = shape("cam");
  const Part part(taught_by(drive(truth, 1, 1000, kDegree), {0, kDegree, 0, 0}).outline);
  const rollfix::Reading reading = shapes::reading_from(truth, 1.7, 0.9);
  const rollfix::Answer answer = rollfix::solve({part, reading});
  EXPECT_EQ(answer.tolerance.source, rollfix::Tolerance::Source::part);
  EXPECT_GT(answer.tolerance.value, part.outline().accuracy.turn);
  EXPECT_TRUE(std::any_of(answer.placements.begin(), answer.placements.end(), [&](const rollfix::Placement& found) {
    return part.boundary().distance(found.start[0], 1.7) < 0.2;
  }));
}

TEST(TeachAccuracy, makes_intervals_on_taught_parts_hold_the_truth) {
  const Part truth = shape("cam");
  const double P = truth.perimeter();
  const Noise noise{1e-4 * P, kDegree, 0, 0};
  const rollfix::Finger finger = rollfix::disk(0.03 * P);
  const auto roll = [&](double start, double length, std::size_t rows, std::uint64_t seed) {
    rollfix::RollPlan plan;
    plan.start = start;
    plan.distance = length;
    plan.rows = rows;
    return rollfix::noisy_roll(truth, finger, plan, noise, seed);
  };
  std::mt19937_64 random = test_generator(3);
  std::uniform_real_distribution<double> unit;
  int within = 0;
  int within_of_exact = 0;
  int cases = 0;
  for (int k = 0; k < test_count(12); ++k) {
    const rollfix::NoisyRoll around = roll(0.3, P, 1000, random());
    Log log = around.log;  // its first row is where both outlines start
    log.fingers[0].u[0] = around.truth.log.fingers[0].u[0];
    log.fingers[0].psi[0] = around.truth.log.fingers[0].psi[0];
    TeachOptions options;
    options.finger = finger;
    options.noise = noise;
    rollfix::Outline outline = rollfix::teach(log, options).outline;
    const Part taught(outline);
    outline.accuracy = {};
    const Part as_exact(outline);
    for (int later = 0; later < 8; ++later, ++cases) {
      const double start = P * unit(random);
      const Log felt = roll(start, P * (0.1 + 0.5 * unit(random)), 200, random()).log;
      const double place = truth.boundary().on_first_lap(start - 0.3) * taught.perimeter() / P;
      const auto holds = [&](const Part& part) {
        const rollfix::Answer answer = rollfix::solve({part, felt, {finger}, noise});
        return std::any_of(answer.placements.begin(), answer.placements.end(), [&](const rollfix::Placement& found) {
          return part.boundary().contains(found.interval[0], place);
        });
      };
      within += holds(taught) ? 1 : 0;
      within_of_exact += holds(as_exact) ? 1 : 0;
    }
  }
  EXPECT_GE(within, 0.95 * cases - 4 * std::sqrt(0.95 * 0.05 * cases));
  EXPECT_LT(within_of_exact, within);
}

// ---- A gyroscope's drift.

/// The same drive, a hundred seconds long, whose gyroscope has a bias.
Log with_bias(Log log, double bias) {
  const auto rows = log.fingers[0].turn.size();
  for (std::size_t k = 0; k < rows; ++k) {
    log.time.push_back(100.0 * static_cast<double>(k + 1) / static_cast<double>(rows));
    log.fingers[0].turn[k] += bias * log.time.back();
  }
  return log;
}

TEST(TeachDrift, of_a_bias_is_spread_where_the_datasheet_allows_it) {
  const Part truth = shape("cam");
  const double bias = 0.02 * kDegree;  // per second: two degrees in all
  const Log log = with_bias(drive(truth, 1, 1000, 0.05 * kDegree), bias);
  Noise noise{0, 0.05 * kDegree, 0, 0};
  noise.drift = bias;
  const Taught taught = taught_by(log, noise);
  EXPECT_EQ(taught.closing, Closing::spread);
  EXPECT_LT(error_of(Part(taught.outline), truth), 0.2 * kDegree);
}

TEST(TeachDrift, without_times_is_refused) {
  Noise noise{0, kDegree, 0, 0};
  noise.walk = 1e-4;
  EXPECT_THAT(refusal_of([&] { taught_by(drive(shape("cam"), 1, 100, 0), noise); }),
              HasSubstr("drive.csv: has no times, and the noise's walk gathers with time"));
}

TEST(DriftVariance, is_a_datasheets) {
  Noise noise;
  noise.drift = 2;
  noise.walk = 3;
  // A bias of sd 2 is off by 2 t, a walk of sd 3 by 3 sqrt(t); from 4 to 9 seconds that is what the squares differ by.
  EXPECT_NEAR(rollfix::drift_variance(noise, LogKind::increments, 1, {4, 9}), 4 * (81 - 16) + 9 * 5, 1e-12);
}

TEST(DriftVariance, of_an_angle_alone_is_a_rows_over_a_perimeter) {
  const Noise noise{0, 0.1, 0, 0};
  EXPECT_NEAR(rollfix::drift_variance(noise, LogKind::travelled, 0.5, {}), 0.005, 1e-15);
  EXPECT_EQ(rollfix::drift_variance(noise, LogKind::contact, 0.5, {}), 0);
}

}  // namespace
}  // namespace teach_noise_test
