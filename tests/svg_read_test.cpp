// Groups, references and what is left out of an SVG file.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "svg_helpers.hpp"

namespace svg_read_test {
namespace {

using rollfix::Drawing;
using svg_test::drawn;
using svg_test::joints;
using svg_test::message_of;
using svg_test::points;
using svg_test::svg;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

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
}  // namespace svg_read_test
