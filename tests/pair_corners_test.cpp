// Corners: at a convex one the finger pivots, and the pivot makes up what the readings lack.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <vector>

#include "pair_cases.hpp"
#include "rollfix/locate.hpp"
#include "shapes.hpp"

namespace pair_corners_test {
namespace {

using namespace rollfix;

bool holds(const Part& part, const Search& search, const PerFinger<double>& at) {
  return pair_cases::holds(part, search, at, 1e-7);
}

TEST(PairCorners, a_finger_that_starts_at_a_corner_pivots_by_the_same_angle_for_all_readings) {
  // A box with a round end: finger a starts at the corner (2, 0), pivoted by 0.3; b rolls on the arc.
  Outline outline = shapes::polygon({{0, 0}, {2, 0}, {2, 1}}, false);
  outline.closed = true;
  outline.curves.emplace_back(Arc({1, 1}, 1, 0, shapes::kPi));
  outline.curves.emplace_back(Line({0, 1}, {0, 0}));
  const Part part(outline);
  const double corner = 2;   // from (2, 0)
  const double pivot = 0.3;  // of the right angle there, already behind the finger
  const double on_arc = 2 + 1 + 0.4;
  // a rolls by 0.2 and 0.5 up the side: its tangent ends upright, so it turns by pi/2 - 0.3 in both readings.
  // b rolls by 0.7 and 1.1 on the arc of radius 1.
  const double turn_a = shapes::kPi / 2 - pivot;
  const Search search = locate(part, {{0.2, 0.7, turn_a - 0.7}, {0.5, 1.1, turn_a - 1.1}});
  EXPECT_TRUE(holds(part, search, {corner, on_arc}));
}

TEST(PairCorners, an_end_at_a_corner_is_decided_by_the_pivot_there) {
  const Part part(gallery("naca"));
  const double period = part.perimeter();
  // Finger a ends at the trailing edge (s = 0) in the first reading, half way round its pivot.
  const double s = 0.7 * period;
  const double t = 0.3 * period;
  const TurningFunction& turning = part.turning();
  const double before = turning.angle(period, Side::before);
  const double after = turning.angle(0, Side::after) + turning.period_turn();
  const double half_way = 0.5 * (before + after) - turning.angle(s);
  const auto turn = [&](double from, double length) { return turning.angle(from + length) - turning.angle(from); };
  const Search search = locate(part, {{period - s, 0.2 * period, half_way - turn(t, 0.2 * period)},
                                      {0.1 * period, -0.15 * period, turn(s, 0.1 * period) - turn(t, -0.15 * period)}});
  EXPECT_TRUE(holds(part, search, {s, t}));
  EXPECT_TRUE(std::any_of(search.placements.begin(), search.placements.end(),
                          [](const Placement& placement) { return placement.kind == Kind::corner; }));
}

TEST(PairCorners, the_pivots_that_are_left_are_told) {
  const Part part(gallery("naca"));
  const double period = part.perimeter();
  const double t = 0.3 * period;
  const TurningFunction& turning = part.turning();
  const double angle =
      turning.angle(0, Side::after) - 0.2;  // a starts at the trailing edge, 0.2 rad short of leaving it
  const auto turn_a = [&](double length) { return turning.angle(length) - angle; };
  const auto turn_b = [&](double length) { return turning.angle(t + length) - turning.angle(t); };
  const Search search = locate(part, {{0.2 * period, 0.15 * period, turn_a(0.2 * period) - turn_b(0.15 * period)},
                                      {0.3 * period, -0.1 * period, turn_a(0.3 * period) - turn_b(-0.1 * period)}});
  ASSERT_TRUE(holds(part, search, {0, t}));
  for (const Placement& placement : search.placements) {
    if (placement.kind != Kind::corner || placement.start[0] != 0) continue;
    ASSERT_TRUE(placement.pivot);
    EXPECT_GT((*placement.pivot)[0].start.width(), 0.2);
    EXPECT_EQ((*placement.pivot)[1].start.width(), 0);
  }
}

TEST(PairCorners, both_fingers_may_stand_at_corners) {
  const Part part = shapes::unit_square();
  // Both start at corners and roll along a side: any pivots with the same difference will do.
  const Search search = locate(part, {{0.3, 0.4, 0.1}, {0.5, 0.6, 0.1}});
  EXPECT_TRUE(holds(part, search, {0, 1}));
  EXPECT_EQ(search.status, Status::complete);
}

TEST(PairCorners, two_contacts_of_one_finger_at_corners_pivot_independently) {
  const Part part = shapes::unit_square();
  // Finger a, pivoted by 0.2 short of the side at s = 0, rolls along it, pivots by 0.2 at its end, and rolls half a
  // side on; finger b stays on one side.
  const Search search = locate(part, {{1, 0.25, 0.4}, {1.5, 0.5, shapes::kPi / 2 + 0.2}});
  EXPECT_TRUE(holds(part, search, {0, 0.1}));
}

TEST(PairCorners, a_hair_beyond_what_a_resting_fingers_pivots_reach_takes_no_work) {
  const Part part(gallery("naca"));
  // Both start at the trailing edge with one heading; a's tangent then ends 1e-10 rad beyond all that b can turn to.
  LocateOptions options{0, 2000};
  options.facing = 0;
  const Search search = locate(part, {{1e-10 * part.perimeter(), 0, 0}}, options);
  EXPECT_LT(search.counts.intervals, 10000U);
}

TEST(PairCorners, of_nearly_half_a_turn_agree_in_heading_at_either_end_of_their_pivots) {
  // Two arcs of 0.004 rad: turned by half a turn the lens is itself, so that the two corners can change places.
  const double half = 0.002;
  const double radius = 1 / std::sin(half);
  const double depth = radius * std::cos(half);
  Outline lens{"lens", {}, true};
  lens.curves = {Arc({0, depth}, radius, -shapes::kPi / 2 - half, 2 * half),
                 Arc({0, -depth}, radius, shapes::kPi / 2 - half, 2 * half)};
  LocateOptions options{0.01};
  options.facing = 0;
  const Search search = locate(Part(lens), {{0, 0, 3.6}}, options);
  const double other = 2 * half * radius;
  EXPECT_TRUE(pair_cases::holds(Part(lens), search, {0, other}, 1e-7));
  EXPECT_TRUE(pair_cases::holds(Part(lens), search, {other, 0}, 1e-7));
  for (const Placement& placement : search.placements) EXPECT_LE(placement.residual, options.tolerance);
}

TEST(PairCorners, where_a_reading_is_given_twice_have_no_roots_but_where_all_equations_hold) {
  const Part part(gallery("naca"));
  const Reading first{-1.4359379108414995, -0.42946309311814024, -4.5512695429043486};
  const Reading second{-1.5317124328620955, -1.0727106349620115, -1.7894685329778759};
  for (const Placement& placement : locate(part, {first, second, first}).placements) {
    EXPECT_LE(placement.residual, 4e-12) << placement.start[0] << ", " << placement.start[1];
    EXPECT_EQ(placement.roots.size(), 1U) << placement.start[0] << ", " << placement.start[1];
  }
}

/// Eight lines and arcs, one of them 0.004 long on an outline of 273.
Part plate_with_a_tiny_fillet() {
  Outline outline{"plate", {}, true};
  outline.curves.emplace_back(Line({5.912705367766222, 9.369597883453551}, {-11.777893555475272, 40.0106140348311}));
  outline.curves.emplace_back(
      Arc({-31.777893555475266, -7.293834365951092}, 51.35864911095564, 1.1707963267948966, 0.8));
  outline.curves.emplace_back(Line({-51.77789355547526, 40.0106140348311}, {-71.77789355547529, 5.369597883453557}));
  outline.curves.emplace_back(Line({-71.77789355547529, 5.369597883453557}, {-51.77904825601368, -29.269418267923985}));
  outline.curves.emplace_back(
      Arc({-51.775584154398544, -29.267418267923986}, 0.004, -2.6179938779916254, 1.0471975511965979));
  outline.curves.emplace_back(
      Line({-51.775584154398544, -29.271418267923984}, {-11.777893555475272, -29.27141826792399}));
  outline.curves.emplace_back(Line({-11.777893555475272, -29.27141826792399}, {5.912705367766222, 1.369597883453554}));
  outline.curves.emplace_back(
      Arc({-1.0154978625092879, 5.369597883453553}, 8.0, -0.5235987755982987, 1.0471975511965974));
  return Part(outline);
}

TEST(PairCorners, many_pieces_in_one_pivot_cost_no_more_than_the_budget) {
  const Part part = plate_with_a_tiny_fillet();
  const std::vector<Reading> readings{{16.074455404606155, 27.154737855854762, 0.3781562840084265},
                                      {80.00187938912804, -271.4164342842274, 9.80293424477767}};
  LocateOptions options;
  options.tolerance = 1e-10;
  options.budget = 4000;
  const std::size_t placements = locate(part, readings, options).placements.size();
  options.budget = 100'000;
  const std::clock_t begin = std::clock();
  EXPECT_EQ(locate(part, readings, options).placements.size(), placements);
  // Each piece with each takes minutes.
  EXPECT_LT(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC, 10);
}

}  // namespace
}  // namespace pair_corners_test
