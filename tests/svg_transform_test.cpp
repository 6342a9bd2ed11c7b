// Transformations in an SVG file.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "svg_helpers.hpp"

namespace svg_transform_test {
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
using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pointwise;
using testing::SizeIs;

/// Where a transformation takes the point (x, y), with y down again.
Vec2 image(const std::string& transform, double x, double y) {
  const Vec2 end = drawn(fmt::format("<g transform='{}'><path d='M{} {} L 1000 777'/></g>", transform, x, y))
                       .curves.at(0)
                       .curve.front();
  return {end.x(), -end.y()};
}

void expect_near(const Vec2& found, const Vec2& expected, double slack = 1e-14) {
  EXPECT_NEAR((found - expected).norm(), 0, slack) << found.transpose() << " instead of " << expected.transpose();
}

TEST(SvgTransform, each_function_does_what_it_says) {
  expect_near(image("translate(10 20)", 1, 2), {11, 22});
  expect_near(image("translate(10)", 1, 2), {11, 2});
  expect_near(image("scale(2)", 1, 2), {2, 4});
  expect_near(image("scale(2, 3)", 1, 2), {2, 6});
  expect_near(image("rotate(90)", 1, 2), {-2, 1}, 0);
  expect_near(image("rotate(30)", 2, 0), {std::sqrt(3), 1}, 1e-15);
  expect_near(image("rotate(-90 5 5)", 5, 6), {6, 5});
  expect_near(image("rotate(180)", 1, 2), {-1, -2}, 0);
  expect_near(image("rotate(450)", 1, 2), {-2, 1}, 0);
  expect_near(image("skewX(45)", 1, 2), {3, 2});
  expect_near(image("skewY(45)", 1, 2), {1, 3});
  expect_near(image("matrix(1 2 3 4 5 6)", 7, 8), {7 + 24 + 5, 14 + 32 + 6});
}

TEST(SvgTransform, the_last_of_a_list_comes_first) {
  expect_near(image("translate(10,0) scale(2)", 1, 2), {12, 4});
  expect_near(image("scale(2),translate(10,0)", 1, 2), {22, 4});
  expect_near(image(" scale( 2 )\n translate (10 , 0 ) ", 1, 2), {22, 4});
  expect_near(image("", 1, 2), {1, 2});
}

TEST(SvgTransform, of_groups_are_around_those_inside) {
  const Drawing drawing = drawn(
      "<g transform='translate(10 0)'><a><g transform='scale(2)'>"
      "<path transform='translate(1 0)' d='M0 0h1'/></g></a></g>");
  EXPECT_EQ(joints(drawing), points({{12, 0}, {14, 0}}));
}

TEST(SvgTransform, arcs_stay_arcs_where_circles_stay_round) {
  const Drawing drawing = drawn("<circle transform='translate(3 4) rotate(37) scale(2)' r='5'/>");
  EXPECT_THAT(kinds(drawing), ElementsAre("arc"));
  EXPECT_THAT(numbers(drawing), Pointwise(DoubleNear(1e-14), std::vector<double>{3, -4, 10, -37 * pi / 180, -2 * pi}));
  const Drawing mirrored = drawn("<circle transform='scale(-1 1)' r='5'/>");
  EXPECT_THAT(numbers(mirrored), Pointwise(DoubleNear(1e-14), std::vector<double>{0, 0, 5, -pi, 2 * pi}));
}

TEST(SvgTransform, others_make_exact_elliptic_arcs) {
  const Drawing drawing = drawn("<circle transform='scale(3 2)' r='5'/>");
  EXPECT_THAT(kinds(drawing), ElementsAre("elliptic-arc"));
  EXPECT_NEAR(length_of(drawing), ellipse_length(15, 10), 1e-9);
  EXPECT_NEAR(area_of(drawn("<circle transform='skewX(30) rotate(20)' r='5'/>")), -25 * pi, 1e-11);
  EXPECT_THAT(kinds(drawn("<ellipse transform='scale(2 3)' rx='3' ry='2'/>")), ElementsAre("arc"));
}

TEST(SvgTransform, part_of_an_arc_keeps_its_ends) {
  const Drawing drawing = drawn("<path transform='matrix(1 .5 -.3 2 7 8)' d='M1 2 A 5 3 20 1 0 4 -2'/>");
  const Vec2 from(1 - 0.6 + 7, 0.5 + 4 + 8), to(4 + 0.6 + 7, 2 - 4 + 8);
  expect_near(drawing.curves.at(0).curve.front(), {from.x(), -from.y()});
  expect_near(drawing.curves.at(0).curve.back(), {to.x(), -to.y()});
}

TEST(SvgTransform, singular_ones_leave_the_element_out) {
  const Drawing drawing = drawn(
      "<circle r='1'/>\n<circle r='5' transform='scale(1 0)'/><g transform='matrix(1 2 2 4 0 0)'>"
      "<path d='M0 0h1'/></g>");
  EXPECT_THAT(drawing.curves, SizeIs(1));
  EXPECT_THAT(drawing.notes,
              ElementsAre("left out: 2 elements that singular transforms make flat, the first on line 2"));
}

TEST(SvgTransform, nonsense_is_refused) {
  const auto message = [](const std::string& transform) {
    return message_of(svg("<g transform='" + transform + "'/>"));
  };
  EXPECT_THAT(message("turn(5)"), HasSubstr("expected matrix, translate, scale, rotate, skewX or skewY, found 'turn'"));
  EXPECT_THAT(message("scale"), HasSubstr("expected '(', found the end"));
  EXPECT_THAT(message("scale(1"), HasSubstr("expected a number, found the end"));
  EXPECT_THAT(message("scale(1,)"), HasSubstr("expected a number, found ')'"));
  EXPECT_THAT(message("scale()"), HasSubstr("scale takes 1 or 2 numbers, found 0"));
  EXPECT_THAT(message("scale(1 2 3)"), HasSubstr("scale takes 1 or 2 numbers, found 3"));
  EXPECT_THAT(message("rotate(1 2)"), HasSubstr("rotate takes 1 or 3 numbers, found 2"));
  EXPECT_THAT(message("matrix(1 2 3 4 5)"), HasSubstr("matrix takes 6 numbers, found 5"));
  EXPECT_THAT(message("matrix(1 2 3 4 5 6 7)"), HasSubstr("expected ')', found '7)'"));
  EXPECT_THAT(message("rotate(10deg)"), HasSubstr("expected a number, found 'deg)'"));
  EXPECT_THAT(message("; scale(1)"), HasSubstr("expected a transformation such as translate(1 2), found ';"));
}

TEST(SvgTransform, in_a_style_is_refused) {
  EXPECT_THAT(message_of(svg("\n<g style='fill:none; transform: scale(2)'/>")),
              HasSubstr("test.svg:2: the style has 'transform', which is read only as an attribute"));
  EXPECT_THAT(message_of(svg("<g transform-origin='5 5' transform='scale(2)'/>")), HasSubstr("transform-origin"));
  EXPECT_THAT(message_of(svg("", "transform='scale(2)'")), HasSubstr("the outermost element has a transform"));
}

}  // namespace
}  // namespace svg_transform_test
