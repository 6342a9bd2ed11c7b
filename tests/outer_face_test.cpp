// Where more than two ends of curves meet, `outer` takes what is around the outside.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "rollfix/curve.hpp"
#include "rollfix/error.hpp"
#include "rollfix/outline.hpp"

namespace outer_face_test {
namespace {

using rollfix::Arc;
using rollfix::Curve;
using rollfix::Line;
using rollfix::Loops;
using rollfix::Vec2;
using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr double kPi = std::numbers::pi;

Loops outer_loops(const std::vector<Curve>& curves) {
  rollfix::Drawing drawing{"drawing.dxf", "", {}, {}};
  for (std::size_t k = 0; k < curves.size(); ++k) drawing.curves.push_back({curves[k], {"LINE", "0", 2 * k}});
  return rollfix::loops(drawing, {{}, true});
}

std::vector<Curve> through(const std::vector<Vec2>& points) {
  std::vector<Curve> curves;
  for (std::size_t k = 0; k < points.size(); ++k) curves.emplace_back(Line(points[k], points[(k + 1) % points.size()]));
  return curves;
}

void add(std::vector<Curve>& curves, const std::vector<Curve>& more) {
  curves.insert(curves.end(), more.begin(), more.end());
}

std::vector<double> areas(const Loops& found) {
  std::vector<double> result;
  for (const rollfix::Loop& loop : found.closed) result.push_back(loop.area);
  return result;
}

/// A plate of 60 by 40 with rounded ends, drawn in pieces.
std::vector<Curve> slot() {
  return {Line({0, -20}, {60, -20}), Arc({60, 0}, 20, -kPi / 2, kPi), Line({60, 20}, {0, 20}),
          Arc({0, 0}, 20, kPi / 2, kPi)};
}

const double kSlotLength = 120 + 40 * kPi;

void expect_the_slot_alone(const std::vector<Curve>& besides) {
  std::vector<Curve> curves = slot();
  curves.insert(curves.begin(), besides.begin(), besides.end());
  const Loops found = outer_loops(curves);
  ASSERT_EQ(found.closed.size(), 1U);
  EXPECT_NEAR(found.closed[0].length, kSlotLength, 1e-9);
  EXPECT_NEAR(found.closed[0].area, 2400 + 400 * kPi, 1e-9);
  EXPECT_EQ(found.doubt, "");
}

TEST(OuterFace, a_leader_is_left_out_whether_it_points_inside_or_outside) {
  expect_the_slot_alone({Line({0, -20}, {-30, -50})});
  expect_the_slot_alone({Line({0, -20}, {20, 0})});
  expect_the_slot_alone({Line({0, -20}, {-30, -50}), Line({-30, -50}, {-60, -50})});
}

TEST(OuterFace, a_line_across_the_part_is_left_out_and_told) {
  expect_the_slot_alone({Line({0, -20}, {0, 20}), Line({60, 20}, {60, -20})});
  std::vector<Curve> curves = slot();
  curves.emplace_back(Line({0, -20}, {0, 20}));
  EXPECT_THAT(outer_loops(curves).notes,
              ElementsAre(HasSubstr("of 5 curves that hang together 4 are around the outside (`outer`), in 1 loop")));
}

TEST(OuterFace, where_curves_leave_along_one_tangent_the_one_that_bends_outward_is_taken) {
  // The full circles of both ends, and the tangent across their tops: all leave (0, 20) and (60, 20) along y = 20.
  expect_the_slot_alone({Arc({0, 0}, 20, -kPi / 2, kPi), Arc({60, 0}, 20, kPi / 2, kPi)});
}

TEST(OuterFace, cells_that_share_walls_have_the_outside_of_all) {
  std::vector<Curve> grid;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      if (i < 3) grid.emplace_back(Line(Vec2(i, j), Vec2(i + 1, j)));
      if (j < 3) grid.emplace_back(Line(Vec2(i, j), Vec2(i, j + 1)));
    }
  }
  const Loops found = outer_loops(grid);
  ASSERT_EQ(found.closed.size(), 1U);
  EXPECT_NEAR(found.closed[0].area, 9, 1e-12);
  EXPECT_EQ(found.closed[0].outline.curves.size(), 12U);
}

TEST(OuterFace, two_loops_on_one_leader_are_two_loops) {
  std::vector<Curve> curves = through({{0, 0}, {1, 0}, {1, 1}, {0, 1}});
  add(curves, through({{2, 0}, {4, 0}, {4, 1}, {2, 1}}));
  add(curves, {Line({1, 0}, {1.5, 0.1}), Line({1.5, 0.1}, {2, 0})});
  EXPECT_THAT(areas(outer_loops(curves)), ElementsAre(DoubleNear(2, 1e-12), DoubleNear(1, 1e-12)));
}

