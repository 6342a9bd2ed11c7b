// Sentences as a stranger reads them: no two voices in one, no noughts that nobody asked for.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>
#include <string>

#include "cli.hpp"

namespace cli_words_test {
namespace {

using cli::run;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// A roll on the cam by a disk of radius 0.2, exact.
void write_roll(const std::string& length = "3") {
  ASSERT_EQ(run("simulate gallery:cam --finger disk,r=0.2 --start 2 --samples 200 -o roll.csv --length " + length).code,
            0);
}

TEST(CliWords, where_nothing_fits_one_voice_says_so) {
  const cli::Folder folder;
  write_roll();
  const std::string exact = run("locate gallery:cam --log roll.csv --finger disk,r=0.25").out;
  EXPECT_THAT(exact, StartsWith("inconsistent: nothing fits\nlikeliest: all lengths are 0.8 ± "));
  const std::string noisy =
      run("locate gallery:cam --log roll.csv --finger disk,r=0.25 --noise contact=0.002,angle=0.2deg").out;
  EXPECT_THAT(noisy, StartsWith("inconsistent: nothing fits\nlikeliest: "));
}

TEST(CliWords, noise_that_was_not_said_is_not_listed) {
  const std::string text = run("locate gallery:cam --reading 2,1.7 --noise contact=0.01,angle=1deg").out;
  EXPECT_THAT(text, HasSubstr("\nnoise      contact 0.01, angle 1.000 deg\n"));
}

TEST(CliWords, exact_rows_teach_an_exact_part_and_not_billionths_of_a_degree) {
  const cli::Folder folder;
  write_roll("8.2");
  const cli::Ran ran = run("teach roll.csv --finger disk,r=0.2 -o taught.json");
  EXPECT_THAT(ran.err, HasSubstr("through all rows\n"));
  EXPECT_THAT(ran.err, Not(HasSubstr("e-09 deg")));
  const std::string located = run("locate taught.json --reading 0.9,0.7").out;
  EXPECT_THAT(located, Not(HasSubstr("e-09 deg")));
}

TEST(CliWords, a_figure_of_an_exact_log_shows_no_rounding) {
  const cli::Folder folder;
  ASSERT_EQ(run("simulate gallery:cam --finger disk,r=0.2 --start 2 --samples 200 --length 3 -o roll.csv").code, 0);
  ASSERT_EQ(run("locate gallery:cam --log roll.csv --finger disk,r=0.2 -o place.svg").code, 0);
  const std::string figure = cli::read("place.svg");
  EXPECT_THAT(figure, HasSubstr("in the world"));
  EXPECT_FALSE(std::regex_search(figure, std::regex("\\de(-|\u2212)[1-9]|(-|\u2212)0(\\.0*)?[ ,<]")));
}

TEST(CliWords, a_finger_that_is_too_large_for_the_figure_is_told) {
  const cli::Folder folder;
  const std::string locate = "locate gallery:cam --reading 1.5,-0.8,110.97000deg --facing -142.40990deg -o pair.svg ";
  ASSERT_EQ(run(locate + "--finger disk,r=0.05 --finger disk,r=40").code, 0);
  EXPECT_THAT(cli::read("pair.svg"), HasSubstr("a finger is too large to be drawn whole"));
  ASSERT_EQ(run(locate + "--finger disk,r=0.05 --force").code, 0);
  EXPECT_THAT(cli::read("pair.svg"), Not(HasSubstr("too large")));
}

TEST(CliWords, a_wrong_ending_of_a_parts_file_is_told_with_all_that_are_right) {
  EXPECT_THAT(run("inspect gallery:cam -o cam.dxf").err,
              HasSubstr("must end in .svg, .png or .pdf, the part's in .json, a table's of its outline in .csv"));
}

TEST(CliWords, no_help_shows_the_types_of_a_library) {
  for (const char* const command : {"catalog list", "catalog remove", "catalog build", "identify", "watch", "teach"}) {
    const std::string page = run(std::string(command) + " --help").out;
    EXPECT_FALSE(std::regex_search(page, std::regex("\\b(TEXT|REQUIRED|FLOAT|UINT|INT)\\b"))) << page;
  }
}

TEST(CliWords, an_option_is_named_as_it_was_typed) {
  EXPECT_THAT(
      run("locate gallery:cam --reading 1,1 --noise angle=1deg --heading 0,1deg").err,
      HasSubstr("--heading: a finger tells how the part lies by u and psi, expected a log of them, found readings"));
  EXPECT_THAT(run("advise --help").out, HasSubstr("--direction ccw|cw "));
  EXPECT_THAT(run("locate --help").out, HasSubstr("--direction ccw|cw|either "));
}

}  // namespace
}  // namespace cli_words_test
