// Section 3.1: between neighbouring a_i (b_j) both total curvatures of a finger are monotone.

#include "march_pairs.hpp"
#include "march_shapes.hpp"
#include "random.hpp"

namespace march_pairs_partition_test {
namespace {

using namespace rollfix::march;
using namespace march_shapes;
using march_pairs::Exhaustive;
using march_pairs::Planted;
using march_pairs::Readings;
using rollfix::Outline;

std::vector<Outline> shapes_of(std::mt19937_64& generator) {
  return {egg(), limacon(1.5, 1), amoeba(), amoeba(0.2, 7), random_spline(generator, 8), random_spline(generator, 13)};
}

/// phi goes one way from each point to the next.
void expect_monotone(const Exhaustive& oracle, const std::vector<double>& points, double length) {
  constexpr int kPlaces = 12;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double lo = points[i];
    const double hi = i + 1 < points.size() ? points[i + 1] : points[0] + oracle.perimeter();
    const double direction = oracle.phi(hi, length) - oracle.phi(lo, length);
    for (int k = 0; k < kPlaces; ++k) {
      const double from = lo + (hi - lo) * k / kPlaces;
      const double gain = oracle.phi(from + (hi - lo) / kPlaces, length) - oracle.phi(from, length);
      EXPECT_GT(gain * direction, 0) << "on [" << lo << ", " << hi << "]";
    }
  }
}

/// The points are the stationary points of both, each once.
void expect_stationary(const Exhaustive& oracle, const std::vector<double>& points, double one, double two) {
  EXPECT_EQ(points.size(), oracle.stationary(one).size() + oracle.stationary(two).size());
  for (const double point : points) {
    EXPECT_NEAR(std::min(std::fabs(oracle.slope(point, one)), std::fabs(oracle.slope(point, two))), 0, 1e-7);
  }
}

TEST(MarchPairsPartition, each_phi_is_monotone_on_each_interval) {
  auto generator = test_generator(41);
  for (const Outline& outline : shapes_of(generator)) {
    const Exhaustive oracle(outline);
    const PairMarch march(outline);
    for (int i = 0; i < test_count(3); ++i) {
      const Readings readings = Planted(oracle, generator).readings;
      SCOPED_TRACE(march_pairs::trace_of(outline.name, readings));
      const PairResult result = march_pairs::march(march, readings);
      for (const auto& reading : readings) {
        expect_monotone(oracle, result.stationary_a, reading.length[0]);
        expect_monotone(oracle, result.stationary_b, reading.length[1]);
      }
    }
  }
}

TEST(MarchPairsPartition, its_points_are_those_that_an_exhaustive_scan_finds) {
  auto generator = test_generator(42);
  for (const Outline& outline : shapes_of(generator)) {
    const Exhaustive oracle(outline);
    const PairMarch march(outline);
    for (int i = 0; i < test_count(3); ++i) {
      const Readings readings = Planted(oracle, generator).readings;
      SCOPED_TRACE(march_pairs::trace_of(outline.name, readings));
      const PairResult result = march_pairs::march(march, readings);
      expect_stationary(oracle, result.stationary_a, readings[0].length[0], readings[1].length[0]);
      expect_stationary(oracle, result.stationary_b, readings[0].length[1], readings[1].length[1]);
      EXPECT_EQ(result.merged, 0U);
      EXPECT_EQ(result.rectangles, result.n() * result.m());
      EXPECT_EQ(result.rectangles, result.rejected + result.examined);
    }
  }
}

TEST(MarchPairsPartition, points_of_both_functions_that_coincide_are_counted_once) {
  const Exhaustive oracle(egg());
  const std::size_t alone = oracle.stationary(1.3).size();
  const PairResult result = locate_pairs(egg(), {1.3, 2.1, 0.2}, {1.3, 0.9, 0.4});  // finger a stays where it was
  EXPECT_EQ(result.n(), alone);
  EXPECT_EQ(result.merged, alone);
}

TEST(MarchPairsPartition, whole_loops_change_no_point) {
  const double perimeter = Exhaustive(egg()).perimeter();
  const PairResult once = locate_pairs(egg(), {1.3, 2.1, 0.2}, {0.7, 0.9, 0.4});
  const PairResult more = locate_pairs(egg(), {1.3 + 2 * perimeter, 2.1, 0.2}, {0.7 - perimeter, 0.9, 0.4});
  ASSERT_EQ(more.n(), once.n());
  for (std::size_t i = 0; i < once.n(); ++i) EXPECT_NEAR(more.stationary_a[i], once.stationary_a[i], 1e-9);
}

}  // namespace
}  // namespace march_pairs_partition_test
