// Where a finger can touch at all: closed forms, and a dense polyline that knows nothing of the search.

#include "rollfix/part.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "rollfix/error.hpp"
#include "rollfix/outline.hpp"
#include "shapes.hpp"

namespace reach_test {
namespace {

using namespace rollfix;
using shapes::kPi;

constexpr double kExact = 1e-12;  // slack for closed forms

Reach exact_reach(const Part& part, double radius) { return reach_of_disk(part, radius, {.slack = kExact}); }
Reach exact_jaw(const Part& part) { return reach_of_jaw(part, {.slack = kExact}); }

void expect_arcs(const Reach& reach, const std::vector<Interval>& expected, double tolerance = 1e-9) {
  EXPECT_TRUE(reach.decided);
  ASSERT_EQ(reach.arcs.size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k) {
    EXPECT_NEAR(reach.arcs[k].lo, expected[k].lo, tolerance) << k;
    EXPECT_NEAR(reach.arcs[k].hi, expected[k].hi, tolerance) << k;
  }
}

TEST(Reach, lets_a_disk_in_as_far_as_both_ends_of_curves_that_were_taken_to_meet_may_be_off) {
  Outline outline = shapes::polygon({{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}});
  outline.gap = 0.01;
  EXPECT_EQ(reach_of_disk(Part(outline), 0.5).slack, 2 * 0.01);
}

// ---- sharp corners

Part l_shape() { return Part(shapes::polygon({{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}})); }

/// A slot one unit wide and two deep, from above; s = 6 and 7 to 10 and 11 are its mouth and its walls.
Part u_shape() { return Part(shapes::polygon({{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}})); }

TEST(Reach, ends_a_radius_before_a_concave_right_angle) {
  for (const double r : {1e-3, 0.3, 0.99}) expect_arcs(exact_reach(l_shape(), r), {{6 + r, 18 - r}});
}

TEST(Reach, of_a_disk_larger_than_both_legs_is_up_to_the_tips) {
  const Reach reach = exact_reach(l_shape(), 5);
  expect_arcs(reach, {{8, 16}});
  // It pivots at (3, 1) until it touches (1, 3) as well: on a chord of 2 sqrt 2, at 135 degrees.
  ASSERT_EQ(reach.pivots.size(), 5U);
  ASSERT_EQ(reach.pivots[2].angles.size(), 1U);
  EXPECT_NEAR(reach.pivots[2].angles[0].hi, 3 * kPi / 4 + std::asin(std::sqrt(2.0) / 5), 1e-9);
}

TEST(Reach, of_a_jaw_is_the_convex_hull) {
  const Reach reach = exact_jaw(l_shape());
  expect_arcs(reach, {{8, 16}});
  EXPECT_NEAR(reach.pivots[2].angles[0].hi, 3 * kPi / 4, 1e-9);
  EXPECT_NEAR(reach.pivots[3].angles[0].lo, 3 * kPi / 4, 1e-9);
}

TEST(Reach, of_a_disk_that_fits_into_a_slot_has_the_slots_bottom) {
  expect_arcs(exact_reach(u_shape(), 0.3), {{9.3, 9.7}, {10.3, 24.7}});
}

TEST(Reach, of_a_disk_wider_than_a_slot_ends_at_the_edges_of_its_mouth) {
  const double r = 0.6;
  const Reach reach = exact_reach(u_shape(), r);
  expect_arcs(reach, {{12, 23}});
  // Pivoting about one edge of the mouth, the centre goes along a circle until it is r from the other.
  ASSERT_EQ(reach.pivots.size(), 6U);
  EXPECT_NEAR(reach.pivots[4].s, 12, 1e-12);
  ASSERT_EQ(reach.pivots[4].angles.size(), 1U);
  // The edge at (1, 3): the centre is at (1, 3) + r (sin a, -cos a).
  const double limit = reach.pivots[4].angles[0].lo;
  const Vec2 centre = Vec2(1, 3) + r * Vec2(std::sin(limit), -std::cos(limit));
  EXPECT_NEAR((centre - Vec2(2, 3)).norm(), r, 1e-9);
  EXPECT_FALSE(reach.pivots[4].is_whole());
  EXPECT_TRUE(reach.pivots[0].is_whole());
}

TEST(Reach, of_a_disk_exactly_as_wide_as_a_slot_is_decided_in_favour_of_touching) {
  const Reach reach = reach_of_disk(u_shape(), 0.5);
  expect_arcs(reach, {{9.5, 9.5}, {10.5, 24.5}}, 2 * reach.slack);
}

TEST(Reach, does_not_go_over_a_concave_corner_however_small_the_finger) {
  const Reach reach = reach_of_disk(l_shape(), 1e-9);
  ASSERT_EQ(reach.arcs.size(), 1U);
  EXPECT_NEAR(reach.arcs[0].lo, 6, 1e-8);
  EXPECT_LE(reach.arcs[0].width(), reach.perimeter);
  const Part bent(shapes::polygon({{0, 0}, {2, 0}, {2, 1}, {1, 0.998}, {0, 1}}));  // 0.2 degrees at (1, 0.998)
  EXPECT_EQ(reach_of_disk(bent, 1e-5).arcs.size(), 1U);
  EXPECT_NEAR(reach_of_disk(bent, 1e-5).arcs[0].lo, 3 + 1 + 2e-6, 1e-6);
}

TEST(Reach, is_not_stopped_by_the_tiny_concave_joints_of_rounded_digits) {
  const Part bent(shapes::polygon({{0, 0}, {2, 0}, {2, 1}, {1, 1 - 1e-6}, {0, 1}}));
  for (const double r : {0.01, 0.5, 20.0}) EXPECT_TRUE(reach_of_disk(bent, r).is_whole()) << r;
  EXPECT_TRUE(reach_of_jaw(bent).is_whole());
}

// ---- holes and open parts

Part hole(Outline outline) {
  outline = reversed(outline);
  outline.hole = true;
  return Part(outline);
}

TEST(Reach, in_a_square_hole_ends_a_radius_from_its_corners) {
  const Part part = hole(shapes::polygon({{0, 0}, {1, 0}, {1, 1}, {0, 1}}));
  expect_arcs(exact_reach(part, 0.1), {{0.1, 0.9}, {1.1, 1.9}, {2.1, 2.9}, {3.1, 3.9}});
  EXPECT_TRUE(reach_of_disk(part, 0.51).arcs.empty());
  EXPECT_TRUE(reach_of_jaw(part).arcs.empty());
}

TEST(Reach, in_a_round_hole_is_everything_up_to_its_own_radius) {
  const Part part = hole(gallery("circle,r=2"));
  EXPECT_TRUE(reach_of_disk(part, 1.5).is_whole());
  EXPECT_TRUE(reach_of_disk(part, 2).is_whole());  // it fills the hole
  EXPECT_TRUE(reach_of_disk(part, 2.01).arcs.empty());
}

TEST(Reach, of_an_open_part_counts_its_far_side_as_well) {
  // A wall along x, then one that stands on it to the right of its direction of travel.
  const Part wall(shapes::polygon({{0, 0}, {2, 0}, {2, -1}}, false));
  expect_arcs(exact_reach(wall, 0.25), {{0, 1.75}, {2.25, 3}});
  const Part step(shapes::polygon({{0, 0}, {2, 0}, {2, 1}}, false));
  EXPECT_TRUE(exact_reach(step, 0.25).is_whole());
}

// ---- smooth dimples

/// r = a + b cos u with b < a < 2b has one dimple, symmetric about u = pi.
Part limacon() { return Part(gallery("limacon,a=1,b=0.9")); }

/// A disk or a jaw that touches a symmetric dimple at two points has its centre on the axis: y of its centre is 0.
TEST(Reach, ends_where_the_disk_touches_both_sides_of_a_dimple) {
  const Part part = limacon();
  for (const double r : {0.05, 0.3, 3.0}) {
    const Reach reach = exact_reach(part, r);
    ASSERT_EQ(reach.arcs.size(), 1U) << r;
    for (const double s : {reach.arcs[0].lo, reach.arcs[0].hi}) {
      const double angle = part.tangent(s);
      const Vec2 centre = part.point(s) + r * Vec2(std::sin(angle), -std::cos(angle));
      EXPECT_NEAR(centre.y(), 0, 1e-8) << r;
    }
    EXPECT_NEAR(reach.arcs[0].lo + reach.arcs[0].hi, 2 * part.perimeter(), 1e-8);
  }
}

TEST(Reach, of_a_jaw_ends_at_the_double_tangent_of_a_dimple) {
  const Part part = limacon();
  const Reach reach = exact_jaw(part);
  ASSERT_EQ(reach.arcs.size(), 1U);
  EXPECT_NEAR(std::abs(part.tangent(reach.arcs[0].hi)), kPi / 2, 1e-8);
  EXPECT_NEAR(part.point(reach.arcs[0].lo).x(), part.point(reach.arcs[0].hi).x(), 1e-8);
}

TEST(Reach, begins_to_shrink_where_one_plus_r_kappa_becomes_zero) {
  const Part part = limacon();
  double least = 0;
  for (const Spiral& spiral : part.turning().spirals()) least = std::min(least, spiral.start.curvature);
  const double critical = -1 / least;
  EXPECT_TRUE(exact_reach(part, 0.99 * critical).is_whole());
  EXPECT_FALSE(exact_reach(part, 1.01 * critical).is_whole());
}

TEST(Reach, of_a_convex_part_is_everything) {
  for (const char* name : {"circle", "ellipse", "reuleaux", "superellipse", "stadium", "polygon,n=3", "polygon,n=9"}) {
    const Part part(gallery(name));
    for (const double r : {1e-3, 1.0, 1e3}) EXPECT_TRUE(reach_of_disk(part, r).is_whole()) << name << r;
    EXPECT_TRUE(reach_of_jaw(part).is_whole()) << name;
  }
}

TEST(Reach, of_a_gear_has_its_symmetry) {
  const Part part(gallery("gear,teeth=12"));
  const Reach reach = reach_of_disk(part, 0.2);
  ASSERT_EQ(reach.arcs.size(), 12U);
  for (std::size_t k = 1; k < 12; ++k) EXPECT_NEAR(reach.arcs[k].width(), reach.arcs[0].width(), 1e-8);
}

// ---- an oracle

/// How deep the boundary is in a disk that touches at s, over many places of the boundary.
double deepest_of_samples(const Part& part, double radius, double s) {
  const double angle = part.tangent(s);
  const Vec2 centre = part.point(s) + radius * Vec2(std::sin(angle), -std::cos(angle));
  double deepest = 0;
  for (int k = 0; k <= 2000; ++k) {
    // Places crowd where the boundary bends, at the start of a spiral.
    const Vec2 point = part.point(part.perimeter() * std::pow(k / 2000.0, 6));
    deepest = std::max(deepest, radius - (point - centre).norm());
  }
  return deepest;
}

/// Its inner turns are one spiral of the part that turns by 4 pi, nearly all of it near the start.
TEST(Reach, of_a_disk_beside_a_curve_that_bends_more_and_more_is_as_samples_say) {
  const Part part(gallery("log-spiral,a=1,b=1,turns=2"));
  for (const double radius : {3.0, 300.0, 1000.0, 30000.0}) {
    const Reach reach = reach_of_disk(part, radius);
    EXPECT_TRUE(reach.decided);
    for (int k = 1; k < 300; ++k) {
      const double s = part.perimeter() * std::pow(k / 300.0, 6);
      const double depth = deepest_of_samples(part, radius, s);
      if (depth > 0 && depth <= 10 * reach.slack) continue;
      EXPECT_EQ(reach.contains(s), depth == 0) << radius << ", s = " << s;
    }
  }
}

// ---- what is hit

TEST(DeepestHit, of_a_disk_beside_a_concave_corner_is_the_other_leg) {
  const Hit hit = deepest_hit(l_shape(), 1 / 0.5, 5.9, kPi / 2 + kPi / 2);  // (1.1, 1), the leg x = 1
  EXPECT_NEAR(hit.depth, 0.4, 1e-9);
  EXPECT_NEAR(hit.point.x(), 1, 1e-9);
  EXPECT_NEAR(hit.point.y(), 1.5, 1e-5);
  EXPECT_NEAR(hit.s, 6.5, 1e-5);
}

TEST(DeepestHit, of_a_jaw_is_the_point_furthest_beyond_it) {
  const Hit hit = deepest_hit(l_shape(), 0, 5, kPi);
  EXPECT_NEAR(hit.depth, 2, 1e-9);
  EXPECT_NEAR(hit.point.y(), 3, 1e-9);
}

TEST(DeepestHit, of_a_free_finger_has_no_depth) { EXPECT_NEAR(deepest_hit(l_shape(), 1 / 0.5, 1, 0).depth, 0, 1e-12); }

// ---- words

TEST(Reach, refuses_a_radius_that_is_none) {
  for (const double r : {0.0, -1.0, std::nan(""), HUGE_VAL}) EXPECT_THROW(reach_of_disk(l_shape(), r), InputError);
}

TEST(Reach, counts_what_its_budget_does_not_reach_as_reachable_and_says_so) {
  ReachOptions options;
  options.budget = 10;
  const Reach reach = reach_of_disk(u_shape(), 0.6, options);
  EXPECT_FALSE(reach.decided);
  EXPECT_TRUE(reach.contains(9.5));
}

/// A bean through so many points: convex but for one wide dimple.
Part bean_through(int count) {
  std::vector<Vec2> points;
  for (int k = 0; k < count; ++k) {
    const double t = 2 * kPi * k / count;
    points.push_back((2 - 0.9 * std::exp(-4 * (1 - std::cos(t)))) * Vec2(std::cos(t), std::sin(t)));
  }
  return Part({"bean", spline_through(points, true), true}, {true});
}

TEST(Reach, of_a_scan_takes_fewer_tests_than_it_has_points) {
  constexpr std::size_t kPoints = 20000;
  const Part bean = bean_through(kPoints);
  ASSERT_GE(bean.turning().spirals().size(), kPoints);
  const Reach small = reach_of_disk(bean, 0.05);
  EXPECT_TRUE(small.whole_loop);
  EXPECT_LT(small.tests, kPoints);
}

TEST(Reach, of_a_scan_ends_where_it_does_on_few_points) {
  for (const double r : {0.5, 1.0, 3.0}) {
    const Reach few = reach_of_disk(bean_through(200), r);
    ASSERT_FALSE(few.is_whole());
    expect_arcs(reach_of_disk(bean_through(20000), r), few.arcs, 1e-4);
  }
}

}  // namespace
}  // namespace reach_test
