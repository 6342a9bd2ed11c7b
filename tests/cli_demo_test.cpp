// The demo does what it says: six placements, then one, found anew from the files that it leaves behind.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli.hpp"

namespace {

using cli::run;
using testing::ElementsAre;
using testing::HasSubstr;

/// A command that the demo shows, and the output it shows for it.
struct Shown {
  std::string command;
  std::string output;
};

std::vector<Shown> commands_in(const std::string& text) {
  std::istringstream lines(text);
  std::vector<Shown> shown;
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("  rollfix ", 0) == 0) {
      shown.push_back({line.substr(2), ""});
    } else if (!shown.empty()) {
      shown.back().output += line + "\n";
    }
  }
  return shown;
}

}  // namespace

TEST(Demo, writes_figures_logs_and_a_part) {
  const cli::Folder folder;
  EXPECT_EQ(run("demo").code, 0);
  EXPECT_THAT(folder.files(), ElementsAre("figure7-roll.csv", "figure7.png", "figure7.svg", "wing-roll.csv", "wing.csv",
                                          "wing.png", "wing.svg"));
}

TEST(Demo, finds_six_placements_and_then_one) {
  const cli::Folder folder;
  const std::vector<Shown> shown = commands_in(run("demo").out);
  ASSERT_EQ(shown.size(), 6U);
  EXPECT_THAT(shown[1].output, HasSubstr("ambiguous (6)"));
  EXPECT_THAT(shown[2].output, HasSubstr("unique"));
  EXPECT_THAT(shown[2].output, HasSubstr("a5 of the roll to b"));
  EXPECT_THAT(shown[4].output, HasSubstr("ambiguous (4)"));
  EXPECT_THAT(shown[5].output, HasSubstr("unique"));
}

TEST(Demo, shows_what_its_commands_really_print) {
  const cli::Folder folder;
  for (const Shown& shown : commands_in(run("demo -o made").out)) {
    const cli::Ran ran = cli::shell(shown.command + " --force");
    const bool is_simulation = shown.command.rfind("rollfix simulate", 0) == 0;
    const cli::Ran again = is_simulation ? ran : cli::shell(shown.command);
    EXPECT_EQ(again.code, 0) << shown.command << "\n" << again.err;
    EXPECT_EQ(shown.output.substr(0, again.out.size()), again.out) << shown.command;
  }
}

TEST(Demo, simulates_the_same_log_as_its_command) {
  const cli::Folder folder;
  const std::string simulate = commands_in(run("demo").out).front().command;
  const std::string log = cli::read("figure7-roll.csv");
  EXPECT_EQ(cli::shell(simulate + " --force").code, 0);
  EXPECT_EQ(cli::read("figure7-roll.csv"), log);
}

TEST(Demo, draws_six_arcs_and_then_one) {
  const cli::Folder folder;
  run("demo");
  const std::string figure = cli::read("figure7.svg");
  EXPECT_THAT(figure, HasSubstr("ambiguous (6)"));
  EXPECT_THAT(figure, HasSubstr("unique"));
}

TEST(Demo, makes_the_folder_that_it_is_given_and_does_not_overwrite) {
  const cli::Folder folder;
  EXPECT_EQ(run("demo -o a/b").code, 0);
  EXPECT_TRUE(cli::fs::exists("a/b/figure7.png"));
  EXPECT_EQ(run("demo -o a/b").code, 2);
  EXPECT_EQ(run("demo -o a/b --force").code, 0);
}
