#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include "random.hpp"
#include "touch/roll_cases.hpp"

// With noise: whether intervals hold the truth as often as they say, and the likeliest pose is right as often.
namespace roll_coverage_test {

using namespace roll_cases;

struct Tally {
  int cases = 0;
  int listed = 0;
  std::array<int, 3> held{};
  int first = 0;
  double claimed = 0;
  int bad = 0;  // that are said to contradict their noise
  bool has_place = false;

  void add(const TouchAnswer& answer, const RollCase& one) {
    ++cases;
    has_place = answer.place == rollfix::PlaceKnown::measured;
    bad += answer.verdict.fits_badly || answer.poses.empty() ? 1 : 0;
    if (!answer.poses.empty()) claimed += answer.poses.front().probability;
    const TouchPose* nearest = nullptr;
    double least = 0;
    for (const TouchPose& pose : answer.poses) {
      const double off = distance(pose, one);
      if (nearest != nullptr && off >= least) continue;
      nearest = &pose;
      least = off;
    }
    if (nearest == nullptr) return;
    ++listed;
    first += nearest == answer.poses.data() ? 1 : 0;
    held[0] += nearest->interval[0].contains(one.truth.x) ? 1 : 0;
    held[1] += nearest->interval[1].contains(one.truth.y) ? 1 : 0;
    held[2] += holds_heading(nearest->interval[2], one.truth.heading) ? 1 : 0;
  }

  /// How far the truth is from a listed pose: in standard deviations of the heading, and of where the rolls started
  /// along the part.
  static double distance(const TouchPose& pose, const RollCase& one) {
    double off = std::abs(rollfix::nearest_angle(one.truth.heading - pose.spread.mean.heading));
    for (std::size_t k = 0; k < one.starts.size(); ++k) {
      const double s = one.problem.part.boundary().canonical(one.starts[k]);
      off =
          std::max(off, one.problem.part.boundary().distance(s, pose.contacts[k].s) * 6 / one.problem.part.perimeter());
    }
    return off;
  }

  /// Within four standard deviations of a count, and two in a hundred.
  void expect_calibrated(const char* what) const {
    const double count = listed;
    std::printf(
        "%s: %d of %d listed; within 95 %%: x %.1f, y %.1f, heading %.1f %%; first %.1f %%, claimed %.1f %%; "
        "contradictions %d\n",
        what, listed, cases, 100 * held[0] / count, 100 * held[1] / count, 100 * held[2] / count, 100 * first / count,
        100 * claimed / cases, bad);
    EXPECT_GE(listed, cases - 1 - cases / 50) << "of " << cases;
    EXPECT_LE(bad, 1 + cases / 75) << "of " << cases;  // of all answers and of each roll, one in a thousand or two
    for (std::size_t i = has_place ? 0 : 2; i < 3; ++i) {
      EXPECT_NEAR(held[i] / count, 0.95, 4 * std::sqrt(0.05 * 0.95 / count) + 0.02) << "of " << listed;
    }
    const double share = claimed / cases;
    EXPECT_NEAR(first / count, share, 4 * std::sqrt(share * (1 - share) / count) + 0.03) << "of " << listed;
  }
};

Part smooth(int number, std::mt19937_64& /*generator*/) {
  return rollfix::load_part("gallery:spline,n=" + std::to_string(number % 2 == 0 ? 9 : 15) +
                            ",wobble=0.2,seed=" + std::to_string(number + 1));
}
Part flat(int number, std::mt19937_64& generator) { return number % 2 == 0 ? random_polygon(generator) : bracket(); }

template <class PartOf>
void expect_calibrated(const char* what, const Rolling& rolling, const PartOf& part_of) {
  Tally tally;
  const int count = test_count(24);
  for (int number = 0; number < count; ++number) {
    std::mt19937_64 generator = test_generator(static_cast<std::uint64_t>(number) + 9000);
    const RollCase one = random_rolls(part_of(number, generator), rolling, generator);
    tally.add(rollfix::solve(one.problem), one);
  }
  tally.expect_calibrated(what);
}

/// So many rolls of a tenth of the perimeter with 40 rows; sensors as in the docs' table.
Rolling rolls(std::size_t count, bool centres, std::size_t touches = 0) {
  Rolling rolling;
  rolling.count = count;
  rolling.centres = centres;
  rolling.touches = touches;
  rolling.contact_sd = rolling.place_sd = 0.002;
  rolling.angle_sd = 0.005;
  return rolling;
}

TEST(RollCoverage, TwoRollsWithoutCentresOnSmoothParts) { expect_calibrated("2 rolls", rolls(2, false), smooth); }
TEST(RollCoverage, ThreeRollsWithoutCentresOnSmoothParts) { expect_calibrated("3 rolls", rolls(3, false), smooth); }
TEST(RollCoverage, TwoRollsWithCentresOnSmoothParts) { expect_calibrated("2 with centres", rolls(2, true), smooth); }
TEST(RollCoverage, ThreeRollsWithCentresOnSmoothParts) { expect_calibrated("3 with centres", rolls(3, true), smooth); }
TEST(RollCoverage, ARollAndTwoTouchesOnSmoothParts) { expect_calibrated("1 and touches", rolls(1, true, 2), smooth); }
TEST(RollCoverage, TwoRollsWithoutCentresOnFlats) { expect_calibrated("2 rolls, flats", rolls(2, false), flat); }
TEST(RollCoverage, TwoRollsWithCentresOnFlats) { expect_calibrated("2 with centres, flats", rolls(2, true), flat); }
TEST(RollCoverage, ARollAndTwoTouchesOnFlats) { expect_calibrated("1 and touches, flats", rolls(1, true, 2), flat); }

}  // namespace roll_coverage_test
