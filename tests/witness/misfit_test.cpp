// What is told of rows that fit badly, or too well, and of what was said beforehand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "belief/posterior.hpp"
#include "belief_cases.hpp"
#include "cli.hpp"
#include "rollfix/solve.hpp"

namespace misfit_test {
namespace {

using belief_cases::part_of;
using rollfix::Answer;
using rollfix::Cause;
using rollfix::Fit;
using rollfix::Noise;
using rollfix::Part;
using rollfix::Placement;
using rollfix::Problem;
using rollfix::solve;
using rollfix::Verdict;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kRadiusShare = 0.03;  // of the perimeter

/// An honest log of a disk, and all that is said of it is true.
Problem roll_of(const std::string& shape, std::uint64_t seed, double length_share, std::size_t rows) {
  const Part part = part_of(shape);
  const double P = part.perimeter();
  const Noise noise{5e-4 * P, 5e-3, 0, 0};
  const rollfix::NoisyRoll roll =
      belief_cases::roll_on(part, kRadiusShare * P, 0.3 * P, length_share * P, rows, noise, test_seed() + seed);
  return {part, roll.log, {rollfix::disk(kRadiusShare * P)}, noise};
}

/// psi is off by so much as a function of how much of the roll is over.
template <class Off>
void turn_by(Problem& problem, Off off) {
  std::vector<double>& psi = problem.measured.log->fingers[0].psi;
  for (std::size_t k = 0; k < psi.size(); ++k) psi[k] += off(static_cast<double>(k) / static_cast<double>(psi.size()));
}

Fit fit_of(const Problem& problem) { return solve(problem).weighing->fit; }

/// One cosine (DCT-II) of this size among innovations that are 0 else.
rollfix::belief::Innovations cosine(std::size_t k, double size, std::size_t count) {
  rollfix::belief::Innovations innovations;
  for (std::size_t i = 0; i < count; ++i) {
    const double angle =
        std::numbers::pi * static_cast<double>(k) * (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    innovations[0].push_back(size * std::sqrt(2 / static_cast<double>(count)) * std::cos(angle));
  }
  return innovations;
}

}  // namespace

TEST(Trend, one_slow_cosine_is_a_chi_square_of_ten_degrees) {
  // Tables have 29.588 as what a chi-square of 10 degrees exceeds with 0.001, as 3.0902 is exceeded.
  for (const std::size_t k : {1U, 4U, 9U}) {
    EXPECT_NEAR(rollfix::belief::trend_of(cosine(k, std::sqrt(29.588), 300), 300).sigmas, 3.0902, 0.03) << k;
  }
  EXPECT_LT(rollfix::belief::trend_of(cosine(10, std::sqrt(29.588), 300), 300).sigmas, -3);
}

TEST(Trend, innovations_that_are_all_larger_than_said_have_none) {
  std::mt19937_64 random(test_seed());
  std::normal_distribution<double> normal(0, 3);
  for (int log = 0; log < 200; ++log) {
    rollfix::belief::Innovations innovations;
    for (int k = 0; k < 100; ++k) innovations[0].push_back(normal(random));
    EXPECT_LT(rollfix::belief::trend_of(innovations, 100).sigmas, 4.5);
  }
}

TEST(Misfit, a_gyroscope_that_drifts_by_less_than_the_other_ways_see_is_told) {
  int by_trend_alone = 0;
  for (const std::string shape : {"cam", "limacon", "naca"}) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      Problem drifting = roll_of(shape, seed, 0.5, 200);
      turn_by(drifting, [](double share) { return 2 * kDegree * share; });
      const Answer answer = solve(drifting);
      const Fit& fit = answer.weighing->fit;
      const double others = std::max({fit.sigmas, fit.correlation_sigmas, fit.row_sigmas});
      if (fit.trend_sigmas <= Fit::kMostSigmas || others > Fit::kMostSigmas) continue;
      ++by_trend_alone;
      EXPECT_TRUE(answer.verdict.fits_badly) << shape << seed;
      EXPECT_FALSE(answer.diagnoses.empty()) << shape << seed;
      EXPECT_GT(fit.widened, 1.5) << shape << seed;
    }
  }
  EXPECT_GE(by_trend_alone, 2);
}

