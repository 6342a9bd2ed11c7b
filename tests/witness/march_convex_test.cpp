// Section 2.1: the march on a convex boundary. Lemmas 1 and 2, Proposition 3.

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include <fmt/core.h>

#include "march_agreement.hpp"
#include "march_shapes.hpp"
#include "random.hpp"

namespace march_convex_test {
namespace {

using namespace rollfix::march;
using namespace march_shapes;
using march_oracle::Exhaustive;
using march_oracle::RandomReading;

Options recording() {
  Options options;
  options.record = true;
  return options;
}

/// All finds on the egg of one reading, with their sequences.
struct Finds {
  rollfix::Outline outline = egg();
  Exhaustive oracle{outline};
  double length = 0.3 * oracle.perimeter();
  double turn = oracle.phi(0.4 * oracle.perimeter(), length);
  Result result = locate(outline, {length, turn}, recording());
  std::vector<double> roots = oracle.scan(length, turn).roots;

  double curvature(double s) const {
    const double d = 1e-4 * oracle.perimeter();
    const double near = (oracle.value(s + d) - oracle.value(s - d)) / (2 * d);
    const double far = (oracle.value(s + 2 * d) - oracle.value(s - 2 * d)) / (4 * d);
    return (4 * near - far) / 3;
  }
};

TEST(MarchConvex, case_1_and_case_2_take_turns_round_the_egg) {
  const Finds finds;
  ASSERT_GE(finds.result.segments.size(), 2U);
  for (std::size_t i = 1; i < finds.result.segments.size(); ++i) {
    EXPECT_NE(finds.result.segments[i].found, finds.result.segments[i - 1].found);
  }
}

TEST(MarchConvex, lemma_1_the_starts_increase_and_stay_below_the_root) {
  const Finds finds;
  for (std::size_t i = 0; i < finds.result.segments.size(); ++i) {
    const std::vector<Iterate>& sequence = finds.result.segments[i].sequence;
    ASSERT_GT(sequence.size(), 5U);
    for (std::size_t k = 1; k < sequence.size(); ++k) {
      EXPECT_GT(sequence[k].start, sequence[k - 1].start);
      EXPECT_GE(sequence[k].end, sequence[k - 1].end);
    }
    EXPECT_LT(sequence.back().start, finds.roots[i] + 1e-13);
    EXPECT_LT(sequence.back().end, finds.roots[i] + finds.length + 1e-12);
  }
}

TEST(MarchConvex, the_sequences_obey_the_two_cases_to_the_letter) {
  const Finds finds;
  for (const Segment& segment : finds.result.segments) {
    const std::vector<Iterate>& sequence = segment.sequence;
    for (std::size_t k = 0; k + 1 < sequence.size(); ++k) {
      const Iterate now = sequence[k];
      const double next = sequence[k + 1].start;
      if (segment.found == Found::case_1) {
        EXPECT_NEAR(finds.oracle.value(now.end) - finds.oracle.value(now.start), finds.turn, 1e-12);
        EXPECT_NEAR(next, now.end - finds.length, 1e-12);
      } else {
        EXPECT_NEAR(now.end, now.start + finds.length, 1e-12);
        EXPECT_NEAR(finds.oracle.value(now.end) - finds.oracle.value(next), finds.turn, 1e-12);
      }
    }
  }
}

/// The factor by which the error shrinks per round, from the first error below `from` to the last above `to`.
double measured_rate(const std::vector<Iterate>& sequence, double root, double from, double to) {
  std::size_t first = 0;
  while (root - sequence[first].start > from) ++first;
  std::size_t last = first;
  while (last + 1 < sequence.size() && root - sequence[last + 1].start > to) ++last;
  return std::pow((root - sequence[last].start) / (root - sequence[first].start),
                  1.0 / static_cast<double>(last - first));
}

TEST(MarchConvex, lemma_2_the_error_shrinks_by_the_ratio_of_the_curvatures) {
  const Finds finds;
  fmt::print("  find  s          kappa(a)   kappa(b)   rate by Lemma 2   measured\n");
  for (std::size_t i = 0; i < finds.result.segments.size(); ++i) {
    const Segment& segment = finds.result.segments[i];
    const double at_start = finds.curvature(finds.roots[i]);
    const double at_end = finds.curvature(finds.roots[i] + finds.length);
    const double rate = segment.found == Found::case_1 ? at_start / at_end : at_end / at_start;
    const double measured = measured_rate(segment.sequence, finds.roots[i], 1e-4, 1e-9);
    fmt::print("  {:4}  {:.6f}   {:.6f}   {:.6f}   {:.8f}        {:.8f}\n", i, finds.roots[i], at_start, at_end, rate,
               measured);
    EXPECT_LT(rate, 1);
    EXPECT_NEAR(measured, rate, 1e-4);
    EXPECT_NEAR(segment.rate, rate, 1e-8);
  }
}

TEST(MarchConvex, proposition_3_the_first_find_is_the_first_feasible_segment) {
  const Finds finds;
  ASSERT_FALSE(finds.roots.empty());
  EXPECT_NEAR(finds.result.segments.front().start, finds.roots.front(), 1e-9);
}

TEST(MarchConvex, a_convex_boundary_has_no_breakpoints) {
  EXPECT_TRUE(March(egg(), curvature_density()).breakpoints().empty());
  EXPECT_TRUE(March(ellipse(3, 1), curvature_density()).breakpoints().empty());
  EXPECT_TRUE(March(limacon(2.1, 1), curvature_density()).breakpoints().empty());
}

TEST(MarchConvex, random_readings_have_the_segments_that_an_exhaustive_scan_finds) {
  std::mt19937_64 generator = test_generator(1);
  for (const rollfix::Outline& outline : {egg(), ellipse(2, 1), limacon(2.5, 1)}) {
    const March march(outline, curvature_density());
    const Exhaustive oracle(outline);
    for (int i = 0; i < test_count(20); ++i) {
      const RandomReading reading(oracle, true, generator);
      SCOPED_TRACE(fmt::format("{} {:.17g},{:.17g}", outline.name, reading.length, reading.integral));
      const auto roots = oracle.scan(reading.length, reading.integral).roots;
      march_oracle::expect_agreement(march.segments(reading.length, reading.integral), roots, oracle.perimeter(), true);
    }
  }
}

TEST(MarchConvex, a_root_at_the_seam_is_listed_once) {
  const Exhaustive oracle(egg());
  const double length = 0.3 * oracle.perimeter();
  for (const double offset : {0.0, 1e-13, -1e-13, 1e-9, -1e-9}) {
    const double turn = oracle.phi(offset, length);
    const Result result = locate(egg(), {length, turn});
    march_oracle::expect_agreement(result, oracle.scan(length, turn).roots, oracle.perimeter(), true);
    EXPECT_EQ(result.segments.size() % 2, 0U) << offset;  // crossings of a closed boundary are even in number
  }
}

TEST(MarchConvex, a_clockwise_boundary_is_the_mirror_image) {
  const rollfix::Outline outline = egg();
  const Exhaustive oracle(outline);
  const double length = 0.3 * oracle.perimeter();
  const double turn = oracle.phi(0.4 * oracle.perimeter(), length);
  const Result forward = locate(outline, {length, turn});
  const rollfix::Outline backward{"egg", {rollfix::reversed(outline.curves.front())}, true, true};
  const Result mirrored = locate(backward, {length, -turn});
  std::vector<double> ends;
  for (const Segment& segment : forward.segments) ends.push_back(segment.end);
  Result seen_from_behind = mirrored;
  for (Segment& segment : seen_from_behind.segments) segment.start = oracle.perimeter() - segment.start;
  march_oracle::expect_agreement(seen_from_behind, ends, oracle.perimeter(), true);
}

}  // namespace
}  // namespace march_convex_test
