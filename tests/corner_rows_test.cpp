// What noisy rows say in which a finger is on a corner of its own: their turns are known to intervals.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "corner_fingers.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/solve.hpp"

namespace corner_rows_test {
namespace {

using corner_fingers::Polygon;
using rollfix::Answer;
using rollfix::Log;
using rollfix::Noise;
using rollfix::Part;

constexpr double kCorner = 3.6;  // where on the cam the finger's corner touches
constexpr double kStart = 2.5;
constexpr double kHalf = 0.6;  // of a side of the square
constexpr Noise kNoise{.contact = 1e-3, .angle = 1e-3};

/// A square on a cam: two rows on its lower side, and then some on its corner, with the finger turned by this share of
/// the corner, and from there by more than it can have. By the outline's points alone.
Answer rolled_to_corner(double share, int rows_on_corner, double turned_back = 0) {
  const Part part(rollfix::gallery("cam"));
  const Polygon square = corner_fingers::square(kHalf);
  Log log;
  rollfix::FingerRows& rows = log.fingers[0];
  const auto add = [&](double s, double normal) {
    rows.u.push_back(kCorner - kHalf - s);
    rows.psi.push_back(corner_fingers::tangent_of(part, s) + std::numbers::pi / 2 - normal);
  };
  const double lower = square.normal(0);
  add(kStart, lower);
  add(kStart + 0.4, lower);
  for (int k = 0; k < rows_on_corner; ++k) add(kCorner, lower - share * std::numbers::pi / 2 + turned_back);
  rows.psi_wrapped = true;
  rows.u_period = square.around();
  return solve(rollfix::Problem{part, log, {square.finger()}, kNoise});
}

bool lists_truth(const Answer& answer) {
  return std::any_of(answer.placements.begin(), answer.placements.end(), [&](const rollfix::Placement& one) {
    return answer.part.distance(one.mean[0], kStart) < 5 * one.sd[0];
  });
}

}  // namespace

TEST(CornerRows, exclude_places_from_which_no_turn_of_theirs_can_have_come) {
  EXPECT_EQ(rolled_to_corner(1, 0).verdict.text(), "ambiguous (4)");
  EXPECT_EQ(rolled_to_corner(1, 1).verdict.text(), "unique");
  EXPECT_TRUE(lists_truth(rolled_to_corner(1, 1)));
}

TEST(CornerRows, say_nothing_of_places_that_some_turn_of_theirs_allows) {
  EXPECT_EQ(rolled_to_corner(0, 1).placements.size(), 4U);
  EXPECT_EQ(rolled_to_corner(0, 1).placements.front().probability,
            rolled_to_corner(0, 0).placements.front().probability);
}

TEST(CornerRows, leave_the_truth_wherever_in_its_pivot_the_finger_is) {
  for (const double share : {0.0, 0.1, 0.5, 0.9, 1.0}) EXPECT_TRUE(lists_truth(rolled_to_corner(share, 4))) << share;
}

TEST(CornerRows, contradict_the_noise_where_they_allow_no_place) {
  EXPECT_FALSE(rolled_to_corner(0, 2).verdict.fits_badly);
  EXPECT_TRUE(rolled_to_corner(0, 2, 2).verdict.fits_badly);
}

}  // namespace corner_rows_test
