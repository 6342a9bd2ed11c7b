// A robot's options in a file: what is taken from it, what counts more, and what is wrong in it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "cli.hpp"

namespace cli_settings_test {
namespace {

using cli::run;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

constexpr const char* kRobot =
    "# the left hand\npart = \"gallery:cam\"\nfinger = \"disk,r=0.2\"\nnoise = \"contact=0.002,angle=0.2deg\"  # "
    "skin\n";

/// A folder with a robot's file and a log of a roll on its part.
class CliSettings : public testing::Test {
 protected:
  CliSettings() {
    EXPECT_EQ(run("simulate gallery:cam --finger disk,r=0.2 --start 2 --length 4 --samples 50 -o roll.csv").code, 0);
  }

  /// The error about a file with this text.
  static std::string refusal(const std::string& text) {
    const cli::Folder other;
    other.write("rollfix.toml", text);
    const cli::Ran ran = run("locate gallery:cam --reading 1,0.5");
    EXPECT_EQ(ran.code, 2) << text;
    EXPECT_THAT(ran.out, IsEmpty());
    return ran.err;
  }

  cli::Folder folder_;
};

TEST_F(CliSettings, a_log_alone_is_located_where_the_rest_stands_in_a_file) {
  folder_.write("rollfix.toml", kRobot);
  const cli::Ran ran = run("locate --log roll.csv --json");
  const cli::Ran typed = run(
      "locate gallery:cam --finger disk,r=0.2 --noise contact=0.002,angle=0.2deg --log roll.csv --json --no-config");
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_EQ(ran.out, typed.out);
  EXPECT_EQ(typed.err, "");
}

TEST_F(CliSettings, what_is_taken_is_told_in_one_line_that_can_be_typed) {
  folder_.write("rollfix.toml", kRobot);
  EXPECT_THAT(
      run("locate --log roll.csv").err,
      StartsWith("rollfix: rollfix.toml: gallery:cam --finger disk,r=0.2 --noise contact=0.002,angle=0.2deg\n"));
  EXPECT_EQ(run("locate --log roll.csv --quiet").err, "");
  EXPECT_THAT(run("watch --log roll.csv --once").err, StartsWith("rollfix: rollfix.toml: gallery:cam "));
}

TEST_F(CliSettings, what_is_typed_counts) {
  folder_.write("rollfix.toml", kRobot);
  const cli::Ran ran = run("locate gallery:ellipse --log roll.csv --finger disk,r=0.3");
  EXPECT_THAT(ran.err, StartsWith("rollfix: rollfix.toml: --noise contact=0.002,angle=0.2deg\n"));
  EXPECT_THAT(ran.out, HasSubstr("gallery:ellipse"));
}

TEST_F(CliSettings, what_goes_with_a_log_alone_is_left_out_where_readings_are_typed) {
  folder_.write("rollfix.toml", "log = \"roll.csv\"\ncolumns = \"u=skin:deg\"\nskip-bad = true\nheading = \"1,1\"\n");
  EXPECT_EQ(run("locate gallery:cam --reading 0.9,40deg").err, "");
}

TEST_F(CliSettings, another_part_has_none_of_what_is_said_of_the_files_part) {
  folder_.write("rollfix.toml", "part = \"plate.dxf\"\nloop = 2\nunit = \"mm\"\n");
  const cli::Ran ran = run("locate gallery:cam --reading 0.9,40deg");
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_THAT(ran.err, StartsWith("rollfix: rollfix.toml: --unit mm\n"));
}

TEST_F(CliSettings, files_are_relative_to_the_one_that_names_them) {
  cli::fs::create_directory("robot");
  folder_.write("robot/plate.csv", "0 0\n4 0\n4 3\n0 3\n");
  folder_.write("robot/hand.toml", "part = \"plate.csv\"\n[watch]\nlog = \"tcp:robot.local:7000\"\n");
  const cli::Ran ran = run("inspect --config robot/hand.toml");
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_THAT(ran.err, StartsWith("rollfix: robot/hand.toml: robot/plate.csv\n"));
}

TEST_F(CliSettings, below_a_commands_name_they_are_for_that_alone) {
  folder_.write("rollfix.toml", std::string(kRobot) + "[watch]\nevery = 10\nfinger = \"disk,r=0.25\"\n");
  EXPECT_THAT(run("locate --log roll.csv").err, HasSubstr("--finger disk,r=0.2 "));
  const cli::Ran watched = run("watch --log roll.csv --once");
  EXPECT_THAT(watched.err, AllOf(HasSubstr("--every 10"), HasSubstr("--finger disk,r=0.25"), Not(HasSubstr("r=0.2 "))));
}

TEST_F(CliSettings, of_two_fingers_a_list_has_both) {
  folder_.write("rollfix.toml", "finger = [\"disk,r=0.2\", \"disk,r=0.1\"]\n");
  const cli::Ran ran = run("locate gallery:cam --reading 1.5,-0.8,110.97000deg --facing -142.40990deg");
  EXPECT_THAT(ran.err, HasSubstr("--finger disk,r=0.2 --finger disk,r=0.1"));
}

TEST_F(CliSettings, an_error_says_that_what_it_is_about_is_from_the_file) {
  folder_.write("rollfix.toml", "part = \"gallery:cam\"\nfinger = \"disc,r=0.2\"\n");
  EXPECT_EQ(run("locate --reading 1,0.5").err,
            "rollfix: --finger disc,r=0.2: did you mean disk,r=0.2? expected a disk with its radius, as in disk,r=0.1, "
            "or jaw, or the file of an outline (--finger is from rollfix.toml:2)\n");
}

TEST_F(CliSettings, so_does_one_that_lists_what_is_known) {
  folder_.write("rollfix.toml", "noise = \"contct=1\"\n");
  EXPECT_THAT(run("locate gallery:cam --reading 1,0.5").err,
              HasSubstr("did you mean 'contact'? (--noise is from rollfix.toml:1)\n  Known are: contact"));
}

TEST_F(CliSettings, what_is_wrong_in_it_is_told_with_its_line_and_what_was_meant) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"# a\n\nfingr = \"jaw\"\n", "rollfix.toml:3: there is no setting 'fingr'; did you mean 'finger'?"},
      {"corner_angle = 1\n", "rollfix.toml:1: there is no setting 'corner_angle'; did you mean 'corner-angle'?"},
      {"[wach]\nevery = 1\n", "rollfix.toml:2: there is no command 'wach' that takes settings; did you mean 'watch'?"},
      {"[watch]\nnois = \"angle=1\"\n", "rollfix.toml:2: there is no setting 'nois'; did you mean 'noise'?"},
      {"finger = disk,r=0.2\n", "rollfix.toml:1: expected a text in quotes, finger = \"disk,r=0.2\", found disk,r=0.2"},
      {"unit = mm\n", "rollfix.toml:1: expected a text in quotes, unit = \"mm\", found mm"},
      {"noise\n", "rollfix.toml:1: expected KEY = VALUE, found noise"},
      {"part = \"a.csv\nunit = \"mm\"\n", "rollfix.toml:1: expected a text between two quotes"},
      {"unit = \"mm\"\nunit = \"cm\"\n", "rollfix.toml:2: error while parsing key-value pair: cannot redefine"},
      {"time = 2026-01-01\n", "rollfix.toml:1: time: expected a text, a number, true or false, or a list of them"},
      {"open = 1\n", "rollfix.toml:1: open: expected true or false, found 1"},
      {"force = true\n", "rollfix.toml:1: there is no setting 'force'"},
      {"a.b = 1\n", "rollfix.toml:1: there is no command 'a' that takes settings"},
      {"watch.a.b = 1\n", "rollfix.toml:1: expected a key of a command, as in [watch], found watch.a"}};
  for (const auto& [text, error] : cases) EXPECT_THAT(refusal(text), HasSubstr(error)) << text;
}

