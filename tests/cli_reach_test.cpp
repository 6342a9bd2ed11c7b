// --finger: what it can't reach is dropped, counted and explained.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "cli.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/part.hpp"

namespace cli_reach_test {
namespace {

using cli::Json;
using cli::Ran;
using cli::run;
using testing::HasSubstr;
using testing::Not;

/// "--reading L,THETA" of a roll on a gallery shape.
std::string reading(const std::string& shape, double s, double length) {
  const rollfix::Part part(rollfix::gallery(shape));
  const double turn = part.turning().angle(s + length) - part.turning().angle(s);
  return "locate gallery:" + shape + " --reading " + cli::exact(length) + "," + cli::exact(turn);
}

/// Inside the dimple, around s = 3.82.
std::string in_the_dimple() { return reading("limacon,a=1,b=0.9", 3.6, 0.3); }

TEST(ReachCli, drops_what_the_finger_cant_reach_and_counts_it) {
  const std::size_t all = run(in_the_dimple() + " --json").json()["placements"].size();
  const Json found = run(in_the_dimple() + " --finger disk,r=0.5 --json").json();
  EXPECT_GT(found["dropped"]["reach"], 0);
  EXPECT_EQ(found["placements"].size() + found["dropped"]["reach"].get<std::size_t>(), all);
  EXPECT_FALSE(found.contains("impossible"));
}

TEST(ReachCli, drops_nothing_without_a_finger_or_with_a_small_one) {
  EXPECT_EQ(run(in_the_dimple() + " --json").json()["dropped"], Json::object());
  EXPECT_EQ(run(in_the_dimple() + " --finger disk,r=0.001 --json").json()["dropped"]["reach"], 0);
  EXPECT_THAT(run(in_the_dimple() + " --finger disk,r=0.001").out, Not(HasSubstr("dropped")));
}

TEST(ReachCli, says_how_many_and_explains_on_demand) {
  const std::string command = in_the_dimple() + " --finger disk,r=0.5";
  EXPECT_THAT(run(command).out, HasSubstr("that the finger can't reach (--explain lists them)"));
  EXPECT_THAT(run(command).out, Not(HasSubstr("would hit")));
  const std::string explained = run(command + " --explain").out;
  EXPECT_THAT(explained, HasSubstr("start 3.600000 (crossing): touching at s = "));
  EXPECT_THAT(explained, HasSubstr("the finger would hit the part at s = "));
  const Json entry = run(command + " --explain --json").json()["impossible"][0];
  EXPECT_EQ(entry["reason"], "reach");
  EXPECT_GT(entry["obstruction"]["depth"].get<double>(), 1e-3);
  EXPECT_EQ(entry["obstruction"]["cause"], "hit");
}

TEST(ReachCli, with_no_placement_left_the_exit_code_is_1) {
  // At the middle of the dimple the curvature is the least: nothing else looks like it.
  const std::string command = reading("limacon,a=1,b=0.9", 3.79, 0.05) + " --tolerance 1e-6";
  ASSERT_EQ(run(command).code, 0);
  const Ran ran = run(command + " --finger disk,r=1");
  EXPECT_EQ(ran.code, 1);
  EXPECT_THAT(ran.out, HasSubstr("inconsistent: "));
  EXPECT_THAT(ran.out, HasSubstr("the finger can't get there; check the finger's size"));
}

TEST(ReachCli, uses_every_row_of_a_log) {
  // The last row is back near the first, but in between the finger was past a dimple that a larger one can't pass.
  const cli::Folder folder;
  folder.write("there-and-back.csv", "length,turn\n0.8,0\n0,0\n");
  const std::string locate = "locate gallery:limacon,a=1,b=0.9 --log there-and-back.csv --tolerance 1e-9 --json";
  const Json all = run(locate).json();
  EXPECT_EQ(all["verdict"], "unobservable");
  const Json some = run(locate + " --finger disk,r=0.5").json();
  EXPECT_EQ(some["dropped"]["reach"], 0);  // an extent from which some start is possible stays
}

TEST(ReachCli, drops_pairs_whose_fingers_overlap) {
  const std::string command =
      "locate gallery:cam --reading 0.7446832,-0.3983439,57.48184deg --reading 1.5,-0.8,110.97000deg";
  ASSERT_EQ(run(command + " --json").json()["placements"].size(), 4U);
  const Json found = run(command + " --finger disk,r=0.2 --explain --json").json();
  EXPECT_EQ(found["dropped"]["overlap"], 1);
  EXPECT_EQ(found["dropped"]["reach"], 0);
  EXPECT_EQ(found["placements"].size(), 3U);
  EXPECT_EQ(found["impossible"][0]["reason"], "overlap");
  EXPECT_THAT(run(command + " --finger disk,r=0.2 --explain").out, HasSubstr("the fingers would overlap by"));
}

TEST(ReachCli, explains_only_with_a_finger) {
  const Ran ran = run(in_the_dimple() + " --explain");
  EXPECT_EQ(ran.code, 2);
  EXPECT_THAT(ran.err, HasSubstr("--finger"));
}

TEST(ReachCli, takes_a_jaw) {
  EXPECT_EQ(run(in_the_dimple() + " --finger jaw").code == 2, false);
  EXPECT_EQ(run("simulate gallery:cam --finger jaw --start 0 --length 1").code, 0);
  EXPECT_EQ(run("simulate gallery:limacon --finger jaw --start 0 --length 7").code, 2) << "over the dimple";
}

TEST(ReachCli, inspect_shows_the_arcs) {
  const Ran whole = run("inspect gallery:ellipse --finger jaw");
  EXPECT_THAT(whole.out, HasSubstr("jaw reaches all of the boundary"));
  const Ran cut = run("inspect gallery:limacon,a=1,b=0.9 --finger disk,r=0.3");
  EXPECT_THAT(cut.out, HasSubstr("disk,r=0.3 reaches "));
  EXPECT_THAT(cut.out, HasSubstr(" % of the boundary: "));
  const Json reach = run("inspect gallery:limacon,a=1,b=0.9 --finger disk,r=0.3 --json").json()["reach"];
  EXPECT_EQ(reach["finger"], "disk,r=0.3");
  ASSERT_EQ(reach["arcs"].size(), 1U);
  EXPECT_LT(reach["share"].get<double>(), 1);
  EXPECT_TRUE(reach["decided"].get<bool>());
  EXPECT_EQ(run("inspect gallery:limacon --json").json()["reach"], nullptr);
}

TEST(ReachCli, the_figure_marks_what_is_out_of_reach) {
  const std::string inspect = "inspect gallery:limacon,a=1,b=0.9 -o - ";
  EXPECT_THAT(run(inspect + "--finger disk,r=0.3").out, HasSubstr("out of reach of a disk of radius 0.3"));
  EXPECT_THAT(run(inspect).out, Not(HasSubstr("out of reach")));
}

TEST(ReachCli, simulate_says_what_a_real_finger_could_not_do) {
  const std::string roll = "simulate gallery:spline,n=40,seed=3 --start 0.3 --length 0.2 --finger disk,r=";
  EXPECT_THAT(run(roll + "0.001").err, Not(HasSubstr("can't do this roll")));
  // The curvature lets it roll there, and a neighbouring bump does not.
  const Ran gear = run("simulate gallery:gear --finger disk,r=0.6 --start 0 --length 0.1");
  EXPECT_THAT(gear.err, HasSubstr("a real finger can't do this roll: touching at s = "));
}

}  // namespace
}  // namespace cli_reach_test
