// Every log of two fingers that can't be, and what the message says: file, line, value, cure.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "refusal.hpp"
#include "rollfix/log.hpp"

namespace rollfix::pair_log_errors_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

std::string refusal(const std::string& text) {
  return refusal_of([&] { parse_log(text, "both.csv"); });
}

std::string refusal(const std::string& a, const std::string& b) {
  return refusal_of([&] { paired(parse_log(a, "a.csv"), parse_log(b, "b.csv")); });
}

TEST(PairLogErrors, two_fingers_where_one_is_expected) {
  const std::string both = "u_a,psi_a,u_b,psi_b\n0,1,2,3\n0,1,2,3\n";
  EXPECT_THAT(refusal(both, "u,psi\n0,1\n0,1\n"),
              AllOf(StartsWith("a.csv: this log is of two fingers"), HasSubstr("'u' and 'psi'")));
  EXPECT_THAT(refusal("u,psi\n0,1\n0,1\n", both), StartsWith("b.csv: this log is of two fingers"));
}

TEST(PairLogErrors, more_fingers_than_rolled) {
  const std::vector<Finger> both{DiskFinger{1}, DiskFinger{2}};
  EXPECT_THAT(refusal_of([&] { readings_as_given(parse_log("u,psi\n0,1\n0,1\n", "a.csv"), both); }),
              AllOf(StartsWith("a.csv: is of one finger"), HasSubstr("the shapes of 2")));
}

TEST(PairLogErrors, columns_of_only_one_of_two_fingers) {
  EXPECT_THAT(refusal("time,u_a,psi_a\n0,1,2\n"),
              AllOf(StartsWith("both.csv:1"), HasSubstr("of finger a but none of finger b"), HasSubstr("'u_b'")));
  EXPECT_THAT(refusal("time,u_b,psi_b\n0,1,2\n"), HasSubstr("of finger b but none of finger a"));
}

TEST(PairLogErrors, half_of_a_pair) {
  EXPECT_THAT(refusal("time,u_a,psi_a,u_b\n0,1,2,3\n"), HasSubstr("a column 'u_b' but no 'psi_b'"));
  EXPECT_THAT(refusal("time,u_a,psi_a,u_b,psl_b\n0,1,2,3,4\n"), HasSubstr("did you mean 'psi_b' by 'psl_b'?"));
  EXPECT_THAT(refusal("u_a,psi_a,u_b,psi_b,x_b\n0,1,2,3,4\n"), HasSubstr("a column 'x_b' but no 'y_b'"));
}

TEST(PairLogErrors, different_kinds_of_columns) {
  EXPECT_THAT(refusal("u_a,psi_a,length_b,turn_b\n0,1,2,3\n"), HasSubstr("other columns of finger a than of finger b"));
  EXPECT_THAT(refusal("u_a,psi_a,length_a,turn_a,u_b,psi_b\n0,1,2,3,4,5\n"),
              HasSubstr("'u_a' and 'psi_a' as well as 'length_a' and 'turn_a'"));
  EXPECT_THAT(refusal("u,psi\n0,0\n1,1\n", "length,turn\n1,1\n"),
              AllOf(HasSubstr("a.csv has u and psi, b.csv has length and turn"), HasSubstr("same columns")));
  EXPECT_THAT(refusal("length,turn\n1,1\n", "1,1\n"), HasSubstr("b.csv has distance and dturn"));
}

TEST(PairLogErrors, a_column_twice) {
  EXPECT_THAT(refusal("u_a,psi_a,u_b,psi_b,u_a\n0,1,2,3,4\n"),
              HasSubstr("the column 'u_a' occurs twice, as number 1 and 5"));
  EXPECT_THAT(refusal("u_a,psi_a,u_b,psi_b,contact,contact_b\n0,1,2,3,1,1\n"),
              HasSubstr("the column 'contact_b' occurs twice, as number 5 ('contact') and 6"));
}

TEST(PairLogErrors, a_cell_that_is_no_number_is_named_with_its_finger) {
  EXPECT_THAT(refusal("u_a,psi_a,u_b,psi_b\n0,0,0,0\n0,1,2,x\n"), StartsWith("both.csv:3: psi_b is 'x', expected"));
  EXPECT_THAT(refusal("u_a,psi_a,u_b,psi_b\n0,0,0,0\n0,nan,2,3\n"), StartsWith("both.csv:3: psi_a is 'nan'"));
  EXPECT_THAT(refusal("u_a,psi_a,u_b,psi_b\n0,0,0,0\n0,1,2\n"),
              StartsWith("both.csv:3: '0,1,2' has no psi_b, expected a number in column 4"));
  EXPECT_THAT(refusal("u_a,psi_a,u_b,psi_b,contact_b\n0,0,0,0,2\n"), StartsWith("both.csv:2: contact_b is '2'"));
  EXPECT_THAT(refusal("u_a,psi_a,u_b,psi_b,contact\n0,0,0,0,2\n"), StartsWith("both.csv:2: contact is '2'"));
}

