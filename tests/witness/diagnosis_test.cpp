// One mistake in a log, or in what was said of it: the answer does not pretend to fit, and names the mistake.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "belief_cases.hpp"
#include "noisy_pairs.hpp"
#include "rollfix/solve.hpp"

namespace diagnosis_test {
namespace {

using belief_cases::part_of;
using rollfix::Answer;
using rollfix::Cause;
using rollfix::Diagnosis;
using rollfix::FingerRows;
using rollfix::Noise;
using rollfix::Part;
using rollfix::PerFinger;
using rollfix::Problem;
using rollfix::Verdict;

constexpr double kDegrees = 180 / std::numbers::pi;
constexpr double kRadiusShare = 0.02;  // of the perimeter

void scale(std::vector<double>& values, double by) {
  for (double& value : values) value *= by;
}

/// An honest log, and all that is said of it is true.
struct Case {
  Problem problem;
  PerFinger<double> start;

  double perimeter() const { return problem.part.perimeter(); }
  std::vector<FingerRows>& rows() { return problem.measured.log->fingers; }
  void say_radius(double times) {
    for (rollfix::Finger& finger : problem.fingers) finger = rollfix::disk(times * finger.disk()->radius);
  }
};

Noise noise_on(const Part& part) { return {5e-4 * part.perimeter(), 5e-3, 0, 0}; }

Case one_finger(const std::string& shape, std::uint64_t seed = 1) {
  const Part part = part_of(shape);
  const double start = 0.3 * part.perimeter();
  const double radius = kRadiusShare * part.perimeter();
  rollfix::RollPlan plan;
  plan.start = start;
  plan.distance = 0.6 * part.perimeter();
  plan.rows = 300;
  const rollfix::NoisyRoll roll =
      rollfix::noisy_roll(part, rollfix::disk(radius), plan, noise_on(part), test_seed() + seed);
  return {{part, roll.log, {rollfix::disk(radius)}, noise_on(part)}, start};
}

Case two_fingers(const std::string& shape, std::uint64_t seed = 1) {
  const Part part = part_of(shape);
  const double P = part.perimeter();
  const std::array<double, 2> start = {0.1 * P, 0.5 * P};
  const double radius = kRadiusShare * P;
  rollfix::FreePlan plan = free_rolls::by_distances(radius, start[0], 0.6 * P, radius, start[1], 0.3 * P, -0.3);
  plan.rows = 300;
  const rollfix::NoisyRoll roll = rollfix::noisy_roll_free(part, plan, noise_on(part), test_seed() + seed);
  return {{part, roll.log, {rollfix::disk(radius)}, noise_on(part)}, {start[0], start[1]}};
}

/// From row 135 to row 165 the finger slides along the part by so much more than it rolls.
void drag(Case& log, double length) {
  FingerRows& rows = log.rows()[0];
  const double angle = length / log.problem.fingers[0].disk()->radius;
  for (std::size_t k = 0; k < rows.u.size(); ++k) {
    const double so_far = std::clamp((static_cast<double>(k) - 135) / 30, 0.0, 1.0) * angle;
    rows.u[k] -= so_far;
    rows.psi[k] += so_far;
  }
}

bool holds(const rollfix::Mode& mode, const Case& of) {
  for (std::size_t finger = 0; finger < of.start.size(); ++finger) {
    if (!belief_cases::holds(mode.region[finger], of.start[finger], of.problem.part)) return false;
  }
  return true;
}

bool admits_it(const Answer& answer) {
  return answer.verdict.fits_badly || answer.verdict.name == Verdict::inconsistent;
}

std::string listing(const Answer& answer) {
  std::string text = answer.verdict.text() + ", excess " + std::to_string(answer.weighing->fit.excess) + "; causes";
  for (const Diagnosis& diagnosis : answer.diagnoses) {
    text += " " + std::to_string(static_cast<int>(diagnosis.cause)) + " (excess " + std::to_string(diagnosis.excess) +
            ", lengths " + std::to_string(diagnosis.length_scale) + ")";
  }
  return text;
}

/// The one that names the cause; a failed expectation where none does.
Diagnosis named(const Answer& answer, Cause cause) {
  EXPECT_TRUE(admits_it(answer)) << listing(answer);
  const std::vector<Diagnosis>& all = answer.diagnoses;
  const auto found = std::find_if(all.begin(), all.end(), [&](const Diagnosis& each) { return each.cause == cause; });
  EXPECT_NE(found, all.end()) << listing(answer);
  return found == all.end() ? Diagnosis{} : *found;
}

/// ... and without that mistake the answer would be right.
Diagnosis expect_cured(const Case& of, Cause cause) {
  const Answer answer = solve(of.problem);
  Diagnosis diagnosis = named(answer, cause);
  const bool is_there = std::any_of(diagnosis.modes.begin(), diagnosis.modes.end(),
                                    [&](const rollfix::Mode& mode) { return holds(mode, of); });
  EXPECT_TRUE(is_there) << listing(answer);
  return diagnosis;
}

const std::vector<std::string>& shapes() {
  static const std::vector<std::string> all = {"cam", "limacon", "spline,n=9,seed=7,wobble=0.2", "naca"};
  return all;
}

template <class Spoil>
void expect_cured_everywhere(Spoil spoil, Cause cause) {
  for (const std::string& shape : shapes()) {
    SCOPED_TRACE(shape);
    Case spoilt = one_finger(shape);
    spoil(spoilt);
    expect_cured(spoilt, cause);
  }
}

}  // namespace

TEST(Diagnosis, says_nothing_of_an_honest_log) {
  for (const std::string& shape : shapes()) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      const Answer answer = solve(one_finger(shape, seed).problem);
      EXPECT_FALSE(admits_it(answer)) << shape << ": " << listing(answer);
      EXPECT_TRUE(answer.diagnoses.empty()) << shape << ": " << listing(answer);
    }
  }
}

