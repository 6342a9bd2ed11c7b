// The beginning of a points file: titles, a header of x and y in any order, and the header of something else.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "refusal.hpp"
#include "rollfix/outline.hpp"

namespace rollfix::points_header_test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

const std::vector<Vec2> kTriangle = {{0, 0}, {1, 0}, {0, 2}};

std::vector<Vec2> parsed(const std::string& text) { return parse_points(text, "part.csv"); }

std::string refusal(const std::string& text) {
  return refusal_of([&] { parsed(text); });
}

std::vector<std::string> notes_on(const std::string& text) {
  std::vector<std::string> notes;
  parse_points(text, "part.csv", {}, &notes);
  return notes;
}

TEST(PointsHeader, x_and_y_may_stand_in_any_order_and_among_others) {
  EXPECT_EQ(parsed("x,y\n0,0\n1,0\n0,2\n"), kTriangle);
  EXPECT_EQ(parsed("y,x\n0,0\n0,1\n2,0\n"), kTriangle);
  EXPECT_EQ(parsed("name,x,y\nA,0,0\nB,1,0\nC,0,2\n"), kTriangle);
  EXPECT_EQ(parsed("name;Y;z;X\nA;0;7;0\n\nB;0;7;1  # second\nC;2;7;0\n"), kTriangle);
  EXPECT_EQ(parsed("\"y\",\"x\"\n0,0\n0,1\n2,0\n"), kTriangle);
  EXPECT_EQ(parsed("y x\n0 0\n0  1\n2\t0\n"), kTriangle);
  EXPECT_EQ(parsed("wing\nid\ty\tx\n1\t0\t0\n2\t0\t1\n3\t2\t0\n"), kTriangle);
}

TEST(PointsHeader, words_of_a_title_are_no_columns) {
  EXPECT_EQ(parsed("points x and y of a part\n0 0\n1 0\n0 2\n"), kTriangle);
  EXPECT_EQ(parsed("length and turn\n0 0\n1 0\n0 2\n"), kTriangle);
}

TEST(PointsHeader, a_row_without_a_number_there_is_named) {
  EXPECT_THAT(refusal("name,x,y\nA,0,0\nB,one,0\n"),
              AllOf(StartsWith("part.csv:3: 'B,one,0'"), HasSubstr("no number in the column 'x', number 2")));
  EXPECT_THAT(refusal("name,x,y\nA,0,0\nB,1,5,0,5\n"), HasSubstr("decimal point"));
  EXPECT_THAT(refusal("y,x\n0,0\n1\n"), HasSubstr("no number in the column 'x'"));
}

TEST(PointsHeader, one_of_the_two_in_the_place_of_the_other_is_refused) {
  EXPECT_THAT(refusal("id,x\n1,0\n2,1\n3,0\n"), HasSubstr("a column 'x' but no 'y'"));
  EXPECT_THAT(refusal("y,z\n1,0\n2,1\n3,0\n"), HasSubstr("a column 'y' but no 'x'"));
  EXPECT_EQ(parsed("x,z\n0,0\n1,0\n0,2\n"), kTriangle);
}

TEST(PointsHeader, columns_that_are_taken_without_a_name_are_said) {
  EXPECT_THAT(notes_on("lon,lat,height\n0,0,1\n1,0,1\n0,2,1\n"),
              ElementsAre(AllOf(StartsWith("part.csv: "), HasSubstr("lon and lat"))));
  EXPECT_TRUE(notes_on("x,y,height\n0,0,1\n1,0,1\n0,2,1\n").empty());
}

TEST(PointsHeader, a_log_is_refused_with_the_cure) {
  for (const char* const header : {"time,u,psi", "u,psi,x,y", "time,length,turn", "distance,dturn", "time,u_a,psi_a",
                                   "u [deg],psi [deg]", "length,turn,x,y"}) {
    EXPECT_THAT(refusal(std::string(header) + "\n0,0,1,1\n1,0,1,1\n0,2,1,1\n"),
                AllOf(StartsWith("part.csv:1: '"), HasSubstr("header of a log"), HasSubstr("--log part.csv")))
        << header;
  }
  EXPECT_THAT(refusal("time u psi\n0 0 1\n1 0 1\n0 2 1\n"), HasSubstr("header of a log"));
  EXPECT_THAT(refusal("length turn\n0 0\n1 0\n0 2\n"), HasSubstr("header of a log"));
}

TEST(PointsHeader, several_titles_are_passed_over_and_counted) {
  const std::string text = "S1223\nSelig high lift\n\ncoordinates follow\n0 0\n1 0\n0 2\n";
  EXPECT_EQ(parsed(text), kTriangle);
  EXPECT_THAT(notes_on(text), ElementsAre(HasSubstr("3 title lines")));
}

TEST(PointsHeader, more_columns_than_two_without_one_are_told) {
  const std::string rows = "0,20.0,0.0\n1,19.0,1.0\n2,18.0,3.0\n3,12,8\n";
  EXPECT_THAT(notes_on(rows), ElementsAre(HasSubstr("3 columns without a header: the first two are taken as x and y")));
  EXPECT_THAT(notes_on("id,x,y\n" + rows), ElementsAre());
}

TEST(PointsHeader, points_that_lack_a_piece_of_the_outline_are_told) {
  std::string text;
  for (int k = 0; k < 150; ++k) text += fmt::format("{} {}\n", std::cos(k * 0.0314159), std::sin(k * 0.0314159));
  EXPECT_THAT(notes_on(text),
              ElementsAre(AllOf(HasSubstr("the last point is 1.43"), HasSubstr("`open` leaves it open"))));
}

TEST(PointsHeader, a_point_with_a_slip_of_the_pen_is_no_second_title) {
  EXPECT_THAT(refusal("wing\n1.0 O.5\n0 0\n1 0\n0 2\n"), StartsWith("part.csv:2: '1.0 O.5' is not two numbers"));
  EXPECT_THAT(refusal("x,y\nO,0\n0,0\n1,0\n0,2\n"), StartsWith("part.csv:2: 'O,0' is not two numbers"));
}

TEST(PointsHeader, a_unit_is_the_same_for_both_and_one_of_length) {
  EXPECT_THAT(refusal("x [mm],y [in]\n0,0\n1,0\n0,2\n"), HasSubstr("the same unit"));
  EXPECT_THAT(refusal("x [deg],y [deg]\n0,0\n1,0\n0,2\n"), HasSubstr("unit of length"));
  EXPECT_EQ(parsed("y (mm),x (mm)\n0,0\n0,1\n2,0\n"), kTriangle);
}

}  // namespace
}  // namespace rollfix::points_header_test
