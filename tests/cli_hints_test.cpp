// What is said to who typed something near to what was meant, and what can be silenced.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "cli.hpp"

namespace cli_hints_test {
namespace {

using cli::run;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// An ellipse of so many points, each off by noise of this size.
std::string scan(int count, double noise, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const auto off = [&] { return noise * normal(random); };
  std::string points;
  for (int k = 0; k < count; ++k) {
    const double angle = 2 * std::numbers::pi * k / count;
    const double x = 50 * std::cos(angle) + off();
    const double y = 30 * std::sin(angle) + off();
    points += fmt::format("{:.6f} {:.6f}\n", x, y);
  }
  return points;
}

TEST(CliHints, what_was_meant_is_named) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"locate gallery:cam --reading 1,0.5 --finger disc,r=10", "did you mean disk,r=10?"},
      {"locate gallery:cam --reading 1,0.5 --finger circle,r=10", "did you mean disk,r=10?"},
      {"locate gallery:cam --reading 1,0.5 --finger disk,10mm", "did you mean disk,r=10mm?"},
      {"locate gallery:cam --reading 1,0.5 --output where.svg", "did you mean '-o'?"},
      {"locate gallery:cam --read 1,0.5", "did you mean '--reading'?"},
      {"help", "did you mean 'rollfix --help'?"},
      {"locate gallery:cam help", "did you mean 'rollfix locate --help'?"}};
  for (const auto& [command, hint] : cases) {
    const cli::Ran ran = run(command);
    EXPECT_EQ(ran.code, 2) << command;
    EXPECT_THAT(ran.err, HasSubstr(hint)) << command;
  }
}

TEST(CliHints, two_columns_without_a_header_that_turn_too_far_look_like_touches) {
  const cli::Folder folder;
  folder.write("touches.csv", "106.4,94.4\n158,50\n192.8,57.5\n");
  folder.write("rolls.csv", "0.1,0.02\n0.1,0.03\n");
  EXPECT_THAT(run("locate gallery:cam --log touches.csv").err, HasSubstr("name them in a header, x,y"));
  EXPECT_THAT(run("locate gallery:cam --log rolls.csv").err, Not(HasSubstr("x,y")));
}

TEST(CliHints, what_is_known_stands_on_a_line_of_its_own) {
  const cli::Ran ran = run("locate gallery:cam --reading 1,0.5 --wibble");
  EXPECT_THAT(ran.err, HasSubstr("has no option --wibble\n  Known are: "));
  EXPECT_THAT(run("locate gallery:cam --readin 1,0.5").err, HasSubstr("did you mean '--reading'?\n  Known are: "));
}

TEST(CliHints, decimal_commas_are_named_wherever_numbers_are) {
  const cli::Folder folder;
  folder.write("blanks.csv", "0,5 1,5\n2,5 3,5\n4,5 1\n");
  folder.write("tabs.csv", "x\ty\n0,5\t1,5\n2,5\t3,5\n4,5\t1\n");
  folder.write("log.csv", "time\tu\tpsi\n0,0\t0,5\t1\n0,1\t0,4\t1,1\n");
  folder.write("commas.csv", "time,u,psi\n0,0,0,5,1,0\n0,1,0,4,1,1\n");
  for (const char* const command :
       {"inspect blanks.csv", "inspect tabs.csv", "locate gallery:cam --finger disk,r=0.2 --log log.csv",
        "locate gallery:cam --finger disk,r=0.2 --log commas.csv", "locate gallery:cam --reading 0,5,1,5deg",
        "locate gallery:cam --reading 0.5,1 --tolerance 0,01", "locate gallery:cam --reading 0.5,1 --finger disk,r=0,2",
        "locate gallery:cam --reading 0.5,1 --noise contact=0,1",
        "simulate gallery:cam --finger disk,r=0.2 --start 0,5 "
        "--length 1",
        "locate gallery:cam --reading 0.5,1 --noise angle=0.1 --prior 0,5,0,1",
        "advise gallery:cam --reading 0.5,1 --travel 0,5,1,5", "inspect gallery:ellipse,a=2,5,b=1"}) {
    const cli::Ran ran = run(command);
    EXPECT_EQ(ran.code, 2) << command;
    EXPECT_THAT(ran.err, AllOf(HasSubstr("decimal"), HasSubstr("comma"))) << command;
  }
}

TEST(CliHints, a_noisy_scan_is_told_how_to_be_smoothed) {
  const cli::Folder folder;
  folder.write("scan.csv", scan(300, 0.1));
  folder.write("clean.csv", scan(300, 0));
  const cli::Ran noisy = run("inspect scan.csv");
  EXPECT_THAT(noisy.err, AllOf(HasSubstr("scan.csv: the curve through its 300 points"), HasSubstr("--smooth 0.3")));
  EXPECT_THAT(run("locate scan.csv --reading 10,0.2").err, HasSubstr("--smooth 0.3"));
  EXPECT_THAT(run("inspect scan.csv --smooth 0.35").err, Not(HasSubstr("--smooth")));
  EXPECT_THAT(run("inspect clean.csv").err, IsEmpty());
}

