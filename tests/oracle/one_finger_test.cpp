// One finger against the oracle, which has its own formulas, its own arithmetic and its own way of looking: everywhere.
// All placements, and no other: --count and --seed say how many random cases, and which.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "oracle/doubt.hpp"
#include "oracle/one_finger_agreement.hpp"
#include "oracle/one_finger_cases.hpp"
#include "random.hpp"
#include "rollfix/locate.hpp"

namespace oracle_one_finger_test {
namespace {

using namespace oracle;
using rollfix::Search;

Search ask(const rollfix::Part& part, const Reading& reading) {
  rollfix::LocateOptions options;
  options.tolerance = reading.tolerance;
  return rollfix::locate(part, {reading.length, reading.turn}, options);
}

std::vector<std::string> complaints(const Boundary& boundary, const Reading& reading, const Search& search) {
  const Question question{reading.length, reading.turn, std::max(reading.tolerance, rollfix::kLeastTolerance),
                          doubt(boundary)};
  return OneFingerAgreement(boundary, question, search).complaints();
}

/// Calls `examine(known, part, reading, search)` for so many random readings, ten on each outline.
template <class Examine>
void for_random_cases(int count, std::uint64_t stream, const Examine& examine) {
  constexpr int kReadings = 10;
  for (int k = 0; kReadings * k < count; ++k) {
    std::mt19937_64 generator = test_generator(stream + static_cast<std::uint64_t>(k));
    RandomShapes random(generator);
    const Shape shape = random.shape(static_cast<std::size_t>(k));
    const rollfix::Part part = shape.part();
    const Boundary known = shape.boundary();
    RandomReadings readings(known, random);
    for (int i = 0; i < std::min(kReadings, count - kReadings * k); ++i) {
      const Reading reading = readings.reading();
      SCOPED_TRACE(fmt::format("outline {} ({}), reading {}: length {:.17g}, turn {:.17g}, tolerance {}", k, shape.name,
                               i, reading.length, reading.turn, reading.tolerance));
      examine(known, part, reading, ask(part, reading));
    }
  }
}

TEST(OracleOneFinger, finds_what_the_library_finds_and_nothing_else) {
  const int count = test_count(2000);
  int incomplete = 0;
  for_random_cases(count, 1000,
                   [&](const Boundary& known, const rollfix::Part& part, const Reading& reading, const Search& search) {
                     EXPECT_NEAR(static_cast<double>(part.perimeter() / known.perimeter()), 1, 1e-12);
                     EXPECT_THAT(complaints(known, reading, search), testing::IsEmpty());
                     if (search.status == rollfix::Status::incomplete) ++incomplete;
                   });
  EXPECT_LE(1000 * incomplete, count);
}

TEST(OracleOneFinger, complains_of_a_placement_that_is_missing_twice_there_or_too_wide) {
  int seen = 0;
  for_random_cases(
      60, 2000, [&](const Boundary& known, const rollfix::Part&, const Reading& reading, const Search& search) {
        if (search.placements.empty() || reading.tolerance < 1e-9 || search.placements.front().whole_loop[0]) return;
        ++seen;
        const auto expect_complaint = [&](const auto& spoil) {
          Search spoiled = search;
          spoil(spoiled.placements);
          EXPECT_FALSE(complaints(known, reading, spoiled).empty());
        };
        expect_complaint([](auto& placements) { placements.erase(placements.begin()); });
        expect_complaint([](auto& placements) { placements.push_back(placements.front()); });
        expect_complaint([&](auto& placements) {
          placements.front().extent[0].hi += 1e-3 * static_cast<double>(known.perimeter());
        });
      });
  EXPECT_GT(seen, 20);
}

TEST(OracleBoundary, has_the_length_of_an_ellipse_that_the_elliptic_integral_gives) {
  const Boundary boundary(ellipse(2, 1), true, 2);
  EXPECT_NEAR(static_cast<double>(boundary.perimeter() / (8 * std::comp_ellint_2l(std::sqrt(0.75L))) - 1), 0, 1e-16);
  EXPECT_EQ(boundary.total_turn(), 2 * kPi);
}

TEST(OracleBoundary, turns_along_a_logarithmic_spiral_as_the_logarithm_of_the_length) {
  const Real a = 0.7L, b = 0.13L;
  const Boundary boundary(log_spiral(a, b, 2), false);
  const Real start = a * std::sqrt(1 + 1 / (b * b));  // of the arc length from the pole
  for (Real s = 0; s < boundary.perimeter(); s += 0.37L) {
    const Real turned = boundary.contact(s).angle - boundary.contact(0).angle;
    EXPECT_NEAR(static_cast<double>(turned - std::log(1 + s / start) / b), 0, 1e-16);
  }
}

TEST(OracleBoundary, bounds_the_curvature_on_every_stretch) {
  for (int k = 0; k < 2 * static_cast<int>(RandomShapes::kKindCount); ++k) {
    std::mt19937_64 generator = test_generator(3000 + static_cast<std::uint64_t>(k));
    RandomShapes random(generator);
    const Shape shape = random.shape(static_cast<std::size_t>(k));
    const Boundary boundary = shape.boundary();
    const Real from = random.uniform(0, 0.5) * boundary.perimeter(),
               to = from + random.scaled(1e-6, 0.5) * boundary.perimeter();
    const Interval bounds = boundary.bend(boundary.contact(from), boundary.contact(to)).curvature;
    for (int i = 0; i <= 50; ++i) {
      const Real curvature = boundary.curvature(boundary.contact(from + (to - from) * i / 50));
      EXPECT_LE(bounds.lo, curvature) << shape.name;
      EXPECT_GE(bounds.hi, curvature) << shape.name;
    }
  }
}

}  // namespace
}  // namespace oracle_one_finger_test
