#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "hold/rig_cases.hpp"
#include "hold/rig_scan.hpp"
#include "random.hpp"
#include "rollfix/files.hpp"
#include "witness/squeezed_cases.hpp"

// Jaws with skin and wheels without, simulated as rigid bodies: whether the truth is listed, and how often an interval
// that should hold 95 % does.
namespace rig_coverage_test {

using namespace rig_cases;

const std::vector<std::string> kParts = {"gallery:ellipse,a=2,b=1", "gallery:cam",
                                         "gallery:spline,n=9,seed=4,wobble=0.1", "gallery:superellipse",
                                         "gallery:limacon,a=1,b=0.4"};

const std::vector<std::string> kSqueezed = {"gallery:ellipse,a=2,b=1", "gallery:cam",
                                            "gallery:spline,n=9,seed=4,wobble=0.1", "gallery:limacon,a=1,b=0.4"};

/// How many of so many noisy logs.
struct Counted {
  double logs = 0;
  double listed = 0;
  double start = 0;
  double wheel = 0;
  double heading = 0;
  double contradicted = 0;
};

void count_one(const Part& part, const RigCase& one, Counted& counted) {
  const HoldAnswer answer = rollfix::solve(one.problem);
  counted.logs += 1;
  counted.contradicted += answer.verdict.fits_badly ? 1 : 0;
  for (const HoldPlacement& found : answer.placements) {
    const rollfix::HoldContact &jaw = found.contacts[0], &wheel = found.contacts[1];
    if (part.distance(jaw.mean, one.start) > 6 * jaw.sd) continue;
    const double off = rollfix::nearest_angle(found.last_spread.mean.heading - one.last.heading);
    counted.listed += 1;
    counted.start += part.boundary().contains(jaw.interval, one.start) ? 1 : 0;
    counted.wheel += part.boundary().contains(wheel.interval, one.wheel_start) ? 1 : 0;
    counted.heading += std::abs(off) < 1.96 * std::sqrt(found.last_spread.covariance(2, 2)) ? 1 : 0;
    return;
  }
}

/// `radius`: of the wheel, its standard deviation in perimeters.
Counted counted(int count, bool encoder, double radius) {
  std::mt19937_64 generator(1);
  Counted counted;
  for (int k = 0; k < count; ++k) {
    const Part part = rollfix::load_part(kParts[static_cast<std::size_t>(k) % kParts.size()]);
    const double P = part.perimeter();
    const RigCase exact = random_rig(part, 0.05 * P, generator, encoder, 40);
    count_one(part, noisy(exact, {0.001 * P, 0.005, 0.001 * P, radius * P}, generator), counted);
  }
  return counted;
}

void print(const Counted& counted) {
  const auto percent = [&](double count) { return 100 * count / counted.logs; };
  std::printf("of %.0f logs: listed %.0f, jaw %.1f %%, wheel %.1f %%, heading %.1f %%, contradicted %.0f\n",
              counted.logs, counted.listed, percent(counted.start), percent(counted.wheel), percent(counted.heading),
              counted.contradicted);
}

void expect_covered(const Counted& counted) {
  const double room = 3.5 * std::sqrt(0.95 * 0.05 / counted.logs);
  EXPECT_GE(counted.listed, 0.99 * counted.logs - 1);
  EXPECT_NEAR(counted.start / counted.logs, 0.95, room + 0.02);
  EXPECT_NEAR(counted.wheel / counted.logs, 0.95, room + 0.02);
  EXPECT_NEAR(counted.heading / counted.logs, 0.95, room + 0.02);
  EXPECT_LE(counted.contradicted, 1 + 0.01 * counted.logs);
  print(counted);
}

TEST(RigCoverage, APinsPlaceCoversTheTruthAsOftenAsItSays) { expect_covered(counted(test_count(20), false, 0)); }

TEST(RigCoverage, AnEncoderBesidesAsWell) { expect_covered(counted(test_count(20), true, 0)); }

TEST(RigCoverage, AWheelsRadiusThatIsNotKnownWellAsWell) { expect_covered(counted(test_count(20), false, 0.001)); }

constexpr double kStated = 0.05;  // of a squeeze, radians

/// Of 2 to 200 rows, as likely 10 to 20 as 20 to 40.
std::size_t any_rows(std::mt19937_64& generator) {
  return static_cast<std::size_t>(std::lround(std::exp(uniform(generator, std::log(1), std::log(199)))));
}

struct Squeezed {
  squeezed_cases::SqueezeErrors errors{};
  bool encoder = false;
  bool disk = false;
};

Counted counted_squeezed(const Squeezed& how) {
  std::mt19937_64 generator(4);
  Counted counted;
  for (int k = 0; k < test_count(10); ++k) {
    const Part part = rollfix::load_part(kSqueezed[static_cast<std::size_t>(k) % kSqueezed.size()]);
    const double P = part.perimeter();
    const squeezed_cases::Squeeze squeeze{
        0.05 * P, how.errors, kStated, any_rows(generator), how.encoder, how.disk ? 0.04 * P : 0};
    const RigCase exact = squeezed_cases::random_squeezed(part, squeeze, generator);
    count_one(part, noisy(exact, {0.001 * P, 0.005, 0.001 * P, 0}, generator), counted);
  }
  return counted;
}

constexpr squeezed_cases::SqueezeErrors kAlike{.alike = kStated};
constexpr squeezed_cases::SqueezeErrors kEachRow{.each_row = kStated};
constexpr squeezed_cases::SqueezeErrors kHalf{.each_row = kStated / std::numbers::sqrt2,
                                              .alike = kStated / std::numbers::sqrt2};
constexpr squeezed_cases::SqueezeErrors kTurning{.turning = kStated};

TEST(RigCoverage, SqueezedAndOffAlikeAllAlong) { expect_covered(counted_squeezed({kAlike})); }
TEST(RigCoverage, SqueezedAndOffInEachRow) { expect_covered(counted_squeezed({kEachRow})); }
TEST(RigCoverage, SqueezedAndOffHalfAlikeHalfInEachRow) { expect_covered(counted_squeezed({kHalf})); }
TEST(RigCoverage, SqueezedAndOffToTheOtherSideHalfway) { expect_covered(counted_squeezed({kTurning})); }
TEST(RigCoverage, SqueezedWithAnEncoderAndOffAlikeAllAlong) { expect_covered(counted_squeezed({kAlike, true})); }
TEST(RigCoverage, SqueezedWithAnEncoderAndOffInEachRow) { expect_covered(counted_squeezed({kEachRow, true})); }
TEST(RigCoverage, SqueezedWithAnEncoderAndOffHalfAlike) { expect_covered(counted_squeezed({kHalf, true})); }
TEST(RigCoverage, SqueezedWithAnEncoderAndOffToTheOtherSide) { expect_covered(counted_squeezed({kTurning, true})); }
TEST(RigCoverage, SqueezedWithADiskAndOffInEachRow) { expect_covered(counted_squeezed({kEachRow, false, true})); }
TEST(RigCoverage, SqueezedWithADiskAndOffAlikeAllAlong) { expect_covered(counted_squeezed({kAlike, false, true})); }

TEST(RigTruth, WithoutNoiseItIsAlwaysListed) {
  std::mt19937_64 generator(2);
  for (int k = 0; k < test_count(25); ++k) {
    const Part part = rollfix::load_part(kParts[static_cast<std::size_t>(k) % kParts.size()]);
    const RigCase one = random_rig(part, 0.04 * part.perimeter(), generator, k % 2 == 1, 16);
    const HoldAnswer answer = rollfix::solve(one.problem);
    EXPECT_EQ(answer.status, rollfix::Status::complete);
    EXPECT_TRUE(std::any_of(answer.placements.begin(), answer.placements.end(), [&](const HoldPlacement& found) {
      return part.distance(found.contacts[0].start, one.start) < 1e-5 * part.perimeter();
    })) << kParts[static_cast<std::size_t>(k) % kParts.size()];
  }
}

TEST(RigTruth, AScanOfAHundredThousandPlacesFindsNoOther) {
  std::mt19937_64 generator(3);
  for (int k = 0; k < test_count(2); ++k) {
    const Part part = rollfix::load_part(kParts[static_cast<std::size_t>(k) % 2]);
    const RigCase one = random_rig(part, 0.04 * part.perimeter(), generator, false, 2);
    expect_same_places(rollfix::solve(one.problem), scanned(one.problem, 100000));
  }
}

}  // namespace rig_coverage_test