class DiagnosisOfLengths : public testing::TestWithParam<double> {};

TEST_P(DiagnosisOfLengths, estimates_the_radius_that_was_said_wrong_whatever_its_size) {
  for (const std::string& shape : shapes()) {
    SCOPED_TRACE(shape);
    Case spoilt = one_finger(shape);
    spoilt.say_radius(GetParam());
    const Diagnosis diagnosis = expect_cured(spoilt, Cause::radius);
    EXPECT_NEAR(diagnosis.length_scale * GetParam(), 1, 4 * diagnosis.length_scale_sd * GetParam());
    EXPECT_LT(diagnosis.length_scale_sd * GetParam(), 0.02);
  }
}

INSTANTIATE_TEST_SUITE_P(Factors, DiagnosisOfLengths, testing::Values(0.94, 1.06, 0.5, 2, 10, 25.4),
                         [](const auto& of) { return "case" + std::to_string(of.index); });

TEST(Diagnosis, names_u_that_is_counted_clockwise) {
  expect_cured_everywhere([](Case& log) { scale(log.rows()[0].u, -1); }, Cause::u_clockwise);
}

TEST(Diagnosis, names_psi_that_is_counted_clockwise) {
  expect_cured_everywhere([](Case& log) { scale(log.rows()[0].psi, -1); }, Cause::psi_clockwise);
}

TEST(Diagnosis, names_angles_that_are_all_counted_clockwise) {
  expect_cured_everywhere([](Case& log) { scale(log.rows()[0].u, -1), scale(log.rows()[0].psi, -1); },
                          Cause::both_clockwise);
}

TEST(Diagnosis, names_psi_in_degrees) {
  expect_cured_everywhere([](Case& log) { scale(log.rows()[0].psi, kDegrees); }, Cause::psi_degrees);
}

TEST(Diagnosis, names_u_and_psi_that_are_exchanged) {
  expect_cured_everywhere([](Case& log) { std::swap(log.rows()[0].u, log.rows()[0].psi); }, Cause::u_psi_swapped);
}

TEST(Diagnosis, measures_the_scale_of_a_gyroscope_that_psi_comes_from) {
  for (const std::string& shape : shapes()) {
    SCOPED_TRACE(shape);
    Case spoilt = one_finger(shape);
    std::vector<double>& psi = spoilt.rows()[0].psi;
    const double first = psi.front();
    for (double& each : psi) each = first + (each - first) / 0.95;
    const Diagnosis diagnosis = expect_cured(spoilt, Cause::gyroscope);
    EXPECT_NEAR(diagnosis.turn_scale, 0.95, 4 * diagnosis.turn_scale_sd);
    EXPECT_LT(diagnosis.turn_scale_sd, 0.02);
  }
}

