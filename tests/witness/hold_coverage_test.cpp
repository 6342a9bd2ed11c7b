#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include "hold/hold_spoilt.hpp"
#include "random.hpp"

// Three and four fingers with noise: whether intervals hold the truth as often as they say, and the likeliest placement
// is right as often.
namespace hold_coverage_test {

using namespace hold_cases;

constexpr int kSlow = 8;   // where each takes seconds
constexpr int kMany = 30;  // where a mistake shows in a part of the contacts

struct Tally {
  int cases = 0;
  int listed = 0;
  int contacts = 0;
  int starts = 0;
  int heading = 0;
  int first = 0;
  double claimed = 0;
  int bad = 0;  // that are said to contradict their noise, or fit nowhere

  /// The placement whose first contacts are all within six standard deviations of the true ones.
  static const HoldPlacement* true_one(const HoldAnswer& answer, const HoldCase& one) {
    for (const HoldPlacement& placement : answer.placements) {
      bool all = true;
      for (std::size_t k = 0; k < one.starts.size(); ++k) {
        const rollfix::HoldContact& contact = placement.contacts[k];
        const bool is_inside = one.problem.part.boundary().contains(contact.interval, one.starts[k]);
        all = all && (is_inside || one.problem.part.distance(contact.mean, one.starts[k]) <= 6 * contact.sd);
      }
      if (all) return &placement;
    }
    return nullptr;
  }

  void add(const HoldAnswer& answer, const HoldCase& one) {
    ++cases;
    bad += answer.verdict.fits_badly || answer.placements.empty() ? 1 : 0;
    if (!answer.placements.empty()) claimed += answer.placements.front().probability;
    const HoldPlacement* found = true_one(answer, one);
    if (found == nullptr) return;
    ++listed;
    first += found == answer.placements.data() ? 1 : 0;
    for (std::size_t k = 0; k < one.starts.size(); ++k) {
      ++contacts;
      starts += one.problem.part.boundary().contains(found->contacts[k].interval, one.starts[k]) ? 1 : 0;
    }
    const double sd = std::sqrt(found->last_spread.covariance(2, 2));
    heading += std::abs(rollfix::nearest_angle(found->last_spread.mean.heading - one.last.heading)) < 1.96 * sd ? 1 : 0;
  }

