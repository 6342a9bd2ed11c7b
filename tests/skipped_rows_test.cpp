// Rows that loggers always have: refused with what leaves them out, or left out and told.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "cli.hpp"
#include "refusal.hpp"
#include "rollfix/log.hpp"

namespace rollfix::skipped_rows_test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr const char* kRows =
    "time,u,psi\n0,0,0\n1,-0.1,0.15\n1,-0.1,0.15\n2,nan,0.3\n3,-0.3,\n4,-0.4,0.6\n5,-0.5,0.75\n6,-0.6";

LogOptions skipping() {
  LogOptions options;
  options.skip_bad = true;
  return options;
}

TEST(SkippedRows, a_row_that_can_not_be_read_is_refused_with_what_leaves_it_out) {
  EXPECT_THAT(refusal_of([] { parse_log(kRows, "run.csv"); }),
              AllOf(HasSubstr("run.csv:4: time is '1', expected more than 1 in line 3"),
                    HasSubstr("; `skip_bad` leaves such rows out")));
}

TEST(SkippedRows, they_are_left_out_where_that_is_asked_and_told) {
  const Log log = parse_log(kRows, "run.csv", skipping());
  EXPECT_THAT(log.time, ElementsAre(0, 1, 4, 5));
  EXPECT_THAT(log.fingers[0].u, ElementsAre(0, -0.1, -0.4, -0.5));
  EXPECT_THAT(log.fingers[0].line, ElementsAre(2U, 3U, 7U, 8U));
  ASSERT_EQ(log.skipped.size(), 4U);
  EXPECT_THAT(log.skipped[0], HasSubstr("run.csv:4: time"));
  EXPECT_THAT(log.skipped[1], HasSubstr("run.csv:5: u is 'nan'"));
  EXPECT_THAT(log.skipped[3], HasSubstr("run.csv:9: '6,-0.6' has no psi"));
}

TEST(SkippedRows, where_no_row_can_be_read_leaving_them_out_is_no_cure) {
  EXPECT_THAT(refusal_of([] { parse_log("time,u,psi\n2026-01-01,0,0\n2026-01-02,-0.1,0.15\n", "run.csv"); }),
              AllOf(HasSubstr("run.csv:2: time is '2026-01-01'"), Not(HasSubstr("skip_bad"))));
}

TEST(SkippedRows, where_all_are_left_out_the_log_is_refused_with_the_reason) {
  EXPECT_THAT(
      refusal_of([] { parse_log("u,psi\n0,5,1,25\n0,6,1,5\n", "run.csv", skipping()); }),
      AllOf(HasSubstr("run.csv: holds 0 rows of a roll"), HasSubstr("2 rows were left out, the first: run.csv:2")));
}

TEST(SkippedRows, decimal_commas_between_commas_are_told_what_separates_cells_beside_them) {
  LogOptions options;
  options.decimal_comma = true;
  EXPECT_THAT(refusal_of([&] { parse_log("u,psi\n0,5,1,25\n", "run.csv", options); }),
              HasSubstr("beside decimal commas cells are separated by semicolons, tabs or blanks"));
}

TEST(SkippedRows, a_header_that_is_wrong_is_refused_all_the_same) {
  EXPECT_THAT(refusal_of([] { parse_log("a,b\n1,2\n", "run.csv", skipping()); }), HasSubstr("does not say"));
}

TEST(SkippedRows, of_two_logs_both_are_told) {
  const Log a = parse_log("u,psi\n0,0\nx,1\n1,1\n", "a.csv", skipping());
  const Log b = parse_log("u,psi\n0,0\n1,1\n1,-\n", "b.csv", skipping());
  EXPECT_EQ(paired(a, b).skipped.size(), 2U);
}

TEST(SkippedRows, the_program_says_how_many_and_goes_on) {
  const cli::Folder folder;
  folder.write("run.csv", kRows);
  const std::string words = "locate gallery:circle,r=2 --log run.csv --finger disk,r=1";
  const cli::Ran refused = cli::run(words);
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, HasSubstr("; --skip-bad leaves such rows out"));
  const cli::Ran ran = cli::run(words + " --skip-bad");
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_THAT(ran.err, HasSubstr("run.csv: 4 rows left out, the first: run.csv:4: time is '1'"));
  EXPECT_THAT(cli::run("locate gallery:circle,r=2 --reading 1,0.5 --skip-bad").err,
              HasSubstr("--skip-bad is about a log"));
}

TEST(SkippedRows, of_a_batch_are_told_in_the_answer) {
  const cli::Folder folder;
  folder.write("run.csv", kRows);
  folder.write("problems.jsonl", "{\"log\": \"run.csv\", \"skip_bad\": true}\n");
  const cli::Ran ran = cli::run("locate gallery:circle,r=2 --finger disk,r=1 --batch problems.jsonl");
  EXPECT_EQ(ran.code, 0) << ran.out;
  EXPECT_THAT(ran.json()["notes"][0].get<std::string>(), HasSubstr("run.csv: 4 rows left out"));
}

TEST(SkippedRows, of_swapped_halves_watch_says_once_that_time_went_back) {
  const cli::Folder folder;
  cli::run("simulate gallery:circle,r=2 --finger disk,r=1 --start 1 --length 3 --samples 40 -o roll.csv");
  EXPECT_EQ(cli::shell("head -1 roll.csv > swapped.csv; tail -20 roll.csv >> swapped.csv; head -21 roll.csv | tail -20 "
                       ">> swapped.csv")
                .code,
            0);
  const cli::Ran ran =
      cli::run("watch gallery:circle,r=2 --finger disk,r=1 --noise angle=1deg --log swapped.csv --once");
  EXPECT_THAT(ran.err,
              AllOf(HasSubstr("swapped.csv:22: time is"),
                    HasSubstr("swapped.csv:23: time went back: rows are left out"), Not(HasSubstr("swapped.csv:24"))));
}

TEST(SkippedRows, one_that_is_repeated_is_a_row_like_any_other) {
  const cli::Folder folder;
  folder.write("run.csv", "time,u,psi\n0,0,0\n1,-0.1,0.15\n1,-0.1,0.15\n2,-0.2,0.3\n2,-0.2,0.3\n3,-0.3,0.45\n");
  const cli::Ran ran = cli::run("watch gallery:circle,r=2 --finger disk,r=1 --noise angle=1deg --log run.csv --once");
  EXPECT_THAT(ran.err,
              AllOf(HasSubstr("run.csv:4: time is"), HasSubstr("run.csv:6: time is"), Not(HasSubstr("went back"))));
}

}  // namespace
}  // namespace rollfix::skipped_rows_test
