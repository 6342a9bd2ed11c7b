// Outlines of lines and arcs whose coordinates were rounded: their joints turn by a little, either way.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "integrated_rolls.hpp"
#include "random.hpp"
#include "rollfix/error.hpp"
#include "rollfix/locate.hpp"
#include "rollfix/part.hpp"
#include "rollfix/rolling.hpp"
#include "shapes.hpp"

namespace joints_test {
namespace {

using namespace rollfix;
using integrated_rolls::integrated_roll;
using shapes::kPi;

double rounded(double value) { return std::round(value * 1e4) / 1e4; }

/// An arc from one point to another with this sweep: what a drawing with bulges says.
Curve bulge(const Vec2& from, const Vec2& to, double sweep) {
  const Vec2 chord = to - from;
  const double radius = 0.5 * chord.norm() / std::sin(0.5 * std::abs(sweep));
  const Vec2 left(-chord.y(), chord.x());
  const Vec2 centre = 0.5 * (from + to) + left * (0.5 / std::tan(0.5 * sweep));
  const Vec2 out = from - centre;
  return Arc(centre, radius, std::atan2(out.y(), out.x()), sweep);
}

/// A bean: a stadium of rounded ends with a shallow concave arc in its lower side. Tangent everywhere, unless its
/// points are rounded.
Part bean(bool is_rounded) {
  const double depth = 0.3;  // half the concave arc's sweep
  const double concave = 2.0;
  const double fillet = 0.8;
  // From the left: fillet, concave arc, fillet along the lower side, then the right end, the top, the left end.
  std::vector<Vec2> points;
  std::vector<double> sweeps;
  const double half_waist = (concave + fillet) * std::sin(depth);
  points.emplace_back(-half_waist - 1, 0);
  sweeps.push_back(0);
  points.emplace_back(-half_waist, 0);
  sweeps.push_back(depth);
  points.emplace_back(-concave * std::sin(depth), fillet * (1 - std::cos(depth)));
  sweeps.push_back(-2 * depth);
  points.emplace_back(concave * std::sin(depth), fillet * (1 - std::cos(depth)));
  sweeps.push_back(depth);
  points.emplace_back(half_waist, 0);
  sweeps.push_back(0);
  points.emplace_back(half_waist + 1, 0);
  sweeps.push_back(kPi);
  points.emplace_back(half_waist + 1, 2.2);
  sweeps.push_back(0);
  points.emplace_back(-half_waist - 1, 2.2);
  sweeps.push_back(kPi);
  if (is_rounded) {
    for (Vec2& point : points) point = {rounded(point.x() + 0.00003), rounded(point.y() + 0.00004)};
  }
  Outline outline{is_rounded ? "rounded bean" : "bean", {}, true};
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Vec2& from = points[k];
    const Vec2& to = points[(k + 1) % points.size()];
    outline.curves.push_back(sweeps[k] == 0 ? Curve(Line(from, to)) : bulge(from, to, sweeps[k]));
  }
  return Part(outline);
}

double largest_joint(const Part& part, int sign) {
  double most = 0;
  for (const Corner& corner : part.corners()) most = std::max(most, sign * corner.turn);
  return most;
}

TEST(Joint, of_a_rounded_drawing_turns_by_a_little_both_ways) {
  EXPECT_TRUE(bean(false).corners().empty());
  const Part drawing = bean(true);
  EXPECT_GT(largest_joint(drawing, 1), 1e-6);
  EXPECT_GT(largest_joint(drawing, -1), 1e-6);
  EXPECT_LT(largest_joint(drawing, 1), kJointTurn);
  EXPECT_LT(largest_joint(drawing, -1), kJointTurn);
}

TEST(Joint, loses_no_placement_whatever_the_reading) {
  const Part exact = bean(false);
  const Part drawing = bean(true);
  // Points moved by 1e-4 move tangents by that over the shortest curve's length, twice.
  constexpr double kTurnChange = 4e-4;
  std::mt19937_64 generator = test_generator(81);
  std::uniform_real_distribution<double> unit(0, 1);
  int found = 0;
  for (int round = 0; round < test_count(300); ++round) {
    const double s = exact.perimeter() * unit(generator);
    const double length = exact.perimeter() * (unit(generator) - 0.5);
    const Reading reading = shapes::reading_from(exact, s, length);
    LocateOptions options;
    options.tolerance = kTurnChange;
    EXPECT_TRUE(
        shapes::holds(drawing, locate(drawing, reading, options), s * drawing.perimeter() / exact.perimeter(), 5e-3))
        << "seed " << test_seed() << " round " << round << " s " << s << " L " << length;
    ++found;
  }
  EXPECT_GT(found, 0);
}

TEST(Joint, that_a_turn_falls_into_is_a_placement) {
  const Part drawing = bean(true);
  int concave = 0;
  for (const Corner& corner : drawing.corners()) {
    const double length = 0.05;
    const double before = drawing.turning().angle(corner.s, Side::before);
    const double after = drawing.turning().angle(corner.s);
    const double there = before + 0.4 * (after - before);
    // It ends in the middle of the jump, or starts there.
    const double from = drawing.turning().angle(corner.s - length);
    const Search ends = locate(drawing, {length, there - from});
    EXPECT_TRUE(shapes::holds(drawing, ends, drawing.boundary().base(corner.s - length), 1e-9)) << corner.turn;
    const double to = drawing.turning().angle(corner.s + length);
    EXPECT_TRUE(shapes::holds(drawing, locate(drawing, {length, to - there}), corner.s, 1e-9)) << corner.turn;
    if (corner.turn < 0) ++concave;
  }
  EXPECT_GT(concave, 0);
}

TEST(Joint, that_two_fingers_readings_fall_into_is_a_placement) {
  const Part drawing = bean(true);
  const TurningFunction& turning = drawing.turning();
  int concave = 0;
  for (const Corner& corner : drawing.corners()) {
    if (corner.turn >= 0) continue;
    ++concave;
    const double before = turning.angle(corner.s, Side::before);
    const double there = before + 0.5 * corner.turn;
    const double s = corner.s - 0.05;
    const double t = corner.s + 3.1;
    // Finger a ends in the middle of the jump.
    const Reading reading{0.05, 0.9, (there - turning.angle(s)) - (turning.angle(t + 0.9) - turning.angle(t))};
    LocateOptions options;
    options.facing = turning.angle(s) - turning.angle(t);
    bool found = false;
    for (const Placement& placement : locate(drawing, std::vector<Reading>{reading}, options).placements) {
      found = found || drawing.boundary().contains(placement.extent[0], s, 1e-9);
    }
    EXPECT_TRUE(found) << corner.s;
  }
  EXPECT_GT(concave, 0);
}

TEST(Joint, is_rolled_over) {
  const Part drawing = bean(true);
  RollPlan plan;
  plan.start = 0.1;
  plan.distance = 1.7 * drawing.perimeter();
  plan.rows = 501;
  const DiskFinger finger{0.3};
  for (const double sign : {1.0, -1.0}) {
    plan.distance = sign * 1.7 * drawing.perimeter();
    const Roll one = integrated_roll(drawing, finger, plan);
    const Roll two = roll(drawing, finger, plan);
    EXPECT_NEAR(one.s[0].back() - one.s[0].front(), *plan.distance, 1e-8);
    for (std::size_t k = 0; k < one.s[0].size(); ++k) {
      EXPECT_NEAR(one.s[0][k], two.s[0][k], 1e-8);
      EXPECT_NEAR(one.log.fingers[0].psi[k], two.log.fingers[0].psi[k], 1e-8);
      // Off the joints the tangent is the part's.
      const double theta = std::remainder(one.angle[0][k] - drawing.tangent(one.s[0][k]), 2 * kPi);
      EXPECT_NEAR(theta, 0, kJointTurn);
    }
    EXPECT_NEAR(one.angle[0].back() - one.angle[0].front(),
                drawing.turning().angle(one.s[0].back()) - drawing.turning().angle(one.s[0].front()), 1e-8);
  }
}

TEST(Joint, that_turns_by_more_than_rounded_digits_do_stops_a_finger) {
  const Part bent(shapes::polygon({{0, 0}, {2, 0}, {2, 1}, {1, 1 - 2e-3}, {0, 1}}));
  RollPlan plan;
  plan.start = 3.5;
  plan.distance = 1;
  EXPECT_THROW(roll(bent, {0.3}, plan), InputError);
}

TEST(Joint, does_not_stop_a_finger_that_fits_into_the_concavity) {
  const Part drawing = bean(true);
  EXPECT_TRUE(reach_of_disk(drawing, 1.9).is_whole());
  EXPECT_FALSE(reach_of_disk(drawing, 2.1).is_whole());
}

// ---- rounded corners

/// A square of side 1 whose corners are rounded with this radius.
Part rounded_square(double radius) {
  Outline outline{"rounded square", {}, true};
  const std::vector<Vec2> corners{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec2& from = corners[k];
    const Vec2& to = corners[(k + 1) % 4];
    const Vec2 along = to - from;
    const Vec2 inwards(-along.y(), along.x());
    outline.curves.emplace_back(Line(from + radius * along, to - radius * along));
    const Vec2 centre = to - radius * along + radius * inwards;
    outline.curves.emplace_back(Arc(centre, radius, std::atan2(-inwards.y(), -inwards.x()), kPi / 2));
  }
  return Part(outline);
}

class RoundedCorner : public testing::TestWithParam<double> {};

TEST_P(RoundedCorner, is_found_as_accurately_as_the_closed_form) {
  const double radius = GetParam();
  const Part part = rounded_square(radius);
  const double side = 1 - 2 * radius;
  const double arc = radius * kPi / 2;
  const double turn = 0.7;
  // From an edge into the arc: the end is turn * radius beyond the edge's end. From the arc onto an edge: as far back.
  const Search search = locate(part, {0.4, turn});
  ASSERT_EQ(search.placements.size(), 8U) << radius;
  for (std::size_t k = 0; k < 4; ++k) {
    const double first = static_cast<double>(k) * (side + arc);
    EXPECT_NEAR(search.placements[2 * k].start[0], first + side - 0.4 + turn * radius, 1e-9) << radius;
    EXPECT_NEAR(search.placements[2 * k + 1].start[0], first + side + arc - turn * radius, 1e-9) << radius;
  }
}

TEST_P(RoundedCorner, costs_no_more_than_any_other_rounding) {
  EXPECT_LE(locate(rounded_square(GetParam()), {0.4, 0.7}).counts.intervals,
            locate(rounded_square(0.1), {0.4, 0.7}).counts.intervals);
}

TEST_P(RoundedCorner, tends_to_the_sharp_corners_placements) {
  const double radius = GetParam();
  const Search sharp = locate(shapes::unit_square(), {0.4, 0.7});
  const Search rounded = locate(rounded_square(radius), {0.4, 0.7});
  ASSERT_EQ(sharp.placements.size(), rounded.placements.size());
  const Part part = rounded_square(radius);
  for (std::size_t k = 0; k < sharp.placements.size(); ++k) {
    EXPECT_EQ(sharp.placements[k].kind, Kind::corner);
    // Where on the plane, because arc lengths differ: a start at a corner comes after one on the edge before it, and
    // s = 0 is a corner of the sharp one.
    const Vec2 at = rounded.placements[k].point[0];
    double nearest = 1;
    for (const Placement& placement : sharp.placements) nearest = std::min(nearest, (placement.point[0] - at).norm());
    EXPECT_LT(nearest, 3 * radius);
  }
}

TEST_P(RoundedCorner, is_within_the_reach_of_a_finger_of_any_size) {
  const Part part = rounded_square(GetParam());
  for (const double finger : {0.1, 1.0, 10.0}) {
    const Reach reach = reach_of_disk(part, finger);
    EXPECT_TRUE(reach.is_whole());
    EXPECT_LT(reach.tests, 2000U);
  }
}

INSTANTIATE_TEST_SUITE_P(Radii, RoundedCorner, testing::Values(1e-6, 1e-5, 1e-4, 1e-3),
                         [](const auto& radius) { return "radius_1e_minus_" + std::to_string(6 - radius.index); });

}  // namespace
}  // namespace joints_test