TEST(OuterFace, a_figure_eight_is_two_loops_and_an_arrowhead_at_a_corner_is_no_part_of_the_outline) {
  std::vector<Curve> eight = through({{0, 0}, {-2, 1}, {-2, -1}});
  add(eight, through({{0, 0}, {1, -1}, {1, 1}}));
  EXPECT_THAT(areas(outer_loops(eight)), ElementsAre(DoubleNear(2, 1e-12), DoubleNear(1, 1e-12)));
  std::vector<Curve> plate = through({{0, 0}, {100, 0}, {100, 60}, {0, 60}});
  add(plate, through({{100, 60}, {102, 61}, {101, 62}}));
  add(plate, {Line({101.5, 61.5}, {120, 80})});
  EXPECT_NEAR(areas(outer_loops(plate)).front(), 6000, 1e-9);
}

TEST(OuterFace, outlines_that_share_a_wall_are_one_also_where_each_is_one_entity) {
  std::vector<Curve> both = through({{0, 0}, {10, 0}, {10, 10}, {0, 10}});
  add(both, through({{0, 10}, {10, 10}, {10, 80}, {0, 80}}));
  rollfix::Drawing drawing{"drawing.dxf", "", {}, {}};
  for (std::size_t k = 0; k < both.size(); ++k) drawing.curves.push_back({both[k], {"LWPOLYLINE", "0", k / 4}});
  EXPECT_THAT(areas(rollfix::loops(drawing, {{}, true})), ElementsAre(DoubleNear(800, 1e-9)));
  EXPECT_THAT(areas(rollfix::loops(drawing)), ElementsAre(DoubleNear(700, 1e-9), DoubleNear(100, 1e-9)));
}

TEST(OuterFace, a_spike_at_the_very_left_is_passed_the_right_way_round) {
  expect_the_slot_alone({Line({0, -20}, {0, 20})});
  std::vector<Curve> star = through({{1, 0}, {0, 5}, {0.1, 9}, {4, 9}, {4, 0}});
  add(star, {Line({4, 9}, {2, 4})});
  EXPECT_EQ(outer_loops(star).closed.size(), 1U);
}

TEST(OuterFace, curves_that_cross_where_none_ends_give_no_outline) {
  std::vector<Curve> curves = through({{0, 0}, {4, 0}, {4, 4}, {0, 4}});
  add(curves, through({{0, 0}, {8, 3}, {2, 3}}));  // inside at its corner, and out through the right wall
  try {
    outer_loops(curves);
    FAIL() << "expected a refusal";
  } catch (const rollfix::InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("their outside is no loop"));
  }
}

TEST(OuterFace, lines_that_enclose_nothing_are_no_doubt) {
  std::vector<Curve> curves = slot();
  for (const Vec2& tip : {Vec2(200, 0), Vec2(200, 10), Vec2(200, 20)}) curves.emplace_back(Line({150, 0}, tip));
  const Loops found = outer_loops(curves);
  EXPECT_EQ(found.doubt, "");
  EXPECT_THAT(found.notes, ElementsAre(HasSubstr("3 curves that hang together and enclose nothing")));
}

TEST(OuterFace, a_hole_that_branches_stays_a_hole) {
  std::vector<Curve> curves = slot();
  add(curves, through({{20, -5}, {30, -5}, {30, 5}, {20, 5}}));
  curves.emplace_back(Line({20, -5}, {30, 5}));
  const Loops found = outer_loops(curves);
  ASSERT_EQ(found.closed.size(), 2U);
  EXPECT_NEAR(found.closed[1].area, 100, 1e-9);
  EXPECT_TRUE(found.closed[1].outline.hole);
}

/// A star-shaped polygon, chords between its corners that stay inside where it is convex, and leaders out of it; the
/// curves in any order and direction.
TEST(OuterFace, random_convex_polygons_with_chords_and_leaders_keep_their_outline) {
  std::mt19937 random(20);
  std::uniform_real_distribution<double> share(0, 1);
  for (int trial = 0; trial < 200; ++trial) {
    const int corners = 4 + static_cast<int>(random() % 12);
    std::vector<Vec2> points;
    for (int k = 0; k < corners; ++k) {
      const double at = 2 * kPi * (k + 0.6 * share(random)) / corners;
      points.emplace_back(3 * std::cos(at), 2 * std::sin(at));
    }
    std::vector<Curve> curves = through(points);
    double length = 0;
    for (const Curve& side : curves) length += (side.back() - side.front()).norm();
    curves.emplace_back(Line(points[0], points[2]));
    curves.emplace_back(Line(points[1], 2 * points[1]));
    curves.emplace_back(Line(points[3], 0.5 * points[3]));
    std::shuffle(curves.begin(), curves.end(), random);
    for (Curve& one : curves) {
      if (random() % 2 == 0) one = rollfix::reversed(one);
    }
    const Loops found = outer_loops(curves);
    ASSERT_EQ(found.closed.size(), 1U) << trial;
    ASSERT_NEAR(found.closed[0].length, length, 1e-9) << trial;
    ASSERT_EQ(found.closed[0].outline.curves.size(), points.size()) << trial;
  }
}

}  // namespace
}  // namespace outer_face_test
