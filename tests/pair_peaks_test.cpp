// Two noisy fingers on parts with corners, whose likelihood has many peaks and plateaus: the true place is not lost
// among them.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "free_roll.hpp"
#include "random.hpp"
#include "rollfix/part.hpp"
#include "rollfix/rolling.hpp"
#include "rollfix/solve.hpp"
#include "shapes.hpp"

namespace pair_peaks_test {
namespace {

using rollfix::Answer;
using rollfix::FreePlan;
using rollfix::Part;
using rollfix::Placement;
using rollfix::Verdict;

/// Of two disks that roll as planned.
Answer answer_on(const Part& part, FreePlan plan, const rollfix::Noise& noise, std::uint64_t seed) {
  plan.rows = 60;
  const rollfix::PerFinger<rollfix::Finger> disks{plan.fingers[0].finger, plan.fingers[1].finger};
  rollfix::Problem problem{part, {noisy_roll_free(part, plan, noise, seed).log}, {disks[0], disks[1]}, noise};
  problem.may_overlap = true;
  return solve(problem);
}

bool holds(const Answer& answer, double s, double t) {
  const rollfix::Boundary boundary = answer.part.boundary();
  return std::any_of(answer.placements.begin(), answer.placements.end(), [&](const Placement& each) {
    return boundary.distance(each.start[0], s) < 0.02 && boundary.distance(each.start[1], t) < 0.02;
  });
}

}  // namespace

TEST(PairPeaks, of_equal_sides_leave_the_true_place_among_those_alike) {
  const FreePlan plan = free_rolls::by_distances(0.05, 0.3, 1.0, 0.05, 3.4, 0.8);
  int decided = 0;
  for (const int sides : {6, 12, 24}) {
    const Part part = rollfix::load_part("gallery:polygon,n=" + std::to_string(sides));
    for (int k = 1; k <= test_count(6); ++k) {
      const Answer answer = answer_on(part, plan, {5e-4, 1e-3}, static_cast<std::uint64_t>(k));
      if (answer.verdict.name == Verdict::undecided) continue;
      ++decided;
      EXPECT_TRUE(holds(answer, 0.3, 3.4)) << sides << " sides, seed " << k << ": " << answer.verdict.text();
    }
  }
  EXPECT_GT(decided, 3 * test_count(6) / 2);
}

TEST(PairPeaks, are_found_where_only_one_row_in_many_tells_when_a_finger_passed_a_corner) {
  const Part part(shapes::polygon({{0.794, -0.152},
                                   {0.587, 0.589},
                                   {0.063, 1.135},
                                   {-0.303, 0.777},
                                   {-0.699, 0.318},
                                   {-1.074, -0.509},
                                   {-0.515, -0.855},
                                   {0.222, -0.806},
                                   {0.709, -0.851}}));
  const double P = part.perimeter();
  int decided = 0;
  for (int k = 1; k <= test_count(30); ++k) {
    const FreePlan plan =
        free_rolls::by_distances(0.01435 * P, 0.34191 * P, 0.17626 * P, 0.01435 * P, 0.27883 * P, 0.22018 * P, 0.6572);
    const Answer answer = answer_on(part, plan, {1e-4 * P, 1e-3}, static_cast<std::uint64_t>(k));
    if (answer.verdict.name == Verdict::undecided) continue;
    ++decided;
    EXPECT_TRUE(holds(answer, 0.34191 * P, 0.27883 * P)) << "seed " << k << ": " << answer.verdict.text();
  }
  EXPECT_GT(decided, test_count(30) / 2);
}

}  // namespace pair_peaks_test
