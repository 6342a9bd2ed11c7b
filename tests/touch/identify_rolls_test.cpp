// Which part is it, by several rolls and touches that share its pose.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "catalogs.hpp"
#include "random.hpp"
#include "refusal.hpp"
#include "rollfix/catalog/documents.hpp"
#include "rollfix/catalog/identify_touches.hpp"
#include "touch/roll_certificates.hpp"

namespace identify_rolls_test {

using namespace roll_certificates;
using catalogs::Catalog;
using cli::run;
using rollfix::IdentifiedByTouches;
using rollfix::PartTouched;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

const std::vector<std::string> kShapes = {"ellipse,a=2,b=1",
                                          "cam",
                                          "limacon",
                                          "spline,n=9,wobble=0.2,seed=1",
                                          "spline,n=9,wobble=0.2,seed=2",
                                          "spline,n=9,wobble=0.2,seed=3"};
constexpr std::size_t kCam = 1, kSpline = 3;

class IdentifyRolls : public testing::Test {
 protected:
  IdentifyRolls() : catalog_(catalogs::of(kShapes)) {}

  RollCase rolled(std::size_t part, std::size_t rolls, std::size_t touches, std::uint64_t seed, double noise = 1) {
    std::mt19937_64 generator = test_generator(seed);
    Rolling rolling;
    rolling.count = rolls;
    rolling.touches = touches;
    rolling.length = 0.06;
    rolling.rows = 15;
    rolling.contact_sd = rolling.place_sd = 0.001 * noise;
    rolling.angle_sd = 0.005 * noise;
    return random_rolls(catalog_.part(part), rolling, generator);
  }
  std::vector<std::string> names_of(const IdentifiedByTouches& found) const {
    std::vector<std::string> names;
    for (const PartTouched& part : found.parts) names.push_back(catalog_.entry(part.part).name);
    return names;
  }
  std::string all_of(const IdentifiedByTouches& found) const {
    cli::Json document = cli::Json::parse(format_identified(catalog_, found));
    document["catalog"].erase("searched");
    return document.dump();
  }
  void expect_no_loss(const TouchProblem& problem) const {
    rollfix::IdentifyOptions without;
    without.use_index = false;
    EXPECT_EQ(all_of(identify(catalog_, problem)), all_of(identify(catalog_, problem, without)));
  }

  cli::Folder folder_;
  Catalog catalog_;
};

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

TEST_F(IdentifyRolls, LoseNothingByBounds) {
  expect_no_loss(rolled(kSpline, 2, 0, 30).problem);
  expect_no_loss(rolled(kSpline + 1, 1, 2, 31, 4).problem);
  expect_no_loss(face_down(rolled(kCam, 2, 1, 32).problem));
}

TEST_F(IdentifyRolls, LoseNothingWithinATolerance) {
  TouchProblem problem = rolled(kSpline, 2, 0, 33).problem;
  problem.noise.reset();
  problem.tolerance = {0.02, 0.05};
  expect_no_loss(problem);
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
