// From a log to readings: kinds of logs, wrapped angles, instants, digits, directions.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "refusal.hpp"
#include "rollfix/error.hpp"
#include "rollfix/log.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/rolling.hpp"
#include "text/number.hpp"

namespace rollfix::log_readings_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
constexpr double kPi = std::numbers::pi;
constexpr double kDegree = kPi / 180;

const Part& ellipse() {
  static const Part part(gallery("ellipse"));
  return part;
}

Log log_of(const std::string& text) { return parse_log(text, "run.csv"); }

Reading only_reading(const std::string& text, const std::vector<Finger>& fingers = {}) {
  const std::vector<Reading> found = readings(log_of(text), ellipse(), fingers);
  EXPECT_EQ(found.size(), 1U);
  return found.front();
}

void expect_reading(const Reading& found, double length, double turn) {
  EXPECT_NEAR(found.length[0], length, 1e-12);
  EXPECT_NEAR(found.turn, turn, 1e-12);
}

// --- What the columns mean.

TEST(Log, u_and_psi_are_measured_from_the_first_row) {
  const std::string text = "time,u,psi\n0,1.5,0.25\n1,1,0.75\n2,0.5,1.5\n";
  expect_reading(only_reading(text, {DiskFinger{2}}), 2, 0.25);
}

TEST(Log, length_and_turn_are_readings_as_they_stand) {
  expect_reading(only_reading("length,turn\n0.5,0.1\n1.5,0.4\n"), 1.5, 0.4);
}

TEST(Log, distance_and_dturn_are_summed) {
  expect_reading(only_reading("time,distance,dturn\n0,0.5,0.1\n1,0.25,0.2\n2,-0.125,0.3\n"), 0.625, 0.6);
}

TEST(Log, two_columns_without_a_header_are_distance_and_dturn) {
  expect_reading(only_reading("0.5,0.1\n0.25,0.2\n"), 0.75, 0.3);
  expect_reading(only_reading("0.5 0.1\n0.25\t0.2\n"), 0.75, 0.3);
  expect_reading(only_reading("0.5;10deg\n0.25;20deg\n"), 0.75, 30 * kDegree);
}

TEST(Log, a_million_increments_add_up_without_loss) {
  std::string text = "distance,dturn\n";
  for (int k = 0; k < 1000000; ++k) text += "0.1,-0.3\n";
  const Reading found = only_reading(text);
  EXPECT_NEAR(found.length[0], 1e5, 2e-11);
  EXPECT_NEAR(found.turn, -3e5, 6e-11);
}

TEST(Log, columns_may_stand_in_any_order_among_others) {
  const std::string text = "force,psi,u,time,remark\n9,0.25,1.5,0,first\n8,0.75,1,1,second one\n";
  expect_reading(only_reading(text, {DiskFinger{2}}), 1, 0);
  EXPECT_THAT(log_of(text).time, ElementsAre(0, 1));
}

TEST(Log, the_finger_centre_is_read_where_it_is_given) {
  const Log log = log_of("u,psi,y,x\n0,0,3,1\n1,1,4,2\n");
  EXPECT_THAT(log.fingers[0].x, ElementsAre(1, 2));
  EXPECT_THAT(log.fingers[0].y, ElementsAre(3, 4));
}

TEST(Log, angles_may_be_written_in_degrees) {
  expect_reading(only_reading("u,psi\n90deg,-10deg\n0deg,0.5\n", {DiskFinger{1}}), kPi / 2,
                 0.5 + 10 * kDegree - kPi / 2);
}

TEST(Log, comments_blank_lines_quotes_a_mark_and_line_ends_do_not_matter) {
  const std::string plain = "time,u,psi\n0,1.5,0.25\n1,1,0.75\n";
  const std::string dressed =
      "\xEF\xBB\xBF# a roll\r\n\r\n \"time\" , \"u\",psi  # columns\r\n0, 1.5 ,\"0.25\"\r\n   \r\n# half "
      "time\r\n1,1,0.75";
  EXPECT_EQ(log_of(dressed).fingers[0].u, log_of(plain).fingers[0].u);
  EXPECT_EQ(log_of(dressed).fingers[0].psi, log_of(plain).fingers[0].psi);
  EXPECT_THAT(log_of(dressed).fingers[0].line, ElementsAre(4, 7));
}

