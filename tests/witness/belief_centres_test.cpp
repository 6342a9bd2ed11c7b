// The fingers' centres as evidence: x and y of a log are off by normal numbers that the test adds itself.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "belief_cases.hpp"
#include "rollfix/solve.hpp"

namespace belief_centres_test {
namespace {

using belief_cases::part_of;
using rollfix::Answer;
using rollfix::Finger;
using rollfix::Noise;
using rollfix::Part;
using rollfix::Placement;
using rollfix::Problem;

// As many standard deviations of a binomial count are allowed: one test of ten thousand fails by chance.
constexpr double kSigmas = 4;
constexpr double kNormal95 = 1.96;  // a normal distribution has 95 % within so many standard deviations

/// A roll whose centres are off: the part lies in the world as it is drawn.
struct Case {
  Problem problem;
  double start = 0;
};

Case roll_on(const Part& part, const Finger& finger, double start, double length, Noise noise, std::uint64_t seed) {
  rollfix::RollPlan plan;
  plan.start = start;
  plan.distance = length;
  plan.rows = 60;
  const rollfix::Log log = rollfix::noisy_roll(part, finger, plan, noise, seed).log;
  return {{part, log, {finger}, noise}, start};
}

Noise noise_on(const Part& part, double position_share) {
  Noise noise{1e-3 * part.perimeter(), 1e-2, 0, 0};
  noise.position = position_share * part.perimeter();
  return noise;
}

/// How often what is said with 95 % is true.
struct Coverage {
  int cases = 0;
  int start = 0;
  int x = 0;
  int y = 0;
  int heading = 0;

  void add(const Case& of) {
    const Answer answer = solve(of.problem);
    ++cases;
    for (const Placement& place : answer.placements) {
      if (!of.problem.part.boundary().contains(place.interval[0], of.start)) continue;
      ++start;
      const rollfix::PoseSpread& pose = *place.pose_spread;
      const auto within = [&](double off, int k) {
        return std::abs(off) <= kNormal95 * std::sqrt(pose.covariance(k, k)) ? 1 : 0;
      };
      x += within(pose.mean.x, 0);
      y += within(pose.mean.y, 1);
      heading += within(std::remainder(pose.mean.heading, 2 * std::numbers::pi), 2);
    }
  }

  void expect_calibrated() const {
    const double spread = kSigmas * std::sqrt(0.05 * 0.95 * cases);
    EXPECT_GE(start, 0.95 * cases - spread);
    // Of the poses those are counted whose start is within its own interval: at least 90 of 100.
    for (const int inside : {x, y, heading}) EXPECT_GE(inside, 0.92 * cases - spread);
  }
};

Coverage coverage(const Part& part, const Finger& finger, double position_share, int count, std::uint64_t stream) {
  std::mt19937_64 random = test_generator(stream);
  std::uniform_real_distribution<double> unit;
  Coverage result;
  for (int k = 0; k < count; ++k) {
    const double start = unit(random) * part.perimeter();
    const double length = (unit(random) < 0.5 ? -1 : 1) * part.perimeter() * (0.2 + 0.3 * unit(random));
    result.add(roll_on(part, finger, start, length, noise_on(part, position_share), random()));
  }
  return result;
}

double sd_with(const Part& part, double position_share) {
  const double P = part.perimeter();
  const Answer answer = solve(
      roll_on(part, rollfix::disk(0.03 * P), 0.3 * P, 0.3 * P, noise_on(part, position_share), test_seed()).problem);
  EXPECT_FALSE(answer.placements.empty());
  return answer.placements.empty() ? std::nan("") : answer.placements.front().sd[0];
}

}  // namespace

TEST(BeliefCentres, starts_and_poses_of_a_disk_are_known_as_well_as_they_say) {
  for (const char* shape : {"cam", "limacon", "ellipse,a=2,b=1"}) {
    SCOPED_TRACE(shape);
    const Part part = part_of(shape);
    coverage(part, rollfix::disk(0.03 * part.perimeter()), 1e-3, test_count(80), 1).expect_calibrated();
  }
}

TEST(BeliefCentres, starts_and_poses_of_a_jaw_are_known_as_well_as_they_say) {
  const Part part = part_of("cam");
  coverage(part, rollfix::jaw(), 1e-3, test_count(80), 2).expect_calibrated();
}

TEST(BeliefCentres, the_better_they_are_known_the_better_the_start_is) {
  const Part part = part_of("cam");
  const double without = sd_with(part, 0);
  const double roughly = sd_with(part, 3e-3);
  const double well = sd_with(part, 1e-4);
  EXPECT_LT(roughly, without);
  EXPECT_LT(well, 0.5 * roughly);
}

TEST(BeliefCentres, show_a_radius_that_is_wrong) {
  const Part part = part_of("cam");
  const double P = part.perimeter();
  Case of = roll_on(part, rollfix::disk(0.03 * P), 0.3 * P, 0.3 * P, noise_on(part, 2e-4), test_seed());
  EXPECT_FALSE(solve(of.problem).verdict.fits_badly);
  of.problem.fingers = {rollfix::disk(1.03 * 0.03 * P)};
  const Answer answer = solve(of.problem);
  EXPECT_TRUE(answer.verdict.fits_badly || answer.verdict.name == rollfix::Verdict::inconsistent);
}

}  // namespace belief_centres_test
