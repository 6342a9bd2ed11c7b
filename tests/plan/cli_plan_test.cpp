// `rollfix plan` as it is typed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "cli.hpp"

namespace cli_plan_test {
namespace {

using cli::run;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

const std::string kTwo = "plan gallery:ellipse --finger disk,r=0.3 --start 2.4 --start 7.2 --length 0.8 ";

TEST(CliPlan, says_what_the_fingers_do_and_what_is_left_of_each_condition) {
  const cli::Ran ran = run(kTwo + "--friction 0.5");
  EXPECT_EQ(ran.code, 0);
  EXPECT_THAT(ran.out, AllOf(StartsWith("plan: finger a rolls by 0.8, finger b rolls by "),
                             HasSubstr("friction of finger b"), HasSubstr("proved")));
}

TEST(CliPlan, says_which_condition_fails_and_writes_nothing) {
  const cli::Folder folder;
  const cli::Ran ran = run(kTwo + "--length 0.7 --friction 0.3 -o never.csv");
  EXPECT_EQ(ran.code, 1);
  EXPECT_THAT(ran.out, AllOf(StartsWith("no plan: finger "), HasSubstr(" slips, first at "), HasSubstr("FAILS")));
  EXPECT_FALSE(std::filesystem::exists("never.csv"));
}

TEST(CliPlan, writes_a_table_that_locate_reads) {
  const cli::Folder folder;
  EXPECT_EQ(run(kTwo + "--friction 0.5 -o plan.csv").code, 0);
  const cli::Ran found = run("locate gallery:ellipse --finger disk,r=0.3 --json --log plan.csv");
  EXPECT_NEAR(found.json()["placements"][0]["start"][0].get<double>(), 2.4, 1e-7);
}

TEST(CliPlan, has_its_json) {
  const cli::Json json = run(kTwo + "--friction 0.5 --json").json();
  EXPECT_EQ(json["schema"], "rollfix/plan/1");
  EXPECT_EQ(json["feasible"], true);
  EXPECT_EQ(json["margins"][0]["condition"], "friction");
}

TEST(CliPlan, of_a_jaw_and_a_wheel_finds_where_the_wheel_is) {
  const cli::Ran ran = run("plan gallery:ellipse --finger jaw --finger wheel,r=0.3 --start 2.4 --length 0.3 --json");
  EXPECT_EQ(ran.json()["path"], "squeezed");
  EXPECT_NEAR(ran.json()["start"][1].get<double>(), 7.310565, 1e-6);
}

TEST(CliPlan, refuses_what_it_can_not_take) {
  EXPECT_THAT(run("plan gallery:ellipse --finger disk,r=0.3 --start 1").err, HasSubstr("expected --length"));
  EXPECT_THAT(run(kTwo + "--limit sped=1").err, HasSubstr("'sped=1' is none of speed=LENGTH"));
  EXPECT_THAT(run(kTwo + "--friction 1,2,3").err, HasSubstr("expected a coefficient"));
  EXPECT_THAT(run(kTwo + "--stays here").err, HasSubstr("expected a, b or part"));
  EXPECT_THAT(run(kTwo + "--pose 1,2").err, HasSubstr("expected X,Y,HEADING"));
  EXPECT_EQ(run(kTwo + "--samples 1").code, 2);
}

}  // namespace
}  // namespace cli_plan_test
