// What an SVG file draws with elements of a shape.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <string>
#include <vector>

#include "svg_helpers.hpp"

namespace svg_shapes_test {
namespace {

using rollfix::Drawing;
using rollfix::Vec2;
using std::numbers::pi;
using svg_test::area_of;
using svg_test::drawn;
using svg_test::ellipse_length;
using svg_test::joints;
using svg_test::kinds;
using svg_test::length_of;
using svg_test::message_of;
using svg_test::numbers;
using svg_test::points;
using svg_test::svg;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pointwise;
using testing::SizeIs;

TEST(SvgShape, circle_is_a_full_turn_from_angle_zero) {
  const Drawing drawing = drawn("<circle cx='2' cy='3' r='5'/>");
  EXPECT_THAT(kinds(drawing), ElementsAre("arc"));
  EXPECT_THAT(numbers(drawing), ElementsAre(2, -3, 5, 0, -2 * pi));
  EXPECT_EQ(drawing.curves[0].origin.entity, "circle");
}

TEST(SvgShape, ellipse_has_its_axes) {
  const Drawing drawing = drawn("<ellipse cx='2' cy='3' rx='5' ry='4'/>");
  EXPECT_THAT(kinds(drawing), ElementsAre("elliptic-arc"));
  EXPECT_EQ(drawing.curves[0].curve.front(), Vec2(7, -3));
  EXPECT_NEAR(length_of(drawing), ellipse_length(5, 4), 1e-10);
  EXPECT_NEAR(area_of(drawing), -20 * pi, 1e-12);  // SVG draws it clockwise
  EXPECT_THAT(numbers(drawn("<ellipse rx='3'/>")), ElementsAre(0, 0, 3, 0, -2 * pi));
  EXPECT_THAT(numbers(drawn("<ellipse rx='auto' ry='3'/>")), ElementsAre(0, 0, 3, 0, -2 * pi));
}

TEST(SvgShape, rect_starts_at_its_corner) {
  const Drawing drawing = drawn("<rect x='1' y='2' width='3' height='4'/>");
  EXPECT_EQ(joints(drawing), points({{1, -2}, {4, -2}, {4, -6}, {1, -6}, {1, -2}}));
  EXPECT_THAT(kinds(drawing), ElementsAre("line", "line", "line", "line"));
}

TEST(SvgShape, rounded_rect_has_its_perimeter_and_area) {
  const Drawing drawing = drawn("<rect x='1' y='2' width='30' height='20' rx='4'/>");
  EXPECT_THAT(kinds(drawing), ElementsAre("line", "arc", "line", "arc", "line", "arc", "line", "arc"));
  EXPECT_NEAR(length_of(drawing), 2 * (22 + 12) + 8 * pi, 1e-12);
  EXPECT_NEAR(area_of(drawing), -(600 - (4 - pi) * 16), 1e-11);
  EXPECT_EQ(drawing.curves[0].curve.front(), Vec2(5, -2));
  EXPECT_EQ(joints(drawing), joints(drawn("<rect x='1' y='2' width='30' height='20' ry='4'/>")));
  EXPECT_EQ(joints(drawing), joints(drawn("<rect x='1' y='2' width='30' height='20' rx='auto' ry='4'/>")));
}

TEST(SvgShape, rect_with_two_radii_has_elliptic_corners) {
  const Drawing drawing = drawn("<rect width='30' height='20' rx='4' ry='2'/>");
  EXPECT_THAT(kinds(drawing)[1], "elliptic-arc");
  EXPECT_NEAR(area_of(drawing), -(600 - (4 - pi) * 8), 1e-11);
  EXPECT_NEAR(length_of(drawing), 2 * (22 + 16) + ellipse_length(4, 2), 1e-10);
}

TEST(SvgShape, radii_of_a_rect_are_at_most_half_of_it) {
  const Drawing drawing = drawn("<rect width='30' height='20' rx='40'/>");
  EXPECT_THAT(kinds(drawing), Pointwise(testing::Eq(), std::vector<std::string>(4, "elliptic-arc")));
  EXPECT_NEAR(area_of(drawing), -pi * 15 * 10, 1e-11);
  EXPECT_THAT(drawing.notes, IsEmpty());
  EXPECT_THAT(kinds(drawn("<rect width='30' height='20' ry='10' rx='0'/>")), SizeIs(4));
  EXPECT_THAT(kinds(drawn("<rect width='30' height='20' rx='10'/>")), SizeIs(6));  // a stadium
}

TEST(SvgShape, line_polyline_and_polygon) {
  EXPECT_EQ(joints(drawn("<line x1='1' y1='2' x2='3'/>")), points({{1, -2}, {3, 0}}));
  EXPECT_EQ(joints(drawn("<polyline points='0,0 1,0 1,1'/>")), points({{0, 0}, {1, 0}, {1, -1}}));
  EXPECT_EQ(joints(drawn("<polygon points='0 0,1 0-1-1'/>")), points({{0, 0}, {1, 0}, {-1, 1}, {0, 0}}));
}

TEST(SvgShape, without_size_is_left_out_and_counted) {
  for (const char* empty : {"<circle r='0'/>", "<circle/>", "<rect width='5'/>", "<rect width='0' height='3'/>",
                            "<ellipse rx='5' ry='0'/>", "<polyline points='1 2'/>", "<polygon/>", "<path/>"}) {
    EXPECT_THAT(drawn(empty).notes, ElementsAre("left out: 1 element without a size")) << empty;
    EXPECT_THAT(drawn(empty).curves, IsEmpty()) << empty;
  }
}

TEST(SvgShape, of_a_size_below_0_is_left_out_with_its_line_and_the_rest_is_drawn) {
  for (const char* absurd : {"<circle r='-1'/>", "<rect width='2' height='-3'/>",
                             "<rect width='2' height='3' rx='-1'/>", "<ellipse rx='-2' ry='1'/>"}) {
    const rollfix::Drawing drawing = drawn(std::string("\n") + absurd + "<path d='M0 0h1'/>");
    EXPECT_THAT(drawing.notes, ElementsAre("left out: 1 element of a size below 0, the first on line 2")) << absurd;
    EXPECT_EQ(drawing.curves.size(), 1U) << absurd;
  }
}

TEST(SvgShape, bad_attributes_are_refused) {
  EXPECT_THAT(message_of(svg("<circle r='big'/>")), HasSubstr("expected a length such as 12 or 12mm, found 'big'"));
  EXPECT_THAT(message_of(svg("<circle r='1 2'/>")), HasSubstr("expected a length such as 12 or 12mm, found '2'"));
  EXPECT_THAT(message_of(svg("<circle r='2em'/>")), HasSubstr("found '2em'"));
  EXPECT_THAT(message_of(svg("<circle r='1e999'/>")), HasSubstr("'1e999' is too large"));
  EXPECT_THAT(message_of(svg("<polyline points='1 2 3'/>")), HasSubstr("second number of a point, found the end"));
  EXPECT_THAT(message_of(svg("<polygon points='1 2 x'/>")), HasSubstr("expected a number, found 'x'"));
  EXPECT_THAT(message_of(svg("<rect width='50%' height='5'/>")), HasSubstr("'50%' is a share of a page"));
}

}  // namespace
}  // namespace svg_shapes_test