TEST(Misfit, honest_logs_have_no_trend) {
  for (const std::string shape : {"cam", "limacon", "naca", "stadium"}) {
    for (const std::size_t rows : {20U, 150U}) {
      for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        const Fit fit = fit_of(roll_of(shape, 100 * rows + seed, 0.5, rows));
        EXPECT_LT(fit.trend_sigmas, Fit::kMostSigmas) << shape << ", " << rows << " rows, seed " << seed;
      }
    }
  }
}

TEST(Misfit, honest_increments_are_none_either_where_many_rows_are_taken_together) {
  for (const std::string shape : {"cam", "limacon", "naca"}) {
    const Part part = part_of(shape);
    const double P = part.perimeter();
    const Noise noise{1e-4 * P, 5e-4, 0, 0};
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const rollfix::Log log = rollfix::noisy_increments(part, 0.3 * P, 0.4 * P, 4000, noise, test_seed() + seed).log;
      EXPECT_LT(fit_of({part, log, {}, noise}).correlation_sigmas, Fit::kMostSigmas) << shape << ", seed " << seed;
    }
  }
}

TEST(Misfit, a_prior_at_a_place_that_fits_passably_is_told_where_another_fits_far_better) {
  // What four times the noise would allow.
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    Problem problem = roll_of("limacon", seed, 0.1, 100);
    const double truth = 0.3 * problem.part.perimeter();
    Problem wide = problem;
    wide.noise->contact *= 4;
    wide.noise->angle *= 4;
    const std::vector<Placement> places = solve(wide).placements;
    const auto wrong = std::find_if(places.begin(), places.end(), [&](const Placement& place) {
      return !belief_cases::holds(place.interval[0], truth, problem.part);
    });
    ASSERT_NE(wrong, places.end());
    problem.prior = rollfix::Prior{wrong->start[0], 0.01 * problem.part.perimeter()};
    const Answer answer = solve(problem);
    EXPECT_TRUE(answer.verdict.fits_badly) << seed;
    ASSERT_FALSE(answer.diagnoses.empty()) << seed;
    EXPECT_EQ(answer.diagnoses.front().cause, Cause::prior) << seed;
    for (const Placement& place : answer.placements) EXPECT_LT(place.probability, 0.5) << seed;
  }
}

TEST(Misfit, a_prior_that_is_right_is_not_told) {
  std::mt19937_64 random(test_seed());
  std::normal_distribution<double> normal;
  for (const std::string shape : {"cam", "limacon", "ellipse,a=2,b=1"}) {
    for (const double share : {0.1, 0.01}) {
      for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        Problem problem = roll_of(shape, seed, 0.1, 60);
        const double P = problem.part.perimeter();
        problem.prior = rollfix::Prior{(0.3 + share * normal(random)) * P, share * P};
        EXPECT_LT(fit_of(problem).prior_sigmas, Fit::kMostSigmas) << shape << ", " << share << ", seed " << seed;
      }
    }
  }
}

namespace {

/// What both commands say in the end.
void expect_alike(const std::string& question, const std::string& what) {
  const cli::Ran located = cli::run("locate " + question + " --json");
  const cli::Ran watched = cli::run("watch " + question + " --once --jsonl");
  ASSERT_FALSE(located.out.empty()) << what << ": " << located.err;
  const cli::Json answer = located.json();
  cli::Json over;
  std::istringstream lines(watched.out);
  for (std::string line; std::getline(lines, line);) {
    const cli::Json event = cli::Json::parse(line);
    if (event["event"] == "over") over = event;
  }
  ASSERT_FALSE(over.is_null()) << what << ": " << watched.out << watched.err;
  EXPECT_EQ(over["verdict"], answer["verdict"]) << what;
  ASSERT_EQ(over["placements"].size(), answer["placements"].size()) << what;
  for (std::size_t k = 0; k < answer["placements"].size(); ++k) {
    const cli::Json& place = answer["placements"][k];
    EXPECT_NEAR(over["placements"][k]["probability"].get<double>(), place["probability"].get<double>(), 1e-6) << what;
    EXPECT_NEAR(over["placements"][k]["start"][0].get<double>(), place["start"][0].get<double>(), 1e-3) << what;
  }
  ASSERT_EQ(over["diagnosis"].is_null(), answer["diagnosis"].is_null()) << what;
  if (answer["diagnosis"].is_null()) return;
  EXPECT_EQ(over["diagnosis"]["cause"], answer["diagnosis"]["cause"]) << what;
}

}  // namespace

