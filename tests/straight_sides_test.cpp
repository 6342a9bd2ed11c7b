// Exact logs of parts with straight sides: many starts fit the first readings, and the rest of the log says which.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "disk_rolls.hpp"
#include "random.hpp"
#include "random_outlines.hpp"
#include "rollfix/error.hpp"
#include "rollfix/solve.hpp"
#include "shapes.hpp"

namespace straight_sides_test {
namespace {

using rollfix::Answer;
using rollfix::Part;
using rollfix::Placement;
using rollfix::Problem;

/// The places at which an exact log may start that was rolled from `start`; nothing: a finger can't roll so.
std::optional<Answer> answer_of(const Part& part, double start, double distance, std::size_t rows) {
  const rollfix::Finger finger = rollfix::disk(0.02 * part.perimeter());
  if (!reach_of(part, finger).arc_at(start)) return std::nullopt;
  try {
    const rollfix::Roll rolled = rollfix::roll(part, finger, rollfix::disk_rolls::by_distance(start, distance, rows));
    Problem problem{part, {rolled.log}, {finger}};
    return solve(problem);
  } catch (const rollfix::InputError&) {
    return std::nullopt;
  }
}

bool holds(const Part& part, const Placement& placement, double start) {
  return part.boundary().distance(placement.extent[0], start) <= 1e-6 * part.perimeter();
}

/// False: a finger can't roll so.
bool expect_true_start(const Part& part, double start, double distance, std::size_t rows, const std::string& what) {
  const std::optional<Answer> answer = answer_of(part, start, distance, rows);
  if (!answer) return false;
  EXPECT_FALSE(answer->verdict.fits_badly) << what << ": " << answer->verdict.text();
  EXPECT_TRUE(std::any_of(answer->placements.begin(), answer->placements.end(),
                          [&](const Placement& each) { return !each.is_contradicted && holds(part, each, start); }))
      << what << ": " << answer->verdict.text();
  return true;
}

}  // namespace

TEST(StraightSides, are_contradicted_by_no_exact_log) {
  int rolled = 0;
  for (const std::string source : {"gallery:rounded-rectangle", "gallery:polygon,n=4", "gallery:polygon,n=6",
                                   "gallery:polygon,n=24", "gallery:stadium", "gallery:circle"}) {
    const Part part = rollfix::load_part(source);
    const double P = part.perimeter();
    for (const double start : {0.03 * P, 0.21 * P, 0.37 * P, 0.77 * P}) {
      for (const double distance : {0.04 * P, 0.26 * P, -0.3 * P, 0.6 * P}) {
        const std::string what = source + " from " + std::to_string(start) + " by " + std::to_string(distance);
        rolled += expect_true_start(part, start, distance, 60, what) ? 1 : 0;
      }
    }
  }
  EXPECT_EQ(rolled, 6 * 16);
}

TEST(StraightSides, of_random_outlines_are_contradicted_by_no_exact_log) {
  auto generator = test_generator();
  int rolled = 0;
  for (int k = 0; k < test_count(100); ++k) {
    const std::optional<Part> part = random_outlines::outline(generator);
    if (!part) continue;
    const double P = part->perimeter();
    const double start = random_outlines::uniform(generator, 0, P);
    const double distance = random_outlines::uniform(generator, -0.6, 0.6) * P;
    const auto rows = static_cast<std::size_t>(std::pow(10, random_outlines::uniform(generator, 1.3, 3)));
    const std::string what = "seed " + std::to_string(test_seed()) + ", case " + std::to_string(k);
    rolled += expect_true_start(*part, start, distance, rows, what) ? 1 : 0;
  }
  EXPECT_GT(rolled, test_count(100) / 4);
}

TEST(StraightSides, leave_the_start_that_the_whole_log_tells) {
  const Part part = rollfix::load_part("gallery:rounded-rectangle");
  const std::optional<Answer> answer = answer_of(part, 0.3, 2.6, 200);
  ASSERT_TRUE(answer);
  ASSERT_EQ(answer->verdict.places, 2U);  // the part looks the same after half a turn
  EXPECT_TRUE(std::any_of(answer->placements.begin(), answer->placements.end(),
                          [](const Placement& each) { return std::abs(each.start[0] - 0.3) < 1e-9; }));
}

}  // namespace straight_sides_test
