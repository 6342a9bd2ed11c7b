// The demo does what it says: six placements, then one, and 16 pairs, then one; found anew from what it leaves behind.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli.hpp"
#include "paths.hpp"
#include "rollfix/march.hpp"
#include "rollfix/outline.hpp"

namespace demo_test {
namespace {

using cli::run;
using testing::AllOf;
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

/// What can be read in a figure. Its coordinates may depend on the compiler in their last digit.
std::vector<std::string> texts_in(const std::string& svg) {
  std::vector<std::string> texts;
  for (std::size_t end = 0, start = svg.find('>'); start != std::string::npos; start = svg.find('>', end)) {
    end = svg.find('<', start);
    if (end == std::string::npos) break;
    const std::string text = svg.substr(start + 1, end - start - 1);
    if (text.find_first_not_of(" \n") != std::string::npos) texts.push_back(text);
  }
  return texts;
}

std::string figure_of_the_documents(const std::string& name) { return cli::read(checked_out("docs/" + name)); }

}  // namespace

TEST(Demo, finds_six_placements_and_sixteen_pairs_and_then_one) {
  const cli::Folder folder;
  const std::vector<Shown> shown = commands_in(run("demo").out);
  ASSERT_EQ(shown.size(), 10U);
  EXPECT_THAT(shown[1].output, HasSubstr("ambiguous (6)"));
  EXPECT_THAT(shown[2].output, HasSubstr("unique"));
  EXPECT_THAT(shown[2].output, HasSubstr("a5 of the roll to b"));
  EXPECT_THAT(shown[4].output, HasSubstr("ambiguous (4)"));
  EXPECT_THAT(shown[5].output, HasSubstr("unique"));
  EXPECT_THAT(shown[6].output, HasSubstr("ambiguous (16)"));
  EXPECT_THAT(shown[7].output, HasSubstr("unique"));
  EXPECT_THAT(shown[9].output, HasSubstr("unique"));
}

TEST(Demo, has_two_fingers_turn_as_in_the_paper_between_sixteen_intervals_each) {
  const cli::Folder folder;
  const std::string command = commands_in(run("demo").out).at(6).command;
  EXPECT_THAT(command, HasSubstr("--reading 0.58,0.94,-0.725248 --reading 1.01,1.92,-1.99849 "));
  const auto marched = rollfix::march::locate_pairs(rollfix::load_outline("gallery:spline,n=9,seed=7,wobble=0.2"),
                                                    {0.58, 0.94, -0.725248}, {1.01, 1.92, -1.99849});
  EXPECT_EQ(marched.n(), 16U);
  EXPECT_EQ(marched.m(), 16U);
  EXPECT_EQ(marched.pairs.size(), 16U);
}

TEST(Demo, shows_what_its_commands_really_print) {
  const cli::Folder folder;
  for (const Shown& shown : commands_in(run("demo -o made").out)) {
    const cli::Ran ran = cli::shell(shown.command + " --force");
    const bool writes = shown.command.find(" -o ") != std::string::npos;
    const cli::Ran again = writes ? ran : cli::shell(shown.command);
    EXPECT_EQ(again.code, 0) << shown.command << "\n" << again.err;
    EXPECT_EQ(shown.output.substr(0, again.out.size()), again.out) << shown.command;
  }
}

TEST(Demo, writes_the_same_files_as_its_commands) {
  const cli::Folder folder;
  std::size_t written = 0;
  for (const Shown& shown : commands_in(run("demo").out)) {
    const std::size_t option = shown.command.find(" -o ");
    if (option == std::string::npos) continue;
    const std::string file = shown.command.substr(option + 4);
    const std::string before = cli::read(file);
    EXPECT_EQ(cli::shell(shown.command + " --force").code, 0);
    EXPECT_FALSE(before.empty()) << file;
    EXPECT_TRUE(cli::read(file) == before) << file;
    ++written;
  }
  EXPECT_EQ(written, 5U);  // a log in each story, and two figures of pairs
}

TEST(Demo, draws_what_it_finds_and_the_figures_of_the_documents) {
  const cli::Folder folder;
  run("demo");
  EXPECT_THAT(cli::read("figure7.svg"), AllOf(HasSubstr("ambiguous (6)"), HasSubstr("unique")));
  EXPECT_THAT(cli::read("figure8.svg"), HasSubstr("ambiguous (16)"));
  EXPECT_THAT(cli::read("figure8-rolled-on.svg"), HasSubstr("unique"));
  for (const char* name : {"figure7.svg", "figure8.svg"}) {
    EXPECT_GT(texts_in(figure_of_the_documents(name)).size(), 20U) << name;
    EXPECT_EQ(texts_in(cli::read(name)), texts_in(figure_of_the_documents(name))) << name;
  }
}

}  // namespace demo_test
