// loops: a drawing's curves, in whatever order and direction, joined end to end.
#include "rollfix/outline.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "outline/joining.hpp"
#include "random.hpp"
#include "rollfix/curve.hpp"
#include "rollfix/error.hpp"
#include "rollfix/part.hpp"

namespace loops_test {
namespace {

using rollfix::Arc;
using rollfix::Curve;
using rollfix::Drawing;
using rollfix::InputError;
using rollfix::Line;
using rollfix::Loops;
using rollfix::Part;
using rollfix::Vec2;
using rollfix::outline::Polygon;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kPi = std::numbers::pi;

/// Each curve an entity of its own, on the line of its number.
Drawing drawing(const std::vector<Curve>& curves) {
  Drawing result{"drawing.dxf", "mm", {}, {}};
  for (const Curve& curve : curves) result.curves.push_back({curve, {"LINE", "0", result.curves.size() + 1}});
  return result;
}

/// All of one polyline.
Drawing polyline(const std::vector<Vec2>& points) {
  Drawing result{"drawing.dxf", "mm", {}, {}};
  for (std::size_t k = 0; k + 1 < points.size(); ++k) {
    result.curves.push_back({Line(points[k], points[k + 1]), {"LWPOLYLINE", "0", 1}});
  }
  return result;
}

std::vector<Curve> square(double side, const Vec2& corner = Vec2(0, 0)) {
  const Vec2 x(side, 0);
  const Vec2 y(0, side);
  return {Line(corner, corner + x), Line(corner + x, corner + x + y), Line(corner + x + y, corner + y),
          Line(corner + y, corner)};
}

std::vector<Curve> stadium(double radius, double straight) {
  return {Line({0, -radius}, {straight, -radius}), Arc({straight, 0}, radius, -kPi / 2, kPi),
          Line({straight, radius}, {0, radius}), Arc({0, 0}, radius, kPi / 2, kPi)};
}

template <class... Lists>
std::vector<Curve> together(const Lists&... lists) {
  std::vector<Curve> all;
  (all.insert(all.end(), lists.begin(), lists.end()), ...);
  return all;
}

std::string message_of(const Drawing& drawn) {
  try {
    rollfix::loops(drawn);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Loops, join_pieces_in_any_order_and_direction) {
  std::mt19937_64 generator = test_generator();
  for (int round = 0; round < test_count(200); ++round) {
    std::vector<Curve> curves = stadium(0.5, 2);
    std::shuffle(curves.begin(), curves.end(), generator);
    for (Curve& curve : curves) {
      if (generator() % 2 == 0) curve = rollfix::reversed(curve);
    }
    const Loops found = rollfix::loops(drawing(curves));
    ASSERT_EQ(found.closed.size(), 1U);
    EXPECT_TRUE(found.open.empty());
    EXPECT_NEAR(found.closed[0].area, 2 + kPi / 4, 1e-12);
    EXPECT_NEAR(found.closed[0].length, 4 + kPi, 1e-12);
    EXPECT_NEAR(Part(found.closed[0].outline).perimeter(), 4 + kPi, 1e-11);
  }
}

TEST(Loops, start_with_the_first_curve_of_the_file_in_its_direction) {
  const std::vector<Curve> curves = {Line({1, 1}, {1, 0}), Line({0, 0}, {1, 0}), Line({0, 1}, {1, 1}),
                                     Line({0, 0}, {0, 1})};
  const Part part(rollfix::loops(drawing(curves)).closed.at(0).outline);
  EXPECT_EQ(part.point(0), Vec2(1, 1));
  EXPECT_TRUE(part.reversed());  // that way it runs clockwise
}

TEST(Loops, keep_arcs_and_lines_exact) {
  const Part part(rollfix::loops(drawing(stadium(0.5, 2))).closed.at(0).outline);
  for (const rollfix::Spiral& spiral : part.turning().spirals()) EXPECT_EQ(spiral.trend, 0);
}

TEST(Loops, are_listed_by_area_and_know_what_is_a_hole) {
  const auto hole = square(2, {1, 1});
  const auto island = square(1, {1.5, 1.5});
  const Loops found = rollfix::loops(drawing(together(island, square(10), hole)));
  ASSERT_EQ(found.closed.size(), 3U);
  EXPECT_THAT((std::vector<double>{found.closed[0].area, found.closed[1].area, found.closed[2].area}),
              ElementsAre(100, 4, 1));
  EXPECT_THAT((std::vector<int>{found.closed[0].depth, found.closed[1].depth, found.closed[2].depth}),
              ElementsAre(0, 1, 2));
  EXPECT_TRUE(found.closed[1].outline.hole);
  EXPECT_FALSE(found.closed[2].outline.hole);
}

TEST(Loops, a_hole_is_stored_clockwise_with_the_material_on_its_left) {
  const Loops found = rollfix::loops(drawing(together(square(10), square(2, {1, 1}))));
  const Part hole(found.closed.at(1).outline);
  EXPECT_EQ(hole.turns(), -1);
  EXPECT_TRUE(hole.reversed());
  ASSERT_EQ(hole.corners().size(), 4U);
  for (const rollfix::Corner& corner : hole.corners()) EXPECT_NEAR(corner.turn, -kPi / 2, 1e-12);
}

TEST(Loops, a_circle_is_a_loop_by_itself_even_where_a_line_touches_it) {
  const Loops found = rollfix::loops(drawing({Arc({0, 0}, 1, 0, 2 * kPi), Line({1, 0}, {3, 0})}));
  EXPECT_EQ(found.closed.size(), 1U);
  EXPECT_EQ(found.open.size(), 1U);
}

TEST(Loops, a_polyline_through_one_of_its_own_points_stays_one_loop) {
  const Loops found = rollfix::loops(polyline({{1, 1}, {0, 0}, {-1, -1}, {1, -1}, {0, 0}, {-1, 1}, {1, 1}}));
  ASSERT_EQ(found.closed.size(), 1U);
  EXPECT_EQ(found.closed[0].outline.curves.size(), 6U);
}

TEST(Loops, ends_within_the_gap_meet_and_the_largest_gap_is_reported) {
  std::vector<Curve> curves = square(1);
  curves[1] = Line({1 + 1e-7, 0}, {1, 1});
  const Loops found = rollfix::loops(drawing(curves));
  ASSERT_EQ(found.closed.size(), 1U);
  EXPECT_NEAR(found.closed[0].gap, 1e-7, 1e-15);
  EXPECT_NEAR(Part(found.closed[0].outline).perimeter(), 4, 1e-6);
}

TEST(Loops, ends_beyond_the_gap_leave_an_open_chain) {
  std::vector<Curve> curves = square(1);
  curves[3] = Line({0, 1}, {0, 0.01});
  EXPECT_EQ(rollfix::loops(drawing(curves)).open.size(), 1U);
  EXPECT_EQ(rollfix::loops(drawing(curves), {0.02}).closed.size(), 1U);
}

TEST(Loops, an_open_chain_keeps_the_direction_of_its_first_curve) {
  const Loops found = rollfix::loops(drawing({Line({2, 0}, {3, 1}), Line({1, 0}, {2, 0}), Line({1, 0}, {0, 1})}));
  ASSERT_EQ(found.open.size(), 1U);
  EXPECT_EQ(found.open[0].outline.curves.front().front(), Vec2(0, 1));
  EXPECT_EQ(found.open[0].outline.curves.back().back(), Vec2(3, 1));
}

TEST(Loops, curves_drawn_twice_count_once_and_it_is_said) {
  std::vector<Curve> curves = together(square(1), square(1));
  curves[5] = rollfix::reversed(curves[5]);
  const Loops found = rollfix::loops(drawing(curves));
  EXPECT_EQ(found.closed.size(), 1U);
  EXPECT_THAT(found.notes, ElementsAre(HasSubstr("4 curves that are drawn twice, such as the LINE '0' of line 8")));
}

TEST(Loops, a_wall_that_two_entities_share_stays_with_both) {
  Drawing both = drawing(together(square(1), square(1)));
  for (std::size_t k = 0; k < both.curves.size(); ++k) {
    const auto& side = both.curves[k].curve;
    const Vec2 shift = k < 4 ? Vec2(0, 0) : Vec2(0, 1);
    both.curves[k] = {Line(side.front() + shift, side.back() + shift), {"LWPOLYLINE", "0", k / 4}};
  }
  EXPECT_EQ(rollfix::loops(both).closed.size(), 2U);
  EXPECT_THAT(rollfix::loops(both).notes, testing::IsEmpty());
}

TEST(Loops, a_line_traced_over_a_side_of_an_outline_is_left_out_whichever_comes_first) {
  for (const bool line_first : {true, false}) {
    Drawing traced = drawing(square(1));
    for (auto& drawn : traced.curves) drawn.origin = {"LWPOLYLINE", "0", 1};
    traced.curves.insert(line_first ? traced.curves.begin() : traced.curves.end(),
                         {Line({0, 0}, {1, 0}), {"LINE", "0", 9}});
    EXPECT_EQ(rollfix::loops(traced).closed.size(), 1U) << line_first;
    EXPECT_THAT(rollfix::loops(traced).notes, ElementsAre(HasSubstr("1 curve that is drawn twice, such as the LINE")));
  }
}

TEST(Loops, a_hole_that_touches_the_outside_where_it_starts_is_a_hole) {
  const Loops found = rollfix::loops(drawing({Arc({0, 0}, 40, 0, 2 * kPi), Arc({20, 0}, 20, 0, 2 * kPi)}));
  ASSERT_EQ(found.closed.size(), 2U);
  EXPECT_TRUE(found.closed[1].outline.hole);
  const Loops beside = rollfix::loops(drawing({Arc({0, 0}, 40, 0, 2 * kPi), Arc({60, 0}, 20, kPi, 2 * kPi)}));
  EXPECT_FALSE(beside.closed[1].outline.hole);
}

TEST(Loops, two_arcs_over_one_chord_are_not_the_same_curve) {
  const Loops found = rollfix::loops(drawing({Arc({0, 0}, 1, 0, kPi), Arc({0, 0}, 1, kPi, kPi)}));
  ASSERT_EQ(found.closed.size(), 1U);
  EXPECT_NEAR(found.closed[0].area, kPi, 1e-12);
}

TEST(Loops, curves_below_the_gap_are_left_out_and_counted) {
  const Loops found = rollfix::loops(drawing(together(square(1), std::vector<Curve>{Line({0, 0}, {1e-9, 0})})));
  EXPECT_EQ(found.closed.size(), 1U);
  EXPECT_THAT(found.notes, ElementsAre(HasSubstr("left out: 1 curve no longer than")));
}

TEST(Loops, a_branch_is_refused_with_its_place) {
  EXPECT_THAT(message_of(drawing(together(square(1), std::vector<Curve>{Line({0, 0}, {0.5, 0.5})}))),
              HasSubstr("drawing.dxf: 3 ends of curves meet near (0, 0), expected two at most"));
}

TEST(Loops, a_branch_inside_of_a_sound_loop_is_left_out_and_told) {
  // A square with a hole whose side has a construction line at a corner.
  std::vector<Curve> hole;
  for (const Curve& side : square(1)) {
    hole.emplace_back(Line(0.25 * side.front() + Vec2(0.3, 0.3), 0.25 * side.back() + Vec2(0.3, 0.3)));
  }
  hole.emplace_back(Line(hole.front().front(), hole.front().front() + Vec2(0.1, 0.15)));
  const Loops found = rollfix::loops(drawing(together(square(1), hole)));
  ASSERT_EQ(found.closed.size(), 1U);
  EXPECT_NEAR(found.closed[0].length, 4, 1e-12);
  EXPECT_TRUE(found.open.empty());
  EXPECT_EQ(found.doubt, "");
  EXPECT_THAT(found.notes,
              ElementsAre(HasSubstr("left out: 5 curves that hang together where 3 ends of curves meet near ")));
}

TEST(Loops, a_branch_around_the_sound_loops_is_a_doubt_which_one_is_meant) {
  std::vector<Curve> hole;
  for (const Curve& side : square(1)) {
    hole.emplace_back(Line(0.25 * side.front() + Vec2(0.3, 0.3), 0.25 * side.back() + Vec2(0.3, 0.3)));
  }
  std::vector<Curve> outer = square(1);
  outer.emplace_back(Line({0, 0}, {-0.5, -0.5}));  // a leader
  const Loops found = rollfix::loops(drawing(together(outer, hole)));
  ASSERT_EQ(found.closed.size(), 1U);
  EXPECT_NEAR(found.closed[0].length, 1, 1e-12);
  EXPECT_THAT(found.doubt, HasSubstr("drawing.dxf: 3 ends of curves meet near (0, 0), expected two at most"));
  EXPECT_THAT(found.doubt, HasSubstr("or take it with `loop` 1"));
}

TEST(Loops, a_drawing_without_curves_is_refused) {
  EXPECT_THAT(message_of(Drawing{"drawing.dxf", "", {}, {}}), HasSubstr("draws no curve"));
}

/// An arc that counts how often it is evaluated.
struct CountedArc {
  Arc arc;
  int* evaluations;

  rollfix::Interval domain() const { return arc.domain(); }
  rollfix::Jet jet(double u) const { return ++*evaluations, arc.jet(u); }
  Vec2 velocity(double u) const { return ++*evaluations, arc.velocity(u); }
};

TEST(Loops, short_arcs_far_from_the_origin_are_measured_without_halving) {
  for (const double offset : {0.0, 10.0, 1e4, 1e8}) {
    for (const double sweep : {1.0, 1e-2, 1e-5}) {
      int evaluations = 0;
      const auto measure = rollfix::outline::measure(CountedArc{Arc({offset, offset}, 10, 1, sweep), &evaluations});
      EXPECT_LT(evaluations, 100) << offset << ' ' << sweep;
      EXPECT_NEAR(measure.length, 10 * sweep, 1e-12 * sweep);
    }
  }
}

TEST(Loops, a_hundred_thousand_lines_at_one_place_end_soon) {
  std::vector<Curve> curves;
  for (int k = 0; k < 100000; ++k) {
    const double angle = 2 * kPi * k / 100000;
    curves.emplace_back(Line({0, 0}, {std::cos(angle), std::sin(angle)}));
  }
  EXPECT_THAT(message_of(drawing(curves)), HasSubstr("100000 ends of curves meet near (0, 0)"));
}

Polygon ring(const Vec2& middle, double radius, int sides, double first, bool clockwise = false) {
  Polygon result;
  for (int k = 0; k < sides; ++k) {
    const double angle = first + (clockwise ? -2 : 2) * std::numbers::pi * k / sides;
    result.points.emplace_back(middle + radius * Vec2(std::cos(angle), std::sin(angle)));
  }
  result.box = rollfix::box_around(result.points);
  return result;
}

std::vector<int> one_by_one(const std::vector<Polygon>& polygons) {
  std::vector<int> depths(polygons.size(), 0);
  for (std::size_t inner = 0; inner < polygons.size(); ++inner) {
    for (std::size_t outer = 0; outer < inner; ++outer) {
      depths[inner] += polygons[outer].contains(polygons[inner].points.front()) ? 1 : 0;
    }
  }
  return depths;
}

/// Rings in rings in rings, side by side, of any direction; none touches another.
void add_rings(std::vector<Polygon>& all, const Vec2& middle, double radius, std::mt19937_64& random) {
  const auto number = [&](double lo, double hi) { return std::uniform_real_distribution(lo, hi)(random); };
  if (radius < 0.02) return;
  all.push_back(ring(middle, radius, 3 + static_cast<int>(random() % 9), number(0, 7), random() % 2 == 0));
  if (random() % 3 == 0) return add_rings(all, middle, 0.49 * radius, random);
  for (const Vec2& side : {Vec2(-1, 0), Vec2(1, 0)})
    add_rings(all, middle + 0.2 * radius * side, 0.18 * radius, random);
}

void sort_by_size(std::vector<Polygon>& all) {
  std::stable_sort(all.begin(), all.end(), [](const Polygon& a, const Polygon& b) {
    return a.box.diagonal().norm() > b.box.diagonal().norm();
  });
}

TEST(Nesting, of_polygons_that_do_not_meet_is_what_asking_each_of_each_says) {
  for (int k = 0; k < test_count(50); ++k) {
    std::mt19937_64 random = test_generator(static_cast<std::uint64_t>(k));
    std::vector<Polygon> all;
    for (int j = 0; j < 12; ++j) add_rings(all, Vec2(2.5 * j, j), 1, random);
    sort_by_size(all);
    EXPECT_EQ(rollfix::outline::nesting_depths(all), one_by_one(all)) << k;
  }
}

TEST(Nesting, of_polygons_that_cross_is_one_deeper_than_the_smallest_around_the_first_point) {
  const std::vector<Polygon> all = {ring({0, 0}, 10, 16, 0), ring({0, 0}, 4, 16, 0), ring({4, 0}, 1, 16, 0),
                                    ring({-4, 0}, 1, 16, 0)};
  EXPECT_THAT(rollfix::outline::nesting_depths(all), ElementsAre(0, 1, 1, 2));
}

TEST(Nesting, of_rings_in_rings_is_found_without_asking_each_of_each) {
  constexpr int kRings = 20'000;
  std::vector<Polygon> all;
  for (int k = 0; k < kRings; ++k) all.push_back(ring({0, 0}, kRings - k, 16, 0));
  const std::vector<int> depths = rollfix::outline::nesting_depths(all);
  for (int k = 0; k < kRings; ++k) ASSERT_EQ(depths[static_cast<std::size_t>(k)], k);
}

}  // namespace
}  // namespace loops_test
