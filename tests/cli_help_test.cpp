// Help pages, the manual and what completes command lines: one source, and all that they say holds.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>  // setenv

#include <sstream>
#include <string>
#include <vector>

#include "cli.hpp"

namespace cli_help_test {
namespace {

using cli::run;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

const std::vector<std::string> kCommands = {"inspect",  "locate",   "advise", "catalog build", "catalog list",
                                            "identify", "simulate", "plan",   "teach",         "watch",
                                            "demo",     "paper",    "man",    "completion"};

/// COLUMNS as long as it lives.
class Columns {
 public:
  explicit Columns(const char* width) { ::setenv("COLUMNS", width, 1); }
  ~Columns() { ::unsetenv("COLUMNS"); }
  Columns(const Columns&) = delete;
  Columns& operator=(const Columns&) = delete;
};

std::size_t longest_line(const std::string& text) {
  std::istringstream lines(text);
  std::size_t longest = 0;
  for (std::string line; std::getline(lines, line);) longest = std::max(longest, line.size());
  return longest;
}

TEST(CliHelp, fits_the_terminal) {
  const Columns usual("80");
  for (const std::string& command : kCommands) EXPECT_LE(longest_line(run(command + " --help").out), 80U) << command;
  EXPECT_LE(longest_line(run("--help").out), 80U);
  const Columns narrow("60");
  EXPECT_LE(longest_line(run("inspect --help").out), 60U);
}

TEST(CliHelp, lists_options_by_what_they_are_about) {
  const std::string page = run("locate --help").out;
  std::size_t last = 0;
  for (const char* const group : {"\nPart:\n", "\nLog:\n", "\nFinger:\n", "\nNoise:\n", "\nSearch:\n", "\nOutput:\n"}) {
    EXPECT_GT(page.find(group), last) << group;
    EXPECT_NE(page.find(group), std::string::npos) << group;
    last = page.find(group);
  }
}

TEST(CliHelp, has_every_option_in_a_group) {
  const std::string completion = run("completion bash").out;
  for (const std::string& command : kCommands) {
    const std::string page = run(command + " --help").out;
    const std::size_t at = completion.find("'" + command + "') options='");
    ASSERT_NE(at, std::string::npos) << command;
    const std::size_t from = completion.find("options='", at) + 9;
    std::istringstream options(completion.substr(from, completion.find('\'', from) - from));
    for (std::string option; options >> option;) EXPECT_THAT(page, HasSubstr(option)) << command;
  }
}

TEST(CliHelp, the_manual_has_all_commands_and_the_file_of_settings) {
  const std::string page = run("man").out;
  EXPECT_THAT(page, StartsWith(".TH ROLLFIX 1 "));
  EXPECT_THAT(page, AllOf(HasSubstr(".SS rollfix catalog build\n"), HasSubstr("\\fB\\-\\-corner\\-angle\\fR \\fIANGLE"),
                          HasSubstr(".B rollfix.toml"), HasSubstr(".SH EXIT STATUS")));
}

TEST(CliHelp, the_manual_is_what_roff_takes) {
  if (std::system("command -v groff > /dev/null") != 0) GTEST_SKIP() << "groff is not there";
  const cli::Ran ran = cli::shell("rollfix man | groff -man -ww -z 2>&1");
  EXPECT_EQ(ran.out, "");
}

/// What bash offers for a command line that ends here.
std::string completed(const std::string& words) {
  return cli::shell("bash -c 'eval \"$(rollfix completion bash)\"; COMP_WORDS=(" + words +
                    "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _rollfix; echo \"${COMPREPLY[*]}\"'")
      .out;
}

TEST(CliHelp, bash_completes_commands_options_and_words) {
  EXPECT_EQ(completed("rollfix lo"), "locate\n");
  EXPECT_EQ(completed("rollfix catalog bu"), "build\n");
  EXPECT_EQ(completed("rollfix locate --corner"), "--corner-angle\n");
  EXPECT_EQ(completed("rollfix catalog build --jo"), "--jobs\n");
  EXPECT_EQ(completed("rollfix locate x.csv --direction \"\""), "ccw cw either\n");
}

TEST(CliHelp, bash_completes_files) {
  const cli::Folder folder;
  folder.write("wing.csv", "");
  EXPECT_EQ(completed("rollfix locate wi"), "wing.csv\n");
}

TEST(CliHelp, zsh_has_every_command_with_what_it_does) {
  const std::string script = run("completion zsh").out;
  EXPECT_THAT(script, StartsWith("#compdef rollfix\n"));
  EXPECT_THAT(script, AllOf(HasSubstr("'locate:Every place on a part where a roll can have started.'"),
                            HasSubstr("'*--direction["), HasSubstr(":(ccw cw either)'")));
}

TEST(CliHelp, a_shell_that_is_not_known_is_refused) {
  EXPECT_THAT(run("completion fish").err, HasSubstr("expected bash or zsh, found fish"));
}

}  // namespace
}  // namespace cli_help_test
