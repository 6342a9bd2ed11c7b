// Logs with names and units of their own: what a header says in brackets, and what `columns` says instead of it.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "refusal.hpp"
#include "rollfix/log.hpp"
#include "rollfix/outline.hpp"
#include "shapes.hpp"

namespace rollfix::log_columns_test {
namespace {

using shapes::kPi;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

LogOptions columns(const std::string& text, const std::string& unit = "") { return {parse_columns(text), unit}; }

Log log_of(const std::string& text, const LogOptions& options = {}) { return parse_log(text, "run.csv", options); }

std::string refusal(const std::string& text, const LogOptions& options = {}) {
  return refusal_of([&] { log_of(text, options); });
}

// Rows of a time, a contact in degrees and an orientation in degrees.
constexpr const char* kRows = "0,0,10\n250,-12.5,20.25\n500,-25,30.5\n";

/// That a log holds those rows, to the bit.
void expect_the_rows(const Log& log) {
  const double deg = kPi / 180;
  EXPECT_EQ(log.kind, LogKind::contact);
  EXPECT_THAT(log.time, ElementsAre(0, 0.25, 0.5));
  EXPECT_THAT(log.fingers[0].u, ElementsAre(0, -12.5 * deg, -25 * deg));
  EXPECT_THAT(log.fingers[0].psi, ElementsAre(10 * deg, 20.25 * deg, 30.5 * deg));
}

TEST(LogColumns, a_header_states_units_in_brackets) {
  expect_the_rows(log_of(std::string("time [ms],u [deg],psi [deg]\n") + kRows));
  expect_the_rows(log_of(std::string("time(ms),u(deg), psi (degrees)\n") + kRows));
  expect_the_rows(log_of("time [ms] u [deg] psi [deg]\n0 0 10\n250 -12.5 20.25\n500 -25 30.5\n"));
  expect_the_rows(log_of("\"time [ms]\";\"u [deg]\";\"psi [deg]\"\n0;0;10\n250;-12.5;20.25\n500;-25;30.5\n"));
}

TEST(LogColumns, capitals_do_not_matter_where_no_other_column_has_the_name) {
  expect_the_rows(log_of(std::string("Time [ms],U [Deg],PSI (deg)\n") + kRows));
  const Log two = log_of("U_A,Psi_A,u_b,psi_B\n0,0,0,0\n1,2,3,4\n");
  EXPECT_THAT(two.fingers[1].psi, ElementsAre(0, 4));
  EXPECT_THAT(log_of("U,u,psi\n7,0,0\n9,1,2\n").fingers[0].u, ElementsAre(0, 1));
  EXPECT_THAT(log_of("U,psi\n0,0\n1,2\n", columns("u=U:deg")).fingers[0].u, ElementsAre(0, kPi / 180));
}

TEST(LogColumns, options_say_what_columns_are_called_and_in_what_they_are) {
  const std::string text = std::string("stamp,contact_deg,yaw_deg\n") + kRows;
  expect_the_rows(log_of(text, columns("u=contact_deg:deg,psi=yaw_deg:deg,time=stamp:ms")));
}

TEST(LogColumns, options_go_before_what_the_header_says) {
  const std::string text = "time [s],u [rad],psi\n0,0,10\n250,-12.5,20.25\n500,-25,30.5\n";
  expect_the_rows(log_of(text, columns("u=u:deg,psi=psi:deg,time=time:ms")));
}

TEST(LogColumns, a_named_column_hides_one_that_has_the_known_name) {
  const Log log = log_of("u,psi,raw\n1,2,3\n4,5,6\n", columns("u=raw"));
  EXPECT_THAT(log.fingers[0].u, ElementsAre(3, 6));
  EXPECT_THAT(log.fingers[0].psi, ElementsAre(2, 5));
}

TEST(LogColumns, a_named_pair_is_the_one_that_is_read) {
  const std::string text = "u,psi,length,turn\n1,2,3,4\n5,6,7,8\n";
  EXPECT_THAT(refusal(text), HasSubstr("`columns` u=u,psi=psi"));
  EXPECT_THAT(log_of(text, columns("length=length,turn=turn")).fingers[0].length, ElementsAre(3, 7));
}

TEST(LogColumns, names_may_hold_blanks_and_colons) {
  const Log log = log_of("skin angle,/joint:pos\n90,1\n180,2\n", columns("u=skin angle:deg,psi=/joint:pos:rad"));
  EXPECT_THAT(log.fingers[0].u, ElementsAre(90 * (kPi / 180), 180 * (kPi / 180)));
  EXPECT_THAT(log.fingers[0].psi, ElementsAre(1, 2));
}

TEST(LogColumns, lengths_come_out_in_the_parts_unit) {
  const std::string text = "distance [in],dturn [deg]\n1,90\n2,0\n";
  EXPECT_THAT(log_of(text, {{}, "mm"}).fingers[0].length, ElementsAre(25.4, testing::DoubleEq(76.2)));
  EXPECT_THAT(log_of(text, {{}, "in"}).fingers[0].length, ElementsAre(1, 3));
  const Log centres = log_of("u,psi,x [m],y [m]\n0,0,0.5,2\n1,1,1,3\n", {{}, "cm"});
  EXPECT_THAT(centres.fingers[0].x, ElementsAre(50, 100));
  EXPECT_THAT(centres.fingers[0].y, ElementsAre(200, 300));
}

TEST(LogColumns, a_unit_of_length_needs_the_parts) {
  EXPECT_THAT(refusal("distance [mm],dturn\n1,1\n"),
              AllOf(StartsWith("run.csv:1: the column 'distance [mm]'"), HasSubstr("`unit` mm")));
}

TEST(LogColumns, digits_count_in_the_unit_they_are_in) {
  const Log log = log_of("length [cm],turn [deg]\n1.25,3.5\n2,4\n", {{}, "mm"});
  EXPECT_DOUBLE_EQ(log.fingers[0].place_rounding, 0.05);
  EXPECT_DOUBLE_EQ(log.fingers[0].angle_rounding, 0.05 * kPi / 180);
}

TEST(LogColumns, a_cell_may_still_say_degrees_itself) {
  EXPECT_THAT(log_of("u [rad],psi [deg]\n90deg,90deg\n0,0\n").fingers[0].psi.front(), kPi / 180 * 90);
}

TEST(LogColumns, two_fingers_in_one_file_and_in_two) {
  const Log both = log_of("l_skin,l_yaw,r_skin,r_yaw\n90,0,1,2\n91,1,2,3\n",
                          columns("u_a=l_skin:deg,psi_a=l_yaw:deg,u_b=r_skin,psi_b=r_yaw"));
  ASSERT_EQ(both.fingers.size(), 2U);
  EXPECT_DOUBLE_EQ(both.fingers[0].u.front(), kPi / 2);
  EXPECT_THAT(both.fingers[1].u, ElementsAre(1, 2));
  EXPECT_THAT(log_of("u_a [deg],psi_a,u_b,psi_b\n90,0,0,0\n0,0,1,1\n").fingers[0].u.front(), kPi / 180 * 90);
}

TEST(LogColumns, what_sounds_like_degrees_is_not_taken_for_radians) {
  const std::string text = std::string("stamp,contact_deg,yaw_deg\n") + kRows;
  EXPECT_THAT(refusal(text, columns("u=contact_deg:deg,psi=yaw_deg")),
              AllOf(HasSubstr("sounds like deg"), HasSubstr("`columns` psi=yaw_deg:deg"), HasSubstr(":rad")));
  EXPECT_THAT(refusal(text, columns("u=contact_deg:deg,psi=yaw_deg:rad,time=stamp")), StartsWith("nothing"));
  EXPECT_THAT(refusal("t_ms,u,psi\n0,0,0\n1,1,1\n", columns("time=t_ms")), HasSubstr("time=t_ms:ms"));
}

TEST(LogColumns, a_missing_columns_message_has_the_option_to_paste) {
  const std::string told = refusal(std::string("stamp_ms,contact_deg,yaw_deg\n") + kRows);
  EXPECT_THAT(
      told, AllOf(StartsWith("run.csv:1: "), HasSubstr("`columns` u=contact_deg:deg,psi=yaw_deg:deg,time=stamp_ms:ms"),
                  HasSubstr("the header has stamp_ms, contact_deg, yaw_deg")));
  EXPECT_THAT(refusal("time,u,yaw_deg\n0,0,0\n"), HasSubstr("`columns` psi=yaw_deg:deg (the header"));
  EXPECT_THAT(refusal("time,odometer_mm,heading_deg\n0,0,0\n"),
              HasSubstr("`columns` length=odometer_mm:mm,turn=heading_deg:deg"));
  EXPECT_THAT(refusal("a b,c\n0,0\n"), HasSubstr("=NAME"));
  EXPECT_THAT(refusal("time,u\n0,0\n"), AllOf(HasSubstr("; the header has time, u"), Not(HasSubstr("=NAME"))));
}

TEST(LogColumns, the_option_that_is_pasted_reads_the_log) {
  for (const char* const header :
       {"stamp_ms,contact_deg,yaw_deg", "t_ms,skin [deg],finger orientation_deg", "clock_ms,tactile_deg,rot_deg"}) {
    const std::string text = fmt::format("{}\n{}", header, kRows);
    const std::string told = refusal(text);
    const std::size_t start = told.find("`columns` ") + 10;
    std::string option = told.substr(start, told.find(" (the header", start) - start);
    if (option.front() == '\'') option = option.substr(1, option.size() - 2);
    SCOPED_TRACE(option);
    expect_the_rows(log_of(text, columns(option)));
  }
}

TEST(LogColumns, a_name_that_is_not_there) {
  EXPECT_THAT(refusal("stamp,contact,yaw\n0,0,0\n", columns("u=contct,psi=yaw")),
              AllOf(StartsWith("run.csv:1: expected a column 'contct' for u"), HasSubstr("did you mean 'contact'?"),
                    HasSubstr("the header has stamp, contact, yaw")));
  EXPECT_THAT(refusal("1,2,3\n", columns("u=a,psi=b")), HasSubstr("expected a header with the names"));
}

TEST(LogColumns, units_of_another_kind_or_of_no_kind) {
  EXPECT_THAT(refusal("u [deg],psi [mm]\n0,0\n"), AllOf(HasSubstr("'psi [mm]'"), HasSubstr("an angle (rad, deg)")));
  EXPECT_THAT(refusal("u [counts],psi\n0,0\n"), HasSubstr("is in 'counts'"));
  EXPECT_EQ(refusal("u,psi,force [N]\n0,0,1\n1,1,1\n"), "nothing was thrown");
}

TEST(LogColumns, options_that_can_not_be_meant) {
  const auto told = [](const std::string& text) { return refusal_of([&] { parse_columns(text); }); };
  EXPECT_THAT(told("u"), HasSubstr("COLUMN=NAME:UNIT"));
  EXPECT_THAT(told("u="), HasSubstr("COLUMN=NAME:UNIT"));
  EXPECT_THAT(told("phi=yaw"), AllOf(HasSubstr("no column 'phi'"), HasSubstr("did you mean 'psi'?")));
  EXPECT_THAT(told("u=a:deg,u=b"), HasSubstr("u is given twice"));
  EXPECT_THAT(told("u=a:grad"), HasSubstr("an angle (rad, deg) or a length"));
  EXPECT_THAT(told("time=t:deg"), HasSubstr("a time (s, ms, us, ns)"));
}

TEST(LogColumns, u_is_an_angle_of_a_disk_and_a_length_of_a_jaw) {
  const Log angle = log_of("u [deg],psi\n0,0\n1,1\n");
  const Log length = log_of("u [mm],psi\n0,0\n1,1\n", {{}, "mm"});
  EXPECT_EQ(refusal_of([&] { readings_as_given(angle, {DiskFinger{1}}); }), "nothing was thrown");
  EXPECT_EQ(refusal_of([&] { readings_as_given(length, {jaw()}); }), "nothing was thrown");
  EXPECT_THAT(refusal_of([&] { readings_as_given(angle, {jaw()}); }), HasSubstr("expected a length"));
  EXPECT_THAT(refusal_of([&] { readings_as_given(length, {DiskFinger{1}}); }), HasSubstr("divided by the radius"));
}

TEST(LogColumns, a_stream_takes_the_same_options_as_a_file) {
  const Part part(gallery("ellipse"));
  const LogOptions options = columns("u=contact_deg:deg,psi=yaw_deg:deg,time=stamp:ms");
  const std::string text = std::string("stamp,contact_deg,yaw_deg\n") + kRows;
  LogStream stream("live", part, {DiskFinger{0.2}}, {}, options);
  const std::vector<Reading> file = readings_as_given(log_of(text, options), {DiskFinger{0.2}});
  std::vector<Reading> live;
  for (std::size_t start = 0; start < text.size();) {
    const std::size_t end = text.find('\n', start) + 1;
    const LogLine line = stream.push(text.substr(start, end - start));
    if (line.kind == LineKind::first || line.kind == LineKind::sample) live.push_back(line.sample.reading);
    start = end;
  }
  ASSERT_EQ(live.size(), file.size());
  for (std::size_t k = 0; k < live.size(); ++k) {
    EXPECT_EQ(live[k].length[0], file[k].length[0]);
    EXPECT_EQ(live[k].turn, file[k].turn);
  }
}

TEST(LogColumns, what_is_suggested_for_two_fingers_names_both_and_keeps_their_units) {
  const std::string header = "stamp_ms,skin_deg_a,yaw_deg_a,skin_deg_b,yaw_deg_b\n";
  const std::string told = refusal(header + "0,0,0,0,0\n10,1,1,1,1\n");
  const std::string cure =
      "u_a=skin_deg_a:deg,psi_a=yaw_deg_a:deg,time=stamp_ms:ms,u_b=skin_deg_b:deg,psi_b=yaw_deg_b:deg";
  EXPECT_THAT(told, HasSubstr("`columns` " + cure));
  const Log log = log_of(header + "0,0,0,0,0\n10,1,1,1,1\n", columns(cure));  // as it stands
  EXPECT_EQ(log.fingers.size(), 2U);
  EXPECT_THAT(log.fingers[1].u, ElementsAre(0, kPi / 180));
}

TEST(LogColumns, of_one_finger_the_other_ones_are_told_and_how_both_are_taken) {
  const std::string rows = "0,0,0,0\n1,1,1,1\n";
  const Log own = log_of("skin_a,yaw_a,skin_b,yaw_b\n" + rows, columns("u=skin_a,psi=yaw_a"));
  ASSERT_EQ(own.notes.size(), 1U);
  EXPECT_THAT(own.notes[0],
              HasSubstr("this is about one finger: the columns of another, skin_b, yaw_b, are not looked "
                        "at; both are taken with `columns` u_a=skin_a,psi_a=yaw_a,u_b=skin_b,psi_b=yaw_b"));
  EXPECT_EQ(log_of("u,psi,u_b,psi_b\n" + rows).notes.size(), 1U);
  EXPECT_EQ(log_of("u,psi,x,y\n" + rows).notes.size(), 0U);
  EXPECT_EQ(log_of("u_a,psi_a,u_b,psi_b\n" + rows).notes.size(), 0U);
}

TEST(LogColumns, a_name_that_sounds_like_a_unit_does_so_with_a_finger_behind_it) {
  const std::string header = "contact_deg_a,psi_a,contact_deg_b,psi_b\n";
  EXPECT_THAT(refusal(header + "0,0,0,0\n1,1,1,1\n", columns("u_a=contact_deg_a,u_b=contact_deg_b")),
              HasSubstr("'contact_deg_a' (u_a) sounds like deg, which is not taken for granted"));
}

}  // namespace
}  // namespace rollfix::log_columns_test
