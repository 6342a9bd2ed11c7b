#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "cli.hpp"

// Three fingers on a part that moves, as the program takes them.
namespace cli_hold_test {

using cli::Folder;
using cli::Json;
using cli::Ran;
using cli::run;
using testing::HasSubstr;
using testing::Not;

const std::string kPart = "gallery:spline,n=9,seed=4,wobble=0.25 ";
const std::string kLogs = "--log a.csv --log b.csv --log c.csv --finger disk,r=0.1 ";
const std::string kNoise = "--noise contact=0.01,angle=0.3deg,position=0.01 ";

/// a.csv, b.csv and c.csv: from s = 1, 3 and 5 by 0.6, -0.4 and 0.3, the part turning by 20 deg.
void simulate(const std::string& noise = "") {
  const std::string same =
      "simulate " + kPart + "--finger disk,r=0.1 --part-rotation 20deg --samples 30 --start 1 --length 0.6 " + noise;
  ASSERT_EQ(run(same + " --start 3 --length -0.4 -o a.csv -o b.csv").code, 0);
  ASSERT_EQ(run(same + "" + (noise.empty() ? "" : " --seed 7") + " --start 5 --length 0.3 -o again.csv -o c.csv").code,
            0);
}

TEST(CliHold, ThreeLogsAreThreeFingersOnAPartThatMoves) {
  const Folder folder;
  simulate();
  const Ran ran = run("locate " + kPart + kLogs);
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_THAT(ran.out, HasSubstr("unique: finger a started at s = 1, finger b at 3, finger c at 5\n"));
  EXPECT_THAT(ran.out, HasSubstr("at the last at x = 1.008308, y = -0.148375, heading 20.000 deg"));
  EXPECT_THAT(ran.out, HasSubstr("samples    30, of which 9 are used"));
}

TEST(CliHold, JsonHasEachFingersPlacesAndBothPoses) {
  const Folder folder;
  simulate();
  const Json document = run("locate " + kPart + kLogs + "--json").json();
  EXPECT_EQ(document["verdict"], "unique");
  EXPECT_EQ(document["fingers"], 3);
  ASSERT_EQ(document["placements"].size(), 1U);
  const Json& found = document["placements"][0];
  const std::vector<double> starts = found["start"];
  EXPECT_THAT(starts, testing::Pointwise(testing::DoubleNear(1e-6), {1.0, 3.0, 5.0}));
  EXPECT_EQ(found["pose"].size(), 2U);
  EXPECT_EQ(found["probability"], nullptr);
}

TEST(CliHold, ALineOfABatchSaysWhatTheCommandSays) {
  const Folder folder;
  simulate();
  folder.write("problems.jsonl", R"({"log": ["a.csv", "b.csv", "c.csv"], "fingers": "disk,r=0.1"}
{"log": ["a.csv", "b.csv", "c.csv"], "fingers": "disk,r=0.1", "facing": 1})");
  const Ran ran = run("locate " + kPart + "--batch problems.jsonl");
  EXPECT_EQ(ran.code, 2);
  const std::size_t first = ran.out.find('\n');
  EXPECT_EQ(Json::parse(ran.out.substr(0, first)), run("locate " + kPart + kLogs + "--json").json());
  EXPECT_THAT(ran.out.substr(first),
              HasSubstr("problems.jsonl:2: --facing: logs of u and psi contain it; leave it out"));
}

TEST(CliHold, WithNoiseEachFingerHasAnInterval) {
  const Folder folder;
  simulate("--noise contact=0.01,angle=0.3deg");
  const Json found = run("locate " + kPart + kLogs + kNoise + "--json").json()["placements"].at(0);
  for (std::size_t k = 0; k < 3; ++k) {
    const double truth = 2 * static_cast<double>(k) + 1;
    EXPECT_NEAR(found["mean"][k], truth, 4 * found["sd"][k].get<double>());
  }
  EXPECT_GT(found["probability"], 0.99);
}

TEST(CliHold, WithoutTheirErrorCentresOnlyTellWhereThePartIs) {
  const Folder folder;
  simulate("--noise contact=0.01,angle=0.3deg");
  const Ran ran = run("locate " + kPart + kLogs + "--noise contact=0.01,angle=0.3deg");
  EXPECT_EQ(ran.code, 0);
  EXPECT_THAT(ran.out, HasSubstr("x and y only tell where the part is; add --noise position=SD"));
}

TEST(CliHold, InstantsCanBeChosen) {
  const Folder folder;
  simulate();
  const Ran ran = run("locate " + kPart + kLogs + "--at 3,4");
  EXPECT_EQ(ran.code, 0);
  EXPECT_THAT(ran.out, HasSubstr("of which 3 are used"));
}

TEST(CliHold, AFigureShowsThePartAtTheEnd) {
  const Folder folder;
  simulate();
  EXPECT_EQ(run("locate " + kPart + kLogs + "-o hold.svg").code, 0);
  EXPECT_THAT(cli::read("hold.svg"), HasSubstr("3 fingers"));
}

TEST(SlowCliHold, NoisyLogsWithoutNoiseFitNowhereAndTheCureIsSaid) {
  const Folder folder;
  simulate("--noise contact=0.01,angle=0.3deg");
  const Ran ran = run("locate " + kPart + kLogs);
  EXPECT_EQ(ran.code, 1);
  EXPECT_THAT(ran.out, HasSubstr("no noise was stated; cure: --noise contact="));
}

TEST(CliHold, WithRollAllTheSameLogsAreRollsOfOneFinger) {
  const Folder folder;
  simulate();
  EXPECT_THAT(run("locate " + kPart + kLogs + "--roll all").out, Not(HasSubstr("free to move")));
}

TEST(CliHold, CertifyWritesWhatTheVerifierProves) {
  const Folder folder;
  simulate();
  EXPECT_EQ(run("locate " + kPart + kLogs + "--certify proof.json").code, 0);
  const Ran verified = cli::shell("rollfix-verify proof.json");
  EXPECT_EQ(verified.code, 0);
  EXPECT_THAT(verified.out, testing::StartsWith("proved: 1 set of first contacts, nothing else\npart "));
}

TEST(CliHold, WhatIsNotTakenIsRefused) {
  const Folder folder;
  simulate();
  const auto refusal = [](const std::string& more) { return run("locate " + kPart + kLogs + more).err; };
  EXPECT_THAT(refusal("--robust"), HasSubstr("--robust is about outliers among noisy rows: expected noise as well"));
  EXPECT_THAT(refusal("--touch 1,2"), HasSubstr("--roll all"));
  EXPECT_THAT(refusal("--finger disk,r=0.2"), HasSubstr("expected one finger for all logs, or 3"));
  EXPECT_THAT(refusal("--roll 1"), HasSubstr("--roll"));
}

}  // namespace cli_hold_test