TEST(Log, semicolons_tabs_and_blanks_separate_as_well) {
  for (const char* text : {"u;psi\n1;2\n3;4\n", "u\tpsi\n1\t2\n3\t4\n", "u  psi\n 1 2 \n3   4\n"}) {
    EXPECT_THAT(log_of(text).fingers[0].u, ElementsAre(1, 3)) << text;
    EXPECT_THAT(log_of(text).fingers[0].psi, ElementsAre(2, 4)) << text;
  }
}

TEST(Log, empty_cells_of_unknown_columns_are_ignored) {
  EXPECT_THAT(log_of("a\tu\tpsi\tb\n\t1\t2\t\n\t3\t4\t\n").fingers[0].u, ElementsAre(1, 3));
  EXPECT_THAT(log_of("a,u,psi,b\n,1,2,\n,3,4\n").fingers[0].u, ElementsAre(1, 3));
}

// --- Contact.

TEST(Log, rows_without_contact_before_and_after_the_roll_are_skipped) {
  const Log log = log_of("time,u,psi,contact\n0,nan,0,0\n1,,0,0\n2,1,0,1\n3,2,1,1\n4,nan,2,0\n5,,,0\n");
  EXPECT_THAT(log.fingers[0].u, ElementsAre(1, 2));
  EXPECT_THAT(log.time, ElementsAre(2, 3));
}

TEST(Log, increments_without_contact_do_not_count) {
  expect_reading(only_reading("distance,dturn,contact\n5,5,0\n1,0.5,1\n1,0.5,1\n7,7,0\n"), 2, 1);
}

// --- Several rolls.

TEST(Log, every_unbroken_stretch_of_contact_is_a_roll) {
  const std::vector<Log> rolls = parse_rolls(
      "time,u,psi,contact\n0,,,0\n1,1,0,1\n2,2,1,1\n3,,,0\n4,9,9,1\n5,,,0\n6,5,0,1\n7,6,1,1\n8,8,2,1\n", "run.csv");
  ASSERT_EQ(rolls.size(), 2U) << "one row alone is no roll";
  EXPECT_THAT(rolls[0].fingers[0].u, ElementsAre(1, 2));
  EXPECT_THAT(rolls[1].fingers[0].u, ElementsAre(5, 6, 8));
  EXPECT_EQ(rolls[0].name, "run.csv, lines 3 to 4");
  EXPECT_EQ(rolls[1].name, "run.csv, lines 8 to 10");
}

TEST(Log, one_roll_is_what_it_always_was) {
  const std::string text = "u,psi,contact\n1,0,1\n2,1,1\n0,0,0\n";
  const std::vector<Log> rolls = parse_rolls(text, "run.csv");
  ASSERT_EQ(rolls.size(), 1U);
  EXPECT_EQ(rolls[0].name, "run.csv");
  EXPECT_EQ(rolls[0].fingers[0].u, log_of(text).fingers[0].u);
}

TEST(Log, a_roll_of_two_fingers_lasts_while_both_touch) {
  const auto rolls = parse_rolls(
      "u_a,psi_a,contact_a,u_b,psi_b,contact_b\n1,0,1,9,9,0\n2,0,1,5,0,1\n3,0,1,6,0,1\n4,0,0,7,0,1\n5,0,1,8,0,1\n"
      "6,0,1,9,0,1\n",
      "both.csv");
  ASSERT_EQ(rolls.size(), 2U);
  EXPECT_THAT(rolls[0].fingers[0].u, ElementsAre(2, 3));
  EXPECT_THAT(rolls[1].fingers[1].u, ElementsAre(8, 9));
}

