// Two fingers that pivot at sharp corners: how far is one unknown for all rows of a pivot.
#include <gtest/gtest.h>

#include <random>
#include <utility>

#include "noisy_pairs.hpp"
#include "random.hpp"

namespace pair_pivots_test {
namespace {

using namespace noisy_pairs;
using free_rolls::part_of;

struct Count {
  int logs = 0;
  int listed = 0;
  int misfits = 0;
};

/// Rolls over two corners and more.
Count count_of(std::size_t rows, const Noise& noise, int logs, bool robust = false) {
  const Part part = part_of("polygon,n=5");
  std::mt19937_64 generator = test_generator(4);
  std::uniform_real_distribution<double> start(0, part.perimeter());
  BeliefOptions options;
  options.noise = noise;
  options.robust = robust;
  Count count;
  for (; count.logs < logs; ++count.logs) {
    const double a = start(generator);
    const double b = part.boundary().on_first_lap(a + 0.45 * part.perimeter());
    const Case drawn = noisy_case(part, {a, b}, 3, 2.6, rows, 0.1, 0.1, noise, generator);
    Belief belief = belief_of(part, drawn, options);
    count.listed += modes_at(part, belief.modes(), drawn.start).empty() ? 0 : 1;
    count.misfits += belief.fit().is_bad() ? 1 : 0;
  }
  return count;
}

}  // namespace

TEST(PairPivots, contradict_no_row_however_many_there_are) {
  for (const auto& [rows, logs] : {std::pair<std::size_t, int>{200, 12}, {2000, 6}, {20000, 3}}) {
    const Count count = count_of(rows, {0.003, 0.005, 0, 0}, test_count(logs));
    EXPECT_EQ(count.misfits, 0) << rows << " rows";
    EXPECT_EQ(count.listed, count.logs) << rows << " rows";
  }
}

TEST(PairPivots, of_a_finger_that_slips_may_begin_where_it_has_slipped_to) {
  const Count count = count_of(300, {0.003, 0.005, 0.003, 0}, test_count(12));
  EXPECT_EQ(count.misfits, 0);
  EXPECT_EQ(count.listed, count.logs);
}

TEST(PairPivots, contradict_no_row_where_some_may_be_stray) {
  const Count count = count_of(300, {0.003, 0.005, 0, 0}, test_count(8), true);
  EXPECT_EQ(count.misfits, 0);
  EXPECT_EQ(count.listed, count.logs);
}

}  // namespace pair_pivots_test
