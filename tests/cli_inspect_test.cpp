// inspect --json of what can be counted by hand: a drawing's loops, rolls that fit one place or many, a finger's reach.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "cli.hpp"
#include "dxf_text.hpp"

namespace cli_inspect_test {
namespace {

using cli::Json;
using testing::ElementsAre;

constexpr double kPi = std::numbers::pi;

Json inspected(const std::string& what) { return cli::run("inspect " + what + " --json").json(); }

/// A plate of 4 by 2 whose upper side ends 0.01 early, with a round hole.
std::string plate() {
  using dxf_text::line;
  return "0\nSECTION\n2\nENTITIES\n" + line(0, 0, 4, 0) + line(4, 0, 4, 2) + line(4, 2, 0.01, 2) + line(0, 2, 0, 0) +
         dxf_text::circle(1, 1, 0.5) + "0\nENDSEC\n0\nEOF\n";
}

Json each(const char* field, const Json& loops) {
  Json values = Json::array();
  for (const Json& loop : loops) values.push_back(loop[field]);
  return values;
}

TEST(InspectLoops, say_which_was_taken_and_how_many_each_lies_in) {
  const cli::Folder folder;
  folder.write("plate.dxf", plate());
  const Json outer = inspected("plate.dxf --gap 0.02")["loops"];
  EXPECT_EQ(each("number", outer), Json({1, 2}));
  EXPECT_EQ(each("taken", outer), Json({true, false}));
  EXPECT_EQ(each("hole", outer), Json({false, true}));
  EXPECT_EQ(each("depth", outer), Json({0, 1}));
  EXPECT_EQ(each("taken", inspected("plate.dxf --gap 0.02 --loop 2")["loops"]), Json({false, true}));
}

TEST(InspectLoops, with_a_gap_below_0_are_refused) {
  const cli::Folder folder;
  folder.write("plate.dxf", plate());
  EXPECT_THAT(cli::run("inspect plate.dxf --gap -1").err,
              testing::HasSubstr("--gap: expected a length of at least 0, found -1"));
}

TEST(InspectLoops, are_measured_and_say_how_far_their_curves_are_apart) {
  const cli::Folder folder;
  folder.write("plate.dxf", plate());
  const Json loops = inspected("plate.dxf --gap 0.02")["loops"];
  EXPECT_NEAR(loops[0]["gap"], 0.01, 1e-12);
  EXPECT_EQ(loops[1]["gap"], 0);
  EXPECT_NEAR(loops[0]["area"], 8, 0.011);
  EXPECT_NEAR(std::abs(loops[1]["area"].get<double>()), kPi / 4, 1e-12);
}

TEST(InspectStart, is_the_first_point_and_the_tangent_there) {
  const cli::Folder folder;
  folder.write("square.csv", "1,0\n1,1\n0,1\n0,0\n");
  const Json start = inspected("square.csv")["start"];
  EXPECT_EQ(start["point"], Json({1.0, 0.0}));
  EXPECT_NEAR(start["tangent"], kPi / 2, 1e-15);
}

TEST(InspectAmbiguity, of_a_curve_that_bends_more_and_more_is_one_place_for_every_roll) {
  const Json found = inspected("gallery:log-spiral");
  ASSERT_FALSE(found["ambiguity"].empty());
  for (const Json& rolls : found["ambiguity"]) {
    EXPECT_NEAR(rolls["mean_placements"], 1, 1e-12) << rolls["length"];
    EXPECT_EQ(rolls["most_placements"], 1);
    EXPECT_EQ(rolls["rolls_with_stretch"], 0);
  }
}

TEST(InspectAmbiguity, of_a_square_is_a_stretch_for_every_roll_and_the_same_on_each_side) {
  const cli::Folder folder;
  folder.write("square.csv", "1,0\n1,1\n0,1\n0,0\n");
  const Json found = inspected("square.csv");
  ASSERT_FALSE(found["ambiguity"].empty());
  for (const Json& rolls : found["ambiguity"]) {
    EXPECT_EQ(rolls["rolls_with_stretch"], rolls["rolls"]);
    // Shorter than a side it stays on one of the four or goes over one of four corners; else all of the square fits.
    EXPECT_EQ(rolls["mean_placements"], rolls["length"] < 1.0 ? 4 : 1) << rolls["length"];
  }
}

TEST(InspectReach, says_how_far_a_finger_may_enter) {
  const cli::Folder folder;
  folder.write("square.csv", "1,0\n1,1\n0,1\n0,0\n");
  const double diagonal = std::sqrt(2.0);
  EXPECT_NEAR(inspected("square.csv --finger disk,r=0.5")["reach"]["slack"], 1e-6 * diagonal, 1e-15);
  EXPECT_NEAR(inspected("square.csv --finger disk,r=0.0001")["reach"]["slack"], 1e-3 * 0.0001, 1e-15);
}

}  // namespace
}  // namespace cli_inspect_test
