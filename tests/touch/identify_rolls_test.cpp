// Which part is it, by several rolls and touches that share its pose.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "refusal.hpp"
#include "touch/identify_rolls.hpp"

namespace identify_rolls_test {

using namespace identify_rolls;
using cli::run;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

class IdentifyRolls : public Identified {};

TEST_F(IdentifyRolls, NameThePartAndItsPose) {
  const RollCase one = rolled(kSpline, 2, 0, 1);
  const IdentifiedByTouches found = identify(catalog_, one.problem);
  EXPECT_EQ(found.verdict, "unique part, unique pose");
  EXPECT_THAT(names_of(found), ElementsAre(kShapes[kSpline]));
  EXPECT_NEAR(found.parts[0].answer.poses[0].pose.x, one.truth.x, 0.02);
}

TEST_F(IdentifyRolls, WithTouchesNameThePartAndItsPose) {
  const IdentifiedByTouches found = identify(catalog_, rolled(kCam, 1, 2, 2).problem);
  EXPECT_EQ(found.verdict, "unique part, unique pose");
  EXPECT_THAT(names_of(found), ElementsAre(kShapes[kCam]));
}

TEST_F(IdentifyRolls, WithoutCentresListThePartThatWasRolledOn) {
  for (int k = 0; k < test_count(3); ++k) {
    TouchProblem problem = rolled(kSpline, 2, 0, 20 + static_cast<std::uint64_t>(k)).problem;
    for (Log& log : problem.rolls) log.fingers.front().x = log.fingers.front().y = {};
    problem.noise->position = 0;
    EXPECT_THAT(names_of(identify(catalog_, problem)), Contains(kShapes[kSpline])) << k;
  }
}

TEST_F(IdentifyRolls, SayThatNoPartFitsWhereThePartWasMoved) {
  TouchProblem problem = rolled(kSpline, 2, 0, 34).problem;
  for (double& psi : problem.rolls.back().fingers.front().psi) psi += 1;
  EXPECT_EQ(identify(catalog_, problem).verdict, "none");
}

TEST_F(IdentifyRolls, WeighByHowManyOfEachThereAre) {
  rollfix::build_catalog("bin.db", {{"gallery:cam", "one", 1}, {"gallery:cam,lift=0.5", "three", 3}});
  const Catalog bin("bin.db");
  const IdentifiedByTouches found = identify(bin, rolled(kCam, 2, 0, 35).problem);
  ASSERT_EQ(found.parts.size(), 2U);
  EXPECT_NEAR(found.parts[0].probability, 0.75, 1e-9);
  EXPECT_EQ(found.verdict, "2 congruent parts");
}

TEST_F(IdentifyRolls, AreReadFromALogWithLiftOff) {
  run("simulate gallery:cam --finger disk,r=0.1 --start 1 --length 0.6 --samples 20 -o a.csv");
  run("simulate gallery:cam --finger disk,r=0.1 --start 4 --length -0.6 --samples 20 -o b.csv");
  const std::string asked =
      "identify parts.db --log a.csv --log b.csv --roll all --finger disk,r=0.1 "
      "--noise contact=0.002,angle=0.3deg,position=0.005";
  const cli::Ran ran = run(asked + " --json");
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_EQ(ran.json()["verdict"], "unique part, unique pose");
  EXPECT_EQ(ran.json()["rolls"].size(), 2U);
  EXPECT_EQ(ran.json()["parts"][0]["name"], "cam");
  EXPECT_THAT(run(asked).out, HasSubstr("unique part, unique pose\n"));
  EXPECT_THAT(run(asked + " -o which.svg").err, HasSubstr("of several rolls draw the part"));
}

TEST_F(IdentifyRolls, OfOneRollAloneAreAnotherQuestion) {
  const TouchProblem problem = rolled(kCam, 1, 0, 36).problem;
  EXPECT_THAT(refusal_of([&] { identify(catalog_, problem); }), HasSubstr("give it as a Problem"));
}

}  // namespace identify_rolls_test
