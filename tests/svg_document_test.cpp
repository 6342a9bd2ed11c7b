// The page of an SVG file, and the units of its lengths.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "svg_helpers.hpp"

namespace svg_document_test {
namespace {

using rollfix::Drawing;
using std::numbers::pi;
using svg_test::drawn;
using svg_test::joints;
using svg_test::message_of;
using svg_test::numbers;
using svg_test::points;
using svg_test::svg;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pointwise;

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

}  // namespace
}  // namespace svg_document_test