TEST_F(CliSettings, a_list_of_numbers_is_one_value_where_one_is_taken) {
  folder_.write("rollfix.toml", std::string(kRobot) + "at = [3, 5.5]\n");
  EXPECT_THAT(run("locate --log roll.csv").err, HasSubstr("--at 3,5.5"));
}

TEST_F(CliSettings, pairs_may_stand_in_a_table_and_a_name_may_hold_a_hash) {
  std::ofstream("a#b.csv") << cli::read("roll.csv");
  folder_.write("rollfix.toml", "log = \"a#b.csv\"\nnoise = {contact = 0.002, angle = \"0.2deg\"}\n");
  const cli::Ran ran = run("locate gallery:cam --finger disk,r=0.2");
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_THAT(ran.err, HasSubstr("--noise contact=0.002,angle=0.2deg"));
}

TEST_F(CliSettings, a_file_that_is_asked_for_has_to_be_there) {
  EXPECT_EQ(run("locate gallery:cam --reading 1,0.5 --config nowhere.toml").code, 2);
  EXPECT_THAT(run("locate gallery:cam --reading 1,0.5 --config a.toml --no-config").err, HasSubstr("found both"));
}

TEST_F(CliSettings, are_not_of_what_shows_or_builds) {
  folder_.write("rollfix.toml", "wrong = 1\n");
  EXPECT_EQ(run("demo -o . --quiet").code, 0);
  EXPECT_EQ(run("catalog build roll.csv -o parts.db").code, 2);  // for what it is, and not for the file beside it
}

}  // namespace
}  // namespace cli_settings_test
