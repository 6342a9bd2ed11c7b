// Two noisy fingers on parts with corners, whose likelihood has many peaks and plateaus: the true place is not lost
// among them.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
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

/// Is a pair in one of the placements, by what each is known to?
bool covers(const Answer& answer, double s, double t) {
  const rollfix::Boundary boundary = answer.part.boundary();
  const auto is_near = [&](const Placement& each, std::size_t finger, double at) {
    return boundary.distance(each.mean[finger], at) < 8 * each.sd[finger] + 1e-5 * boundary.perimeter ||
           boundary.contains(each.interval[finger], at);
  };
  return std::any_of(answer.placements.begin(), answer.placements.end(),
                     [&](const Placement& each) { return is_near(each, 0, s) && is_near(each, 1, t); });
}

/// Its corners are on a circle.
Part irregular_polygon(std::mt19937_64& generator) {
  std::uniform_real_distribution<double> part_of_step(-0.3, 0.3);
  std::vector<rollfix::Vec2> corners;
  const int count = std::uniform_int_distribution<int>(3, 10)(generator);
  for (int k = 0; k < count; ++k) {
    corners.push_back(free_rolls::direction(2 * shapes::kPi * (k + part_of_step(generator)) / count));
  }
  return Part(shapes::polygon(corners));
}

}  // namespace

TEST(PairPeaks, of_equal_sides_leave_the_true_place_among_those_alike) {
  const FreePlan sharp = free_rolls::by_distances(0.05, 0.3, 1.0, 0.05, 3.4, 0.8);
  // Finger b's place is known to a third of a side: there the likelihood is flat.
  const FreePlan flat = free_rolls::by_distances(0.176, 0.457, 0.72, 0.177, 2.326, 0.096);
  int decided = 0;
  int tried = 0;
  for (const int sides : {6, 12, 24}) {
    const Part part = rollfix::load_part("gallery:polygon,n=" + std::to_string(sides));
    for (const FreePlan& plan : {sharp, flat}) {
      for (int k = 1; k <= test_count(3); ++k, ++tried) {
        const Answer answer = answer_on(part, plan, {5e-4, 1e-3}, static_cast<std::uint64_t>(k));
        if (answer.verdict.name == Verdict::undecided) continue;
        ++decided;
        EXPECT_TRUE(covers(answer, plan.fingers[0].start, plan.fingers[1].start))
            << sides << " sides, seed " << k << ": " << answer.verdict.text();
        const double side = part.perimeter() / sides;
        for (const Placement& each : answer.placements) {
          if (each.probability < rollfix::kLeastProbability) continue;
          EXPECT_TRUE(covers(answer, each.mean[0] + side, each.mean[1] + side)) << sides << " sides, seed " << k;
        }
      }
    }
  }
  EXPECT_GT(decided, tried / 2);
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
    EXPECT_TRUE(covers(answer, 0.34191 * P, 0.27883 * P)) << "seed " << k << ": " << answer.verdict.text();
  }
  EXPECT_GT(decided, test_count(30) / 2);
}

TEST(PairPeaks, are_found_however_precise_the_fingers_are) {
  std::mt19937_64 generator = test_generator();
  int decided = 0;
  int tried = 0;
  for (const double contact : {1e-4, 1e-5}) {
    for (int k = 1; k <= test_count(12); ++k, ++tried) {
      const Part part = irregular_polygon(generator);
      const double P = part.perimeter();
      std::uniform_real_distribution<double> place(0, P);
      std::uniform_real_distribution<double> length(-0.3 * P, 0.3 * P);
      const double s = place(generator);
      const double t = place(generator);
      const FreePlan plan =
          free_rolls::by_distances(0.02 * P, s, length(generator), 0.015 * P, t, length(generator), 0.5);
      const Answer answer = answer_on(part, plan, {contact * P, 1e-3}, static_cast<std::uint64_t>(k));
      if (answer.verdict.name == Verdict::undecided) continue;
      ++decided;
      EXPECT_TRUE(covers(answer, s, t)) << contact << ", " << k << ": " << answer.verdict.text();
    }
  }
  EXPECT_GT(decided, 2 * tried / 3);
}

}  // namespace pair_peaks_test
