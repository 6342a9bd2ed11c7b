// Two fingers on the command line: simulated logs, what is read from them, and poses as JSON.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "answer/steps.hpp"
#include "cli.hpp"
#include "documents/documents.hpp"
#include "refusal.hpp"
#include "rollfix/arguments/arguments.hpp"
#include "rollfix/curve.hpp"
#include "rollfix/error.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/output/answer_output.hpp"
#include "rollfix/solve.hpp"

namespace cli_two_fingers_test {
namespace {

using cli::Json;
using cli::run;
using rollfix::Answer;
using rollfix::Log;
using rollfix::Observation;
using rollfix::Part;
using rollfix::solve;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

const std::string kSpline = "simulate gallery:spline,seed=3 --finger disk,r=0.1 --start 1 --start 4";
const std::string kRoll = kSpline + " --length 1.5 --length -0.8 --part-rotation 30deg";

Log log_in(const std::vector<std::string>& files) {
  std::vector<std::string> notes;
  return rollfix::app::read_roll(files, "", {}, notes);
}

}  // namespace

TEST(CliTwoFingers, simulate_writes_one_log_of_both) {
  const cli::Folder folder;
  const cli::Ran ran = run(kRoll + " -o both.csv");
  EXPECT_EQ(ran.code, 0);
  EXPECT_EQ(ran.out, "");
  EXPECT_THAT(ran.err, AllOf(HasSubstr("finger a rolled from s = 1.000000 over length 1.500000"),
                             HasSubstr("finger b rolled from s = 4.000000 over length -0.800000"),
                             HasSubstr("the part turned by 30.000 deg"), HasSubstr("wrote both.csv")));
  EXPECT_THAT(cli::read("both.csv"), StartsWith("time,u_a,psi_a,x_a,y_a,u_b,psi_b,x_b,y_b\n0.0000000000000000,"));
}

TEST(CliTwoFingers, simulate_writes_a_log_of_each_when_asked) {
  const cli::Folder folder;
  run(kRoll + " -o both.csv");
  EXPECT_EQ(run(kRoll + " -o a.csv -o b.csv").code, 0);
  EXPECT_EQ(rollfix::format_log(log_in({"a.csv", "b.csv"})), cli::read("both.csv"));
}

TEST(CliTwoFingers, simulate_prints_the_log_when_no_file_is_named) {
  const cli::Folder folder;
  run(kRoll + " -o both.csv");
  EXPECT_EQ(run(kRoll).out, cli::read("both.csv"));
  EXPECT_EQ(run(kRoll + " -o -").out, cli::read("both.csv"));
}

TEST(CliTwoFingers, simulate_takes_samples_contact_angles_and_two_radii) {
  const cli::Folder folder;
  run(kRoll + " --finger disk,r=0.05 --samples 31 --contact-angle 10deg --contact-angle 20deg -o both.csv");
  const Log log = log_in({"both.csv"});
  EXPECT_EQ(log.rows(), 31U);
  EXPECT_NEAR(log.fingers[0].u[0], std::numbers::pi / 18, 1e-12);
  EXPECT_NEAR(log.fingers[1].u[0], std::numbers::pi / 9, 1e-12);
  EXPECT_NEAR(log.fingers[0].u[30] - log.fingers[0].u[0], -1.5 / 0.1, 1e-9);
  EXPECT_NEAR(log.fingers[1].u[30] - log.fingers[1].u[0], 0.8 / 0.05, 1e-9);
}

TEST(CliTwoFingers, one_contact_angle_is_of_both) {
  const cli::Folder folder;
  run(kRoll + " --contact-angle 10deg -o both.csv");
  const Log log = log_in({"both.csv"});
  EXPECT_NEAR(log.fingers[0].u[0], std::numbers::pi / 18, 1e-12);
  EXPECT_NEAR(log.fingers[1].u[0], std::numbers::pi / 18, 1e-12);
}

TEST(CliTwoFingers, a_log_gives_the_middle_reading_and_the_last_and_the_facing) {
  const cli::Folder folder;
  run(kRoll + " -o both.csv");
  const Part part(rollfix::gallery("spline,seed=3"));
  const Log log = log_in({"both.csv"});
  const Observation seen = rollfix::observe({part, log, {0.1}});
  EXPECT_EQ(seen.rolls.size(), 101U);
  EXPECT_THAT(seen.times, ElementsAre(log.time[50], log.time[100]));
  ASSERT_EQ(seen.readings.size(), 2U);
  EXPECT_NEAR(seen.readings[1].length[0], 1.5, 1e-9);
  EXPECT_NEAR(seen.readings[1].length[1], -0.8, 1e-9);
  const auto angle = [&](double s) { return part.turning().angle(s); };
  EXPECT_NEAR(seen.readings[1].turn, (angle(2.5) - angle(1)) - (angle(3.2) - angle(4)), 1e-9);
  EXPECT_NEAR(std::remainder(*seen.facing - (angle(1) - angle(4)), 2 * std::numbers::pi), 0, 1e-9);
  EXPECT_FALSE(seen.lengths_reversed);
  EXPECT_EQ(seen.roundings.size(), 1U);
}

TEST(CliTwoFingers, a_log_of_lengths_on_a_reversed_outline_is_turned_round) {
  const cli::Folder folder;
  folder.write("a.csv", "length,turn\n1,2\n2,3\n");
  folder.write("b.csv", "length,turn\n-1,1\n-3,1\n");
  rollfix::Outline clockwise{"clockwise", {}, true};
  clockwise.curves = {rollfix::Line({0, 0}, {0, 3}), rollfix::Line({0, 3}, {4, 0}), rollfix::Line({4, 0}, {0, 0})};
  const Observation seen = rollfix::observe({Part(clockwise), log_in({"a.csv", "b.csv"})});
  EXPECT_TRUE(seen.lengths_reversed);
  EXPECT_EQ(seen.readings[1].length[1], 3);
  EXPECT_FALSE(seen.facing);
  EXPECT_TRUE(seen.times.empty());
}

TEST(CliTwoFingers, the_log_argument_is_of_as_many_fingers_as_its_files) {
  const cli::Folder folder;
  folder.write("one.csv", "u,psi\n0,0\n1,1\n");
  EXPECT_EQ(log_in({"one.csv"}).fingers.size(), 1U);
  EXPECT_EQ(log_in({"one.csv", "one.csv"}).fingers.size(), 2U);
  EXPECT_THAT(refusal_of([] { log_in({"1", "2", "3"}); }), HasSubstr("--log is given 3 times"));
}

TEST(CliTwoFingers, fingers_are_as_many_as_are_given_and_two_at_most) {
  using rollfix::app::read_fingers;
  EXPECT_EQ(read_fingers({"disk,r=0.5"}, 2, "").at(0).disk()->radius, 0.5);
  EXPECT_EQ(read_fingers({"disk,r=0.5", "disk,r=2"}, 2, "").at(1).disk()->radius, 2);
  EXPECT_TRUE(read_fingers({}, 2, "").empty());
  EXPECT_THAT(refusal_of([] {
                read_fingers({"disk,r=1", "disk,r=1", "disk,r=1"}, 2, "");
              }),
              HasSubstr("expected at most 2, one for each finger"));
}

TEST(CliTwoFingers, poses_are_lists_in_json) {
  const cli::Folder folder;
  run(kRoll + " -o both.csv");
  const Part part(rollfix::gallery("spline,seed=3"));
  Answer answer = solve({part, log_in({"both.csv"}), {0.1}});
  ASSERT_FALSE(answer.placements.empty());
  const Json found = rollfix::answer_document(answer, false);
  const auto nearest = std::find_if(answer.placements.begin(), answer.placements.end(), [](const auto& placement) {
    return std::abs(placement.start[0] - 1) < 1e-6 && std::abs(placement.start[1] - 4) < 1e-6;
  });
  ASSERT_NE(nearest, answer.placements.end());
  const Json& placement = found["placements"][static_cast<std::size_t>(nearest - answer.placements.begin())];
  const Json& pose = placement["pose"];
  ASSERT_EQ(pose.size(), 101U);
  EXPECT_NEAR(pose[0][0], 0, 1e-6);  // the simulated part starts in the world's frame
  EXPECT_NEAR(pose[0][1], 0, 1e-6);
  EXPECT_NEAR(pose[0][2], 0, 1e-6);
  EXPECT_NEAR(pose[100][2], std::numbers::pi / 6, 1e-6);
  EXPECT_LT(placement["pose_residual"]["length"].get<double>(), 1e-6);
  EXPECT_LT(placement["pose_residual"]["turn"].get<double>(), 1e-6);
  answer.placements.front().pose_residual.reset();
  EXPECT_TRUE(rollfix::answer_document(answer, false)["placements"][0]["pose"].is_null());
}

// --- Mistakes.

namespace {

struct Mistake {
  const char* name;
  std::string command;
  std::vector<std::string> words;
};

void PrintTo(const Mistake& mistake, std::ostream* out) { *out << mistake.command; }

std::string mistake_name(const testing::TestParamInfo<Mistake>& info) { return info.param.name; }

class TwoFingerMistakes : public testing::TestWithParam<Mistake> {};

}  // namespace

TEST_P(TwoFingerMistakes, are_told_in_one_line_and_write_nothing) {
  const cli::Folder folder;
  const cli::Ran ran = run(GetParam().command);
  EXPECT_EQ(ran.code, 2);
  EXPECT_EQ(ran.out, "");
  EXPECT_THAT(ran.err, StartsWith("rollfix: "));
  EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
  for (const std::string& word : GetParam().words) EXPECT_THAT(ran.err, HasSubstr(word));
  EXPECT_TRUE(folder.files().empty());
}

INSTANTIATE_TEST_SUITE_P(
    Simulate, TwoFingerMistakes,
    testing::Values(
        Mistake{"no_finger", "simulate gallery:cam --start 1 --start 2 --length 1 --length 1", {"--finger"}},
        Mistake{"three_fingers",
                kRoll + " --finger disk,r=1 --finger disk,r=1",
                {"--finger is given 3 times", "two fingers"}},
        Mistake{"one_start",
                "simulate gallery:cam --finger disk,r=1 --start 1 --length 1 --length 1",
                {"--start twice", "found it once"}},
        Mistake{"no_starts",
                "simulate gallery:cam --finger disk,r=1 --length 1 --length 1",
                {"--start twice", "found it nowhere"}},
        Mistake{"three_lengths", kRoll + " --length 3", {"--length twice", "found it 3 times"}},
        Mistake{"rotation", kSpline + " --rotation 1", {"--rotation is of one finger", "--part-rotation"}},
        Mistake{"part_rotation_of_one_finger",
                "simulate gallery:cam --finger disk,r=1 --start 1 --length 1 --part-rotation 1",
                {"--start twice"}},
        Mistake{"three_files", kRoll + " -o 1 -o 2 -o 3", {"-o is given 3 times"}},
        Mistake{"the_same_file_twice", kRoll + " -o a.csv -o a.csv", {"-o a.csv -o a.csv", "two files"}},
        Mistake{"a_file_and_stdout", kRoll + " -o a.csv -o -", {"one -o for both"}},
        Mistake{"no_folder", kRoll + " -o a.csv -o no/b.csv", {"no/b.csv", "no folder"}},
        Mistake{"three_contact_angles",
                kRoll + " --contact-angle 1 --contact-angle 1 --contact-angle 1",
                {"--contact-angle is given 3 times"}},
        Mistake{"nothing_moves", kSpline + " --length 0 --length 0", {"other than 0"}},
        Mistake{"letters", kSpline + " --length 1 --length x", {"--length", "'x'"}},
        Mistake{"part_rotation_of_letters", kSpline + " --length 1 --length 1 --part-rotation x", {"--part-rotation"}},
        Mistake{
            "too_big_for_the_part",
            "simulate gallery:limacon --finger disk,r=0.1 --finger disk,r=1 --start 3 --start 3 --length 1 --length 4",
            {"finger b: ", "too big", "s = "}},
        Mistake{"off_the_end",
                "simulate gallery:exponential --finger disk,r=0.1 --start 9 --start 1 --length 5 --length 1",
                {"finger a: ", "end", "10.014"}}),
    mistake_name);

}  // namespace cli_two_fingers_test
