// Points files: what is read, and what every kind of bad file is told.
#include "rollfix/outline.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "random.hpp"
#include "rollfix/error.hpp"

namespace points_test {
namespace {

using rollfix::InputError;
using rollfix::outline_through;
using rollfix::OutlineOptions;
using rollfix::parse_points;
using rollfix::Vec2;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

const OutlineOptions kOpen{true};

std::vector<Vec2> parsed(const std::string& text, const OutlineOptions& options = {}) {
  return parse_points(text, "part.csv", options);
}

std::string message_of(const std::string& text, const OutlineOptions& options = {}) {
  try {
    parsed(text, options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

const std::vector<Vec2> kTriangle = {{0, 0}, {1, 0}, {0, 1}};

TEST(Points, blanks_commas_tabs_and_semicolons_separate) {
  EXPECT_EQ(parsed("0 0\n1 0\n0 1\n"), kTriangle);
  EXPECT_EQ(parsed("0,0\n1,0\n0,1\n"), kTriangle);
  EXPECT_EQ(parsed("0\t0\n1\t0\n0\t1\n"), kTriangle);
  EXPECT_EQ(parsed("0;0\n1;0\n0;1\n"), kTriangle);
  EXPECT_EQ(parsed("  0 , 0\n1 ,0  \n\t0,   1"), kTriangle);
}

TEST(Points, numbers_are_read_to_the_last_bit) {
  const std::vector<Vec2> points = parsed("0.1 -2.5e-3\n+1 1e3\n.5 -7.\n0.30000000000000004 12345.678901234567\n");
  EXPECT_EQ(points[0], Vec2(0.1, -2.5e-3));
  EXPECT_EQ(points[1], Vec2(1, 1000));
  EXPECT_EQ(points[2], Vec2(0.5, -7));
  EXPECT_EQ(points[3], Vec2(0.30000000000000004, 12345.678901234567));
}

TEST(Points, random_numbers_round_trip) {
  auto generator = test_generator();
  std::uniform_real_distribution<double> coordinate(-1, 1);
  std::vector<Vec2> points;
  std::string text;
  for (int i = 0; i < test_count(1000) + 3; ++i) {
    points.emplace_back(coordinate(generator), coordinate(generator));
    text += fmt::format("{},{}\n", points.back().x(), points.back().y());
  }
  EXPECT_EQ(parsed(text), points);
}

TEST(Points, comments_and_blank_lines_are_skipped) {
  EXPECT_EQ(parsed("# a part\n\n0 0  # first\n   \n1 0\n#\n0 1\n\n"), kTriangle);
}

TEST(Points, one_title_line_is_skipped) {
  EXPECT_EQ(parsed("x,y\n0,0\n1,0\n0,1\n"), kTriangle);
  EXPECT_EQ(parsed("# made by hand\n\nAG03 (flat aft bottom)\n0 0\n1 0\n0 1\n"), kTriangle);
  EXPECT_EQ(parsed("2412 wing, 12% thick\n0 0\n1 0\n0 1\n"), kTriangle);
}

TEST(Points, windows_line_ends_and_byte_order_mark_are_skipped) {
  EXPECT_EQ(parsed("\xEF\xBB\xBFx;y\r\n0;0\r\n1;0\r\n\r\n0;1\r\n"), kTriangle);
}

TEST(Points, further_columns_are_ignored) {
  EXPECT_EQ(parsed("0 0 7 left\n1 0\n0 1 8\n"), kTriangle);
  EXPECT_EQ(parsed("0,0,5.7,5.9\n1,0,,\n0,1,x y\n"), kTriangle);
}

TEST(Points, last_point_that_repeats_the_first_is_dropped) {
  EXPECT_EQ(parsed("0 0\n1 0\n0 1\n0 0\n"), kTriangle);
  EXPECT_EQ(parsed("0 0\n1 0\n0 1\n1e-10 -1e-10\n"), kTriangle);
  EXPECT_EQ(parsed("0 0\n1 0\n0 1\n1e-8 0\n").size(), 4U);
  EXPECT_EQ(parsed("0 0\n1 0\n0 1\n0 0\n", kOpen).size(), 4U);
}

TEST(Points, order_is_kept_also_clockwise) { EXPECT_EQ(parsed("0 0\n0 1\n1 0\n")[1], Vec2(0, 1)); }

TEST(Points, two_points_make_an_open_curve) { EXPECT_EQ(parsed("0 0\n1 1\n", kOpen).size(), 2U); }

TEST(Points, points_on_a_line_make_an_open_curve) { EXPECT_EQ(parsed("0 0\n1 1\n2 2\n", kOpen).size(), 3U); }

TEST(Points, make_the_outline_of_their_spline) {
  const rollfix::Outline outline = outline_through(kTriangle, "triangle", {});
  EXPECT_EQ(outline.name, "triangle");
  EXPECT_TRUE(outline.closed);
  EXPECT_EQ(outline.curves.size(), 3U);
  EXPECT_FALSE(outline_through(kTriangle, "triangle", kOpen).closed);
}

// ---- Bad files.

TEST(BadPoints, word_in_a_line_is_named_with_its_line) {
  EXPECT_EQ(message_of("0 0\n1 0\n\n0 one\n"),
            "part.csv:4: '0 one' is not two numbers, expected a point as in '1.5 2' or '1.5,2'");
  EXPECT_THAT(message_of("0 0\n1 0\nend\n"), StartsWith("part.csv:3: 'end' is not two numbers"));
  EXPECT_THAT(message_of("0 0\n1.0abc 0\n0 1\n"), StartsWith("part.csv:2: '1.0abc 0'"));
  EXPECT_THAT(message_of("0 0\n1,,0\n0 1\n"), StartsWith("part.csv:2: '1,,0'"));
  EXPECT_THAT(message_of("0 0\n0x10 0\n0 1\n"), StartsWith("part.csv:2: '0x10 0'"));
}

TEST(BadPoints, lone_number_is_named_with_its_line) {
  EXPECT_EQ(message_of("0 0\n1\n0 1\n"),
            "part.csv:2: '1' is only one number, expected two as in '1.5 2'; a title goes behind a #");
  EXPECT_THAT(message_of("2412\n0 0\n1 0\n0 1\n"), StartsWith("part.csv:1: '2412' is only one number"));
  EXPECT_THAT(message_of("0,0\n1,\n0,1\n"), StartsWith("part.csv:2: '1,' is only one number"));
}

TEST(BadPoints, more_than_ten_million_are_refused_where_they_stand) {
  std::string text;
  for (int k = 0; k <= 10'000'000; ++k) text += "1 0\n";
  EXPECT_EQ(message_of(text),
            "part.csv:10000001: expected no more than 10000000 points or curves, found more: thin it out");
}

TEST(BadPoints, decimal_commas_are_not_taken_for_points) {
  EXPECT_EQ(message_of("1,5 2,5\n"),
            "part.csv:1: '1,5 2,5' mixes separators, expected 'x y' or 'x,y' with decimal points, not commas, "
            "which `decimal_comma` takes");
  EXPECT_THAT(message_of("0,5 2,5\n"), HasSubstr("mixes separators"));
  EXPECT_THAT(message_of("0,5\t2,5\n"), HasSubstr("mixes separators"));
}

TEST(BadPoints, numbers_that_are_not_finite_are_named) {
  EXPECT_THAT(message_of("0 0\n1 nan\n0 1\n"), StartsWith("part.csv:2: the point (1, nan) is out of range"));
  EXPECT_THAT(message_of("0 0\n-inf 1\n0 1\n"), StartsWith("part.csv:2: the point (-inf, 1) is out of range"));
  EXPECT_THAT(message_of("0 0\n1e999 1\n0 1\n"), StartsWith("part.csv:2: the point (inf, 1) is out of range"));
  EXPECT_THAT(message_of("0 0\n1e200 1\n0 1\n"), StartsWith("part.csv:2: the point (1e+200, 1) is out of range"));
}

TEST(BadPoints, too_few_are_counted) {
  EXPECT_EQ(message_of(""), "part.csv: holds 0 different points, a closed outline needs at least 3");
  EXPECT_EQ(message_of("# nothing\n\n"), "part.csv: holds 0 different points, a closed outline needs at least 3");
  EXPECT_EQ(message_of("0 0\n1 0\n"),
            "part.csv: holds 2 different points, a closed outline needs at least 3; of an open one say so with `open`");
  EXPECT_EQ(message_of("0 0\n", kOpen), "part.csv: holds 1 different points, an open outline needs at least 2");
  EXPECT_THAT(message_of("0 0\n1 0\n0 0\n"), StartsWith("part.csv: holds 2 different points"));
}

TEST(BadPoints, same_point_twice_in_a_row_is_named_with_both_lines) {
  EXPECT_EQ(message_of("0 0\n\n1 0\n# again\n1 0\n0 1\n"),
            "part.csv: lines 3 and 5 hold the same point (1, 0); remove one of them");
  EXPECT_EQ(message_of("0 0\n1 0\n1 1e-12\n0 1\n"),
            "part.csv: lines 2 and 3 hold the same point (1, 1e-12) but for 1e-12, too little for a size of 1.414; "
            "remove one of them");
  EXPECT_THAT(message_of("0 0\n1 0\n0 1\n0 0\n0 0\n"), StartsWith("part.csv: lines 4 and 1 hold the same point"));
}

TEST(BadPoints, outline_without_size_is_refused) {
  EXPECT_EQ(message_of("2 3\n2 3\n2 3\n"), "part.csv: all 3 points are the same, (2, 3)");
}

TEST(BadPoints, closed_outline_on_one_line_is_refused) {
  EXPECT_EQ(
      message_of("0 0\n1 2\n2 4\n0.5 1\n"),
      "part.csv: all 4 points lie on one line, a closed outline encloses an area; of an open one say so with `open`");
  EXPECT_THAT(message_of("0.1 0.3\n0.2 0.6\n0.7 2.1\n"), HasSubstr("lie on one line"));
  EXPECT_EQ(message_of("0 0\n1 2\n2 4.0000001\n0.5 1\n"), "no error");
}

TEST(BadPoints, file_that_is_no_text_is_refused) {
  EXPECT_THAT(message_of(std::string("PK\0\3", 4)), HasSubstr("is not a text file"));
  EXPECT_THAT(message_of("\xFF\xFE" + std::string("0\0 \0", 4)), HasSubstr("is UTF-16 text"));
}

TEST(BadPoints, any_mess_gives_points_or_an_explanation) {
  const std::string alphabet = "0123456789.,;-+eE \t\r\n\n#xnaif\xEF\xFF";
  auto generator = test_generator();
  std::uniform_int_distribution<std::size_t> letter(0, alphabet.size() - 1);
  std::uniform_int_distribution<std::size_t> length(0, 60);
  int explained = 0;
  const int count = test_count(3000);
  for (int i = 0; i < count; ++i) {
    std::string text;
    for (std::size_t k = length(generator); k > 0; --k) text += alphabet[letter(generator)];
    const std::string message = message_of(text);
    if (message == "no error") continue;
    ++explained;
    EXPECT_THAT(message, StartsWith("part.csv:"));
    EXPECT_EQ(message.find('\n'), std::string::npos);
  }
  EXPECT_GT(explained, count / 2);
}

TEST(BadPoints, long_and_strange_lines_are_shown_in_short) {
  const std::string message = message_of("0 0\n" + std::string(500, 'x') + "\n");
  EXPECT_LT(message.size(), 150U);
  EXPECT_EQ(message_of("0 0\n\x1b[31m 1\n").find('\x1b'), std::string::npos);
}

}  // namespace
}  // namespace points_test