TEST(Misfit, watch_says_in_the_end_what_locate_says) {
  const cli::Folder folder;
  ASSERT_EQ(cli::run("simulate gallery:cam --finger disk,r=0.2 --start 2 --length 4 --samples 200 --noise "
                     "contact=0.002,angle=0.2deg,slip=0.002 --seed 3 -o roll.csv")
                .code,
            0);
  const std::string noise = " --noise contact=0.002,angle=0.2deg,slip=0.002";
  const std::string log = "gallery:cam --log roll.csv";
  expect_alike(log + " --finger disk,r=0.2" + noise, "honest");
  expect_alike(log + " --finger disk,r=0.205" + noise, "a radius that is 2.5 % too large");
  expect_alike(log + " --finger disk,r=0.2 --noise contact=0.002,angle=0.2deg,radius=0.01 --prior 5,0.05",
               "a wrong prior");
  expect_alike(log + " --finger disk,r=0.4" + noise, "a diameter");
  expect_alike(log + " --finger disk,r=5.08" + noise, "inches");
}

TEST(Misfit, noise_that_is_said_four_times_too_large_is_a_caution_and_no_misfit) {
  Problem problem = roll_of("cam", 1, 0.5, 200);
  EXPECT_FALSE(fit_of(problem).is_too_good());
  problem.noise->contact *= 4;
  problem.noise->angle *= 4;
  const Answer answer = solve(problem);
  EXPECT_TRUE(answer.weighing->fit.is_too_good());
  EXPECT_FALSE(answer.verdict.fits_badly);
}

TEST(Misfit, neighbours_that_are_alike_are_told_with_the_length_over_which_they_are) {
  // Errors of the first order: each is so much of the one before. As long as the roll they look like another offset.
  constexpr double kAlike = 0.99;
  const Part part = part_of("cam");
  const double P = part.perimeter();
  const double radius = kRadiusShare * P;
  const Noise noise{1e-3 * P, 5e-3, 0, 0};
  constexpr std::size_t kRows = 150;
  std::mt19937_64 random(test_seed());
  std::normal_distribution<double> normal;
  int told = 0;
  for (int log = 0; log < 10; ++log) {
    rollfix::NoisyRoll roll = belief_cases::roll_on(part, radius, 0.3 * P, 0.4 * P, kRows, Noise{}, 1);
    double of_contact = normal(random);
    double of_angle = normal(random);
    for (std::size_t k = 0; k < kRows; ++k) {
      roll.log.fingers[0].u[k] += noise.contact / radius * of_contact;
      roll.log.fingers[0].psi[k] += noise.angle * of_angle;
      const double fresh = std::sqrt(1 - kAlike * kAlike);
      of_contact = kAlike * of_contact + fresh * normal(random);
      of_angle = kAlike * of_angle + fresh * normal(random);
    }
    const Fit fit = fit_of({part, roll.log, {rollfix::disk(radius)}, noise});
    if (!fit.is_too_good()) continue;
    ++told;
    const double length = -0.4 * P / kRows / std::log(kAlike);
    EXPECT_GT(fit.alike_over, 0.5 * length);
    EXPECT_LT(fit.alike_over, 2 * length);
  }
  EXPECT_GE(told, 8);
}

TEST(Misfit, the_caution_is_printed_and_in_the_document) {
  const cli::Folder folder;
  cli::run(
      "simulate gallery:cam --finger disk,r=0.2 --start 2 --length 4 --samples 200 --noise "
      "contact=0.001,angle=0.1deg --seed 3 -o roll.csv");
  const std::string question =
      "locate gallery:cam --log roll.csv --finger disk,r=0.2 --noise contact=0.005,angle=0.5deg";
  const cli::Ran told = cli::run(question);
  EXPECT_NE(told.out.find("\ncaution "), std::string::npos) << told.out;
  EXPECT_NE(told.out.find("--noise correlation="), std::string::npos) << told.out;
  EXPECT_EQ(told.out.find("fit badly"), std::string::npos) << told.out;
  const cli::Json fit = cli::run(question + " --json").json()["fit"];
  EXPECT_TRUE(fit["too_good"].get<bool>());
  EXPECT_GT(fit["alike_over"].get<double>(), 0);
}

