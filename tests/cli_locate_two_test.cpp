// `rollfix locate` for two fingers, as a script and as a person sees it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "cli.hpp"

namespace cli_locate_two_test {
namespace {

using cli::Json;
using cli::run;
using testing::HasSubstr;
using testing::StartsWith;

const std::string kSimulate =
    "simulate gallery:cam --finger disk,r=0.2 --finger disk,r=0.3 --start 1 --start 4 --length 1.5 --length -0.8 "
    "--part-rotation 20deg -o ";
const std::string kFingers = " --finger disk,r=0.2 --finger disk,r=0.3";

TEST(LocateTwo, json_has_all_the_fields_of_the_contract) {
  const Json found =
      run("locate gallery:cam --reading 0.7446832,-0.3983439,57.48184deg --reading 1.5,-0.8,110.97000deg --json")
          .json();
  EXPECT_EQ(found["schema"], "rollfix/locate/1");
  EXPECT_EQ(found["fingers"], 2);
  EXPECT_EQ(found["readings"][1]["length"], Json::array({1.5, -0.8}));
  EXPECT_TRUE(found["facing"].is_null());
  for (const Json& placement : found["placements"]) {
    for (const char* pair : {"start", "end", "extent", "point", "tangent"})
      EXPECT_EQ(placement[pair].size(), 2U) << pair;
    EXPECT_EQ(placement["roots"][0].size(), 2U);
    EXPECT_EQ(placement["sensitivity"]["per_turn"][1].size(), 2U);
    EXPECT_EQ(placement["sensitivity"]["per_length"][1][0].size(), 2U);
    for (const char* empty : {"family", "family_error", "probability", "pose", "pivot"}) {
      EXPECT_TRUE(placement.contains(empty) && placement[empty].is_null()) << empty;
    }
  }
}

TEST(LocateTwo, a_log_finds_its_first_contacts_and_the_poses_at_every_row) {
  const cli::Folder folder;
  ASSERT_EQ(run(kSimulate + "both.csv").code, 0);
  const Json found = run("locate gallery:cam --log both.csv --json" + kFingers).json();
  ASSERT_EQ(found["verdict"], "unique");
  const Json& placement = found["placements"][0];
  EXPECT_NEAR(placement["start"][0], 1, 1e-7);
  EXPECT_NEAR(placement["start"][1], 4, 1e-7);
  ASSERT_EQ(placement["pose"].size(), 101U);
  EXPECT_EQ(found["pose_time"].size(), 101U);
  EXPECT_NEAR(placement["pose"][0][2], 0, 1e-9);
  EXPECT_NEAR(placement["pose"][100][2], 20 * std::numbers::pi / 180, 1e-9);
  EXPECT_LE(placement["pose_residual"]["length"].get<double>(), 1e-9);
}

TEST(LocateTwo, two_logs_say_the_same_as_one) {
  const cli::Folder folder;
  ASSERT_EQ(run(kSimulate + "both.csv").code, 0);
  ASSERT_EQ(run(kSimulate + "a.csv -o b.csv").code, 0);
  const Json one = run("locate gallery:cam --log both.csv --json" + kFingers).json();
  const Json two = run("locate gallery:cam --log a.csv --log b.csv --json" + kFingers).json();
  EXPECT_EQ(one["placements"], two["placements"]);
}

TEST(LocateTwo, the_middle_row_and_the_last_are_used_with_the_facing) {
  const cli::Folder folder;
  ASSERT_EQ(run(kSimulate + "both.csv").code, 0);
  const Json found = run("locate gallery:cam --log both.csv --json" + kFingers).json();
  EXPECT_EQ(found["readings"].size(), 2U);
  EXPECT_NEAR(found["readings"][1]["length"][0], 1.5, 1e-9);
  EXPECT_TRUE(found["facing"].is_number());
}

TEST(LocateTwo, symmetric_rolls_tell_that_no_such_roll_can_ever_tell) {
  const cli::Ran ran = run("locate gallery:ellipse --reading 1,1,0 --reading 2,2,0");
  EXPECT_EQ(ran.code, 0);
  EXPECT_THAT(ran.out, StartsWith("unobservable: "));
  EXPECT_THAT(ran.out, HasSubstr("no such roll"));
}

TEST(LocateTwo, a_stretch_is_given_as_a_line_with_a_bound_on_its_error) {
  const Json found = run("locate gallery:ellipse --reading 1,1,0 --reading 2,2,0 --json").json();
  ASSERT_EQ(found["placements"].size(), 2U);
  for (const Json& placement : found["placements"]) {
    EXPECT_EQ(placement["kind"], "stretch");
    EXPECT_GE(placement["family"].size(), 2U);
    EXPECT_LE(placement["family_error"].get<double>(), 1e-5);
    EXPECT_EQ(placement["whole_loop"], Json::array({true, true}));
  }
}

TEST(LocateTwo, nothing_that_fits_is_exit_code_1) {
  const cli::Ran ran = run("locate gallery:cam --reading 1,1,3 --reading 2,2,0");
  EXPECT_EQ(ran.code, 1);
  EXPECT_THAT(ran.out, StartsWith("inconsistent: "));
}

TEST(LocateTwo, a_budget_that_runs_out_is_exit_code_3) {
  const cli::Ran ran =
      run("locate gallery:spline --reading 0.5,0.7,0.1 --reading 1.1,-0.4,0.3 --tolerance 1e-9 --budget 1 --json");
  EXPECT_EQ(ran.code, 3);
  EXPECT_EQ(ran.json()["verdict"], "undecided");
  EXPECT_EQ(ran.json()["unresolved"][0].size(), 2U);
}

TEST(LocateTwo, typed_digits_give_the_tolerance_of_both_lengths) {
  const Json found = run("locate gallery:circle --reading 0.50,0.50,0 --reading 1,1,0 --json").json();
  EXPECT_NEAR(found["tolerance"], 0.005 + 2 * 0.005, 1e-12);  // the circle's curvature is 1
}

}  // namespace
}  // namespace cli_locate_two_test
