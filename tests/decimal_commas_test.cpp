// What programs write in half of Europe, and other files that are nearly right: read where they can mean one thing
// only, else refused with what to type.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "cli.hpp"
#include "refusal.hpp"
#include "rollfix/log.hpp"
#include "rollfix/outline.hpp"
#include "text/number.hpp"

namespace rollfix::decimal_commas_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(DecimalCommas, are_seen_between_semicolons_only) {
  EXPECT_EQ(with_decimal_points("0,5;-1,25"), std::optional<std::string>("0.5;-1.25"));
  EXPECT_EQ(with_decimal_points("1;\"0,5\" ; 2,5e-3"), std::optional<std::string>("1;\"0.5\" ; 2.5e-3"));
  EXPECT_EQ(with_decimal_points("12,5deg;3"), std::optional<std::string>("12.5deg;3"));
  EXPECT_EQ(with_decimal_points("1,25;a,5"), std::optional<std::string>("1.25;a,5"));
  for (const char* const as_it_is : {"0,5", "0,5 1,5", "1.5;2.5", "1,2,3;4", "x,y;z", ";,;", "1,;2", ""}) {
    EXPECT_EQ(with_decimal_points(as_it_is), std::nullopt) << as_it_is;
  }
}

TEST(DecimalCommas, a_log_that_excel_wrote_is_read) {
  const Log log = parse_log("time;u;psi\r\n0,00;0,000;0,10\r\n0,25;-0,125;1\r\n", "run.csv");
  EXPECT_THAT(log.time, ElementsAre(0, 0.25));
  EXPECT_THAT(log.fingers[0].u, ElementsAre(0, -0.125));
  EXPECT_THAT(log.fingers[0].psi, ElementsAre(0.1, 1));
  EXPECT_DOUBLE_EQ(log.fingers[0].place_rounding, 0.0005);
}

TEST(DecimalCommas, a_log_without_a_header_as_well) {
  const Log log = parse_log("0,5;0,25\n1;0,5\n", "drive.csv");
  EXPECT_EQ(log.kind, LogKind::increments);
  EXPECT_THAT(log.fingers[0].length, ElementsAre(0.5, 1.5));
}

TEST(DecimalCommas, points_are_read_with_a_header_and_without) {
  EXPECT_THAT(parse_points("0,5;0\n2;0,25\n1;1,5\n", "part.csv"),
              ElementsAre(Vec2(0.5, 0), Vec2(2, 0.25), Vec2(1, 1.5)));
  EXPECT_THAT(parse_points("y;x\n0;0,5\n0,25;2\n1,5;1\n", "part.csv"),
              ElementsAre(Vec2(0.5, 0), Vec2(2, 0.25), Vec2(1, 1.5)));
}

TEST(DecimalCommas, between_blanks_and_tabs_are_read_where_that_is_said) {
  LogOptions log_options;
  log_options.decimal_comma = true;
  const Log log = parse_log("time\tu\tpsi\n0\t0,5\t0,10\n0,25\t0,25\t1\n", "run.csv", log_options);
  EXPECT_THAT(log.time, ElementsAre(0, 0.25));
  EXPECT_THAT(log.fingers[0].u, ElementsAre(0.5, 0.25));
  EXPECT_THAT(parse_log("0,5 0,25\n1 0,5\n", "drive.csv", log_options).fingers[0].length, ElementsAre(0.5, 1.5));
  OutlineOptions options;
  options.decimal_comma = true;
  EXPECT_THAT(parse_points("0,5 0\n2 0,25\n1 1,5\n", "part.csv", options),
              ElementsAre(Vec2(0.5, 0), Vec2(2, 0.25), Vec2(1, 1.5)));
  EXPECT_THAT(parse_points("0.5,0\n2,0.25\n1,1.5\n", "part.csv", options),  // a comma that separates
              ElementsAre(Vec2(0.5, 0), Vec2(2, 0.25), Vec2(1, 1.5)));
}