TEST(Misfit, centres_that_are_no_evidence_may_be_as_noisy_as_they_are) {
  std::mt19937_64 random(test_seed());
  for (const std::string shape : {"cam", "limacon", "naca"}) {
    Problem problem = roll_of(shape, 1, 0.5, 200);
    std::normal_distribution<double> off(0, 0.01 * problem.part.perimeter());
    for (double& x : problem.measured.log->fingers[0].x) x += off(random);
    for (double& y : problem.measured.log->fingers[0].y) y += off(random);
    const Answer answer = solve(problem);
    EXPECT_FALSE(answer.verdict.fits_badly) << shape;
    EXPECT_TRUE(answer.diagnoses.empty()) << shape;
  }
}

TEST(Misfit, a_corner_is_the_kind_of_a_place_only_where_its_interval_has_one) {
  // Wide noise lets the search reach corners that all rows together exclude.
  int seen = 0;
  for (const std::string shape : {"polygon", "reuleaux"}) {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      const Part part = part_of(shape);
      const double P = part.perimeter();
      const Noise noise{0.005 * P, 0.03, 0, 0};
      const rollfix::NoisyRoll roll = belief_cases::roll_on(
          part, kRadiusShare * P, std::fmod(0.13 * static_cast<double>(seed), 1.0) * P, 0.27 * P, 300, noise, seed);
      const Answer answer = solve({part, roll.log, {rollfix::disk(kRadiusShare * P)}, noise});
      for (const Placement& place : answer.placements) {
        if (place.kind != rollfix::Kind::corner) continue;
        ++seen;
        const bool is_there = std::any_of(part.corners().begin(), part.corners().end(), [&](const auto& corner) {
          const double end = 2 * place.end_sd[0];
          const double rolled = part.boundary().offset(place.start[0], place.end_mean[0]);
          const rollfix::Interval last{place.interval[0].lo + rolled - end, place.interval[0].hi + rolled + end};
          return part.boundary().distance(place.interval[0], corner.s) < 1e-6 * P ||
                 part.boundary().distance(last, corner.s) < 0.01 * P;
        });
        EXPECT_TRUE(is_there) << shape << ", seed " << seed << ", s = " << place.start[0];
      }
    }
  }
  EXPECT_GT(seen, 0);
}

TEST(Misfit, the_start_lies_within_its_interval_also_on_a_stretch) {
  for (const std::string shape : {"stadium", "rounded-rectangle", "circle", "cam"}) {
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
      const Part part = part_of(shape);
      const double P = part.perimeter();
      const Noise noise{1e-3 * P, 5e-3, 0, 0};
      const rollfix::NoisyRoll roll = belief_cases::roll_on(
          part, kRadiusShare * P, 0.07 * static_cast<double>(seed) * P, 0.04 * P, 40, noise, seed);
      for (const Placement& place : solve({part, roll.log, {rollfix::disk(kRadiusShare * P)}, noise}).placements) {
        EXPECT_TRUE(belief_cases::holds(place.interval[0], place.start[0], part))
            << shape << ", seed " << seed << ": " << place.start[0] << " beside " << place.interval[0].lo << " to "
            << place.interval[0].hi;
      }
    }
  }
}

TEST(Misfit, of_a_stretch_the_verdict_states_the_interval) {
  const cli::Folder folder;
  cli::run(
      "simulate gallery:stadium --finger disk,r=0.2 --start 0.3 --length 0.2 --samples 40 --noise "
      "contact=0.002,angle=0.2deg --seed 3 -o roll.csv");
  const cli::Ran told = cli::run(
      "locate gallery:stadium --log roll.csv --finger disk,r=0.2 --noise contact=0.002,angle=0.2deg --prior "
      "0.5,0.3");
  EXPECT_NE(told.out.find("ambiguous (1 stretch): the finger started between s = "), std::string::npos) << told.out;
}

}  // namespace misfit_test
