// Wide noise is wide: coverage where angles are off by 6 and 17 degrees, and after short rolls of many rows.
#include <gtest/gtest.h>

#include <cmath>

#include "belief_cases.hpp"

namespace belief_wide_test {

using namespace belief_cases;

namespace {

// As many standard deviations of a binomial count are allowed: one test of ten thousand fails by chance.
constexpr double kSigmas = 4;
// A little more than is said is no harm: a mode ends where the density is least.
constexpr double kCaution = 0.02;
constexpr double kRadiusShare = 0.03;  // of the perimeter

struct Family {
  const char* name;
  const char* shape;
  double angle;         // noise, radians
  double length_share;  // of a roll, of the perimeter
};

void PrintTo(const Family& family, std::ostream* out) { *out << family.name; }

}  // namespace

class BeliefWide : public testing::TestWithParam<Family> {};

TEST_P(BeliefWide, the_95_percent_interval_holds_the_truth_95_times_of_100) {
  const Family& family = GetParam();
  const Part part = part_of(family.shape);
  const Noise noise = noise_on(part, 1e-3, family.angle, 5e-3);
  const Tally found = tally(part, kRadiusShare * part.perimeter(), family.length_share, noise, test_count(100), 11);
  const double spread = kSigmas * std::sqrt(0.05 * 0.95 / found.cases);
  EXPECT_GE(found.share_inside(), 0.95 - spread);
  EXPECT_LE(found.share_inside(), std::min(1.0, 0.95 + spread + kCaution));
  EXPECT_GE(found.listed, 0.97 * found.cases - 1);
  EXPECT_NEAR(found.first, found.claimed, kSigmas * std::sqrt(found.claimed_variance + 1));
}

INSTANTIATE_TEST_SUITE_P(
    Families, BeliefWide,
    testing::Values(Family{"ellipse_0_1", "ellipse,a=2,b=1", 0.1, 0.4},
                    Family{"ellipse_0_3", "ellipse,a=2,b=1", 0.3, 0.4}, Family{"cam_0_1", "cam", 0.1, 0.4},
                    Family{"cam_0_3", "cam", 0.3, 0.4}, Family{"limacon_0_1", "limacon", 0.1, 0.4},
                    Family{"limacon_0_3", "limacon", 0.3, 0.4}, Family{"naca_0_1", "naca", 0.1, 0.4},
                    Family{"reuleaux_0_1", "reuleaux", 0.1, 0.4}, Family{"ellipse_short", "ellipse,a=2,b=1", 0.1, 0.02},
                    Family{"cam_short", "cam", 0.1, 0.02}, Family{"cam_short_precise", "cam", 5e-3, 0.02},
                    Family{"spline_short", "spline,n=9,seed=7,wobble=0.2", 0.1, 0.02}),
    [](const testing::TestParamInfo<Family>& of) { return of.param.name; });

TEST(BeliefWide, of_nothing_but_noise_nothing_is_known) {
  const Part part = part_of("cam");
  const double P = part.perimeter();
  const Noise noise = noise_on(part, 1e-3, 0.5, 0);
  const NoisyRoll roll = roll_on(part, kRadiusShare * P, 0.2 * P, 0.02 * P, 20, noise, test_seed());
  BeliefOptions options;
  options.noise = noise;
  Belief belief = belief_in(part, roll.log, kRadiusShare * P, options);
  EXPECT_NE(belief.verdict().name, rollfix::Verdict::unique);
  EXPECT_NE(belief.verdict().name, rollfix::Verdict::inconsistent);
}

}  // namespace belief_wide_test
