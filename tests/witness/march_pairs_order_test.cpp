// Which of s and t moves first, and what is lost when t always does, as the paper's figure has it. Several pairs in one
// pair of intervals. The table is that of docs/march.md.

#include <map>

#include "march_pairs.hpp"
#include "march_shapes.hpp"
#include "random.hpp"

namespace march_pairs_order_test {
namespace {

using namespace rollfix::march;
using namespace march_shapes;
using march_pairs::Exhaustive;
using march_pairs::Planted;
using march_pairs::Readings;
using rollfix::Outline;

PairMarch as_printed(const Outline& outline) {
  PairMarchOptions options;
  options.order = MoveOrder::printed;
  return PairMarch(outline, options);
}

/// A question with three pairs in one pair of intervals.
const Readings kThree{{{8.7811392891699281, 8.868733191164143, -0.40694985676921913},
                       {1.7650357293844057, 3.5796330222445083, -0.9073508928839815}}};

/// The largest number of pairs in one pair of intervals.
int crowd(const PairResult& result) {
  std::map<std::pair<std::size_t, std::size_t>, int> pairs;
  int most = 0;
  for (const StartPair& pair : result.pairs) {
    const std::size_t i = march_pairs::interval_of(result.stationary_a, pair.s);
    const std::size_t j = march_pairs::interval_of(result.stationary_b, pair.t);
    most = std::max(most, ++pairs[{i, j}]);
  }
  return most;
}

TEST(MarchPairsOrder, three_pairs_in_one_pair_of_intervals_are_all_found) {
  const Exhaustive oracle(ellipse(2, 1));
  const PairResult result = march_pairs::march(PairMarch(ellipse(2, 1)), kThree);
  EXPECT_EQ(crowd(result), 3);
  EXPECT_TRUE(result.complete());
  EXPECT_EQ(result.pairs.size(), oracle.pairs(kThree).size());
  march_pairs::expect_agreement(oracle, result, kThree);
}

TEST(MarchPairsOrder, of_several_pairs_in_one_pair_of_intervals_the_printed_order_finds_one) {
  const PairResult printed = march_pairs::march(as_printed(ellipse(2, 1)), kThree);
  const PairResult all = march_pairs::march(PairMarch(ellipse(2, 1)), kThree);
  EXPECT_EQ(crowd(printed), 1);
  EXPECT_LT(printed.pairs.size(), all.pairs.size());
  EXPECT_TRUE(printed.complete());  // it does not know
}

TEST(MarchPairsOrder, the_printed_order_loses_pairs_in_silence) {
  fmt::print("  shape                      pairs   by bisection   by the iteration   of these as printed\n");
  auto generator = test_generator(71);
  for (const Outline& outline : {ellipse(2, 1), egg(), amoeba(), random_spline(generator, 10)}) {
    const Exhaustive oracle(outline);
    const PairMarch march(outline);
    const PairMarch printed_march = as_printed(outline);
    std::size_t all = 0, bisection = 0, printed_too = 0;
    for (int i = 0; i < full_count(20); ++i) {
      const Planted planted(oracle, generator);
      const PairResult result = march_pairs::march(march, planted.readings);
      const PairResult printed = march_pairs::march(printed_march, planted.readings);
      EXPECT_TRUE(march_pairs::lists(result, planted.at, oracle.perimeter()) || !result.complete());
      all += result.pairs.size();
      for (const StartPair& pair : result.pairs) {
        const bool listed = march_pairs::lists(printed, {pair.s, pair.t}, oracle.perimeter());
        if (pair.found == PairFound::bisection) {
          ++bisection;
          EXPECT_TRUE(listed);
        } else {
          printed_too += listed ? 1 : 0;
        }
      }
    }
    fmt::print("  {:25}  {:5}   {:5}          {:5}              {:5}\n", outline.name, all, bisection, all - bisection,
               printed_too);
    const double share = static_cast<double>(printed_too) / static_cast<double>(all - bisection);
    EXPECT_LT(share, 0.7);
    EXPECT_GT(share, 0.15);
  }
}

TEST(MarchPairsOrder, exchanging_the_fingers_exchanges_s_and_t) {
  // The printed order would find other pairs then: those at which the other finger has to go first.
  auto generator = test_generator(72);
  const Exhaustive oracle(amoeba());
  const PairMarch march(amoeba());
  for (int i = 0; i < test_count(3); ++i) {
    const Readings readings = Planted(oracle, generator).readings;
    Readings exchanged;
    for (std::size_t k = 0; k < 2; ++k) {
      exchanged[k] = {readings[k].length[1], readings[k].length[0], -readings[k].turn};
    }
    const PairResult one = march_pairs::march(march, readings);
    const PairResult other = march_pairs::march(march, exchanged);
    EXPECT_EQ(one.pairs.size(), other.pairs.size());
    for (const StartPair& pair : one.pairs) {
      EXPECT_TRUE(march_pairs::lists(other, {pair.t, pair.s}, oracle.perimeter()));
    }
  }
}

}  // namespace
}  // namespace march_pairs_order_test
