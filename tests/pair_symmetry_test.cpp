// Two noisy fingers on a part that looks the same from several places: what fits at one of them fits at all.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "free_roll.hpp"
#include "random.hpp"
#include "rollfix/part.hpp"
#include "rollfix/rolling.hpp"
#include "rollfix/solve.hpp"

namespace pair_symmetry_test {
namespace {

using rollfix::Answer;
using rollfix::Part;
using rollfix::Placement;

/// Of two disks that roll on a polygon of equal sides.
Answer answer_on(const Part& part, std::uint64_t seed) {
  rollfix::FreePlan plan = free_rolls::by_distances(0.05, 0.3, 1.0, 0.05, 3.4, 0.8);
  plan.rows = 60;
  const rollfix::Noise noise{5e-4, 1e-3};
  rollfix::Problem problem{part, {rollfix::noisy_roll_free(part, plan, noise, seed).log}, {rollfix::disk(0.05)}, noise};
  return solve(problem);
}

bool holds(const Answer& answer, double s, double t) {
  const rollfix::Boundary boundary = answer.part.boundary();
  return std::any_of(answer.placements.begin(), answer.placements.end(), [&](const Placement& each) {
    return boundary.distance(each.start[0], s) < 0.02 && boundary.distance(each.start[1], t) < 0.02;
  });
}

}  // namespace

TEST(PairSymmetry, of_equal_sides_leaves_the_true_place_among_those_alike) {
  int decided = 0;
  for (const int sides : {6, 12, 24}) {
    const Part part = rollfix::load_part("gallery:polygon,n=" + std::to_string(sides));
    for (int k = 1; k <= test_count(6); ++k) {
      const Answer answer = answer_on(part, static_cast<std::uint64_t>(k));
      if (answer.verdict.name == rollfix::Verdict::undecided) continue;
      ++decided;
      EXPECT_TRUE(holds(answer, 0.3, 3.4)) << sides << " sides, seed " << k << ": " << answer.verdict.text();
    }
  }
  EXPECT_GT(decided, 3 * test_count(6) / 2);
}

}  // namespace pair_symmetry_test