  /// Within four standard deviations of a count, and two or three in a hundred. Starts of one case are alike.
  void expect_calibrated(const char* what) const {
    const double count = listed;
    const double share = claimed / cases;
    std::printf(
        "%s: %d of %d listed; within 95 %%: starts %.1f, last heading %.1f %%; first %.1f %%, claimed %.1f %%; "
        "contradictions %d\n",
        what, listed, cases, 100.0 * starts / contacts, 100 * heading / count, 100 * first / count, 100 * share, bad);
    EXPECT_GE(listed, cases - cases / 50) << "of " << cases;
    EXPECT_LE(bad, 1 + cases / 75) << "of " << cases;
    const double spread = 4 * std::sqrt(0.05 * 0.95 / count) + 0.02;
    EXPECT_NEAR(static_cast<double>(starts) / contacts, 0.95, spread);
    EXPECT_NEAR(heading / count, 0.95, spread);
    EXPECT_NEAR(first / count, share, 4 * std::sqrt(share * (1 - share) / count) + 0.03);
  }
};

Part smooth(int number, std::mt19937_64& /*generator*/) {
  return rollfix::load_part("gallery:spline,n=" + std::to_string(number % 2 == 0 ? 9 : 15) +
                            ",wobble=0.2,seed=" + std::to_string(number + 1));
}
/// Roundings of a few times the contact's error.
Part rounded(int number, std::mt19937_64& /*generator*/) {
  const double radius = 0.01 + 0.004 * (number % 6);
  return rollfix::load_part(
      fmt::format("gallery:rounded-rectangle,width=1.5,height={},r={}", 0.8 + 0.05 * (number % 5), radius));
}
Part sharp(int /*number*/, std::mt19937_64& generator) { return random_polygon(generator); }
Part flat(int number, std::mt19937_64& generator) { return number % 2 == 0 ? random_polygon(generator) : bracket(); }

/// `outliers`: a share of all measurements that are anything.
template <class PartOf>
void expect_calibrated(const char* what, const Holding& holding, const PartOf& part_of, double outliers = 0,
                       int cases = 12) {
  Tally tally;
  const int count = full_count(cases);
  for (int number = 0; number < count; ++number) {
    std::mt19937_64 generator = test_generator(static_cast<std::uint64_t>(number) + 400);
    HoldCase one = random_hold(part_of(number, generator), holding, generator);
    if (outliers > 0) {
      add_outliers(one, outliers, generator);
      one.problem.robust = true;
    }
    tally.add(rollfix::solve(one.problem), one);
  }
  tally.expect_calibrated(what);
}

/// Rolls of 8 % of the perimeter with 41 rows.
Holding noisy(std::size_t fingers, bool centres, double slip = 0) {
  Holding holding;
  holding.fingers = fingers;
  holding.centres = centres;
  holding.contact_sd = holding.place_sd = 0.002;
  holding.angle_sd = 0.005;
  holding.slip_sd = slip;
  return holding;
}

TEST(HoldCoverage, ThreeFingersWithCentresOnSmoothParts) { expect_calibrated("3, x y", noisy(3, true), smooth); }
TEST(HoldCoverage, ThreeFingersWithoutCentresOnSmoothParts) { expect_calibrated("3", noisy(3, false), smooth); }
TEST(HoldCoverage, FourFingersWithCentresOnSmoothParts) { expect_calibrated("4, x y", noisy(4, true), smooth); }
TEST(HoldCoverage, FourFingersWithoutCentresOnSmoothParts) { expect_calibrated("4", noisy(4, false), smooth); }
TEST(HoldCoverage, ThreeFingersThatSlipOnSmoothParts) {
  expect_calibrated("3, x y, slip", noisy(3, true, 0.02), smooth);
}
TEST(HoldCoverage, ThreeFingersWithCentresKnownBetterThanContacts) {
  Holding holding = noisy(3, true);
  holding.place_sd = 0.1 * holding.contact_sd;
  expect_calibrated("3, x y ten times as good", holding, smooth, 0, kMany);
}
TEST(HoldCoverage, ThreeFingersWithCentresAndRadiiThatAreNotKnown) {
  Holding holding = noisy(3, true);
  holding.radius_sd = 0.05;
  expect_calibrated("3, x y, radii to 5 %", holding, smooth, 0, kMany);
}
TEST(HoldCoverage, ThreeFingersWithCentresThatPivotAtCorners) {
  Holding holding = noisy(3, true);
  holding.length = 0.25;
  holding.rows = 100;
  expect_calibrated("3, x y, over corners", holding, sharp, 0, kMany);
}
/// Where normals are all that is known, two and three first contacts are free: no ridge, but a cloud.
TEST(HoldCoverage, ThreeFingersWithoutCentresOnStraightSides) {
  Holding holding = noisy(3, false);
  holding.length = 0.25;
  expect_calibrated("3, straight sides", holding, sharp, 0, kMany);
}
/// From row to row a contact goes farther than it is off: no slope leads a row back that is past a corner.
TEST(HoldCoverage, ThreePreciseFingersWithoutCentresThatPivotAtCorners) {
  Holding holding = noisy(3, false);
  holding.contact_sd = 1e-4;
  holding.angle_sd = 5e-4;
  holding.length = 0.25;
  expect_calibrated("3, precise, straight sides", holding, sharp);
}
TEST(HoldCoverage, RobustThreeFingersWithCentresAndOutliers) {
  expect_calibrated("3, x y, robust, 2 % outliers", noisy(3, true), smooth, 0.02, kSlow);
}
TEST(HoldCoverage, RobustThreeFingersWithoutCentresAndOutliers) {
  expect_calibrated("3, robust, 2 % outliers", noisy(3, false), smooth, 0.02, kSlow);
}
TEST(HoldCoverage, RobustThreeFingersOfHonestLogs) {
  expect_calibrated("3, x y, robust, no outliers", noisy(3, true), smooth, 1e-12, kSlow);
}
TEST(HoldCoverage, ThreeFingersWithCentresOnFlats) { expect_calibrated("3, x y, flats", noisy(3, true), flat); }
TEST(HoldCoverage, ThreeFingersWithCentresOnSmallRoundings) {
  expect_calibrated("3, x y, roundings", noisy(3, true), rounded);
}
TEST(HoldCoverage, FourFingersWithCentresOnFlats) { expect_calibrated("4, x y, flats", noisy(4, true), flat); }

}  // namespace hold_coverage_test
