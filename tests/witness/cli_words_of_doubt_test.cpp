// What the program says of an answer that the rows contradict: it looks for what is wrong, which takes seconds.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "cli.hpp"

namespace cli_words_of_doubt_test {
namespace {

using cli::run;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

}  // namespace

TEST(CliWords, what_the_other_rows_contradict_is_one_sentence) {
  const cli::Folder folder;
  folder.write("square.csv", "0 0\n4 0\n4 1\n1 1\n1 2\n0 2\n");
  std::string rows = "length,turn\n";
  for (int k = 1; k <= 8; ++k) rows += std::to_string(-0.005 * k) + ",0\n";
  for (int k = 9; k <= 16; ++k) rows += std::to_string(-0.005 * k) + (k == 12 ? ",1\n" : ",1.5707963\n");
  folder.write("back.csv", rows);
  const std::string text = run("locate square.csv --log back.csv").out;
  EXPECT_THAT(text,
              StartsWith("unique, but the rows fit badly: the place that the readings allow is contradicted by other "
                         "rows of the log or by the contacts in the world\n"));
}

TEST(CliWords, what_is_doubted_is_not_told_as_the_answer) {
  const cli::Folder folder;
  ASSERT_EQ(run("simulate gallery:limacon --finger disk,r=0.2 --start 1 --length 5 --samples 400 -o roll.csv "
                "--noise contact=0.005,angle=0.3deg --seed 4")
                .code,
            0);
  const std::string text =
      run("locate gallery:limacon --log roll.csv --finger disk,r=0.21 --noise contact=0.005,angle=0.3deg").out;
  EXPECT_THAT(text, HasSubstr(", but the rows fit badly: if all is as stated, the "));
  EXPECT_THAT(text, HasSubstr(", but what follows is likelier\nlikeliest: "));
  EXPECT_THAT(text, HasSubstr("\na0       0.00"));  // next to nothing of the probability is of what was said
  EXPECT_THAT(text, Not(HasSubstr(" 0.0000 ")));
}

TEST(CliWords, what_is_missing_first_is_told_first) {
  EXPECT_THAT(run("locate").err, HasSubstr("expected a PART"));
  EXPECT_THAT(run("advise").err, HasSubstr("expected a PART"));
  EXPECT_THAT(run("version").err, HasSubstr("did you mean 'rollfix --version'?"));
}

}  // namespace cli_words_of_doubt_test