TEST(DecimalCommas, a_point_that_is_said_leaves_no_comma_between_semicolons_either) {
  LogOptions options;
  options.decimal_comma = false;
  EXPECT_THAT(refusal_of([&] { parse_log("u;psi\n0,5;1\n1;2\n", "run.csv", options); }),
              HasSubstr("u is '0,5', expected a number"));
  OutlineOptions points;
  points.decimal_comma = false;
  EXPECT_THAT(refusal_of([&] { parse_points("0,5;0\n2;0,25\n1;1,5\n", "part.csv", points); }), HasSubstr("part.csv:1"));
}

TEST(DecimalCommas, are_said_by_an_option_of_the_program) {
  const cli::Folder folder;
  folder.write("part.csv", "0,5 0\n2 0,25\n1 1,5\n");
  EXPECT_THAT(cli::run("inspect part.csv").err, HasSubstr("with decimal points, not commas, which --decimal , takes"));
  EXPECT_EQ(cli::run("inspect part.csv --decimal ,").code, 0);
  folder.write("drive.csv", "length\tturn\n0,5\t0,25\n1\t0,5\n");
  EXPECT_THAT(cli::run("locate gallery:cam --log drive.csv").err, HasSubstr("; --decimal , takes them"));
  EXPECT_EQ(cli::run("locate gallery:cam --log drive.csv --decimal ,").code, 1);
  EXPECT_THAT(cli::run("inspect part.csv --decimal x").err, HasSubstr("expected a comma or a point"));
}

TEST(NearlyRight, a_compressed_file_is_told_how_to_unpack) {
  const std::string packed = std::string("\x1F\x8B\x08\x00", 4) + "whatever";
  EXPECT_THAT(refusal_of([&] { parse_log(packed, "run.csv.gz"); }),
              HasSubstr("run.csv.gz: is compressed, expected plain text: gunzip -k run.csv.gz"));
  EXPECT_THAT(refusal_of([&] { parse_points(packed, "part.csv"); }), HasSubstr("is compressed"));
  EXPECT_THAT(refusal_of([&] { load_outline("part.csv.gz"); }), HasSubstr("gunzip -k part.csv.gz"));
}

TEST(NearlyRight, lines_that_end_in_carriage_returns_alone_are_told_how_to_change) {
  EXPECT_THAT(refusal_of([] { parse_log("u,psi\r0,0\r1,1\r", "run.csv"); }),
              HasSubstr("tr '\\r' '\\n' < run.csv > run_lf.csv"));
  EXPECT_THAT(refusal_of([] { parse_points("0 0\r1 0\r0 1\r", "part.csv"); }), HasSubstr("tr '\\r' '\\n'"));
  EXPECT_EQ(parse_points("0 0\r\n1 0\r\n0 1\r\n", "part.csv").size(), 3U);
}

TEST(NearlyRight, a_unit_in_the_names_of_x_and_y_is_their_unit) {
  std::string unit;
  std::vector<std::string> notes;
  OutlineOptions options;
  options.unit = "cm";
  const std::vector<Vec2> points = parse_points("x_mm,y_mm\n0,0\n10,0\n0,20\n", "part.csv", options, &notes, &unit);
  EXPECT_EQ(unit, "cm");
  EXPECT_THAT(points, ElementsAre(Vec2(0, 0), Vec2(1, 0), Vec2(0, 2)));
}

TEST(NearlyRight, a_third_coordinate_is_told) {
  std::vector<std::string> notes;
  parse_points("x,y,z\n0,0,1\n1,0,1\n0,1,1\n", "part.csv", {}, &notes);
  EXPECT_THAT(notes, ElementsAre("part.csv: the column z is not looked at: outlines are plane"));
  notes.clear();
  parse_points("x,y\n0,0\n1,0\n0,1\n", "part.csv", {}, &notes);
  EXPECT_THAT(notes, IsEmpty());
}

}  // namespace
}  // namespace rollfix::decimal_commas_test
