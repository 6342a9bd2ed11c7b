// The `d` attribute: commands, numbers, arcs; and what its curves become.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "svg_helpers.hpp"

namespace svg_path_test {
namespace {

using rollfix::Vec2;
using std::numbers::pi;
using svg_test::area_of;
using svg_test::drawn;
using svg_test::joints;
using svg_test::kinds;
using svg_test::length_of;
using svg_test::message_of_path;
using svg_test::path;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// Points written with y up.
std::vector<Vec2> points(std::initializer_list<Vec2> list) { return list; }

TEST(SvgPath, lines_absolute_and_relative) {
  EXPECT_EQ(joints(path("M 1 2 L 3 5 l 1 1")), points({{1, -2}, {3, -5}, {4, -6}}));
  EXPECT_EQ(joints(path("m 1 2 h 3 v 4 H 0 V 1")), points({{1, -2}, {4, -2}, {4, -6}, {0, -6}, {0, -1}}));
  EXPECT_THAT(kinds(path("M1 2L3 5")), ElementsAre("line"));
}

TEST(SvgPath, commands_repeat_and_further_points_of_a_move_are_lines) {
  EXPECT_EQ(joints(path("M1 2 3 5 4 6")), joints(path("M 1 2 L 3 5 L 4 6")));
  EXPECT_EQ(joints(path("m1 2 3 5 4 6")), joints(path("M 1 2 l 3 5 l 4 6")));
  EXPECT_EQ(joints(path("M0 0h1 2v1 2")), points({{0, 0}, {1, 0}, {3, 0}, {3, -1}, {3, -3}}));
  EXPECT_THAT(path("M0 0 C 1 0 2 1 2 2 3 3 4 3 5 4").curves, SizeIs(2));
  EXPECT_THAT(path("M0 0 A 1 1 0 0 1 2 0 1 1 0 0 1 4 0").curves, SizeIs(2));
}

TEST(SvgPath, numbers_need_nothing_between_them_where_it_is_clear) {
  EXPECT_EQ(joints(path("M1.5.5-3-.5")), points({{1.5, -0.5}, {-3, 0.5}}));
  EXPECT_EQ(joints(path("M1e-1-2E1L+3e+0,4")), points({{0.1, 20}, {3, -4}}));
  EXPECT_EQ(joints(path("M1,2,3,4")), points({{1, -2}, {3, -4}}));
  EXPECT_EQ(joints(path(" M\n1\t,\r\n2 L 3 , 4 ")), points({{1, -2}, {3, -4}}));
  EXPECT_EQ(joints(path("M0 0L1. 2.")), points({{0, 0}, {1, -2}}));
}

TEST(SvgPath, flags_of_arcs_need_nothing_behind_them) {
  EXPECT_EQ(joints(path("M0 0a1 1 0 01.5 1")), joints(path("M 0 0 a 1 1 0 0 1 .5 1")));
  EXPECT_EQ(joints(path("M0 0a1 1 0 1110 10")), joints(path("M 0 0 a 1 1 0 1 1 10 10")));
  EXPECT_EQ(joints(path("M0 0a1,1,0,0,0-1-1")), joints(path("M 0 0 a 1 1 0 0 0 -1 -1")));
}

TEST(SvgPath, cubic_has_its_control_points) {
  const auto record = path("M 1 2 C 3 4 5 7 7 8").curves.at(0).curve.record();
  EXPECT_EQ(record->kind, "bezier");
  EXPECT_THAT(record->numbers, ElementsAre(1, -2, 3, -4, 5, -7, 7, -8));
  EXPECT_EQ(path("M 1 2 c 2 2 4 5 6 6").curves.at(0).curve.record()->numbers, record->numbers);
}

TEST(SvgPath, smooth_cubic_reflects_the_control_point_of_a_cubic_only) {
  EXPECT_THAT(path("M0 0 C 1 1 2 2 4 0 S 7 1 8 0").curves.at(1).curve.record()->numbers,
              ElementsAre(4, 0, 6, 2, 7, -1, 8, 0));
  EXPECT_THAT(path("M0 0 C 1 1 2 2 4 0 s 3 1 4 0").curves.at(1).curve.record()->numbers,
              ElementsAre(4, 0, 6, 2, 7, -1, 8, 0));
  // Behind a line the first control point is the pen's place: at rest.
  const auto record = path("M0 0 L 4 0 S 7 1 8 0").curves.at(1).curve.record();
  EXPECT_EQ(record->kind, "bezier-from-rest");
  EXPECT_THAT(record->numbers, ElementsAre(4, 0, 4, 0, 7, -1, 8, 0));
  EXPECT_EQ(path("M0 0 Q 1 1 4 0 S 7 1 8 0").curves.at(1).curve.record()->kind, "bezier-from-rest");
}

TEST(SvgPath, quadratic_and_its_smooth_continuations) {
  const auto drawing = path("M0 0 Q 1 2 2 0 T 4 0 t 2 0");
  EXPECT_THAT(drawing.curves.at(0).curve.record()->numbers, ElementsAre(0, 0, 1, -2, 2, 0));
  EXPECT_THAT(drawing.curves.at(1).curve.record()->numbers, ElementsAre(2, 0, 3, 2, 4, 0));
  EXPECT_THAT(drawing.curves.at(2).curve.record()->numbers, ElementsAre(4, 0, 5, -2, 6, 0));
  EXPECT_THAT(path("M0 0 q 1 2 2 0").curves.at(0).curve.record()->numbers, ElementsAre(0, 0, 1, -2, 2, 0));
  // Behind anything else T's control point is the pen's place, which makes a line.
  EXPECT_THAT(kinds(path("M0 0 L 2 0 T 4 1")), ElementsAre("line", "line"));
  EXPECT_THAT(kinds(path("M0 0 C 1 1 2 2 2 0 T 4 1")), ElementsAre("bezier", "line"));
}

TEST(SvgPath, area_under_a_parabola_is_two_thirds) {
  EXPECT_NEAR(area_of(path("M0 0 Q 1 2 2 0 Z")), 2 * 2.0 / 3 * 1, 1e-14);  // counter-clockwise on the screen
  EXPECT_NEAR(area_of(path("M2 0 Q 1 2 0 0 Z")), -4.0 / 3, 1e-14);
}

TEST(SvgPath, close_returns_by_a_line_where_there_is_a_way) {
  EXPECT_EQ(joints(path("M1 1 L 3 1 L 3 4 Z")), points({{1, -1}, {3, -1}, {3, -4}, {1, -1}}));
  EXPECT_EQ(joints(path("M1 1 L 3 1 L 3 4 z")), points({{1, -1}, {3, -1}, {3, -4}, {1, -1}}));
  EXPECT_THAT(path("M1 1 L 3 1 L 3 4 L 1 1 Z").curves, SizeIs(3));
  EXPECT_THAT(path("M1 1 L 3 1 L 3 4 L 1 1 Z").notes, IsEmpty());
}

TEST(SvgPath, close_within_rounding_closes_exactly) {
  const auto drawing = path("M1 1 L 3 1 L 3 4 L 1 1.000000001 Z");
  ASSERT_THAT(drawing.curves, SizeIs(3));
  EXPECT_EQ(drawing.curves.back().curve.back(), drawing.curves.front().curve.front());
  EXPECT_THAT(path("M1 1 L 3 1 L 3 4 L 1 1.00000001 Z").curves, SizeIs(4));
}

TEST(SvgPath, what_follows_a_close_starts_at_its_start) {
  EXPECT_EQ(joints(path("M1 1 h 2 v 2 z h -1")), points({{1, -1}, {3, -1}, {3, -3}, {1, -1}, {0, -1}}));
  EXPECT_EQ(joints(path("M1 1 h 2 v 2 z l 5 5 0 1 z m 1 0 h 1")),
            points({{1, -1}, {3, -1}, {3, -3}, {1, -1}, {6, -6}, {6, -7}, {1, -1}, {2, -1}, {3, -1}}));
}

TEST(SvgPath, arc_of_a_circle_is_one) {
  // A quarter from (1, 0) to (0, 1), y down: counter-clockwise for numbers, clockwise on the screen.
  const auto drawing = path("M 1 0 A 1 1 0 0 1 0 1");
  ASSERT_THAT(kinds(drawing), ElementsAre("arc"));
  const auto numbers = drawing.curves[0].curve.record()->numbers;
  EXPECT_THAT(numbers, testing::Pointwise(testing::DoubleNear(1e-15), std::vector<double>{0, 0, 1, 0, -pi / 2}));
}

TEST(SvgPath, four_flags_give_the_four_arcs) {
  // Between (0, 0) and (6, 0) with radius 5 the centres are 4 away from the chord.
  const double shorter = 10 * std::asin(0.6), longer = 10 * pi - shorter;
  const double cap = 25 * std::asin(0.6) - 12, rest = 25 * pi - cap;
  const auto length = [](const char* flags) {
    return length_of(path("M0 0 A 5 5 0 " + std::string(flags) + " 6 0 Z")) - 6;
  };
  const auto area = [](const char* flags) { return area_of(path("M0 0 A 5 5 0 " + std::string(flags) + " 6 0 Z")); };
  EXPECT_NEAR(length("0 0"), shorter, 1e-12);
  EXPECT_NEAR(length("0 1"), shorter, 1e-12);
  EXPECT_NEAR(length("1 0"), longer, 1e-12);
  EXPECT_NEAR(length("1 1"), longer, 1e-12);
  EXPECT_NEAR(area("0 0"), cap, 1e-12);  // bulges down and comes back to the left: counter-clockwise on the screen
  EXPECT_NEAR(area("0 1"), -cap, 1e-12);
  EXPECT_NEAR(area("1 0"), rest, 1e-12);
  EXPECT_NEAR(area("1 1"), -rest, 1e-12);
}

TEST(SvgPath, arc_that_cannot_reach_grows) {
  const auto drawing = path("M 0 0 A 1 1 0 0 1 10 0");
  ASSERT_THAT(kinds(drawing), ElementsAre("arc"));
  EXPECT_NEAR(length_of(drawing), 5 * pi, 1e-13);
  // Both radii grow alike.
  EXPECT_NEAR(area_of(path("M 0 0 A 1 2 0 0 0 10 0 Z")), pi * 5 * 10 / 2, 1e-12);
}

TEST(SvgPath, arc_with_a_radius_of_zero_is_a_line_and_with_equal_ends_nothing) {
  EXPECT_THAT(kinds(path("M 0 0 A 0 5 0 0 1 10 0")), ElementsAre("line"));
  EXPECT_THAT(kinds(path("M 0 0 A 5 0 0 0 1 10 0")), ElementsAre("line"));
  const auto nothing = path("M 0 0 A 5 5 0 1 1 0 0 L 1 1");
  EXPECT_THAT(kinds(nothing), ElementsAre("line"));
  EXPECT_THAT(nothing.notes, ElementsAre("left out: 1 segment without length"));
}

TEST(SvgPath, radius_below_zero_counts_as_its_size) {
  EXPECT_EQ(joints(path("M 0 0 A -5 -5 0 0 1 6 0")), joints(path("M 0 0 A 5 5 0 0 1 6 0")));
}

TEST(SvgPath, turned_ellipse_has_its_area_and_its_ends) {
  // Half of an ellipse with half axes 3 and 2, turned by 30 degrees, between the ends of its long axis.
  const double c = 3 * std::cos(pi / 6), s = 3 * std::sin(pi / 6);
  const auto drawing = path(fmt::format("M {} {} A 3 2 30 0 0 {} {} Z", -c, -s, c, s));
  EXPECT_THAT(kinds(drawing), ElementsAre("elliptic-arc", "line"));
  EXPECT_NEAR(area_of(drawing), 3 * pi, 1e-12);
  EXPECT_NEAR((drawing.curves[0].curve.front() - Vec2(-c, s)).norm(), 0, 1e-15);
  EXPECT_NEAR((drawing.curves[0].curve.back() - Vec2(c, -s)).norm(), 0, 1e-14);
}

TEST(SvgPath, handle_that_is_pulled_in_is_taken) {
  // x = 6 u^2 (1 - u) + 4 u^3, y = 4 u^3 (y down), and back by a line.
  const auto drawing = path("M0 0 C 0 0 2 0 4 4 Z");
  EXPECT_THAT(kinds(drawing), ElementsAre("bezier-from-rest", "line"));
  // Integral of (x dy - y dx) / 2 with x = 6u^2 - 2u^3, y = -4u^3: -12 u^4 (6 - 2u)/2 + 4 u^4 (12 - 6u)/2.
  EXPECT_NEAR(area_of(drawing), -36.0 / 5 + 2 + 24.0 / 5 - 2, 1e-12);
  EXPECT_THAT(kinds(path("M0 0 C 0 0 4 4 4 4")), ElementsAre("line"));
  EXPECT_THAT(kinds(path("M0 0 C 1 3 4 4 4 4")), ElementsAre("bezier-to-rest"));
}

TEST(SvgPath, segments_without_length_are_left_out_and_counted) {
  const auto drawing = path("M0 0 L 0 0 L 5 0 C 5 0 5 0 5 0 L 5 5 l 0 0 Z");
  EXPECT_EQ(joints(drawing), points({{0, 0}, {5, 0}, {5, -5}, {0, 0}}));
  EXPECT_THAT(drawing.notes, ElementsAre("left out: 3 segments without length"));
}

TEST(SvgPath, empty_paths_draw_nothing) {
  for (const char* data : {"", " ", "M 1 2", "M 1 2 z", "none", "M1 2 M 3 4"}) {
    EXPECT_THAT(path(data).curves, IsEmpty()) << data;
    EXPECT_THAT(path(data).notes, ElementsAre("left out: 1 element without a size")) << data;
  }
}

TEST(SvgPath, curves_follow_the_file) {
  const auto drawing = drawn("<path id='a' d='M0 0h1'/>\n<path id='b' d='M2 0h1M4 0h1'/>");
  ASSERT_THAT(drawing.curves, SizeIs(3));
  EXPECT_EQ(drawing.curves[0].origin.layer, "a");
  EXPECT_EQ(drawing.curves[2].origin.layer, "b");
  EXPECT_EQ(drawing.curves[2].origin.entity, "path");
  EXPECT_EQ(drawing.curves[0].origin.line, 1U);
  EXPECT_EQ(drawing.curves[2].origin.line, 2U);
}

TEST(SvgPath, nonsense_is_refused_with_the_place) {
  EXPECT_THAT(message_of_path("M 0 0 X 1"), HasSubstr("one of MmLlHhVvCcSsQqTtAaZz, found 'X 1'"));
  EXPECT_THAT(message_of_path("L 0 0"), HasSubstr("begins with M or m, found 'L 0 0'"));
  EXPECT_THAT(message_of_path("5 5"), HasSubstr("expected a path command"));
  EXPECT_THAT(message_of_path("M 0"), HasSubstr("expected a number, found the end"));
  EXPECT_THAT(message_of_path("M 0 0 L"), HasSubstr("expected a number, found the end"));
  EXPECT_THAT(message_of_path("M 0 0 L 1 two"), HasSubstr("expected a number, found 'two'"));
  EXPECT_THAT(message_of_path("M 0 0 L 1 2,"), HasSubstr("expected a number after the comma, found the end"));
  EXPECT_THAT(message_of_path("M 0 0 L 1,,2"), HasSubstr("expected a number, found ',2'"));
  EXPECT_THAT(message_of_path("M 0 0 A 1 1 0 2 0 3 3"), HasSubstr("expected an arc's flag, 0 or 1, found '2 0 3 3'"));
  EXPECT_THAT(message_of_path("M 0 0 A 1 1 0 0.5 0 3 3"), HasSubstr("expected an arc's flag"));
  EXPECT_THAT(message_of_path("M 0 0 C 1 1 2 2"), HasSubstr("expected a number, found the end"));
  EXPECT_THAT(message_of_path("M 0 0 L nan 2"), HasSubstr("expected a number, found 'nan 2'"));
  EXPECT_THAT(message_of_path("M 0 0 L inf 2"), HasSubstr("expected a number, found 'inf 2'"));
  EXPECT_THAT(message_of_path("M 0 0 L - 2"), HasSubstr("expected a number, found '- 2'"));
  EXPECT_THAT(message_of_path("M 0 0 Z 5 5"), HasSubstr("expected a path command"));
  EXPECT_THAT(message_of_path("M 0 0 L 1 1e400"), HasSubstr("the number '1e400' is too large"));
  EXPECT_THAT(message_of_path("M 0 0 L 1 1e76"), HasSubstr("coordinate beyond 1e+75"));
  EXPECT_THAT(message_of_path("M 0 0 l 1 1e308 1 1e308"), HasSubstr("coordinate beyond 1e+75"));
  EXPECT_THAT(message_of_path("M 0 0 \n L 1 two"), HasSubstr("test.svg:2: "));
  EXPECT_THAT(svg_test::message_of(svg_test::svg("\n<path\n d='M 0 0\n\n L 1 two'/>")), HasSubstr("test.svg:5: "));
}

}  // namespace
}  // namespace svg_path_test
