// Elements, transformations, units, references, and what is left out of an SVG file.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/math/special_functions/ellint_2.hpp>
#include <cmath>
#include <numbers>
#include <string>

#include "svg_helpers.hpp"

namespace svg_elements_test {
namespace {

using rollfix::Drawing;
using rollfix::Vec2;
using std::numbers::pi;
using svg_test::area_of;
using svg_test::drawn;
using svg_test::joints;
using svg_test::kinds;
using svg_test::length_of;
using svg_test::message_of;
using svg_test::svg;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pointwise;
using testing::SizeIs;

std::vector<Vec2> points(std::initializer_list<Vec2> list) { return list; }

std::vector<double> numbers(const Drawing& drawing, std::size_t k = 0) {
  return drawing.curves.at(k).curve.record()->numbers;
}

double ellipse_length(double a, double b) { return 4 * a * boost::math::ellint_2(std::sqrt(1 - b * b / (a * a))); }

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

// ---- shapes

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

// ---- units

TEST(SvgUnits, lengths_have_units_of_the_world) {
  const double inch = 96;
  const auto radius = [](const std::string& r) { return numbers(drawn("<circle r='" + r + "'/>")).at(2); };
  EXPECT_NEAR(radius("1in"), inch, 1e-13);
  EXPECT_NEAR(radius("25.4mm"), inch, 1e-13);
  EXPECT_NEAR(radius("2.54cm"), inch, 1e-13);
  EXPECT_NEAR(radius("72pt"), inch, 1e-13);
  EXPECT_NEAR(radius("6pc"), inch, 1e-13);
  EXPECT_NEAR(radius("101.6Q"), inch, 1e-13);
  EXPECT_EQ(radius("96px"), inch);
  EXPECT_EQ(radius(" 96 "), inch);
}

TEST(SvgUnits, percentages_are_of_the_page) {
  EXPECT_EQ(joints(drawn("<rect x='10%' y='10%' width='50%' height='50%'/>", "viewBox='0 0 200 100'")),
            points({{20, -10}, {120, -10}, {120, -60}, {20, -60}, {20, -10}}));
  EXPECT_NEAR(numbers(drawn("<circle r='50%'/>", "width='300' height='400'")).at(2), std::sqrt(62500 * 2) / 2, 1e-12);
}

TEST(SvgUnits, physical_page_with_a_view_box_gives_millimetres) {
  const Drawing drawing =
      drawn("<circle cx='10' cy='20' r='5'/>", "width='210mm' height='29.7cm' viewBox='0 0 420 594'");
  EXPECT_EQ(drawing.unit, "mm");
  EXPECT_THAT(numbers(drawing), Pointwise(DoubleNear(1e-13), std::vector<double>{5, -10, 2.5, 0, -2 * pi}));
}

TEST(SvgUnits, origin_is_the_upper_left_corner_of_a_physical_page) {
  const Drawing drawing =
      drawn("<circle cx='10' cy='20' r='5'/>", "width='100mm' height='100mm' viewBox='10 20 50 50'");
  EXPECT_THAT(numbers(drawing), Pointwise(DoubleNear(1e-13), std::vector<double>{0, 0, 10, 0, -2 * pi}));
}

TEST(SvgUnits, one_physical_side_is_enough) {
  for (const char* page :
       {"width='200mm'", "height='100mm'", "width='200mm' height='100%'", "width='100%' height='100mm'"}) {
    const Drawing drawing = drawn("<circle r='5'/>", std::string(page) + " viewBox='0 0 100 50'");
    EXPECT_NEAR(numbers(drawing).at(2), 10, 1e-13) << page;
    EXPECT_EQ(drawing.unit, "mm");
  }
}

TEST(SvgUnits, without_physical_units_lengths_are_as_written) {
  for (const char* page : {"", "viewBox='5 5 10 10'", "width='200' height='100' viewBox='0 0 10 10'",
                           "width='200px' height='100px' viewBox='0 0 10 10'", "width='100%' viewBox='0 0 1 1'",
                           "width='210mm' height='297mm'", "width='10em' viewBox='0 0 1 1'"}) {
    const Drawing drawing = drawn("<circle cx='1' r='5'/>", page);
    EXPECT_THAT(numbers(drawing), ElementsAre(1, 0, 5, 0, -2 * pi)) << page;
    EXPECT_EQ(drawing.unit, "px") << page;
  }
}

TEST(SvgUnits, aspect_ratio_of_the_page_is_kept) {
  const auto circle = [](const std::string& aspect) {
    return numbers(drawn("<circle r='1'/>", "width='40mm' height='20mm' viewBox='0 0 10 10' " + aspect));
  };
  const auto is = [](const std::vector<double>& expected) { return Pointwise(DoubleNear(1e-13), expected); };
  EXPECT_THAT(circle(""), is({10, 0, 2, 0, -2 * pi}));
  EXPECT_THAT(circle("preserveAspectRatio='xMinYMin'"), is({0, 0, 2, 0, -2 * pi}));
  EXPECT_THAT(circle("preserveAspectRatio='xMaxYMax meet'"), is({20, 0, 2, 0, -2 * pi}));
  EXPECT_THAT(circle("preserveAspectRatio='xMinYMax slice'"), is({0, 20, 4, 0, -2 * pi}));
  EXPECT_THAT(circle("preserveAspectRatio='xMidYMid slice'"), is({0, 10, 4, 0, -2 * pi}));
  EXPECT_THAT(circle("preserveAspectRatio='none'"), is({0, 0, 4, 0, 0, -2, 0, 2 * pi}));
}

TEST(SvgUnits, bad_pages_are_refused) {
  EXPECT_THAT(message_of(svg("", "viewBox='0 0 10'")), HasSubstr("expected four numbers in a viewBox, found the end"));
  EXPECT_THAT(message_of(svg("", "viewBox='0 0 10 10 10'")),
              HasSubstr("expected four numbers in a viewBox, found '10'"));
  EXPECT_THAT(message_of(svg("", "viewBox='0 0 0 10'")), HasSubstr("a viewBox of a size above 0, found '0 0 0 10'"));
  EXPECT_THAT(message_of(svg("", "width='-5mm' viewBox='0 0 10 10'")), HasSubstr("a width above 0, found -5mm"));
  EXPECT_THAT(message_of(svg("", "width='5mm' viewBox='0 0 10 10' preserveAspectRatio='middle'")),
              HasSubstr("expected a preserveAspectRatio such as 'xMidYMid meet', found 'middle'"));
}

// ---- transformations

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

// ---- structure

TEST(SvgStructure, nested_viewports) {
  EXPECT_EQ(joints(drawn("<svg x='10' y='20'><path d='M0 0h1'/></svg>")), points({{10, -20}, {11, -20}}));
  EXPECT_EQ(joints(drawn("<svg x='10' width='40' height='20' viewBox='0 0 10 10'><path d='M0 0h1'/></svg>")),
            points({{20, 0}, {22, 0}}));
  EXPECT_EQ(joints(drawn("<svg viewBox='0 0 10 10'><path d='M0 0h1'/></svg>", "width='40' height='20'")),
            points({{10, 0}, {12, 0}}));
  EXPECT_EQ(joints(drawn("<svg width='50%' height='20'><line x2='100%'/></svg>", "width='40' height='20'")),
            points({{0, 0}, {20, 0}}));
  EXPECT_THAT(message_of(svg("<svg viewBox='0 0 10 10'/>")), HasSubstr("has a viewBox but no size"));
}

TEST(SvgStructure, use_draws_another_element_again) {
  const Drawing drawing = drawn(
      "<g transform='scale(2)'><path id='p' transform='translate(1 0)' d='M0 0h1'/></g>"
      "<use href='#p' x='10' y='5' transform='scale(3)'/>");
  EXPECT_EQ(joints(drawing), points({{2, 0}, {4, 0}, {33, -15}, {36, -15}}));
  EXPECT_EQ(joints(drawn("<defs><path id='p' d='M0 0h1'/></defs><use xlink:href='#p'/>")), points({{0, 0}, {1, 0}}));
  EXPECT_EQ(joints(drawn("<use href='#p'/><defs><g id='p'><path d='M0 0h1'/></g></defs>")), points({{0, 0}, {1, 0}}));
}

TEST(SvgStructure, symbols_are_drawn_by_use_with_a_viewport) {
  const std::string symbol = "<symbol id='s' viewBox='0 0 10 10'><path d='M0 0h1'/></symbol>";
  EXPECT_EQ(joints(drawn(symbol + "<use href='#s' x='5' width='20' height='20'/>")), points({{5, 0}, {7, 0}}));
  EXPECT_EQ(joints(drawn(symbol + "<use href='#s'/>", "viewBox='0 0 30 30'")), points({{0, 0}, {3, 0}}));
  EXPECT_THAT(drawn(symbol).curves, IsEmpty());
  EXPECT_EQ(joints(drawn("<symbol id='s'><path d='M0 0h1'/></symbol><use href='#s' x='5'/>")),
            points({{5, 0}, {6, 0}}));
}

TEST(SvgStructure, references_to_nothing_are_left_out_with_their_line) {
  const rollfix::Drawing drawing = drawn("\n<use href='#nothing'/><path d='M0 0h1'/><use href='#less'/>");
  EXPECT_THAT(drawing.notes, ElementsAre("left out: 2 <use> of what is not there, the first on line 2"));
  EXPECT_EQ(drawing.curves.size(), 1U);
}

TEST(SvgStructure, references_out_of_the_file_or_to_what_holds_them_are_refused) {
  EXPECT_THAT(message_of(svg("<use href='other.svg#a'/>")),
              HasSubstr("'other.svg#a', expected an element of this file"));
  EXPECT_THAT(message_of(svg("<g id='a'><use href='#a'/></g>")), HasSubstr("'#a', which holds this very reference"));
  EXPECT_THAT(message_of(svg("<use id='a' href='#a'/>")), HasSubstr("holds this very reference"));
  EXPECT_THAT(message_of(svg("<g id='a'><use href='#b'/></g><g id='b'><use href='#a'/></g>")),
              HasSubstr("holds this very reference"));
  EXPECT_THAT(message_of(svg("<use href='#root'/>", "id='root'")), HasSubstr("holds this very reference"));
  EXPECT_THAT(drawn("<use/>").notes, ElementsAre("left out: 1 <use> of what is not there, the first on line 1"));
}

TEST(SvgStructure, exploding_references_are_refused) {
  std::string bomb = "<path id='a0' d='M0 0h1'/>";
  for (int k = 1; k <= 12; ++k) {
    bomb += fmt::format("<g id='a{}'>", k);
    for (int copy = 0; copy < 10; ++copy) bomb += fmt::format("<use href='#a{}'/>", k - 1);
    bomb += "</g>";
  }
  EXPECT_THAT(message_of(svg("<defs>" + bomb + "</defs><use href='#a12'/>")),
              HasSubstr("<use> copies more than 1000000 elements"));
}

TEST(SvgStructure, references_to_long_paths_count_each_of_their_segments) {
  std::string path = "M0 0";
  for (int k = 0; k < 4000; ++k) path += "h1v1";
  std::string file = "<path id='a' d='" + path + "'/>";
  for (int k = 0; k < 200; ++k) file += "<use href='#a'/>";  // 1.6 million
  EXPECT_THAT(message_of(svg(file)), HasSubstr("<use> copies more than 1000000 elements and segments"));
}

TEST(SvgStructure, references_to_long_texts_count_what_is_read_again) {
  std::string file = "<path id='a' d='M0 0" + std::string(100'000, ' ') + "h1v1z'/>";
  for (int k = 0; k < 700; ++k) file += "<use href='#a'/>";
  EXPECT_THAT(message_of(svg(file)), HasSubstr("<use> copies more than 1000000 elements and segments"));
}

TEST(SvgStructure, deep_nesting_is_refused) {
  const auto nested = [](int depth) {
    std::string text;
    for (int k = 0; k < depth; ++k) text += "<g>";
    text += "<path d='M0 0h1'/>";
    for (int k = 0; k < depth; ++k) text += "</g>";
    return svg(text);
  };
  EXPECT_EQ(message_of(nested(149)), "no error");
  EXPECT_THAT(message_of(nested(150)), HasSubstr("elements are nested more than 150 deep"));
  EXPECT_THAT(message_of(nested(200000)), HasSubstr("elements are nested more than 150 deep"));
}

TEST(SvgStructure, switch_draws_its_first_child) {
  EXPECT_EQ(joints(drawn("<switch><desc/><path d='M0 0h1'/><path d='M0 0h2'/></switch>")), points({{0, 0}, {1, 0}}));
  EXPECT_EQ(joints(drawn(
                "<switch><foreignObject requiredExtensions='http://example.com'/><g><path d='M0 0h2'/></g></switch>")),
            points({{0, 0}, {2, 0}}));
}

TEST(SvgStructure, definitions_draw_nothing_where_they_stand) {
  for (const char* kind : {"defs", "symbol", "clipPath", "mask", "marker", "pattern", "linearGradient", "metadata"}) {
    const Drawing drawing = drawn(fmt::format("<{0}><path d='M0 0h1'/></{0}>", kind));
    EXPECT_THAT(drawing.curves, IsEmpty()) << kind;
    EXPECT_THAT(drawing.notes, IsEmpty()) << kind;
  }
}

TEST(SvgStructure, hidden_elements_are_left_out_and_counted) {
  for (const char* hidden :
       {"display='none'", "style='display:none'", "style='fill:red;display : none !important;'", "visibility='hidden'",
        "style='visibility:hidden'", "visibility='collapse'", "display='inline' style='display:none'"}) {
    const Drawing drawing = drawn(fmt::format("<path {} d='M0 0h1'/>", hidden));
    EXPECT_THAT(drawing.curves, IsEmpty()) << hidden;
    EXPECT_THAT(drawing.notes, ElementsAre("left out: 1 hidden element")) << hidden;
  }
  EXPECT_THAT(drawn("<path style='display:inline' display='none' d='M0 0h1'/>").curves, SizeIs(1));
}

TEST(SvgStructure, what_is_hidden_can_hold_what_is_visible_but_what_is_not_displayed_cannot) {
  EXPECT_THAT(drawn("<g visibility='hidden'><path visibility='visible' d='M0 0h1'/></g>").curves, SizeIs(1));
  EXPECT_THAT(drawn("<g visibility='hidden'><path d='M0 0h1'/></g>").curves, IsEmpty());
  EXPECT_THAT(drawn("<g display='none'><path display='inline' d='M0 0h1'/></g>").curves, IsEmpty());
}

TEST(SvgStructure, what_is_not_an_outline_is_left_out_by_name) {
  const Drawing drawing = drawn("<text>a</text><image/><g><text>b</text></g><path d='M0 0h1'/><blink/>");
  EXPECT_THAT(drawing.curves, SizeIs(1));
  EXPECT_THAT(drawing.notes, ElementsAre("left out: 1 blink, 1 image, 2 text"));
}

TEST(SvgStructure, clips_and_style_sheets_are_named) {
  const Drawing drawing = drawn(
      "<style>.a { display: none }</style><path clip-path='url(#c)' d='M0 0h1'/>"
      "<path style='mask:url(#m)' d='M0 0h1'/><path clip-path='none' d='M0 0h1'/>");
  EXPECT_THAT(drawing.notes,
              ElementsAre("drawn whole: 2 clipped elements", "not read: 1 style sheet that may hide or move elements"));
  EXPECT_THAT(drawn("<style>.a { fill: none }</style><path d='M0 0h1'/>").notes, IsEmpty());
}

TEST(SvgStructure, foreign_elements_are_no_part_of_the_drawing) {
  const Drawing drawing = drawn(
      "<x:path xmlns:x='http://example.com' d='M0 0h1'/>"
      "<path xmlns='http://example.com' d='M0 0h1'/><path d='M0 0h1'/>");
  EXPECT_THAT(drawing.curves, SizeIs(1));
}

TEST(SvgStructure, name_space_may_have_a_prefix) {
  const Drawing drawing = svg_test::parse(
      "<svg:svg xmlns:svg='http://www.w3.org/2000/svg'><svg:g><svg:path d='M0 0h1'/></svg:g></svg:svg>");
  EXPECT_THAT(drawing.curves, SizeIs(1));
  EXPECT_EQ(drawing.curves[0].origin.entity, "path");
}

}  // namespace
}  // namespace svg_elements_test