TEST(Log, a_file_longer_than_the_buffer_it_is_read_through_is_the_same) {
  std::string text = "u,psi # " + std::string(200000, '-') + "\n";
  for (int k = 0; k < 20000; ++k) text += std::to_string(k * 1e-4) + "," + std::to_string(k * 2e-4) + "\r\n";
  const std::string path = testing::TempDir() + "rollfix-long-log.csv";
  std::ofstream(path, std::ios::binary) << text << "3,4";
  const Log log = read_log(path);
  const Log expected = log_of(text + "3,4");
  std::remove(path.c_str());
  EXPECT_EQ(log.fingers[0].u, expected.fingers[0].u);
  EXPECT_EQ(log.fingers[0].line, expected.fingers[0].line);
  EXPECT_EQ(log.fingers[0].u.size(), 20001U);
}

// --- Wrapped angles.

double wrapped_at(double angle, double lowest) { return angle - 2 * kPi * std::floor((angle - lowest) / (2 * kPi)); }

std::vector<double> wrapped(std::vector<double> angles, double lowest) {
  for (double& angle : angles) angle = wrapped_at(angle, lowest);
  return angles;
}

TEST(Log, wrapped_or_not_the_readings_are_the_same) {
  const DiskFinger finger{0.1};
  RollPlan plan;
  plan.distance = 1.7 * ellipse().perimeter();
  plan.rows = 301;
  const Log plain = roll(ellipse(), finger, plan).log;
  const std::vector<Reading> expected = readings_as_given(plain, {finger});
  for (const double lowest : {-kPi, 0.0, -1.0}) {
    for (const bool only_u : {true, false}) {
      Log log = plain;
      log.fingers[0].u = wrapped(plain.fingers[0].u, lowest);
      if (!only_u) log.fingers[0].psi = wrapped(plain.fingers[0].psi, lowest);
      const std::vector<Reading> found = readings_as_given(log, {finger});
      for (std::size_t row = 0; row < expected.size(); ++row) {
        EXPECT_NEAR(found[row].length[0], expected[row].length[0], 1e-12);
        EXPECT_NEAR(found[row].turn, expected[row].turn, 1e-11);
      }
    }
  }
}

TEST(Log, what_is_not_wrapped_keeps_its_bits) {
  const std::vector<double> slow = {0.1, 0.3, -0.2, -3.1};
  const std::vector<double> wide = {0, 4, 8, 3, -2};  // in great steps over more than a full turn
  EXPECT_EQ(unwrapped(slow), slow);
  EXPECT_EQ(unwrapped(wide), wide);
}

TEST(Log, wrapping_is_seen_through_the_rounding_of_written_angles) {
  const Log log = log_of("u,psi\n3.00,0\n3.14,0\n-3.15,0\n-3.00,0\n");
  EXPECT_NEAR(unwrapped(log.fingers[0].u, log.fingers[0].place_rounding).back(), 2 * kPi - 3, 1e-12);
}

TEST(Log, of_two_rows_alone_only_the_usual_ranges_are_taken_as_wrapped) {
  EXPECT_THAT(unwrapped({3, -3}), ElementsAre(3, 2 * kPi - 3));
  EXPECT_THAT(unwrapped({0.5, 6}), ElementsAre(0.5, 6 - 2 * kPi));
  EXPECT_THAT(unwrapped({0, -5}), ElementsAre(0, -5));
  EXPECT_THAT(unwrapped({0, 40}), ElementsAre(0, 40));
}

// --- Instants.

TEST(Log, instants_choose_the_rows_they_are_nearest_to) {
  const Log log = log_of("time,u,psi\n0,0,0\n0.5,-1,1\n1,-2,2\n1.5,-3,3\n");
  EXPECT_THAT(rows_at(log, {}), ElementsAre(3));
  EXPECT_THAT(rows_at(log, {0.5, 1.2, 1.75}), ElementsAre(1, 2, 3));
  const std::vector<Reading> found = readings(log, ellipse(), {DiskFinger{2}}, {1, 0.51});
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].length[0], 4);
  EXPECT_EQ(found[1].length[0], 2);
}