TEST(PairLogErrors, a_time_that_does_not_grow) {
  EXPECT_THAT(refusal("time,u_a,psi_a,u_b,psi_b\n0,0,0,0,0\n0,0,1,2,3\n"), StartsWith("both.csv:3: time is '0'"));
}

TEST(PairLogErrors, contact_that_is_lost_by_one_and_found_again) {
  EXPECT_THAT(refusal("u_a,psi_a,u_b,psi_b,contact_a,contact_b\n0,0,0,0,1,1\n0,0,0,0,1,1\n0,0,0,0,0,1\n0,0,0,0,1,1\n"),
              StartsWith("both.csv:4: contact is lost here and found again in line 5"));
}

TEST(PairLogErrors, too_few_rows) {
  EXPECT_THAT(refusal("u_a,psi_a,u_b,psi_b\n0,0,0,0\n"), StartsWith("both.csv: holds 1 row of a roll"));
  EXPECT_THAT(refusal("time,u,psi,contact\n0,0,0,1\n1,1,0,1\n2,2,0,0\n3,3,0,0\n",
                      "time,u,psi,contact\n0,0,0,0\n1,5,0,0\n2,6,0,1\n3,7,0,1\n"),
              StartsWith("a.csv: holds no row of a roll in which the other finger touches"));
}

TEST(PairLogErrors, times_that_differ) {
  EXPECT_THAT(refusal("time,u,psi\n0,0,0\n0.5,0,1\n1,1,1\n", "# logger b\ntime,u,psi\n0,0,0\n0.51,0,1\n1,1,1\n"),
              AllOf(StartsWith("a.csv:3 is at the time 0.5 and b.csv:4 at 0.51"), HasSubstr("same times")));
}

TEST(PairLogErrors, different_numbers_of_rows) {
  EXPECT_THAT(refusal("time,u,psi\n0,0,0\n1,1,1\n2,2,2\n", "time,u,psi\n0,0,0\n1,1,1\n"),
              AllOf(StartsWith("a.csv has 3 rows and b.csv has 2"), HasSubstr("a.csv:4 has no partner")));
  EXPECT_THAT(refusal("u,psi\n0,0\n1,1\n", "u,psi\n0,0\n1,1\n2,2\n3,3\n"), HasSubstr("b.csv:4 has no partner"));
}

TEST(PairLogErrors, times_in_only_one_of_two_files) {
  EXPECT_THAT(refusal("time,u,psi\n0,0,0\n1,1,1\n", "u,psi\n0,0\n1,1\n"),
              StartsWith("a.csv has a column 'time' and b.csv has none"));
}

TEST(PairLogErrors, rows_without_contact_and_without_times) {
  EXPECT_THAT(refusal("u,psi,contact\n0,0,1\n1,1,1\n2,2,0\n", "u,psi,contact\n0,0,0\n1,1,1\n2,2,1\n"),
              AllOf(StartsWith("a.csv and b.csv: rows without contact"), HasSubstr("add the times")));
}

TEST(PairLogErrors, both_from_standard_input) {
  EXPECT_THAT(refusal_of([] { read_log("-", "-"); }), HasSubstr("standard input"));
}

TEST(PairLogErrors, u_without_the_fingers) {
  const Log log = parse_log("u_a,psi_a,u_b,psi_b\n0,0,0,0\n1,1,1,1\n", "both.csv");
  EXPECT_THAT(refusal_of([&] { readings_as_given(log, {}); }),
              AllOf(StartsWith("both.csv: "), HasSubstr("`finger` disk,r=")));
  EXPECT_THAT(refusal_of([&] { readings_as_given(log, {DiskFinger{1}, DiskFinger{0}}); }), HasSubstr("radius"));
}

TEST(PairLogErrors, an_instant_that_is_not_there) {
  const Log log = parse_log("time,u_a,psi_a,u_b,psi_b\n0,0,0,0,0\n1,1,1,1,1\n", "both.csv");
  EXPECT_THAT(refusal_of([&] { rows_at(log, {7}); }), AllOf(StartsWith("both.csv: "), HasSubstr("instant 7")));
}

TEST(PairLogErrors, logs_that_do_not_go_together_are_not_written) {
  Log log = parse_log("time,u_a,psi_a,u_b,psi_b\n0,0,0,0,0\n1,1,1,1,1\n", "both.csv");
  log.fingers[1].u.push_back(2);
  EXPECT_THAT(refusal_of([&] { format_log(log); }), HasSubstr("expected 2 values in column 'u_b', found 3"));
  log = parse_log("u_a,psi_a,u_b,psi_b\n0,0,3,0\n1,1,-1,1\n", "both.csv");
  EXPECT_THAT(refusal_of([&] {
                log.fingers[1].u = {3, -1};
                format_log(log);
              }),
              HasSubstr("take more rows"));
}

}  // namespace
}  // namespace rollfix::pair_log_errors_test
