// Two fingers of which one pivots at corners: its rows tell where the corner is, however many there are, and what slip
// may have been does not lead them astray.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "belief/tilted_boundary.hpp"
#include "random.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/rolling.hpp"
#include "rollfix/solve.hpp"

namespace rollfix::pivoting_pair_test {
namespace {

Part polygon(const std::vector<Vec2>& corners) {
  Outline outline{"polygon", {}, true};
  for (std::size_t k = 0; k < corners.size(); ++k) {
    outline.curves.push_back(Line(corners[k], corners[(k + 1) % corners.size()]));
  }
  return Part(outline);
}

Part sharp_triangle() { return polygon({{1.049, 0.387}, {-0.952, 0.578}, {-0.92, -0.579}}); }

FreePlan plan_of(const std::array<double, 2>& radius, const std::array<double, 2>& start,
                 const std::array<double, 2>& distance, std::size_t rows) {
  FreePlan plan;
  plan.rows = rows;
  for (const std::size_t finger : {0U, 1U}) {
    plan.fingers[finger].finger = disk(radius[finger]);
    plan.fingers[finger].start = start[finger];
    plan.fingers[finger].distance = distance[finger];
  }
  return plan;
}

bool lists(const Part& part, const Answer& answer, const Roll& truth) {
  return std::ranges::any_of(answer.placements, [&](const Placement& place) {
    return part.boundary().contains(place.interval[0], truth.s[0][0]) &&
           part.boundary().contains(place.interval[1], truth.s[1][0]);
  });
}

TEST(PivotingPair, a_thousand_rows_of_one_finger_at_rest_and_one_that_pivots_list_the_truth) {
  const Part part = polygon({{0, 0}, {3, 0}, {3, 1.7}, {0, 1.7}});
  const Noise noise{.contact = 0.0126, .angle = 0.007};
  const FreePlan plan = plan_of({0.177, 0.121}, {8.925, 4.7}, {-0.29, -4.23}, 1000);
  int listed = 0;
  const int count = test_count(5);
  for (int k = 0; k < count; ++k) {
    const NoisyRoll roll = noisy_roll_free(part, plan, noise, test_generator(static_cast<std::uint64_t>(k) + 1)());
    Problem problem{part, roll.log, {disk(0.177), disk(0.121)}, noise};
    problem.diagnose = false;
    listed += lists(part, solve(problem), roll.truth) ? 1 : 0;
  }
  std::printf("of %d logs %d list the truth\n", count, listed);
  EXPECT_GE(listed, 0.8 * count);
}

TEST(PivotingPair, slip_that_did_not_happen_leaves_an_exact_log_of_a_triangle_where_it_is) {
  const Part part = sharp_triangle();
  const NoisyRoll roll =
      noisy_roll_free(part, plan_of({0.159, 0.106}, {3.0744, 1.0247}, {-1.475, 3.245}, 1000), Noise{}, 1);
  for (const double said : {0.001, 0.02, 0.05}) {
    const Answer answer =
        solve({part, roll.log, {disk(0.159), disk(0.106)}, Noise{.contact = 0.0063, .angle = 0.006, .slip = said}});
    ASSERT_FALSE(answer.placements.empty()) << said;
    EXPECT_NEAR(answer.placements.front().start[0], 3.0744, 1e-2) << said;
    EXPECT_TRUE(lists(part, answer, roll.truth)) << said;
  }
}

TEST(TiltedArc, the_w_of_a_place_is_where_that_place_is) {
  for (const Part& part :
       {sharp_triangle(), Part(gallery("limacon")), Part(gallery("rounded-rectangle,width=6,height=2,r=0.3"))}) {
    const belief::TiltedBoundary boundary(part, 5, 1e-9);
    const belief::TiltedArc& arc = boundary.arcs().front();
    const double from = arc.at(arc.lo()).s;
    for (const double share : {0.0, 0.1, 0.37, 0.5, 0.93, 1.0}) {
      const double s = from + share * (arc.at(arc.hi() - 1e-9).s - from);
      EXPECT_NEAR(arc.at(arc.w_at(s)).s, s, 1e-6 * part.perimeter()) << part.name() << " at " << share;
    }
  }
}

}  // namespace
}  // namespace rollfix::pivoting_pair_test
