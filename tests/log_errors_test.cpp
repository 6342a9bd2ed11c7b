// Every line that a log can't have, and what the message says: file, line, value, cure.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "refusal.hpp"
#include "rollfix/log.hpp"

namespace rollfix::log_errors_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

std::string refusal(const std::string& text) {
  return refusal_of([&] { parse_log(text, "run.csv"); });
}

TEST(LogErrors, a_file_that_is_not_there) {
  EXPECT_THAT(refusal_of([] { read_log("no/such.csv"); }), AllOf(HasSubstr("no/such.csv"), HasSubstr("no such file")));
}

TEST(LogErrors, an_empty_file) {
  EXPECT_THAT(refusal(""), AllOf(StartsWith("run.csv: is empty"), HasSubstr("time,u,psi")));
  EXPECT_THAT(refusal("\n# nothing\n  \n"), StartsWith("run.csv: is empty"));
}

TEST(LogErrors, not_a_text) {
  EXPECT_THAT(refusal(std::string("\xFF\xFEt\0i\0", 6)), HasSubstr("UTF-16"));
  EXPECT_THAT(refusal(std::string("ab\0cd", 5)), HasSubstr("not a text file"));
}

TEST(LogErrors, a_header_that_is_not_understood) {
  EXPECT_THAT(refusal("# roll\nzeit,winkel\n0,1\n"),
              AllOf(StartsWith("run.csv:2: the header 'zeit,winkel'"), HasSubstr("'u' and 'psi'"),
                    HasSubstr("Known are: time, u, psi, x, y, contact, length, turn, distance, dturn")));
  EXPECT_THAT(refusal("time,lenght,trun\n0,1,2\n"), HasSubstr("did you mean 'length' by 'lenght'?"));
}

TEST(LogErrors, half_of_a_pair) {
  EXPECT_THAT(refusal("time,u\n0,1\n"), AllOf(StartsWith("run.csv:1"), HasSubstr("a column 'u' but no 'psi'")));
  EXPECT_THAT(refusal("turn,time\n0,1\n"), HasSubstr("a column 'turn' but no 'length'"));
  EXPECT_THAT(refusal("distance,dtrun\n0,1\n"),
              AllOf(HasSubstr("no 'dturn'"), HasSubstr("did you mean 'dturn' by 'dtrun'?")));
  EXPECT_THAT(refusal("u,psi,x\n0,1,2\n"), HasSubstr("a column 'x' but no 'y'"));
}

TEST(LogErrors, two_kinds_of_log_in_one) {
  EXPECT_THAT(refusal("u,psi,length,turn\n0,1,2,3\n"),
              AllOf(HasSubstr("'u' and 'psi' as well as 'length' and 'turn'"), HasSubstr("rename")));
}

TEST(LogErrors, a_column_twice) {
  EXPECT_THAT(refusal("u,psi,u\n0,1,2\n"), HasSubstr("the column 'u' occurs twice, as number 1 and 3"));
}

TEST(LogErrors, no_header_and_not_two_columns) {
  EXPECT_THAT(refusal("0,1,2\n"),
              AllOf(StartsWith("run.csv:1: the log starts with '0,1,2', 3 numbers without a header"),
                    HasSubstr("exactly two columns, distance and dturn")));
  EXPECT_THAT(refusal("17\n"), HasSubstr("1 numbers without a header"));
}

TEST(LogErrors, a_cell_that_is_no_number) {
  EXPECT_THAT(refusal("u,psi\n0,0\n1,0.5x\n"), StartsWith("run.csv:3: psi is '0.5x', expected a number such as 1.25"));
  EXPECT_THAT(refusal("u,psi,x,y\n0,0,1,1\n1,0,73deg,1\n"), StartsWith("run.csv:3: x is '73deg'"));
  EXPECT_THAT(refusal("0,0\n1,0.5x\n"), StartsWith("run.csv:2: dturn is '0.5x'"));
}

TEST(LogErrors, a_number_that_is_not_finite) {
  for (const char* value : {"nan", "NaN", "inf", "-inf", "1e999"}) {
    EXPECT_THAT(refusal(std::string("u,psi\n0,0\n") + value + ",1\n"),
                AllOf(StartsWith("run.csv:3: u is '"), HasSubstr("finite")));
  }
}

TEST(LogErrors, a_cell_that_is_missing) {
  EXPECT_THAT(refusal("time,u,psi\n0,0,0\n1,2\n"),
              StartsWith("run.csv:3: '1,2' has no psi, expected a number in column 3"));
  EXPECT_THAT(refusal("time,u,psi\n0,0,0\n1,,2\n"), StartsWith("run.csv:3: '1,,2' has no u"));
}

TEST(LogErrors, more_cells_than_columns) {
  EXPECT_THAT(refusal("time,u,psi\n0,0,0\n0,5,1,5,2\n"),
              AllOf(StartsWith("run.csv:3: '0,5,1,5,2' has 5 cells, expected 3"), HasSubstr("decimal point")));
}

TEST(LogErrors, a_decimal_comma) {
  EXPECT_THAT(refusal("u\tpsi\n0\t0\n0,5\t1\n"), StartsWith("run.csv:3: u is '0,5'"));
}

TEST(LogErrors, a_time_that_does_not_grow) {
  EXPECT_THAT(refusal("time,u,psi\n0,0,0\n\n0.5,1,1\n0.5,2,2\n"),
              StartsWith("run.csv:5: time is '0.5', expected more than 0.5 in line 4"));
  EXPECT_THAT(refusal("time,u,psi\n0,0,0\n-1,1,1\n"), StartsWith("run.csv:3: time is '-1'"));
  EXPECT_THAT(refusal("time,u,psi\n1s,0,0\n"), StartsWith("run.csv:2: time is '1s'"));
}

TEST(LogErrors, too_few_rows) {
  EXPECT_THAT(refusal("u,psi\n"), AllOf(StartsWith("run.csv: holds 0 rows"), HasSubstr("at least 2")));
  EXPECT_THAT(refusal("u,psi\n1,2\n"), AllOf(StartsWith("run.csv: holds 1 row of a roll"), HasSubstr("at least 2")));
  EXPECT_THAT(refusal("length,turn\n"), HasSubstr("at least 1"));
  EXPECT_THAT(refusal("u,psi,contact\n1,2,0\n1,2,0\n"), HasSubstr("0 rows of a roll in contact"));
}

TEST(LogErrors, contact_that_is_neither_0_nor_1) {
  EXPECT_THAT(refusal("u,psi,contact\n1,2,1\n1,2,yes\n"), StartsWith("run.csv:3: contact is 'yes', expected 0 or 1"));
  EXPECT_THAT(refusal("u,psi,contact\n1,2,0.5\n"), HasSubstr("contact is '0.5'"));
}

TEST(LogErrors, contact_that_is_lost_and_found_again) {
  EXPECT_THAT(
      refusal("u,psi,contact\n0,0,1\n1,1,1\n1,1,0\n1,1,0\n2,2,1\n"),
      AllOf(StartsWith("run.csv:4: contact is lost here and found again in line 6"), HasSubstr("split the log")));
}

TEST(LogErrors, a_long_line_is_shown_in_part) {
  const std::string message = refusal("u,psi\n0,0\n" + std::string(5000, 'x') + ",1\n");
  EXPECT_LT(message.size(), 200U);
  EXPECT_THAT(message, HasSubstr("xxx..."));
}

}  // namespace
}  // namespace rollfix::log_errors_test
