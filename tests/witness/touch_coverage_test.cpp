#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include "outline/turn.hpp"
#include "random.hpp"
#include "touch/touch_cases.hpp"

namespace touch_coverage_test {

using namespace touch_cases;

/// How often intervals hold the truth, and how often the likeliest pose is it, against what was claimed.
struct Tally {
  int cases = 0;
  int listed = 0;
  std::array<int, 3> held{};
  int first = 0;
  double claimed = 0;
  int bad = 0;  // that are said to contradict their noise

  void add(const TouchAnswer& answer, const Pose& truth) {
    ++cases;
    const TouchPose* nearest = nullptr;
    double least = 0;
    for (const TouchPose& pose : answer.poses) {
      if (!in_extent(pose, truth)) continue;
      const Eigen::Vector3d off(truth.x - pose.spread.mean.x, truth.y - pose.spread.mean.y,
                                rollfix::nearest_angle(truth.heading - pose.spread.mean.heading));
      const double distance = off.dot(pose.spread.covariance.ldlt().solve(off)) - 2 * std::log(pose.probability);
      if (nearest != nullptr && distance >= least) continue;
      nearest = &pose;
      least = distance;
    }
    bad += answer.verdict.fits_badly ? 1 : 0;
    if (!answer.poses.empty()) claimed += answer.poses.front().probability;
    if (nearest == nullptr) return;
    ++listed;
    first += nearest == answer.poses.data() ? 1 : 0;
    held[0] += nearest->interval[0].contains(truth.x) ? 1 : 0;
    held[1] += nearest->interval[1].contains(truth.y) ? 1 : 0;
    held[2] += holds_heading(nearest->interval[2], truth.heading) ? 1 : 0;
  }

  /// Within four standard deviations of a count.
  void expect_calibrated() const {
    const double count = listed;
    std::printf("%d of %d listed; within 95 %%: x %.1f, y %.1f, heading %.1f %%; first %.1f %%, claimed %.1f %%\n",
                listed, cases, 100 * held[0] / count, 100 * held[1] / count, 100 * held[2] / count, 100 * first / count,
                100 * claimed / cases);
    EXPECT_GE(listed, cases - 1 - cases / 100) << "of " << cases;
    EXPECT_LE(bad, 1 + cases / 200) << "of " << cases;  // one in a thousand
    for (const int number : held) {
      EXPECT_NEAR(number / count, 0.95, 4 * std::sqrt(0.05 * 0.95 / count) + 0.01) << "of " << listed;
    }
    const double share = claimed / cases;
    EXPECT_NEAR(first / count, share, 4 * std::sqrt(share * (1 - share) / count) + 0.02) << "of " << listed;
  }
};

/// Makes one touch an outlier: anywhere on a square as large as the perimeter.
void put_anywhere(Case& one, const Part& part, std::mt19937_64& generator) {
  std::vector<MeasuredTouch>& touches = one.problem.touches;
  MeasuredTouch& outlier = touches[std::uniform_int_distribution<std::size_t>(0, touches.size() - 1)(generator)];
  const double half = 0.5 * part.perimeter();
  const double y = one.truth.y + uniform(generator, -half, half);
  outlier.at = {one.truth.x + uniform(generator, -half, half), y};
  if (outlier.normal) outlier.normal = uniform(generator, -std::numbers::pi, std::numbers::pi);
}

template <class PartOf>
Tally tally(int count, const Making& shares, const PartOf& part_of, bool has_outlier = false) {
  Tally result;
  for (int c = 0; c < count; ++c) {
    std::mt19937_64 generator = test_generator(static_cast<std::uint64_t>(c) + 5000);
    const Part part = part_of(c, generator);
    const double size = diagonal(part);
    Making making = shares;
    making.radius *= size;
    making.place_sd *= size;
    Case one = random_case(part, making, generator);
    if (has_outlier) put_anywhere(one, part, generator);
    TouchProblem problem = one.problem;
    problem.robust = has_outlier;
    problem.diagnose = false;
    result.add(rollfix::solve(problem), one.truth);
  }
  return result;
}

Part smooth(int number, std::mt19937_64& /*generator*/) {
  return rollfix::load_part("gallery:spline,n=" + std::to_string(number % 2 == 0 ? 9 : 15) +
                            ",wobble=0.2,seed=" + std::to_string(number + 1));
}
Part flat(int number, std::mt19937_64& generator) { return number % 2 == 0 ? random_polygon(generator) : bracket(); }

constexpr double kDegree = rollfix::kDegree;

TEST(TouchCoverage, TwoNormalsOnSmoothParts) {
  tally(test_count(40), {2, 2, 0, 0.001, kDegree}, smooth).expect_calibrated();
}
TEST(TouchCoverage, ThreeWideNormalsOnSmoothParts) {
  tally(test_count(40), {3, 3, 0, 0.01, 5 * kDegree}, smooth).expect_calibrated();
}
TEST(TouchCoverage, FourBallsOnSmoothParts) {
  tally(test_count(40), {4, 0, 0.04, 0.001, kDegree}, smooth).expect_calibrated();
}
TEST(TouchCoverage, ThreeNormalsOnFlats) {
  tally(test_count(40), {3, 3, 0, 0.003, 2 * kDegree}, flat).expect_calibrated();
}
TEST(TouchCoverage, FivePlacesOnFlats) { tally(test_count(40), {5, 0, 0, 0.003, kDegree}, flat).expect_calibrated(); }
TEST(TouchCoverage, FiveBallsOnFlats) { tally(test_count(40), {5, 0, 0.03, 0.002, kDegree}, flat).expect_calibrated(); }

TEST(TouchCoverage, FiveNormalsOneAnOutlierOnSmoothParts) {
  tally(test_count(40), {5, 5, 0, 0.003, 2 * kDegree}, smooth, true).expect_calibrated();
}
TEST(TouchCoverage, FourNormalsOneAnOutlierOnFlats) {
  tally(test_count(40), {4, 4, 0, 0.003, 2 * kDegree}, flat, true).expect_calibrated();
}
TEST(TouchCoverage, SixBallsOneAnOutlierOnSmoothParts) {
  tally(test_count(40), {6, 0, 0.04, 0.001, kDegree}, smooth, true).expect_calibrated();
}
TEST(TouchCoverage, TwentyPlacesOneAnOutlierOnSmoothParts) {
  tally(test_count(15), {20, 0, 0, 0.003, kDegree}, smooth, true).expect_calibrated();
}

}  // namespace touch_coverage_test
