// The two holes of the paper's march, measured: its rate tends to 1 at a double root, and the "very small positive
// amount" of its reset is too small or too large for some reading.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include <fmt/core.h>

#include "march_agreement.hpp"
#include "march_shapes.hpp"
#include "random.hpp"

namespace march_holes_test {
namespace {

using namespace rollfix::march;
using namespace march_shapes;
using march_oracle::Exhaustive;

/// On the egg, a reading whose two roots lie `gap` (a part of P) apart, around a maximum of phi.
struct CloseRoots {
  rollfix::Outline outline = egg();
  Exhaustive oracle{outline};
  double perimeter = oracle.perimeter();
  double length = 0.3 * perimeter;
  double summit = 0;  // where phi is largest
  double turn = 0;
  std::vector<double> roots;  // the two

  explicit CloseRoots(double gap) {
    const auto stationary = stationary_points(outline, length).segments;
    for (const Segment& segment : stationary) {
      if (summit == 0 || oracle.phi(segment.start, length) > oracle.phi(summit, length)) summit = segment.start;
    }
    turn = oracle.phi(summit - 0.5 * gap * perimeter, length);
    for (const double root : oracle.scan(length, turn).roots) {
      if (std::fabs(root - summit) <= 2 * gap * perimeter) roots.push_back(root);
    }
  }

  Result march(const Options& options) const { return locate(outline, {length, turn}, options); }
  bool near_summit(double s) const { return std::fabs(s - summit) <= 0.01 * perimeter; }
};

TEST(MarchHoles, the_rate_tends_to_one_as_two_roots_close_up) {
  fmt::print("  gap / P    1 - rate   rounds to the two roots\n");
  double last = 0;
  for (const double gap : {1e-1, 1e-2, 1e-3, 1e-4}) {
    const CloseRoots close(gap);
    ASSERT_EQ(close.roots.size(), 2U);
    Options patient;
    patient.iterations = 10'000'000;
    const Result result = close.march(patient);
    double rounds = 0;
    double rate = 0;
    for (const Segment& segment : result.segments) {
      if (std::min(std::fabs(segment.start - close.roots[0]), std::fabs(segment.start - close.roots[1])) > 1e-8)
        continue;
      rounds += static_cast<double>(segment.iterations);
      rate = std::max(rate, segment.rate);
    }
    fmt::print("  {:.0e}      {:.1e}    {:.0f}\n", gap, 1 - rate, rounds);
    if (last > 0 && gap < 1e-2) {
      EXPECT_NEAR(rounds / last, 10, 4);  // rounds grow like 1 / gap
    }
    last = rounds;
  }
}

TEST(MarchHoles, two_roots_that_take_too_many_rounds_become_a_doubt_and_are_not_lost_in_silence) {
  const CloseRoots close(1e-5);
  Options hasty;
  hasty.iterations = 2000;
  const Result result = close.march(hasty);
  ASSERT_FALSE(result.complete());
  EXPECT_EQ(result.doubts.front().why, Doubt::Why::slow);
  EXPECT_EQ(result.doubts.front().iterations, 2000U);
  EXPECT_LE(result.doubts.front().where.lo, close.summit);
  EXPECT_GE(result.doubts.front().where.hi, close.summit);
}

TEST(MarchHoles, an_exact_double_root_becomes_a_doubt_around_it) {
  CloseRoots close(1e-3);
  close.turn = close.oracle.phi(close.summit, close.length);
  Options hasty;
  hasty.iterations = 2000;
  const Result result = close.march(hasty);
  const bool there = std::any_of(result.doubts.begin(), result.doubts.end(), [&](const Doubt& doubt) {
    return doubt.where.lo <= close.summit + 1e-7 && doubt.where.hi >= close.summit - 1e-7;
  });
  EXPECT_TRUE(there);
}

TEST(MarchHoles, a_reset_below_the_limits_error_finds_the_same_root_again_and_again) {
  const CloseRoots close(1e-3);
  Options options;
  options.limit = 1e-8;
  fmt::print("  reset / limit   found again\n");
  std::size_t last = 0;
  for (const double reset : {1e-7, 1e-10, 1e-11, 1e-12}) {
    options.reset = reset;
    const Result result = close.march(options);
    fmt::print("  {:.0e}           {}\n", reset / options.limit, result.found_again);
    EXPECT_EQ(result.segments.size(), close.oracle.scan(close.length, close.turn).roots.size());
    if (reset > options.limit) {
      EXPECT_EQ(result.found_again, 0U);
    } else {
      EXPECT_GT(result.found_again, last);
    }
    last = result.found_again;
  }
  EXPECT_GT(last, 1000U);
}

TEST(MarchHoles, a_reset_beyond_the_gap_jumps_over_the_next_root) {
  const CloseRoots close(1e-3);
  Options options;
  options.reset = 1e-2;
  const Result result = close.march(options);
  const auto near = std::count_if(result.segments.begin(), result.segments.end(),
                                  [&](const Segment& segment) { return close.near_summit(segment.start); });
  EXPECT_EQ(near, 1);  // of two
  ASSERT_EQ(result.doubts.size(), 1U);
  EXPECT_EQ(result.doubts.front().why, Doubt::Why::jumped);
  EXPECT_TRUE(result.doubts.front().where.contains(close.roots.back()));
}

TEST(MarchHoles, the_default_reset_separates_roots_down_to_a_ten_thousandth_of_the_perimeter) {
  for (const double gap : {1e-2, 1e-3, 1e-4}) {
    const CloseRoots close(gap);
    Options patient;
    patient.iterations = 10'000'000;
    const Result result = close.march(patient);
    EXPECT_TRUE(result.complete());
    march_oracle::expect_agreement(result, close.oracle.scan(close.length, close.turn).roots, close.perimeter, true);
  }
}

TEST(MarchHoles, slow_how_many_random_readings_end_in_a_doubt) {
  fmt::print("  shape     readings   with a doubt   roots in doubt   mean rounds\n");
  for (const rollfix::Outline& outline : {ellipse(2, 1), egg(), limacon(1.5, 1), amoeba()}) {
    const March march(outline, curvature_density());
    const Exhaustive oracle(outline);
    std::mt19937_64 generator = test_generator(31);
    constexpr int kReadings = 1000;
    int doubtful = 0;
    std::size_t roots_in_doubt = 0;
    std::size_t rounds = 0;
    for (int i = 0; i < kReadings; ++i) {
      const march_oracle::RandomReading reading(oracle, true, generator);
      const Result result = march.segments(reading.length, reading.integral);
      rounds += result.iterations;
      if (result.complete()) continue;
      ++doubtful;
      roots_in_doubt += oracle.scan(reading.length, reading.integral).roots.size() - result.segments.size();
    }
    fmt::print("  {:8}  {}       {:3}            {:3}              {}\n", outline.name, kReadings, doubtful,
               roots_in_doubt, rounds / kReadings);
    EXPECT_LT(doubtful, kReadings / 20);
  }
}

}  // namespace
}  // namespace march_holes_test
