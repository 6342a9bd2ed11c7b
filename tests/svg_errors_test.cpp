// Files that are no SVG, are broken, large, or written in an unusual way.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <random>
#include <sstream>
#include <string>

#include "paths.hpp"
#include "random.hpp"
#include "svg_helpers.hpp"

namespace svg_errors_test {
namespace {

using rollfix::Drawing;
using svg_test::message_of;
using svg_test::parse;
using svg_test::svg;
using testing::HasSubstr;
using testing::SizeIs;

const std::string kSquare = svg("<path d='M0 0h1v1h-1z'/>");

std::string utf16(const std::string& text, bool little) {
  std::string result = little ? "\xFF\xFE" : "\xFE\xFF";
  for (const char c : text) {
    if (little) result += c;
    result += '\0';
    if (!little) result += c;
  }
  return result;
}

TEST(SvgErrors, what_is_not_xml_is_refused_with_the_line) {
  EXPECT_THAT(message_of(""), HasSubstr("test.svg: holds no XML element, expected an SVG file"));
  EXPECT_THAT(message_of("hello"), HasSubstr("holds no XML element"));
  EXPECT_THAT(message_of("<svg>\n<path\n d='M0 0'\n<"), HasSubstr("test.svg:4: is not XML from here on"));
  EXPECT_THAT(message_of("<svg>\n<g>\n</svg>"), HasSubstr("test.svg:3: is not XML from here on"));
  EXPECT_THAT(message_of("<svg><g></g>"), HasSubstr("is not XML from here on"));
  EXPECT_THAT(message_of(kSquare + kSquare), HasSubstr("has a second outermost element"));
}

TEST(SvgErrors, what_is_not_an_svg_is_refused) {
  EXPECT_THAT(message_of("<html><svg/></html>"), HasSubstr("its outermost element is <html>, expected <svg>"));
  EXPECT_THAT(message_of("<svg xmlns='http://example.com'/>"), HasSubstr("is not an SVG"));
  EXPECT_THAT(message_of("<x:svg xmlns:x='http://example.com'/>"), HasSubstr("is not an SVG"));
}

TEST(SvgErrors, every_truncation_is_refused) {
  const std::string whole =
      "<?xml version='1.0'?>\n<!DOCTYPE svg PUBLIC '-//W3C//DTD SVG 1.1//EN' 'svg11.dtd'>\n" + kSquare;
  ASSERT_THAT(parse(whole).curves, SizeIs(4));
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_NE(message_of(whole.substr(0, size)), "no error") << whole.substr(0, size);
  }
}

TEST(SvgErrors, compressed_file_is_named) {
  EXPECT_THAT(message_of("\x1F\x8B\x08 whatever"), HasSubstr("is compressed (.svgz), expected plain SVG: unpack it"));
}

TEST(SvgErrors, binary_file_is_refused) {
  EXPECT_THAT(message_of(std::string("<svg>\n\0</svg>", 13)), HasSubstr("test.svg:2: holds a byte of 0"));
  EXPECT_THAT(message_of(kSquare + std::string("\0garbage", 8)), HasSubstr("holds a byte of 0"));
}

TEST(SvgErrors, entities_of_its_own_are_refused_where_they_matter) {
  const auto with = [](const std::string& content) {
    return "<!DOCTYPE svg [<!ENTITY e \"<path d='M0 0h1'/>\"> <!ENTITY n '5'>]>" + svg(content);
  };
  EXPECT_EQ(message_of(with("<path d='M0 0h1'/>")), "no error");
  EXPECT_THAT(message_of(with("<g>&e;</g>")), HasSubstr("'&e;' uses an entity of its own"));
  EXPECT_THAT(message_of(with("<circle r='&n;'/>")), HasSubstr("found '&n;'"));
  EXPECT_THAT(message_of(with("<path style='&n;' d='M0 0h1'/>")), HasSubstr("uses an entity of its own"));
  EXPECT_EQ(message_of("<!DOCTYPE svg [<!ENTITY ns 'http://www.w3.org/2000/svg'>]><svg xmlns='&ns;'/>"), "no error");
}

TEST(SvgErrors, character_references_are_read) {
  EXPECT_THAT(parse(svg("<path d='M0&#32;0&#x20;h1'/>")).curves, SizeIs(1));
}

TEST(SvgEncoding, byte_order_marks_and_utf16_are_read) {
  EXPECT_THAT(parse("\xEF\xBB\xBF" + kSquare).curves, SizeIs(4));
  EXPECT_THAT(parse(utf16(kSquare, true)).curves, SizeIs(4));
  EXPECT_THAT(parse(utf16(kSquare, false)).curves, SizeIs(4));
  EXPECT_THAT(parse(utf16("<?xml version='1.0' encoding='UTF-16'?>" + kSquare, true)).curves, SizeIs(4));
  EXPECT_THAT(parse(utf16(kSquare, true).substr(2)).curves, SizeIs(4));
  EXPECT_THAT(message_of(utf16(svg("\n<path d='M0 0 x'/>"), true)), HasSubstr("test.svg:2: "));
  EXPECT_THAT(message_of(utf16(kSquare, true) + "x"), HasSubstr("is broken UTF-16 text"));
  EXPECT_THAT(message_of(utf16(kSquare, true) + std::string("\x01\xDC", 2)), HasSubstr("is broken UTF-16 text"));
}

TEST(SvgEncoding, ids_beyond_ascii_are_kept) {
  EXPECT_EQ(parse(svg("<path id='Gehäuse' d='M0 0h1'/>")).curves.at(0).origin.layer, "Gehäuse");
  const std::string special("\xE4\0\x3D\xD8\0\xDE", 6);  // one unit, and a pair of them
  const std::string encoded = utf16("<svg><path id='", true) + special + utf16("' d='M0 0h1'/></svg>", true).substr(2);
  EXPECT_EQ(parse(encoded).curves.at(0).origin.layer, "ä😀");
}

TEST(SvgErrors, large_file_is_read) {
  std::string text = "<svg>";
  const std::string piece = "<path d='M 1.25 2.5 c 1 2 3 4.5 5 6 s 1 2 3 4 l -5.5 3.25 a 5 3 20 0 1 7 7 z'/>\n";
  while (text.size() < 5000000) text += piece;
  text += "</svg>";
  EXPECT_EQ(parse(text).curves.size(), 5 * ((text.size() - 11) / piece.size()));
}

TEST(SvgErrors, mutilated_files_give_an_error_or_a_drawing) {
  std::ifstream stream(checked_out("tests/svg/inkscape_layers.svg"));
  std::stringstream content;
  content << stream.rdbuf();
  const std::string whole = content.str();
  ASSERT_EQ(message_of(whole), "no error");
  auto generator = test_generator();
  std::uniform_int_distribution<std::size_t> place(0, whole.size() - 1);
  std::uniform_int_distribution<int> byte(0, 255);
  for (int i = 0; i < test_count(2000); ++i) {
    std::string text = whole;
    for (int k = i % 5; k >= 0; --k) text[place(generator)] = static_cast<char>(byte(generator));
    if (i % 3 == 0) text.erase(place(generator), 20);
    const std::string message = message_of(text);
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace svg_errors_test
