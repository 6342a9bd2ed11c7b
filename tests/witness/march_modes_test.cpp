// Section 2.2: the march on a boundary with concavities, mode by mode.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/core.h>

#include "march_agreement.hpp"
#include "march_shapes.hpp"
#include "random.hpp"

namespace march_modes_test {
namespace {

using namespace rollfix::march;
using namespace march_shapes;
using march_oracle::Exhaustive;
using march_oracle::RandomReading;

void compare_with_scan(const rollfix::Outline& outline, int count, std::mt19937_64& generator) {
  const March march(outline, curvature_density());
  const Exhaustive oracle(outline);
  for (int i = 0; i < count; ++i) {
    const RandomReading reading(oracle, outline.closed, generator);
    SCOPED_TRACE(fmt::format("{} {:.17g},{:.17g}", outline.name, reading.length, reading.integral));
    const auto roots = oracle.scan(reading.length, reading.integral).roots;
    const Result result = march.segments(reading.length, reading.integral);
    march_oracle::expect_agreement(result, roots, oracle.perimeter(), outline.closed);
  }
}

TEST(MarchModes, preprocessing_finds_the_inflections_of_a_limacon) {
  const double a = 1.5, b = 1;
  const March march(limacon(a, b), curvature_density());
  const Exhaustive oracle(limacon(a, b));
  // kappa = 0 where a^2 + 3 a b cos u + 2 b^2 = 0
  const double u = std::acos(-(a * a + 2 * b * b) / (3 * a * b));
  const auto length = [&](double to) {
    const auto speed = [&](double x) { return std::sqrt(a * a + b * b + 2 * a * b * std::cos(x)); };
    return boost::math::quadrature::gauss_kronrod<double, 31>::integrate(speed, 0, to, 10, 1e-14);
  };
  const auto found = march.breakpoints();
  ASSERT_EQ(found.size(), 2U);
  EXPECT_NEAR(found[0].s, length(u), 1e-11);
  EXPECT_NEAR(found[1].s, length(2 * kPi - u), 1e-11);
  EXPECT_EQ(found[0].sign_after, -1);
  EXPECT_EQ(found[1].sign_after, 1);
  EXPECT_NEAR(found[0].integral, oracle.value(found[0].s), 1e-12);
}

TEST(MarchModes, segments_are_found_in_all_four_modes) {
  const rollfix::Outline outline = amoeba(0.2, 7);
  const March march(outline, curvature_density());
  const Exhaustive oracle(outline);
  const auto inflections = march.breakpoints();
  const auto sign_at = [&](double s) {
    const auto after = std::upper_bound(inflections.begin(), inflections.end(), s,
                                        [](double x, const Breakpoint& point) { return x < point.s; });
    return after == inflections.begin() ? inflections.back().sign_after : (after - 1)->sign_after;
  };
  std::mt19937_64 generator = test_generator(2);
  std::set<std::pair<int, int>> modes;
  for (int i = 0; i < 20; ++i) {
    const RandomReading reading(oracle, true, generator);
    for (const Segment& segment : march.segments(reading.length, reading.integral).segments) {
      const std::pair<int, int> mode{sign_at(segment.start), sign_at(segment.end)};
      if (segment.found != Found::boundary) {
        EXPECT_EQ(segment.found == Found::bisection, mode.first != mode.second);
      }
      modes.insert(mode);
    }
  }
  EXPECT_EQ(modes.size(), 4U);
}

TEST(MarchModes, random_readings_on_wavy_shapes_have_the_segments_that_an_exhaustive_scan_finds) {
  std::mt19937_64 generator = test_generator(3);
  for (const rollfix::Outline& outline : {limacon(1.5, 1), limacon(1.05, 1), amoeba(), amoeba(0.2, 7)}) {
    compare_with_scan(outline, test_count(15), generator);
  }
}

TEST(MarchModes, random_readings_on_random_splines_have_the_segments_that_an_exhaustive_scan_finds) {
  std::mt19937_64 generator = test_generator(4);
  for (int i = 0; i < test_count(12); ++i) {
    compare_with_scan(random_spline(generator, 8 + i % 12), 5, generator);
  }
}

TEST(MarchModes, random_readings_on_an_open_curve_have_the_segments_that_an_exhaustive_scan_finds) {
  std::mt19937_64 generator = test_generator(5);
  compare_with_scan(open_wave(), test_count(40), generator);
}

TEST(MarchModes, segments_that_start_or_end_at_an_end_of_an_open_curve_count) {
  const rollfix::Outline outline = open_wave();
  const Exhaustive oracle(outline);
  const double perimeter = oracle.perimeter();
  const double length = 0.4 * perimeter;
  for (const double start : {0.0, perimeter - length}) {
    for (const double sign : {1.0, -1.0}) {
      const double from = sign > 0 ? start : start + length;
      const Result result = locate(outline, {sign * length, oracle.phi(from, sign * length)});
      const bool found = std::any_of(result.segments.begin(), result.segments.end(), [&](const Segment& segment) {
        return std::fabs(segment.start - from) < 1e-10 && std::fabs(segment.end - from - sign * length) < 1e-10;
      });
      EXPECT_TRUE(found) << from << " " << sign;
    }
  }
}

TEST(MarchModes, the_whole_of_an_open_curve_fits_once) {
  const rollfix::Outline outline = open_wave();
  const Exhaustive oracle(outline);
  EXPECT_EQ(locate(outline, {oracle.perimeter(), oracle.total()}).segments.size(), 1U);
  EXPECT_TRUE(locate(outline, {oracle.perimeter(), oracle.total() + 1e-6}).segments.empty());
}

TEST(MarchModes, whole_loops_are_added_to_length_and_turn_without_changing_the_answer) {
  const March march(amoeba(), curvature_density());
  const Exhaustive oracle(amoeba());
  const double length = 0.3 * oracle.perimeter();
  const double turn = oracle.phi(0.1 * oracle.perimeter(), length);
  const Result once = march.segments(length, turn);
  for (const int loops : {-7, -1, 1, 20}) {
    const Result more = march.segments(length + loops * oracle.perimeter(), turn + loops * 2 * kPi);
    ASSERT_EQ(more.segments.size(), once.segments.size());
    for (std::size_t i = 0; i < once.segments.size(); ++i) {
      EXPECT_NEAR(more.segments[i].start, once.segments[i].start, 1e-9);
    }
  }
}

TEST(MarchModes, a_turn_that_no_segment_has_is_found_nowhere) {
  const Result result = locate(amoeba(), {1.0, 9.0});
  EXPECT_TRUE(result.segments.empty());
  EXPECT_TRUE(result.complete());
}

TEST(MarchModes, slow_random_splines_again_in_great_numbers) {
  std::mt19937_64 generator = test_generator(6);
  for (int i = 0; i < test_count(40); ++i) {
    const int points = 5 + i % 25;
    const double wobble = std::min(0.05 + 0.01 * (i % 30), 3.0 / points);  // more makes cusps
    compare_with_scan(random_spline(generator, points, wobble), 10, generator);
  }
}

}  // namespace
}  // namespace march_modes_test
