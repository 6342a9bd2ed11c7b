// Section 5: segments of length L over which the integral of any given f equals C, on open and closed curves.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include <fmt/core.h>

#include "march_agreement.hpp"
#include "march_shapes.hpp"
#include "random.hpp"

namespace march_density_test {
namespace {

using namespace rollfix::march;
using namespace march_shapes;
using march_oracle::Exhaustive;
using march_oracle::Measure;
using march_oracle::RandomReading;
using rollfix::Jet;

double height(const Jet& jet) { return jet.position.y() + 0.1; }
double ripple(const Jet& jet) { return std::sin(3 * jet.position.x()) + 0.3 * std::cos(5 * jet.position.y()); }
double bending_energy(const Jet& jet) { return rollfix::curvature(jet) * rollfix::curvature(jet) + 0.01; }

void compare_with_scan(const rollfix::Outline& outline, double (*f)(const Jet&), int count,
                       std::mt19937_64& generator) {
  const March march(outline, density([f](const Site& site) { return f(site.jet); }));
  const Exhaustive oracle(outline, Measure::other, f);
  for (int i = 0; i < count; ++i) {
    const RandomReading reading(oracle, outline.closed, generator);
    SCOPED_TRACE(fmt::format("{} {:.17g},{:.17g}", outline.name, reading.length, reading.integral));
    const auto roots = oracle.scan(reading.length, reading.integral).roots;
    march_oracle::expect_agreement(march.segments(reading.length, reading.integral), roots, oracle.perimeter(),
                                   outline.closed);
  }
}

TEST(MarchDensity, integrals_over_closed_curves_have_the_segments_that_an_exhaustive_scan_finds) {
  std::mt19937_64 generator = test_generator(21);
  for (const rollfix::Outline& outline : {egg(), amoeba()}) {
    for (const auto f : {height, ripple, bending_energy}) compare_with_scan(outline, f, test_count(8), generator);
  }
}

TEST(MarchDensity, integrals_over_open_curves_have_the_segments_that_an_exhaustive_scan_finds) {
  std::mt19937_64 generator = test_generator(22);
  for (const auto f : {height, ripple, bending_energy}) compare_with_scan(open_wave(), f, test_count(15), generator);
}

TEST(MarchDensity, f_may_be_integrated_over_lines_and_round_corners_where_curvature_may_not) {
  const std::vector<rollfix::Vec2> corners{{0, 0}, {2, 0.3}, {2.4, 1.5}, {0.7, 1.9}};
  const rollfix::Outline polygon{"polygon", rollfix::spline_through(corners, true, 0), true, false};
  std::mt19937_64 generator = test_generator(23);
  compare_with_scan(polygon, ripple, test_count(15), generator);
  EXPECT_THROW(March(polygon, curvature_density()), Refusal);
}

TEST(MarchDensity, a_user_who_hands_in_the_curvature_gets_the_answer_for_turns) {
  const Exhaustive oracle(amoeba());
  const double turn = oracle.phi(1.3, 2.0);
  const Result named = locate(amoeba(), {2.0, turn});
  const Result handed = segments_with_integral(
      amoeba(), [](const Site& site) { return rollfix::curvature(site.jet); }, 2.0, turn);
  ASSERT_EQ(handed.segments.size(), named.segments.size());
  for (std::size_t i = 0; i < named.segments.size(); ++i) {
    EXPECT_EQ(handed.segments[i].start, named.segments[i].start);
  }
}

TEST(MarchDensity, the_centre_of_gravity_of_a_wire_segment_can_be_prescribed) {
  // Over an ellipse's wire, segments whose mean height is zero: by symmetry they are centred on the long axis.
  const double perimeter = Exhaustive(ellipse(2, 1)).perimeter();
  const double length = 0.2 * perimeter;
  const Result result = segments_with_integral(
      ellipse(2, 1), [](const Site& site) { return site.jet.position.y(); }, length, 0);
  ASSERT_EQ(result.segments.size(), 2U);
  EXPECT_NEAR(result.segments[0].start, 0.5 * perimeter - 0.5 * length, 1e-9);
  EXPECT_NEAR(result.segments[1].start, perimeter - 0.5 * length, 1e-9);
}

}  // namespace
}  // namespace march_density_test