TEST(Log, an_instant_that_means_the_first_contact_is_refused) {
  const Log log = log_of("time,u,psi\n0,0,0\n0.5,-1,1\n1,-2,2\n1.5,-3,3\n");
  for (const double instant : {0.0, -0.25, 0.2}) {
    EXPECT_THAT(refusal_of([&] {
                  rows_at(log, {1, instant});
                }),
                testing::AllOf(HasSubstr("the first contact"), HasSubstr("`at`"), HasSubstr("up to 1.5")));
  }
  EXPECT_THAT(rows_at(log_of("time,length,turn\n0,0.1,0\n0.5,1,1\n"), {0}), ElementsAre(0));
}

TEST(Log, two_instants_that_mean_one_row_are_refused) {
  const Log log = log_of("time,u,psi\n0,0,0\n0.5,-1,1\n1,-2,2\n1.5,-3,3\n");
  EXPECT_THAT(refusal_of([&] {
                rows_at(log, {1, 0.5, 1.2});
              }),
              testing::AllOf(HasSubstr("the instants 1 and 1.2 mean the same row, at 1"), HasSubstr("`at`")));
  EXPECT_THAT(refusal_of([&] { rows_at(log, {0.5, 0.5}); }), HasSubstr("the instants 0.5 and 0.5"));
}

TEST(Log, instants_outside_or_in_a_gap_of_the_log_are_refused) {
  const Log log = log_of("time,u,psi\n0,0,0\n0.5,-1,1\n1,-2,2\n5,-3,3\n5.5,-4,4\n");
  EXPECT_THAT(refusal_of([&] { rows_at(log, {2}); }), HasSubstr("nearest rows are at 1 and 5"));
  EXPECT_THAT(refusal_of([&] { rows_at(log, {1.26}); }), HasSubstr("instant 1.26"));
  EXPECT_THAT(refusal_of([&] { rows_at(log, {-0.3}); }), HasSubstr("goes from 0 to 5.5"));
  EXPECT_THAT(refusal_of([&] { rows_at(log, {7}); }), HasSubstr("goes from 0 to 5.5"));
  EXPECT_THAT(refusal_of([&] { rows_at(log, {NAN}); }), HasSubstr("instant nan"));
  EXPECT_THAT(refusal_of([&] { rows_at(log_of("u,psi\n0,0\n1,1\n"), {1}); }), HasSubstr("no column 'time'"));
}

TEST(Log, u_needs_to_know_the_finger) {
  const Log log = log_of("u,psi\n0,0\n1,1\n");
  EXPECT_THAT(refusal_of([&] { readings(log, ellipse(), {}); }), HasSubstr("`finger` disk,r="));
  EXPECT_THAT(refusal_of([&] { readings(log, ellipse(), {DiskFinger{0}}); }), HasSubstr("above 0"));
}

// --- Direction: a part that was given clockwise is stored counter-clockwise.

const Part& clockwise_ellipse() {
  static const Part part = [] {
    Outline outline = reversed(gallery("ellipse"));
    outline.reversed = false;
    return Part(outline);
  }();
  return part;
}

TEST(Log, lengths_follow_the_outline_as_it_was_given) {
  ASSERT_TRUE(clockwise_ellipse().reversed());
  const Log travelled = log_of("length,turn\n0.5,-0.1\n1.5,-0.4\n");
  expect_reading(readings(travelled, clockwise_ellipse(), {}).front(), -1.5, -0.4);
  const Log increments = log_of("0.5,-0.1\n1,-0.3\n");
  expect_reading(readings(increments, clockwise_ellipse(), {}).front(), -1.5, -0.4);
}

TEST(Log, a_contact_log_does_not_care_how_the_outline_was_given) {
  const Log log = log_of("u,psi\n0,0\n-1,2\n");
  expect_reading(readings(log, ellipse(), {DiskFinger{2}}).front(), 2, 1);
  expect_reading(readings(log, clockwise_ellipse(), {DiskFinger{2}}).front(), 2, 1);
}

// --- Digits.

