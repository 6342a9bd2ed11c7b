// Exit codes, what goes where, files, and help.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "cli.hpp"

namespace cli_output_test {
namespace {

using cli::Json;
using cli::run;
using testing::AllOf;
using testing::AnyOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// The lines of help pages that show a command, with those that go on after a backslash.
std::vector<std::string> examples_in(const std::string& help) {
  std::istringstream lines(help);
  std::vector<std::string> examples;
  bool goes_on = false;
  for (std::string line; std::getline(lines, line);) {
    if (goes_on) examples.back() += "\n" + line;
    if (!goes_on && line.rfind("  rollfix ", 0) == 0) examples.push_back(line);
    goes_on = !examples.empty() && line.size() > 1 && line.back() == '\\';
  }
  return examples;
}

}  // namespace

TEST(ExitCode, is_0_when_something_fits) { EXPECT_EQ(run("locate gallery:ellipse --reading 1.5,1.25").code, 0); }

TEST(ExitCode, is_1_when_nothing_fits) {
  const cli::Ran ran = run("locate gallery:ellipse --reading 1.5,-2.25");
  EXPECT_EQ(ran.code, 1);
  EXPECT_THAT(ran.out, StartsWith("inconsistent: nothing fits; check the units, the signs"));
  EXPECT_EQ(run("locate gallery:ellipse --reading 1.5,-2.25 --json").json()["placements"], Json::array());
}

TEST(ExitCode, is_3_when_the_budget_runs_out) {
  const cli::Ran ran = run("locate gallery:ellipse --reading 4.844,3.1415 --budget 2");
  EXPECT_EQ(ran.code, 3);
  EXPECT_THAT(ran.out, StartsWith("undecided"));
  EXPECT_THAT(ran.out, HasSubstr("--budget"));
  EXPECT_THAT(ran.out, HasSubstr("not decided: starts from"));
}

TEST(ExitCode, of_the_program_is_that_of_the_run) {
  EXPECT_EQ(cli::shell("rollfix locate gallery:ellipse --reading 1.5,1.25").code, 0);
  EXPECT_EQ(cli::shell("rollfix locate gallery:ellipse --reading 1.5,-2.25").code, 1);
  EXPECT_EQ(cli::shell("rollfix locate gallery:ellipse").code, 2);
}

TEST(LocateText, starts_with_the_verdict_and_what_to_do) {
  EXPECT_THAT(run("locate gallery:ellipse --reading 1.5,1.25").out,
              StartsWith("ambiguous (4): roll on to tell them apart\n"));
  EXPECT_THAT(run("locate gallery:log-spiral --reading 1,0.5 --tolerance 1e-6").out,
              StartsWith("unique: the finger started between s = "));
  EXPECT_THAT(run("locate gallery:log-spiral --reading 1,0.5 --tolerance 1e-9").out,
              StartsWith("unique: the finger started at s = "));
  EXPECT_THAT(run("locate gallery:circle --reading 0.5,0.5").out, StartsWith("unobservable: "));
}

TEST(LocateText, says_the_tolerance_in_use_and_where_it_is_from) {
  EXPECT_THAT(run("locate gallery:ellipse --reading 2,1").out, HasSubstr("= 1e-09 rad, default"));
  EXPECT_THAT(run("locate gallery:ellipse --reading 2,1.00").out, HasSubstr("= 0.015 rad, from the digits given"));
  EXPECT_THAT(run("locate gallery:ellipse --reading 2,1 --tolerance 1deg").out,
              HasSubstr("tolerance  1 deg = 0.0175 rad, as given"));
}

TEST(LocateText, explains_stretches_and_corners) {
  EXPECT_THAT(run("locate gallery:polygon,n=4 --reading 1,0").out,
              HasSubstr("a0: every start from 0.000000 to 0.414214 fits"));
  EXPECT_THAT(run("locate gallery:polygon,n=4 --reading 1,45deg").out,
              HasSubstr("at a corner: the tangent points 90.000 deg at the start, 135.000 deg at the end"));
}

TEST(LocateText, shows_forty_placements_and_says_how_many_more_there_are) {
  const std::string out = run("locate gallery:gear,teeth=60 --reading 0.02,0.1").out;
  EXPECT_THAT(out, HasSubstr("\na39 "));
  EXPECT_THAT(out, Not(HasSubstr("\na40 ")));
  EXPECT_THAT(out, HasSubstr("more; --json lists them all"));
}

TEST(Narration, goes_to_stderr) {
  const cli::Folder folder;
  const cli::Ran ran = run("inspect gallery:cam --json -o cam.svg");
  EXPECT_EQ(ran.json()["part"]["name"], "gallery:cam");
  EXPECT_EQ(ran.err, "rollfix: wrote cam.svg\n");
}

TEST(Narration, tells_when_an_outline_was_turned_round) {
  const cli::Folder folder;
  folder.write("square.csv", "0 0\n0 1\n1 1\n1 0\n");
  const cli::Ran ran = run("inspect square.csv --json");
  EXPECT_EQ(ran.json()["part"]["reversed"], true);
  EXPECT_THAT(ran.err, HasSubstr("square.csv runs clockwise"));
}

TEST(Parts, that_cross_themselves_are_taken_when_allowed) {
  const cli::Folder folder;
  folder.write("bow.csv", "0 0\n2 2\n2 0\n0 2\n");
  EXPECT_EQ(run("inspect bow.csv --allow-crossing").code, 0);
}

TEST(Parts, can_be_gallery_shapes_in_json) {
  const cli::Folder folder;
  folder.write("wing.json", R"({"gallery": "naca", "parameters": {"digits": "0012", "chord": 3}})");
  const Json from_file = run("inspect wing.json --json").json();
  const Json from_name = run("inspect gallery:naca,digits=0012,chord=3 --json").json();
  EXPECT_EQ(from_file["part"]["name"], "wing.json");
  EXPECT_EQ(from_file["part"]["perimeter"], from_name["part"]["perimeter"]);
}

TEST(Parts, of_points_take_the_corner_angle_in_degrees) {
  const cli::Folder folder;
  folder.write("hexagon.csv", "2 0\n1 1.732\n-1 1.732\n-2 0\n-1 -1.732\n1 -1.732\n");
  EXPECT_EQ(run("inspect hexagon.csv --json").json()["part"]["corners"], 6);
  EXPECT_EQ(run("inspect hexagon.csv --corner-angle 70deg --json").json()["part"]["corners"], 0);
}

TEST(Figures, are_written_in_the_format_of_their_ending) {
  const cli::Folder folder;
  const std::string locate = "locate gallery:ellipse --reading 1.5,1.25 --finger disk,r=0.2 -o ";
  EXPECT_EQ(run(locate + "a.svg").code, 0);
  EXPECT_EQ(run(locate + "a.png").code, 0);
  EXPECT_EQ(run("inspect gallery:ellipse -o a.pdf").code, 0);
  EXPECT_THAT(cli::read("a.svg"), HasSubstr("<svg"));
  EXPECT_THAT(cli::read("a.png"), StartsWith("\x89PNG"));
  EXPECT_THAT(cli::read("a.pdf"), StartsWith("%PDF"));
}

TEST(Figures, go_to_stdout_as_svg_when_asked) {
  const cli::Ran ran = run("locate gallery:ellipse --reading 1.5,1.25 -o -");
  EXPECT_THAT(ran.out, HasSubstr("</svg>"));
  EXPECT_EQ(ran.err, "rollfix: ambiguous (4): roll on to tell them apart\n");
}

TEST(Force, replaces_a_file) {
  const cli::Folder folder;
  folder.write("cam.svg", "old");
  EXPECT_EQ(run("inspect gallery:cam -o cam.svg --force").code, 0);
  EXPECT_THAT(cli::read("cam.svg"), HasSubstr("<svg"));
  EXPECT_EQ(folder.files(), std::vector<std::string>{"cam.svg"});
}

TEST(Devices, can_be_written_to_without_force) {
  EXPECT_EQ(run("simulate gallery:cam --finger disk,r=1 --start 0 --length 1 -o /dev/null").code, 0);
}

TEST(Help, starts_with_what_it_is_for_and_examples) {
  for (const std::string command : {"", "inspect ", "locate ", "simulate ", "teach ", "demo "}) {
    const cli::Ran ran = run(command + "--help");
    EXPECT_EQ(ran.code, 0);
    EXPECT_EQ(ran.err, "");
    EXPECT_GE(examples_in(ran.out).size(), 2U) << command;
    EXPECT_LT(ran.out.find("Examples"), ran.out.find("Usage: rollfix " + command)) << command;
  }
}

TEST(Help, calls_each_argument_in_the_usage_as_in_its_list) {
  EXPECT_THAT(run("locate --help").out, HasSubstr("rollfix locate PART [OPTIONS]"));
  EXPECT_THAT(run("teach --help").out, HasSubstr("rollfix teach LOG [OPTIONS]"));
  EXPECT_THAT(run("demo --help").out, HasSubstr("-o FOLDER"));
}

TEST(Help, has_examples_that_work) {
  const cli::Folder folder;
  folder.write("problems.jsonl", "{\"readings\": [\"60.1,5.12deg\"]}\n");
  for (const std::string command : {"", "inspect ", "locate ", "simulate ", "teach ", "demo "}) {
    for (const std::string& example : examples_in(run(command + "--help").out)) {
      const cli::Ran ran = cli::shell(example);
      EXPECT_EQ(ran.code, 0) << example << "\n" << ran.err;
    }
  }
}

TEST(Verbose, adds_widths_sensitivities_and_what_was_taken_as_exact) {
  const std::string locate = "locate gallery:ellipse --reading 1.5,1.25";
  const std::string text = run(locate).out;
  EXPECT_THAT(text, StartsWith("ambiguous (4): roll on to tell them apart\n\n    kind"));
  EXPECT_THAT(text, Not(AnyOf(HasSubstr("width"), HasSubstr("ds/dturn"), HasSubstr("error"))));
  EXPECT_THAT(run(locate + " --verbose").out, AllOf(HasSubstr("width"), HasSubstr("ds/dturn"), HasSubstr("error")));
}

TEST(Version, is_told) { EXPECT_THAT(run("--version").out, StartsWith("rollfix 0.")); }

TEST(Inspect, joints_of_rounded_digits_are_no_corners_and_stop_no_disk) {
  const cli::Folder folder;
  for (const char* const middle : {"0.0001", "-0.0001"}) {  // either side of the line
    folder.write("plate.svg", std::string("<svg xmlns='http://www.w3.org/2000/svg' viewBox='-1 -1 30 20' width='30mm' "
                                          "height='20mm'><path d='M 0 0 L 10 ") +
                                  middle + " L 20 0 L 20 10 L 0 10 Z'/></svg>");
    const std::string text = run("inspect plate.svg").out;
    EXPECT_THAT(text, HasSubstr("corners      4, at"));
    EXPECT_THAT(text,
                HasSubstr("joints       1, of at most 0.0011 deg: smooth but for rounded digits, and rolled over"));
    EXPECT_THAT(text, HasSubstr("disk         of any size rolls all around"));
    EXPECT_EQ(run("inspect plate.svg --json").json()["corners"][0]["joint"], false);
  }
}

TEST(Inspect, a_corner_that_stops_every_disk_is_named) {
  const cli::Folder folder;
  folder.write("notch.csv", "0 0\n2 0\n2 2\n1 1\n0 2\n");
  EXPECT_THAT(run("inspect notch.csv").out,
              HasSubstr("disk         of no size rolls all around: the corner at 5.414214 is concave, -90.000 deg"));
}

void write_ellipse(const std::string& file, int count) {
  std::ofstream points(file);
  points.precision(12);
  const double step = 2 * std::acos(-1) / count;
  for (int k = 0; k < count; ++k) points << std::cos(k * step) << ' ' << 0.7 * std::sin(k * step) << '\n';
}

TEST(Progress, is_told_on_a_terminal_and_gone_in_the_end) {
  const cli::Folder folder;
  std::string shown;
  for (int count = 200000; shown.find("\rrollfix: ") == std::string::npos && count < 4000000; count *= 2) {
    write_ellipse("dense.csv", count);  // as many as this machine takes long for
    const cli::Ran ran = cli::shell("script -qec 'rollfix inspect dense.csv' /dev/null");
    EXPECT_EQ(ran.code, 0);
    shown = ran.out;
  }
  EXPECT_THAT(shown, testing::ContainsRegex("\rrollfix: [a-z ]+, [0-9]+ s *\r"));
  EXPECT_EQ(cli::shell("rollfix inspect gallery:ellipse").err.find("\r"), std::string::npos);
}

}  // namespace cli_output_test
