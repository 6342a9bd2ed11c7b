#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "hold/hold_cases.hpp"
#include "random.hpp"
#include "rollfix/part.hpp"

// Three and more fingers: the truth is always among the answers, and so is all that a scan finds.
namespace hold_truth_test {

using namespace hold_cases;

const std::vector<std::string> kParts = {"gallery:spline,n=9,wobble=0.25,seed=%",
                                         "gallery:spline,n=30,wobble=0.12,seed=%",
                                         "gallery:naca,digits=2412",
                                         "polygon",
                                         "bracket",
                                         "gallery:cam"};

Part part_of(int number, std::mt19937_64& generator) {
  return part_named(kParts[static_cast<std::size_t>(number) % kParts.size()], 1 + number / 6, generator);
}

void expect_truth_listed(std::size_t fingers, bool centres) {
  Holding holding;
  holding.fingers = fingers;
  holding.centres = centres;
  holding.radius = 0.02;
  const int count = test_count(6);
  int listed = 0;
  for (int number = 0; number < count; ++number) {
    std::mt19937_64 generator = test_generator(static_cast<std::uint64_t>(number) + 100);
    const HoldCase one = random_hold(part_of(number, generator), holding, generator);
    const HoldAnswer answer = rollfix::solve(one.problem);
    const bool is_listed = std::any_of(
        answer.placements.begin(), answer.placements.end(),
        [&](const HoldPlacement& placement) { return holds(placement, one, 1e-9 * one.problem.part.perimeter()); });
    EXPECT_TRUE(is_listed) << "case " << number << ": " << answer.verdict_text();
    EXPECT_EQ(answer.status, rollfix::Status::complete) << "case " << number;
    listed += is_listed ? 1 : 0;
  }
  std::printf("%zu fingers%s: %d of %d listed\n", fingers, centres ? " with x and y" : "", listed, count);
}

TEST(HoldTruth, OfThreeFingersWithCentresIsListed) { expect_truth_listed(3, true); }
TEST(HoldTruth, OfThreeFingersWithoutCentresIsListed) { expect_truth_listed(3, false); }
TEST(HoldTruth, OfFourFingersWithCentresIsListed) { expect_truth_listed(4, true); }
TEST(HoldTruth, OfFiveFingersWithCentresIsListed) { expect_truth_listed(5, true); }

/// What one finger says at a row, by the definitions alone.
struct Measurement {
  double travelled = 0;
  double tangent = 0;
  Vec2 at = Vec2::Zero();
};

std::vector<Measurement> felt_by(const Log& log, double radius, const std::vector<std::size_t>& used) {
  const rollfix::FingerRows& rows = log.fingers.front();
  std::vector<Measurement> felt;
  for (const std::size_t k : used) {
    const double towards = rows.u[k] + rows.psi[k];  // from the centre to the contact
    felt.push_back({-radius * (rows.u[k] - rows.u[0]), towards - 0.5 * std::numbers::pi,
                    Vec2(rows.x[k], rows.y[k]) + radius * Vec2(std::cos(towards), std::sin(towards))});
  }
  return felt;
}

/// The largest residual, as a share of the tolerance, with the poses that finger a alone asks for.
double worst_of(const Part& part, const std::vector<std::vector<Measurement>>& felt, const std::vector<double>& starts,
                const rollfix::TouchTolerance& tolerance) {
  double worst = 0;
  for (std::size_t t = 0; t < felt[0].size(); ++t) {
    const double s = starts[0] + felt[0][t].travelled;
    Pose pose{0, 0, felt[0][t].tangent - part.tangent(s)};
    const Vec2 origin = felt[0][t].at - pose.turned(part.point(s));
    pose = {origin.x(), origin.y(), pose.heading};
    for (std::size_t k = 1; k < felt.size(); ++k) {
      const double at = starts[k] + felt[k][t].travelled;
      const double off = (felt[k][t].at - pose.world(part.point(at))).norm();
      const double turn = felt[k][t].tangent - part.tangent(at) - pose.heading;
      worst = std::max({worst, off / tolerance.length, std::abs(rollfix::nearest_angle(turn)) / tolerance.angle});
    }
  }
  return worst;
}

/// The boundary's point that is nearest to a place of the part's frame, among many.
double nearest_start(const std::vector<Vec2>& points, double perimeter, const Vec2& place) {
  const auto nearest = std::min_element(points.begin(), points.end() - 1, [&](const Vec2& a, const Vec2& b) {
    return (a - place).squaredNorm() < (b - place).squaredNorm();
  });
  return perimeter * static_cast<double>(nearest - points.begin()) / static_cast<double>(points.size() - 1);
}

/// Rolls of three rows, and how far they may be off.
HoldCase coarse_case(int number) {
  std::mt19937_64 generator = test_generator(static_cast<std::uint64_t>(number) + 300);
  const Part part = rollfix::load_part("gallery:spline,n=9,wobble=0.2,seed=" + std::to_string(number + 1));
  HoldCase one = random_hold(part, {.length = 0.03, .rows = 2}, generator);
  one.problem.tolerance = rollfix::TouchTolerance{0.1 * diagonal(part), 0.3};
  one.problem.at = {0.2};
  return one;
}

/// First contacts that fit, finger a's at many places all around, the others where they are nearest to its part.
std::vector<std::vector<double>> scan(const HoldCase& one) {
  constexpr int kPlaces = 4000;
  const Part& part = one.problem.part;
  const double radius = one.problem.fingers.front().disk()->radius;
  const rollfix::Reach reach = rollfix::reach_of_disk(part, radius);
  const std::vector<Vec2> points = part.polyline(0, part.perimeter(), kPlaces);
  std::vector<std::vector<Measurement>> felt;
  for (const Log& log : one.problem.logs) felt.push_back(felt_by(log, radius, {0, 2}));
  std::vector<std::vector<double>> found;
  for (int k = 0; k < kPlaces; ++k) {
    std::vector<double> starts{part.perimeter() * k / kPlaces};
    const double heading = felt[0][0].tangent - part.tangent(starts[0]);
    for (std::size_t i = 1; i < felt.size(); ++i) {
      const Vec2 way = Pose{0, 0, -heading}.turned(felt[i][0].at - felt[0][0].at);
      starts.push_back(nearest_start(points, part.perimeter(), part.point(starts[0]) + way));
    }
    bool fits = worst_of(part, felt, starts, *one.problem.tolerance) < 0.99;
    for (std::size_t i = 0; i < felt.size(); ++i) {
      for (const Measurement& at : felt[i]) fits = fits && reach.contains(starts[i] + at.travelled);
    }
    if (fits) found.push_back(starts);
  }
  return found;
}

TEST(HoldTruth, HasAllThatAScanOfTheFirstFingersPlaceFinds) {
  std::size_t found = 0;
  for (int number = 0; number < test_count(3); ++number) {
    HoldCase one = coarse_case(number);
    const HoldAnswer answer = rollfix::solve(one.problem);
    for (const std::vector<double>& starts : scan(one)) {
      ++found;
      one.starts = starts;
      EXPECT_TRUE(std::any_of(answer.placements.begin(), answer.placements.end(),
                              [&](const HoldPlacement& placement) { return holds(placement, one, 1e-9); }))
          << "case " << number << ", s = " << starts[0];
    }
  }
  std::printf("%zu first contacts that a scan found are listed\n", found);
}

}  // namespace hold_truth_test
