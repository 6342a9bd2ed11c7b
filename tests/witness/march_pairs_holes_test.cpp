// The holes of the paper's two-finger algorithm, measured: like those of its one-finger march, the rate tends to 1 at a
// double pair, and the reset is too large for some readings. The tables are those of docs/march.md.

#include "march_pairs.hpp"
#include "march_shapes.hpp"
#include "random.hpp"

namespace march_pairs_holes_test {
namespace {

using namespace rollfix::march;
using namespace march_shapes;
using march_pairs::Exhaustive;
using march_pairs::Planted;
using march_pairs::Point;
using march_pairs::Readings;
using march_pairs::Touching;
using rollfix::Outline;

/// On the egg, readings with two pairs close together: a double pair, theta_2 changed by `off`.
struct ClosePairs {
  Outline outline = egg();
  Exhaustive oracle{outline};
  Point middle;
  Readings readings;

  explicit ClosePairs(double off) {
    const Touching touching(oracle);
    middle = touching.at;
    readings = touching.readings;
    readings[1].turn += off;
  }

  std::vector<StartPair> near(const PairResult& result) const {
    std::vector<StartPair> pairs;
    for (const StartPair& pair : result.pairs) {
      if (oracle.distance({pair.s, pair.t}, middle) < 0.02 * oracle.perimeter()) pairs.push_back(pair);
    }
    return pairs;
  }
  double gap(const std::vector<StartPair>& two) const {
    return oracle.distance({two[0].s, two[0].t}, {two[1].s, two[1].t}) / oracle.perimeter();
  }
};

/// To the side on which there are two pairs.
constexpr double kSide = -1;

TEST(MarchPairsHoles, the_rate_tends_to_one_as_two_pairs_close_up) {
  fmt::print("  gap / P    1 - rate   rounds to the two pairs\n");
  PairMarchOptions patient;
  patient.iterations = 10'000'000;
  patient.budget = 10'000'000;
  double last_rounds = 0, last_gap = 0;
  for (const double off : {1e-5, 1e-6, 1e-7, 1e-8}) {
    const ClosePairs close(kSide * off);
    const std::vector<StartPair> two =
        close.near(march_pairs::march(PairMarch(close.outline, patient), close.readings));
    ASSERT_EQ(two.size(), 2U);
    const auto rounds = static_cast<double>(two[0].iterations + two[1].iterations);
    fmt::print("  {:.1e}    {:.1e}    {:.0f}\n", close.gap(two), 1 - std::max(two[0].rate, two[1].rate), rounds);
    if (last_rounds > 0) {
      EXPECT_NEAR(rounds / last_rounds * close.gap(two) / last_gap, 1, 0.3);  // rounds grow like 1 / gap
    }
    last_rounds = rounds;
    last_gap = close.gap(two);
  }
}

TEST(MarchPairsHoles, pairs_that_take_too_many_rounds_become_doubts_and_are_not_lost_in_silence) {
  const ClosePairs close(kSide * 1e-8);
  PairMarchOptions hasty;
  hasty.iterations = 500;
  const PairResult result = march_pairs::march(PairMarch(close.outline, hasty), close.readings);
  ASSERT_FALSE(result.complete());
  EXPECT_EQ(result.doubts.front().why, PairDoubt::Why::slow);
  const std::vector<StartPair> two = close.near(march_pairs::march(PairMarch(close.outline), close.readings));
  ASSERT_EQ(two.size(), 2U);
  for (const StartPair& pair : two) {
    const Point at{pair.s, pair.t};
    EXPECT_TRUE(march_pairs::lists(result, at, close.oracle.perimeter()) ||
                march_pairs::doubts(result, at, close.oracle.perimeter()));
  }
}

TEST(MarchPairsHoles, a_reset_beyond_the_gap_jumps_over_the_next_pair) {
  const ClosePairs close(kSide * 1e-6);
  PairMarchOptions options;
  options.reset = 2e-2;
  const PairResult result = march_pairs::march(PairMarch(close.outline, options), close.readings);
  EXPECT_EQ(close.near(result).size(), 1U);  // of two
  EXPECT_TRUE(std::any_of(result.doubts.begin(), result.doubts.end(),
                          [](const PairDoubt& doubt) { return doubt.why == PairDoubt::Why::jumped; }));
}

TEST(MarchPairsHoles, slow_how_many_random_readings_end_in_a_doubt) {
  fmt::print(
      "  shape      readings   with a doubt   planted pairs in doubt   mean pairs   mean rounds   most rounds\n");
  auto generator = test_generator(95);
  for (const Outline& outline : {ellipse(2, 1), egg(), amoeba(), random_spline(generator, 10)}) {
    const Exhaustive oracle(outline);
    const PairMarch march(outline);
    constexpr int kReadings = 300;
    int doubtful = 0, in_doubt = 0;
    std::size_t pairs = 0, rounds = 0, most = 0;
    for (int i = 0; i < kReadings; ++i) {
      const Planted planted(oracle, generator);
      const PairResult result = march_pairs::march(march, planted.readings);
      const bool listed = march_pairs::lists(result, planted.at, oracle.perimeter());
      EXPECT_TRUE(listed || march_pairs::doubts(result, planted.at, oracle.perimeter()));
      doubtful += result.complete() ? 0 : 1;
      in_doubt += listed ? 0 : 1;
      pairs += result.pairs.size();
      rounds += result.iterations;
      most = std::max(most, result.iterations);
    }
    fmt::print("  {:9}  {}        {:3}            {:3}                      {:5.1f}        {:6}        {:6}\n",
               outline.name, kReadings, doubtful, in_doubt, static_cast<double>(pairs) / kReadings, rounds / kReadings,
               most);
    EXPECT_LT(doubtful, kReadings / 20);
  }
}

}  // namespace
}  // namespace march_pairs_holes_test
