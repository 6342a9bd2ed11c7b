// Two noisy fingers on opposite sides: a continuum of pairs explains the rows, and corners at its ends must not be
// surer.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "random.hpp"
#include "rollfix/rolling.hpp"
#include "rollfix/solve.hpp"

namespace parallel_sides_test {
namespace {

using rollfix::Answer;
using rollfix::Noise;
using rollfix::Part;
using rollfix::Placement;
using rollfix::Problem;

using Generator = std::mt19937_64;

constexpr double kWidth = 60;
constexpr double kHeight = 40;

double uniform(double lo, double hi, Generator& generator) {
  return std::uniform_real_distribution<double>(lo, hi)(generator);
}

Part rectangle() {
  rollfix::Outline outline{"rectangle", {}, true};
  const std::vector<rollfix::Vec2> corners{{0, 0}, {kWidth, 0}, {kWidth, kHeight}, {0, kHeight}};
  for (std::size_t k = 0; k < 4; ++k) outline.curves.push_back(rollfix::Line(corners[k], corners[(k + 1) % 4]));
  return Part(outline);
}

struct Drawn {
  Problem problem;
  rollfix::PerFinger<double> start;
};

/// Finger a rolls on the lower side and finger b on the upper one, neither up to a corner.
Drawn drawn(std::size_t rows, const Noise& noise, std::uint64_t seed) {
  Generator generator = test_generator(seed);
  rollfix::FreePlan plan;
  plan.rows = rows;
  plan.part_rotation = 0.4;
  for (rollfix::FreeFinger& finger : plan.fingers) finger.finger = rollfix::disk(3);
  plan.fingers[0].start = uniform(20, 40, generator);
  plan.fingers[0].distance = uniform(-15, 15, generator);
  plan.fingers[1].start = kWidth + kHeight + uniform(10, 50, generator);
  plan.fingers[1].distance = uniform(-8, 8, generator);
  const rollfix::NoisyRoll roll = rollfix::noisy_roll_free(rectangle(), plan, noise, generator());
  Problem problem{rectangle(), roll.log, {rollfix::disk(3)}, noise};
  problem.may_overlap = true;
  problem.diagnose = false;
  return {problem, {roll.truth.s[0][0], roll.truth.s[1][0]}};
}

constexpr double kNear = 6;  // of a 95 % interval, some 5 standard deviations of what is known across the continuum

/// Probability of what is listed about these first contacts.
double probability_at(const Answer& answer, const rollfix::Boundary& places, const rollfix::PerFinger<double>& start) {
  double sum = 0;
  for (const Placement& placement : answer.placements) {
    bool holds = true;
    for (const std::size_t finger : {0U, 1U})
      holds = holds && places.contains(placement.interval[finger], start[finger], kNear);
    if (holds) sum += placement.probability;
  }
  return sum;
}

// A rectangle is the same after half a turn.
constexpr double kHalf = 0.5;
constexpr double kAlike = 0.1;

/// That both halves of the rectangle explain the log alike.
testing::AssertionResult is_of_both_halves(const Drawn& drawn) {
  const Answer answer = rollfix::solve(drawn.problem);
  const rollfix::Boundary places = drawn.problem.part.boundary();
  rollfix::PerFinger<double> other = drawn.start;
  for (const std::size_t finger : {0U, 1U}) {
    other[finger] = places.on_first_lap(other[finger] + kHalf * places.perimeter);
  }
  const double here = probability_at(answer, places, drawn.start);
  const double there = probability_at(answer, places, other);
  if (std::abs(here - there) < kAlike && here > kHalf - kAlike) return testing::AssertionSuccess();
  return testing::AssertionFailure() << answer.verdict.text() << ", at the start " << here << ", opposite " << there;
}

}  // namespace

TEST(SlowParallelSides, of_a_rectangle_with_centres_are_alike_however_many_rows) {
  for (const std::size_t rows : {100U, 300U, 1000U}) {
    const Noise noise{.contact = 0.02, .angle = 0.005, .position = 0.05};
    EXPECT_TRUE(is_of_both_halves(drawn(rows, noise, rows))) << rows << " rows";
  }
}

}  // namespace parallel_sides_test