TEST(CliHints, a_scan_that_crosses_itself_is_told_of_smoothing_and_a_figure_eight_is_not) {
  const cli::Folder folder;
  folder.write("scan.csv", scan(600, 0.6));
  const cli::Ran ran = run("inspect scan.csv");
  EXPECT_EQ(ran.code, 2);
  EXPECT_THAT(ran.err, AllOf(HasSubstr("cross itself"), HasSubstr("--smooth 2")));
  std::string eight;
  for (int k = 0; k < 100; ++k) {
    const double angle = 2 * std::numbers::pi * (k + 0.3) / 100;
    eight += fmt::format("{:.6f} {:.6f}\n", 50 * std::sin(angle), 30 * std::sin(2 * angle));
  }
  folder.write("eight.csv", eight);
  EXPECT_THAT(run("inspect eight.csv").err, AllOf(HasSubstr("cross itself"), Not(HasSubstr("--smooth"))));
}

TEST(CliHints, quiet_silences_notes_and_not_errors) {
  const cli::Folder folder;
  folder.write("clockwise.csv", "0 0\n0 10\n4 12\n10 3\n");
  const std::string inspect = "inspect clockwise.csv --corner-angle 20deg";
  EXPECT_THAT(run(inspect).err, HasSubstr("clockwise"));
  const cli::Ran quiet = run(inspect + " --quiet");
  EXPECT_THAT(quiet.err, IsEmpty());
  EXPECT_EQ(quiet.out, run(inspect).out);
  EXPECT_THAT(run("inspect missing.csv --quiet").err, HasSubstr("no such file"));
  EXPECT_THAT(run("simulate gallery:cam --finger disk,r=0.2 --start 0.5 --length 1 --quiet").err, IsEmpty());
}

TEST(CliHints, a_log_does_not_go_into_a_file_of_another_kind) {
  const cli::Folder folder;
  const std::string simulate = "simulate gallery:cam --finger disk,r=0.2 --start 0.5 --length 1 -o ";
  for (const char* const name : {"sim.json", "sim.svg"}) {
    const cli::Ran ran = run(simulate + name);
    EXPECT_EQ(ran.code, 2);
    EXPECT_THAT(ran.err, HasSubstr("sim.csv"));
  }
  EXPECT_THAT(folder.files(), IsEmpty());
  EXPECT_EQ(run(simulate + "sim.txt").code, 0);
}

TEST(CliHints, advise_answers_where_one_place_is_left_and_draws_nothing) {
  const cli::Folder folder;
  const cli::Ran ran = run("advise gallery:log-spiral --reading 2,1.4000001 -o next.svg");
  EXPECT_THAT(ran.out, HasSubstr("unique: there is only one place left"));
  EXPECT_EQ(ran.code, 0);
  EXPECT_THAT(ran.err, HasSubstr("nothing is drawn: there is only one place left"));
  EXPECT_THAT(folder.files(), IsEmpty());
}

TEST(CliHints, only_a_roll_that_tells_nothing_is_said_to_tell_nothing_however_long) {
  const cli::Ran none = run("locate gallery:cam --reading 0.5,0.5,0 --facing 0");
  EXPECT_THAT(none.out, HasSubstr("no such roll, however long"));
  const cli::Ran wide = run("locate gallery:gear --reading 0.5,-0.3,0.2 --reading 0.9,-0.5,0.3 --tolerance 3");
  EXPECT_THAT(wide.out, AllOf(HasSubstr("unobservable: within the tolerance"), Not(HasSubstr("however long"))));
}

TEST(CliHints, with_noise_a_pose_has_its_instant_and_its_deviations) {
  const cli::Folder folder;
  ASSERT_EQ(run("simulate gallery:cam --finger disk,r=0.2 --start 0.5 --length 2.5 -o roll.csv").code, 0);
  const cli::Ran ran = run("locate gallery:cam --finger disk,r=0.2 --log roll.csv --noise contact=1e-3,angle=1e-3");
  EXPECT_THAT(ran.out, testing::ContainsRegex(
                           "a0: at the first contact, at 0 s, the part was at x = [-0-9.]+ ± [-0-9.e]+, y = [-0-9.]+ ± "
                           "[-0-9.e]+, heading [-0-9.]+ ± [-0-9.e]+ deg"));
}

TEST(CliHints, a_host_that_is_not_known_is_an_error_and_not_awaited) {
  const cli::Ran ran = run(
      "watch gallery:cam --finger disk,r=0.2 --noise angle=0.01 --log tcp:no-such-host.invalid:7000 --idle-timeout 20");
  EXPECT_EQ(ran.code, 2);
  EXPECT_THAT(ran.err, HasSubstr("the host 'no-such-host.invalid' can't be found"));
}

}  // namespace
}  // namespace cli_hints_test
