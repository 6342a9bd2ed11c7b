// --robust on logs in which rows jump away and back.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <sstream>
#include <string>
#include <vector>

#include "cli.hpp"

namespace cli_robust_test {
namespace {

using cli::run;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

constexpr const char* kRoll =
    "simulate gallery:cam --finger disk,r=0.2 --start 0.5 --length 2.5 --samples 101 --noise contact=1e-4,angle=1e-4 "
    "-o ";
constexpr const char* kLocate =
    "locate gallery:cam --finger disk,r=0.2 --noise contact=1e-4,angle=1e-4 --json --quiet --log ";

/// The lines of a file; the header is the first.
std::vector<std::string> lines_of(const std::string& file) {
  std::istringstream text(cli::read(file));
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

/// The same log with u of these lines, counted from 1 as the header, so far off.
void write_with_strays(const cli::Folder& folder, const std::string& from, const std::string& to,
                       const std::vector<std::size_t>& strays, double off) {
  std::vector<std::string> lines = lines_of(from);
  for (const std::size_t line : strays) {
    std::string& row = lines[line - 1];
    const std::size_t u = row.find(',') + 1;
    const std::size_t end = row.find(',', u);
    row.replace(u, end - u, fmt::format("{}", std::stod(row.substr(u, end - u)) + off));
  }
  folder.write(to, fmt::format("{}\n", fmt::join(lines, "\n")));
}

TEST(CliRobust, rows_that_jump_away_and_back_are_left_out_and_named) {
  const cli::Folder folder;
  ASSERT_EQ(run(std::string(kRoll) + "roll.csv").code, 0);
  for (const double off : {40.0, -8.0, 11.0}) {
    write_with_strays(folder, "roll.csv", "strays.csv", {30, 57, 58, 102}, off);
    const cli::Ran refused = run(std::string(kLocate) + "strays.csv");
    EXPECT_EQ(refused.code, 2);
    EXPECT_THAT(refused.err, AllOf(HasSubstr("strays.csv:30: expected a roll that goes on"), HasSubstr("--robust")));
    const cli::Json found = run(std::string(kLocate) + "strays.csv --robust").json();
    EXPECT_EQ(found["stray_lines"], cli::Json({30, 57, 58, 102})) << off;
    ASSERT_FALSE(found["placements"].empty());
    EXPECT_NEAR(found["placements"][0]["mean"][0], 0.5, 5e-3) << off;
  }
}

TEST(CliRobust, a_jump_from_which_no_row_comes_back_is_refused_all_the_same) {
  const cli::Folder folder;
  ASSERT_EQ(run(std::string(kRoll) + "roll.csv").code, 0);
  std::vector<std::size_t> rest;
  for (std::size_t line = 50; line <= 102; ++line) rest.push_back(line);
  write_with_strays(folder, "roll.csv", "jump.csv", rest, 40);
  const cli::Ran ran = run(std::string(kLocate) + "jump.csv --robust");
  EXPECT_EQ(ran.code, 2);
  EXPECT_THAT(ran.err, AllOf(HasSubstr("jump.csv:50: expected a roll that goes on, found a jump"),
                             HasSubstr("; split the log there\n")));  // no word of what does not help
}

TEST(CliRobust, watch_goes_on_with_the_roll_behind_a_stray_row) {
  const cli::Folder folder;
  ASSERT_EQ(run(std::string(kRoll) + "roll.csv").code, 0);
  write_with_strays(folder, "roll.csv", "strays.csv", {57}, 40);
  const std::string watch =
      "watch gallery:cam --finger disk,r=0.2 --noise contact=1e-4,angle=1e-4 --once --jsonl --log strays.csv";
  const auto rolls = [](const std::string& out) {
    std::istringstream lines(out);
    cli::Json last;
    for (std::string line; std::getline(lines, line);) last = cli::Json::parse(line);
    return last["counts"]["rolls"].get<int>();
  };
  EXPECT_EQ(rolls(run(watch).out), 3);  // up to the row, the row alone, and the rest
  const cli::Ran robust = run(watch + " --robust");
  EXPECT_EQ(rolls(robust.out), 1);
  EXPECT_THAT(robust.err, HasSubstr("strays.csv:57: a stray row: "));
}

TEST(CliRobust, a_jump_in_degrees_is_told_how_degrees_are_written) {
  const cli::Folder folder;
  std::string log = "time,u,psi\n";
  for (int k = 0; k < 60; ++k) log += fmt::format("{},{},{}\n", k, -10 - 3 * k, k < 30 ? 150 + k : 150 + k - 360);
  folder.write("degrees.csv", log);
  const cli::Ran ran = run("locate gallery:ellipse,a=200,b=150 --finger disk,r=1 --log degrees.csv");
  EXPECT_EQ(ran.code, 2);
  EXPECT_THAT(ran.err, AllOf(HasSubstr("found a jump"), HasSubstr("--columns u=u:deg,psi=psi:deg")));
  EXPECT_THAT(
      run("locate gallery:ellipse,a=200,b=150 --finger disk,r=1 --columns u=u:deg,psi=psi:deg --log degrees.csv").err,
      Not(HasSubstr("found a jump")));
}

TEST(CliRobust, a_jump_in_degrees_is_told_by_the_names_of_the_header) {
  const cli::Folder folder;
  std::string log = "t_sec,pad,wrist\n";
  for (int k = 0; k < 60; ++k) log += fmt::format("{},{},{}\n", k, -10 - 3 * k, k < 30 ? 150 + k : 150 + k - 360);
  folder.write("named.csv", log);
  const std::string locate = "locate gallery:ellipse,a=200,b=150 --finger disk,r=1 --log named.csv --columns ";
  EXPECT_THAT(run(locate + "u=pad,psi=wrist,time=t_sec:s").err,
              HasSubstr("--columns u=pad:deg,psi=wrist:deg,time=t_sec:s"));
  EXPECT_THAT(run(locate + "u=pad:deg,psi=wrist:deg,time=t_sec:s").err, Not(HasSubstr("found a jump")));
}

}  // namespace
}  // namespace cli_robust_test
