// From a part and a roll on it to the answer, by one function for one finger and two.
#include "rollfix/solve.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "refusal.hpp"
#include "rollfix/curve.hpp"
#include "rollfix/error.hpp"
#include "rollfix/locate.hpp"
#include "rollfix/log.hpp"
#include "rollfix/outline.hpp"

namespace solve_test {
namespace {

using rollfix::Answer;
using rollfix::gallery;
using rollfix::locate;
using rollfix::Noise;
using rollfix::Part;
using rollfix::Reading;
using rollfix::solve;
using rollfix::Tolerance;
using rollfix::Verdict;

const Part& cam() {
  static const Part part(gallery("cam"));
  return part;
}

Reading roll_of_one(double s, double length) {
  return {length, cam().turning().angle(s + length) - cam().turning().angle(s)};
}

Reading roll_of_two(double s, double t, double a, double b) {
  return {a, b, roll_of_one(s, a).turn - roll_of_one(t, b).turn};
}

TEST(Solve, answers_exact_readings_as_the_search_does_for_one_finger_and_two) {
  for (const std::vector<Reading>& readings :
       {std::vector<Reading>{roll_of_one(1, 0.7)}, {roll_of_two(1, 4, 0.7, -0.4), roll_of_two(1, 4, 1.5, -0.8)}}) {
    const Answer answer = solve({cam(), readings});
    EXPECT_EQ(answer.tolerance.source, Tolerance::Source::smallest);
    EXPECT_EQ(answer.placements.size(), locate(cam(), readings).placements.size());
    EXPECT_EQ(answer.finger_count(), readings.front().fingers());
  }
}

TEST(Solve, takes_the_tolerance_from_rounded_digits) {
  rollfix::Measurement measured(roll_of_one(1, 0.7));
  measured.roundings = {{0.005, 0}};
  const Answer answer = solve({cam(), measured});
  EXPECT_EQ(answer.tolerance.source, Tolerance::Source::digits);
  EXPECT_GT(answer.tolerance.value, 0.001);
}

TEST(Solve, takes_the_sharpest_curvature_for_the_rounding_also_where_the_outline_starts) {
  // A unit square whose one rounding, of four arcs, is cut by s = 0: a length that is off by less than it is long, and
  // by more than either half, turns by that length over the radius.
  const double r = 0.1;
  const double piece = std::numbers::pi / 8;
  rollfix::Outline outline{"drop", {}, true};
  const auto arc = [&](int k) { outline.curves.emplace_back(rollfix::Arc({r, r}, r, (8 + k) * piece, piece)); };
  arc(2);
  arc(3);
  outline.curves.emplace_back(rollfix::Line({r, 0}, {1, 0}));
  outline.curves.emplace_back(rollfix::Line({1, 0}, {1, 1}));
  outline.curves.emplace_back(rollfix::Line({1, 1}, {0, 1}));
  outline.curves.emplace_back(rollfix::Line({0, 1}, {0, r}));
  arc(0);
  arc(1);
  rollfix::Measurement measured(Reading(0.5, 0));
  measured.roundings = {{3 * piece * r, 0}};
  EXPECT_NEAR(solve({Part(outline), measured}).tolerance.value, 3 * piece, 1e-9);
}

TEST(Solve, allows_for_a_measured_part_whose_tangents_are_off_at_both_ends_of_each_roll) {
  rollfix::Outline outline = gallery("cam");
  outline.accuracy.turn = 0.001;
  const double sd = std::sqrt(2.0) * 0.001;  // 4.5 of them are let pass
  EXPECT_NEAR(solve({Part(outline), roll_of_one(1, 0.7)}).tolerance.value, 4.5 * sd, 1e-8);
  EXPECT_NEAR(solve({Part(outline), {roll_of_two(1, 4, 0.7, -0.4), roll_of_two(1, 4, 1.5, -0.8)}}).tolerance.value,
              4.5 * std::sqrt(2.0) * sd, 1e-8);
}

TEST(Solve, gives_each_placement_its_own_probability_mean_and_interval_with_noise) {
  const Answer answer = solve({cam(), roll_of_one(1, 2), {}, Noise{0.01, 0.01, 0, 0}});
  ASSERT_TRUE(answer.weighing.has_value());
  double total = 0;
  for (const rollfix::Placement& placement : answer.placements) {
    total += placement.probability;
    EXPECT_GT(placement.sd[0], 0);
    EXPECT_TRUE(cam().boundary().contains(placement.interval[0], placement.mean[0]));
  }
  EXPECT_NEAR(total, 1, 0.05);
}

TEST(Solve, has_no_probability_without_noise) {
  EXPECT_TRUE(std::isnan(solve({cam(), roll_of_one(1, 0.7)}).placements.front().probability));
}

TEST(Solve, names_the_field_that_does_not_go_with_the_others) {
  rollfix::Problem problem{cam(), roll_of_one(1, 0.7)};
  problem.prior = rollfix::Prior{1, 0.1};
  EXPECT_THAT(refusal_of([&] { solve(problem); }), testing::HasSubstr("`prior`"));
  problem.prior.reset();
  problem.facing = 1;
  EXPECT_THAT(refusal_of([&] { solve(problem); }), testing::HasSubstr("`facing`"));
}

TEST(Locate, takes_two_readings_of_one_finger_in_braces) {
  EXPECT_FALSE(locate(cam(), {{0.7, roll_of_one(1, 0.7).turn}, {1.5, roll_of_one(1, 1.5).turn}}).placements.empty());
}

TEST(Locate, refuses_readings_of_one_finger_and_of_two_together) {
  const std::vector<Reading> mixed{roll_of_one(1, 0.7), roll_of_two(1, 4, 0.7, -0.4)};
  EXPECT_THAT(refusal_of([&] { locate(cam(), mixed); }), testing::HasSubstr("found both"));
}

/// Finger a starts at the corner s = 0 of a cam-like part with one corner, finger b on a smooth place.
TEST(Sensitivity, of_a_free_finger_beside_one_at_a_corner_is_confirmed_by_finite_differences) {
  const Part part(gallery("naca,digits=2412,chord=1"));  // one corner, at s = 0
  const rollfix::TurningFunction& turning = part.turning();
  const double after = turning.angle(0);
  const double before = turning.angle(part.perimeter(), rollfix::Side::before) - turning.period_turn();
  const double start_tangent = after - 0.3 * (after - before);
  const double t = 0.6;
  const auto reading = [&](double a, double b) {
    return Reading(a, b,
                   (part.turning().angle(a) - start_tangent) - (part.turning().angle(t + b) - part.turning().angle(t)));
  };
  std::vector<Reading> readings{reading(0.1, 0.15), reading(0.25, 0.33)};
  const auto found = [&](const std::vector<Reading>& given) -> const rollfix::Placement* {
    static rollfix::Search search;
    search = locate(part, given);
    for (const rollfix::Placement& placement : search.placements) {
      const bool at_corner = placement.kind == rollfix::Kind::corner && placement.start[0] < 1e-9;
      if (at_corner && std::abs(placement.start[1] - t) < 1e-3) return &placement;
    }
    return nullptr;
  };
  const rollfix::Placement* placement = found(readings);
  ASSERT_NE(placement, nullptr);
  ASSERT_EQ(placement->sensitivity.per_turn.size(), 2U);
  const double there = placement->start[1];
  const rollfix::Sensitivity sensitivity = placement->sensitivity;
  EXPECT_EQ(sensitivity.per_turn[0][0], 0);
  constexpr double kStep = 1e-6;
  for (std::size_t k = 0; k < readings.size(); ++k) {
    std::vector<Reading> moved = readings;
    moved[k].turn += kStep;
    ASSERT_NE(placement = found(moved), nullptr);
    EXPECT_NEAR((placement->start[1] - there) / kStep, sensitivity.per_turn[1][k],
                1e-3 + 1e-3 * std::abs(sensitivity.per_turn[1][k]));
    for (const std::size_t finger : {0U, 1U}) {
      moved = readings;
      moved[k].length[finger] += kStep;
      ASSERT_NE(placement = found(moved), nullptr);
      const double expected = sensitivity.per_length[1][k][finger];
      EXPECT_NEAR((placement->start[1] - there) / kStep, expected, 1e-3 + 1e-3 * std::abs(expected)) << k << finger;
    }
  }
}

}  // namespace
}  // namespace solve_test
