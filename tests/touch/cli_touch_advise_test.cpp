#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "cli.hpp"
#include "paths.hpp"

namespace cli_touch_advise_test {

using cli::Folder;
using cli::Json;
using cli::Ran;
using cli::run;
using testing::HasSubstr;

const std::string kBracket = checked_out("examples/bracket.dxf");
// Two poses are left.
const std::string kThree =
    kBracket +
    " --touch 106.476,94.401 --touch 158.015,50.015 --touch 192.873,57.557 --finger disk,r=3 --noise position=0.02";

TEST(CliTouchAdvise, SaysWhereToGoAndWhatToExpectInEachPose) {
  const Ran ran = run("advise " + kThree);
  EXPECT_EQ(ran.code, 0);
  EXPECT_THAT(ran.out, HasSubstr("ambiguous (2): from x "));
  EXPECT_THAT(ran.out, HasSubstr("1.00 poses are expected to remain, 0.99 of 0.99 bits gained"));
  EXPECT_THAT(ran.out, HasSubstr("\npose  probability  travel [mm]"));
  const Json document = run("advise " + kThree + " --json").json();
  EXPECT_EQ(document["schema"], "rollfix/advise/1");
  EXPECT_TRUE(document["helps"].get<bool>());
  EXPECT_EQ(document["contenders"].size(), 2U);
}

TEST(CliTouchAdvise, ChoosesAmongTheApproachesThatAreGiven) {
  const Ran ran = run("advise " + kThree + " --approach 0,0,-1,0 --approach 100,60,1,0 --json");
  const Json document = ran.json();
  EXPECT_EQ(document["prospects"].size(), 2U);
  EXPECT_EQ(document["approach"]["from"], Json({100, 60}));
  EXPECT_THAT(run("advise " + kThree + " --approach 0,0,-1,0").out,
              HasSubstr("none of these approaches tells the poses apart"));
}

TEST(CliTouchAdvise, DrawsTheWayAndItsEnds) {
  const Folder folder;
  EXPECT_EQ(run("advise " + kThree + " -o next.svg").code, 0);
  EXPECT_THAT(cli::read("next.svg"), HasSubstr("class=\"approach\""));
}

TEST(CliTouchAdvise, SaysSoWhereThePartLooksTheSame) {
  const Ran ran =
      run("advise gallery:ellipse --finger disk,r=0.1 --noise position=0.002 --touch 2.1,0 --touch 1.1112,0.9367 "
          "--touch=-1.6579,0.6816 --touch 0,-1.1");
  EXPECT_EQ(ran.code, 0);
  EXPECT_THAT(ran.out, HasSubstr("the part looks the same in each"));
}

TEST(CliTouchAdvise, APathThatNoPoseLeavesFreeIsNotHeldAgainstThem) {
  const std::string one = "advise gallery:cam --touch 6,3,0deg --finger disk,r=0.2 --tolerance 0.01,1deg";
  EXPECT_EQ(run(one + " --clear 5.4,3,4.8,3").out, run(one).out) << "it runs through the part behind the contact";
}

TEST(CliTouchAdvise, RefusesWhatCannotBeMeant) {
  const auto refused = [](const std::string& rest) {
    const Ran ran = run("advise " + rest);
    EXPECT_EQ(ran.code, 2) << rest;
    return ran.err;
  };
  EXPECT_THAT(refused(kThree + " --approach 1,2,3"), HasSubstr("expected X,Y,DX,DY, as in 0,50,1,0"));
  EXPECT_THAT(refused(kThree + " --approach 1,2,0,0"), HasSubstr("expected a direction DX,DY that is not 0,0"));
  EXPECT_THAT(refused(kThree + " --travel 3"), HasSubstr("--travel: touches do not roll"));
  EXPECT_THAT(refused("gallery:cam --reading 1,1 --approach 1,2,3,4"), HasSubstr("give PART and --touch"));
}

}  // namespace cli_touch_advise_test
