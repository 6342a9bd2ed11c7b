// Eq. (6): stationary points of phi(s) = Phi(s, s + L) by the same march on kappa' instead of kappa.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include <fmt/core.h>

#include "march_agreement.hpp"
#include "march_shapes.hpp"
#include "random.hpp"

namespace march_stationary_test {
namespace {

using namespace rollfix::march;
using namespace march_shapes;
using march_oracle::Exhaustive;
using march_oracle::Measure;

void compare_with_scan(const rollfix::Outline& outline, int count, std::mt19937_64& generator) {
  const March march(outline, curvature_rate_density());
  const Exhaustive oracle(outline, Measure::curvature, {});
  const double perimeter = oracle.perimeter();
  std::uniform_real_distribution<double> part(outline.closed ? -2 : -0.9, outline.closed ? 2 : 0.9);
  for (int i = 0; i < count; ++i) {
    const double length = part(generator) * perimeter;
    SCOPED_TRACE(fmt::format("{} L = {:.17g}", outline.name, length));
    march_oracle::expect_agreement(march.segments(length, 0), oracle.scan(length, 0).roots, perimeter, outline.closed);
  }
}

TEST(MarchStationary, the_vertices_of_an_ellipse_are_its_four_axis_points) {
  const March march(ellipse(2, 1), curvature_rate_density());
  const double quarter = Exhaustive(ellipse(2, 1)).perimeter() / 4;
  const auto vertices = march.breakpoints();
  ASSERT_EQ(vertices.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(vertices[i].s, static_cast<double>(i) * quarter, 1e-12);
}

TEST(MarchStationary, on_an_ellipse_they_lie_symmetrically_about_the_axes) {
  const double perimeter = Exhaustive(ellipse(2, 1)).perimeter();
  const double length = 0.3 * perimeter;
  const Result result = stationary_points(ellipse(2, 1), length);
  ASSERT_EQ(result.segments.size(), 4U);
  for (const Segment& segment : result.segments) {
    const double middle = (segment.start + 0.5 * length) / (perimeter / 4);
    EXPECT_NEAR(middle, std::round(middle), 1e-9);
  }
}

TEST(MarchStationary, random_lengths_have_the_points_that_an_exhaustive_scan_finds) {
  std::mt19937_64 generator = test_generator(11);
  for (const rollfix::Outline& outline : {egg(), limacon(1.5, 1), amoeba(), amoeba(0.2, 7), open_wave()}) {
    compare_with_scan(outline, test_count(12), generator);
  }
}

TEST(MarchStationary, splines_whose_vertices_are_joints_are_no_exception) {
  std::mt19937_64 generator = test_generator(12);
  for (int i = 0; i < test_count(8); ++i) compare_with_scan(random_spline(generator, 8 + i % 12), 4, generator);
}

TEST(MarchStationary, phi_is_monotone_between_neighbouring_ones) {
  const Exhaustive turn(amoeba());
  const double length = 1.7;
  const Result result = stationary_points(amoeba(), length);
  ASSERT_TRUE(result.complete());
  const std::size_t count = result.segments.size();
  ASSERT_GE(count, 4U);
  for (std::size_t i = 0; i < count; ++i) {
    const double lo = result.segments[i].start;
    const double hi = i + 1 < count ? result.segments[i + 1].start : result.segments[0].start + turn.perimeter();
    const double direction = turn.phi(hi, length) - turn.phi(lo, length);
    for (int k = 0; k < 20; ++k) {
      const double here = lo + (hi - lo) * k / 20;
      EXPECT_GT((turn.phi(here + (hi - lo) / 20, length) - turn.phi(here, length)) * direction, 0);
    }
  }
}

TEST(MarchStationary, theorem_5_holds_for_them_too) {
  for (const rollfix::Outline& outline : {egg(), amoeba(), amoeba(0.2, 7)}) {
    const March march(outline, curvature_rate_density());
    std::mt19937_64 generator = test_generator(13);
    std::uniform_real_distribution<double> length(0.2, 6);
    double worst = 0;
    for (int i = 0; i < test_count(20); ++i) {
      const Result result = march.segments(length(generator), 0);
      worst = std::max(worst, static_cast<double>(result.steps.total()) / static_cast<double>(result.steps_per_loop));
    }
    fmt::print("  {:2} vertices  {:.3f} T/h\n", march.breakpoints().size(), worst);
    EXPECT_LE(worst, 5);
  }
}

}  // namespace
}  // namespace march_stationary_test
