// How the answers move with the readings, against answers to readings that were moved.

#include <gtest/gtest.h>

#include <cmath>

#include "pair_cases.hpp"
#include "random.hpp"
#include "rollfix/locate.hpp"
#include "shapes.hpp"

namespace pair_sensitivity_test {
namespace {

using namespace rollfix;

constexpr double kStep = 1e-6;
const double kNearSingular = 30;  // sensitivities above this bend too much for a finite difference

/// The start nearest to a place after the readings have been moved.
PerFinger<double> moved_start(const Part& part, const std::vector<Reading>& readings, const LocateOptions& options,
                              const PerFinger<double>& from) {
  PerFinger<double> best{1e9, 1e9};
  double least = 1e9;
  for (const Placement& placement : locate(part, readings, options).placements) {
    const double far = std::max(part.boundary().distance(placement.start[0], from[0]),
                                part.boundary().distance(placement.start[1], from[1]));
    if (far < least) {
      least = far;
      best = placement.start;
    }
  }
  return best;
}

class PairSensitivityTest : public testing::TestWithParam<std::size_t> {
 protected:
  Part part_{gallery("spline,n=10,seed=8")};

  /// d start / d (what `move` changes), by central differences.
  template <class Move>
  PerFinger<double> derivative(const pair_cases::Case& drawn, const LocateOptions& options, const PerFinger<double>& at,
                               Move move) {
    PerFinger<double> ends[2];
    for (const int side : {0, 1}) {
      std::vector<Reading> readings = drawn.readings;
      LocateOptions moved = options;
      move(readings, moved, side == 0 ? -kStep : kStep);
      ends[side] = moved_start(part_, readings, moved, at);
    }
    return {part_.boundary().offset(ends[0][0], ends[1][0]) / (2 * kStep),
            part_.boundary().offset(ends[0][1], ends[1][1]) / (2 * kStep)};
  }
};

// One reading with facing, two readings.
INSTANTIATE_TEST_SUITE_P(Readings, PairSensitivityTest, testing::Values(1U, 2U));

TEST_P(PairSensitivityTest, agrees_with_finite_differences) {
  auto generator = test_generator();
  int compared = 0;
  for (int k = 0; k < full_count(6); ++k) {
    const pair_cases::Case drawn = pair_cases::random_case(part_, GetParam(), generator);
    LocateOptions options;
    if (GetParam() == 1) options.facing = drawn.facing;
    for (const Placement& placement : locate(part_, drawn.readings, options).placements) {
      if (placement.kind != Kind::crossing || std::abs(placement.sensitivity.per_turn[0][0]) > kNearSingular ||
          std::abs(placement.sensitivity.per_turn[1][0]) > kNearSingular) {
        continue;
      }
      const auto compare = [&](auto move, const PerFinger<double>& expected) {
        const PerFinger<double> found = derivative(drawn, options, placement.start, move);
        for (const std::size_t f : {0U, 1U}) EXPECT_NEAR(found[f], expected[f], 1e-2 * (1 + std::abs(expected[f])));
      };
      const Sensitivity& sensitivity = placement.sensitivity;
      using Readings = std::vector<Reading>;
      compare([](Readings& readings, LocateOptions&, double by) { readings[0].turn += by; },
              {sensitivity.per_turn[0][0], sensitivity.per_turn[1][0]});
      compare([](Readings& readings, LocateOptions&, double by) { readings[0].length[0] += by; },
              {sensitivity.per_length[0][0][0], sensitivity.per_length[1][0][0]});
      compare([](Readings& readings, LocateOptions&, double by) { readings[0].length[1] += by; },
              {sensitivity.per_length[0][0][1], sensitivity.per_length[1][0][1]});
      if (GetParam() == 1) {
        compare([](Readings&, LocateOptions& moved, double by) { *moved.facing += by; },
                {sensitivity.per_facing[0], sensitivity.per_facing[1]});
      }
      ++compared;
    }
  }
  EXPECT_GT(compared, 10);
}

TEST(PairSensitivityLeastSquares, of_more_readings_than_unknowns_is_that_of_least_squares) {
  const Part part(gallery("spline,n=10,seed=8"));
  const PerFinger<double> start{1.0, 4.0};
  std::vector<Reading> readings;
  for (const double length : {0.7, 1.6, 2.9}) {
    readings.push_back(pair_cases::reading_from(part, start, length, 2.2 - length));
  }
  const Search search = locate(part, readings);
  ASSERT_EQ(search.verdict().text(), "unique");
  const Sensitivity& sensitivity = search.placements.front().sensitivity;
  // A change of the readings that the two starts explain is explained by them: pseudo-inverse times J is 1.
  const TurningFunction& turning = part.turning();
  for (const std::size_t finger : {0U, 1U}) {
    double along_s = 0;
    double along_t = 0;
    for (std::size_t k = 0; k < readings.size(); ++k) {
      const double by = sensitivity.per_turn[finger][k];
      along_s += by * (turning.curvature(start[0] + readings[k].length[0]) - turning.curvature(start[0]));
      along_t -= by * (turning.curvature(start[1] + readings[k].length[1]) - turning.curvature(start[1]));
    }
    EXPECT_NEAR(along_s, finger == 0 ? 1 : 0, 1e-9);
    EXPECT_NEAR(along_t, finger == 1 ? 1 : 0, 1e-9);
  }
}

}  // namespace
}  // namespace pair_sensitivity_test