TEST(Diagnosis, names_one_stray_row) {
  expect_cured_everywhere([](Case& log) { log.rows()[0].psi[170] += 0.2; }, Cause::stray);
}

TEST(Diagnosis, measures_the_noise_that_was_said_three_times_too_small) {
  for (const std::string& shape : shapes()) {
    SCOPED_TRACE(shape);
    Case spoilt = one_finger(shape);
    spoilt.problem.noise->contact /= 3;
    spoilt.problem.noise->angle /= 3;
    EXPECT_NEAR(expect_cured(spoilt, Cause::noise).noise_scale, 3, 0.4);
  }
}

TEST(Diagnosis, names_a_prior_that_the_rows_contradict) {
  expect_cured_everywhere(
      [](Case& log) {
        log.problem.prior = rollfix::Prior{log.start[0] + 0.4 * log.perimeter(), 0.02 * log.perimeter()};
      },
      Cause::prior);
}

TEST(Diagnosis, names_a_finger_that_was_dragged_along_once) {
  // Half way, within a tenth of the rows, the length that it felt falls short by so much of the perimeter.
  for (const double share : {0.01, 0.03}) {
    for (const std::string& shape : shapes()) {
      SCOPED_TRACE(shape + ", " + std::to_string(share));
      Case spoilt = one_finger(shape);
      drag(spoilt, share * spoilt.perimeter());
      expect_cured(spoilt, Cause::slip);
    }
  }
}

TEST(Diagnosis, of_another_part_is_never_sure_of_a_place) {
  for (const std::string& shape : shapes()) {
    SCOPED_TRACE(shape);
    Case of = one_finger(shape);
    of.problem.part = part_of("spline,n=7,seed=11,wobble=0.3");
    of.say_radius(of.perimeter() / part_of(shape).perimeter());
    of.problem.noise = noise_on(of.problem.part);
    const Answer answer = solve(of.problem);
    EXPECT_TRUE(admits_it(answer)) << listing(answer);
    EXPECT_FALSE(answer.diagnoses.empty());
    for (const rollfix::Placement& place : answer.placements) EXPECT_LT(place.probability, 0.9) << listing(answer);
  }
}

TEST(DiagnosisOfTwo, says_nothing_of_an_honest_log) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const Answer answer = solve(two_fingers("cam", seed).problem);
    EXPECT_FALSE(admits_it(answer)) << listing(answer);
    EXPECT_TRUE(answer.diagnoses.empty()) << listing(answer);
  }
}

TEST(DiagnosisOfTwo, estimates_a_radius_that_is_a_tenth_too_small) {
  Case spoilt = two_fingers("cam");
  spoilt.say_radius(0.9);
  const Diagnosis diagnosis = expect_cured(spoilt, Cause::radius);
  EXPECT_NEAR(diagnosis.length_scale * 0.9, 1, 4 * diagnosis.length_scale_sd * 0.9);
}

TEST(DiagnosisOfTwo, names_fingers_that_are_exchanged) {
  const Part part = part_of("cam");
  const double P = part.perimeter();
  const std::vector<rollfix::Finger> fingers = {rollfix::disk(0.02 * P), rollfix::disk(0.03 * P)};
  rollfix::FreePlan plan = free_rolls::by_distances(0.02 * P, 0.1 * P, 0.6 * P, 0.03 * P, 0.5 * P, 0.3 * P, -0.3);
  plan.rows = 300;
  const rollfix::NoisyRoll roll = rollfix::noisy_roll_free(part, plan, noise_on(part), test_seed() + 1);
  const Case spoilt{{part, roll.log, {fingers[1], fingers[0]}, noise_on(part)}, {0.1 * P, 0.5 * P}};
  expect_cured(spoilt, Cause::fingers_swapped);
}

TEST(DiagnosisOfTwo, names_u_that_is_counted_clockwise) {
  Case spoilt = two_fingers("cam");
  for (FingerRows& rows : spoilt.rows()) scale(rows.u, -1);
  expect_cured(spoilt, Cause::u_clockwise);
}

TEST(DiagnosisOfTwo, measures_the_noise_that_was_said_three_times_too_small) {
  Case spoilt = two_fingers("cam");
  spoilt.problem.noise->contact /= 3;
  spoilt.problem.noise->angle /= 3;
  EXPECT_NEAR(expect_cured(spoilt, Cause::noise).noise_scale, 3, 0.4);
}

}  // namespace diagnosis_test