TEST(WrittenNumber, rounding_is_half_a_unit_of_the_last_digit) {
  EXPECT_DOUBLE_EQ(rounding_of("1.2"), 0.05);
  EXPECT_DOUBLE_EQ(rounding_of("-1.20"), 0.005);
  EXPECT_DOUBLE_EQ(rounding_of("+.125"), 0.0005);
  EXPECT_DOUBLE_EQ(rounding_of("1.5e-6"), 0.5e-7);
  EXPECT_DOUBLE_EQ(rounding_of("1.25E+1"), 0.05);
  EXPECT_DOUBLE_EQ(rounding_of("73.5deg"), 0.05 * kDegree);
  EXPECT_DOUBLE_EQ(rounding_of("1.2345678901234567890123e-5"), 0.5e-27);
}

TEST(WrittenNumber, whole_numbers_and_zero_are_exact) {
  for (const char* text : {"0", "0.00", "-0.0", "3", "-17", "15e3", "1.5e1", "1.25e2", "90deg", "0.0e-7"}) {
    EXPECT_EQ(rounding_of(text), 0) << text;
  }
}

TEST(WrittenNumber, an_angle_is_radians_or_degrees) {
  EXPECT_EQ(parse_angle("1.25"), 1.25);
  EXPECT_EQ(parse_angle("-73deg"), -73 * kDegree);
  EXPECT_EQ(parse_angle("1e2deg"), 100 * kDegree);
  EXPECT_EQ(parse_angle("1 deg"), kDegree);
  EXPECT_EQ(parse_angle("73\xC2\xB0"), 73 * kDegree);
  EXPECT_EQ(parse_angle("-73 \xC2\xB0"), -73 * kDegree);
  for (const char* text : {"", "deg", " deg", "\xC2\xB0", "\xB0", "73degrees", "1rad", "1,5", "x"}) {
    EXPECT_EQ(parse_angle(text), std::nullopt) << text;
  }
}

TEST(Log, rounding_comes_from_the_most_precise_number_of_a_column) {
  const Log log = log_of("u,psi\n0,1\n0.5,1.125\n0.25,2\n");
  EXPECT_DOUBLE_EQ(log.fingers[0].place_rounding, 0.005);
  EXPECT_DOUBLE_EQ(log.fingers[0].angle_rounding, 0.0005);
}

TEST(Log, rounding_of_a_reading_bounds_what_the_digits_can_do) {
  const DiskFinger finger{0.3};
  RollPlan plan;
  plan.distance = 4;
  plan.rows = 101;
  const Log exact = roll(ellipse(), finger, plan).log;
  const std::vector<Reading> expected = readings_as_given(exact, {finger});
  std::string contacts = "u,psi\n";
  std::string travelled = "length,turn\n";
  std::string increments = "distance,dturn\n";
  for (std::size_t k = 0; k < expected.size(); ++k) {
    const auto row = [](double a, double b) {
      std::string text(64, '\0');
      text.resize(static_cast<std::size_t>(std::snprintf(text.data(), text.size(), "%.3f,%.2f\n", a, b)));
      return text;
    };
    const Reading before = k == 0 ? Reading{} : expected[k - 1];
    contacts += row(exact.fingers[0].u[k], exact.fingers[0].psi[k]);
    travelled += row(expected[k].length[0], expected[k].turn);
    increments += row(expected[k].length[0] - before.length[0], expected[k].turn - before.turn);
  }
  for (const std::string& text : {contacts, travelled, increments}) {
    const Log log = log_of(text);
    const Rounding rounding = rounding_of(log, {finger});
    const Reading found = readings(log, ellipse(), {finger}).front();
    EXPECT_LE(std::abs(found.length[0] - expected.back().length[0]), rounding.length + 1e-12) << text.substr(0, 13);
    EXPECT_LE(std::abs(found.turn - expected.back().turn), rounding.turn + 1e-12) << text.substr(0, 13);
    EXPECT_LT(rounding.length, 0.06) << text.substr(0, 13);
    EXPECT_GT(rounding.length, 0) << text.substr(0, 13);
  }
}

}  // namespace
}  // namespace rollfix::log_readings_test
