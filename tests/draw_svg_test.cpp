// The SVG writer: short numbers, well-formed documents whatever the text, the same bytes for the same calls.
#include "rollfix/draw.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "draw_helpers.hpp"
#include "rollfix/error.hpp"

namespace draw_svg_test {
namespace {

using draw_test::nesting_error;
using rollfix::Svg;
using rollfix::Vec2;
using testing::HasSubstr;

rollfix::Paint red() {
  rollfix::Paint paint;
  paint.stroke = "#ff0000";
  return paint;
}

TEST(Svg, prints_coordinates_to_a_hundredth_without_spare_digits) {
  Svg svg(100, 50);
  svg.polyline({Vec2(1.0 / 3, 2), Vec2(-0.001, 10.50)}, red());
  EXPECT_THAT(svg.str(), HasSubstr("d=\"M0.33 2L0 10.5\""));
}

TEST(Svg, refuses_a_coordinate_that_is_not_finite) {
  Svg svg(100, 50);
  EXPECT_THROW(svg.circle(Vec2(std::numeric_limits<double>::quiet_NaN(), 0), 1, red()), rollfix::InternalError);
  EXPECT_THROW(svg.circle(Vec2(0, 0), std::numeric_limits<double>::infinity(), red()), rollfix::InternalError);
}

TEST(Svg, refuses_a_page_without_area) { EXPECT_THROW(Svg(0, 10), rollfix::InternalError); }

TEST(Svg, closes_every_group_that_was_left_open) {
  Svg svg(100, 50);
  svg.open_group("outer");
  svg.open_clip(0, 0, 10, 10);
  EXPECT_EQ(nesting_error(svg.str()), "");
}

TEST(Svg, refuses_to_close_what_is_not_open) {
  Svg svg(100, 50);
  EXPECT_THROW(svg.close_group(), rollfix::InternalError);
}

TEST(Svg, stays_well_formed_with_any_text) {
  Svg svg(100, 50);
  svg.describe("<b> & \"q\"");
  svg.text({0, 0}, {{"a < b & c > d \"e\" 'f'"}, {"sub<", false, false, true}});
  EXPECT_EQ(nesting_error(svg.str()), "");
  EXPECT_THAT(svg.str(), HasSubstr("a &lt; b &amp; c &gt; d &quot;e&quot;"));
}

TEST(Svg, replaces_control_characters_and_broken_utf8) {
  const std::string replacement = "\xef\xbf\xbd";
  EXPECT_EQ(rollfix::escape_xml("tab\tnul\x01!"), "tab nul !");
  EXPECT_EQ(rollfix::escape_xml("\xff"), replacement);
  EXPECT_EQ(rollfix::escape_xml("caf\xc3\xa9"), "caf\xc3\xa9");
  EXPECT_EQ(rollfix::escape_xml("cut\xc3"), "cut" + replacement);                           // ends within a letter
  EXPECT_EQ(rollfix::escape_xml("\xc0\x80"), replacement + replacement);                    // overlong
  EXPECT_EQ(rollfix::escape_xml("\xed\xa0\x80"), replacement + replacement + replacement);  // surrogate
}

TEST(Svg, keeps_text_as_text_with_subscripts_lowered_and_raised_again) {
  Svg svg(100, 50);
  rollfix::TextStyle style;
  style.size = 10;
  svg.text({5, 5}, {{"a", true, false, false}, {"7", false, false, true}, {" = 1"}}, style);
  EXPECT_THAT(svg.str(), HasSubstr("<tspan font-style=\"italic\">a</tspan><tspan font-size=\"7.2\" dy=\"2.2\">7</tspan>"
                                   "<tspan dy=\"-2.2\"> = 1</tspan>"));
}

TEST(Svg, embeds_another_picture_whole) {
  Svg inner(10, 10), outer(100, 50);
  inner.open_group("left-open");
  inner.circle({5, 5}, 3, red());
  outer.embed(inner, 20, 0);
  EXPECT_EQ(nesting_error(outer.str()), "");
  EXPECT_THAT(outer.str(), HasSubstr("<svg x=\"20\" y=\"0\" width=\"10\" height=\"10\">"));
}

TEST(TextWidth, grows_with_size_and_shrinks_in_subscripts) {
  const double full = rollfix::text_width({{"mm"}}, 10);
  EXPECT_NEAR(full, 19.5, 0.5);  // an m is about an em wide
  EXPECT_DOUBLE_EQ(rollfix::text_width({{"mm"}}, 20), 2 * full);
  EXPECT_LT(rollfix::text_width({{"mm", false, false, true}}, 10), full);
  EXPECT_GT(rollfix::text_width({{"mm", false, true, false}}, 10), full);
}

}  // namespace
}  // namespace draw_svg_test
