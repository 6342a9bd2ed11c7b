#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "cli.hpp"
#include "rollfix/rolling.hpp"
#include "touch_cases.hpp"

namespace cli_roll_all_test {

using cli::Folder;
using cli::Json;
using cli::Ran;
using cli::run;
using testing::HasSubstr;
using testing::Not;

/// Rolls of a disk of radius 0.2 on a limacon at x = 3, y = 1, turned by half a radian, in one log: with lift-off
/// between them, or by files.
std::string rows_of(double start, double distance, double begin, bool centres) {
  const rollfix::Part part = rollfix::load_part("gallery:limacon");
  const rollfix::Pose pose{3, 1, 0.5};
  rollfix::RollPlan plan;
  plan.start = start;
  plan.psi = 0.3;
  plan.distance = distance;
  plan.rows = 30;
  const rollfix::Log log = rollfix::roll(part, rollfix::disk(0.2), plan).log;
  const rollfix::FingerRows& rows = log.fingers.front();
  std::string text;
  for (std::size_t k = 0; k < rows.u.size(); ++k) {
    text += fmt::format("{:.9f},1,{:.9f},{:.9f}", begin + log.time[k], rows.u[k], rows.psi[k] + pose.heading);
    const rollfix::Vec2 at = pose.world({rows.x[k], rows.y[k]});
    text += centres ? fmt::format(",{:.9f},{:.9f}\n", at.x(), at.y()) : "\n";
  }
  return text;
}

std::string header(bool centres) { return centres ? "time,contact,u,psi,x,y\n" : "time,contact,u,psi\n"; }

std::string log_of_two(bool centres = true) {
  return header(centres) + rows_of(0.5, 0.8, 0, centres) + (centres ? "50,0,0,0,0,0\n" : "50,0,0,0\n") +
         rows_of(3.1, -0.9, 100, centres);
}

const std::string kRest = " --roll all --finger disk,r=0.2";

TEST(CliRollAll, TwoRollsWithLiftOffSayWhereThePartIs) {
  const Folder folder;
  folder.write("run.csv", log_of_two());
  const Ran ran = run("locate gallery:limacon --log run.csv" + kRest + " --json");
  ASSERT_EQ(ran.code, 0) << ran.err;
  const Json document = ran.json();
  EXPECT_EQ(document["verdict"], "unique");
  EXPECT_EQ(document["fingers"], 1);
  EXPECT_EQ(document["place"], "measured");
  ASSERT_EQ(document["contacts"].size(), 2U);
  EXPECT_EQ(document["contacts"][0], Json({{"finger", 0}, {"roll", 1}, {"lines", {2, 31}}}));
  EXPECT_EQ(document["contacts"][1], Json({{"finger", 0}, {"roll", 2}, {"lines", {33, 62}}}));
  const Json& found = document["placements"][0];
  EXPECT_NEAR(found["start"][0].get<double>(), 0.5, 1e-5);
  EXPECT_NEAR(found["start"][1].get<double>(), 3.1, 1e-5);
  EXPECT_NEAR(found["end"][1].get<double>(), 2.2, 1e-5);
  EXPECT_NEAR(found["pose"][0][0].get<double>(), 3, 1e-4);
  EXPECT_NEAR(found["pose"][0][1].get<double>(), 1, 1e-4);
  EXPECT_NEAR(found["pose"][0][2].get<double>(), 0.5, 1e-6);
}

TEST(CliRollAll, TheColumnsHaveNamesOfTheirOwn) {
  const Folder folder;
  folder.write("run.csv", log_of_two());
  folder.write("named.csv", "t,skin,pad,wrist,tip_x,tip_y\n" + log_of_two().substr(header(true).size()));
  const std::string named = "time=t,contact=skin,u=pad:rad,psi=wrist:rad,x=tip_x,y=tip_y";
  const Ran ran = run("locate gallery:limacon --log named.csv --columns " + named + kRest + " --json");
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_EQ(ran.json()["placements"],
            run("locate gallery:limacon --log run.csv" + kRest + " --json").json()["placements"]);
}

TEST(CliRollAll, WithoutCentresThePlaceIsNullAndTheHeadingKnown) {
  const Folder folder;
  folder.write("run.csv", log_of_two(false));
  const Ran json = run("locate gallery:limacon --log run.csv" + kRest + " --json");
  ASSERT_EQ(json.code, 0) << json.err;
  const Json found = json.json()["placements"][0];
  EXPECT_TRUE(found["pose"][0][0].is_null());
  EXPECT_NEAR(found["pose"][0][2].get<double>(), 0.5, 1e-6);
  EXPECT_EQ(json.json()["place"], "unknown");
  EXPECT_THAT(run("locate gallery:limacon --log run.csv" + kRest).out, HasSubstr("where the part is is not known"));
}

TEST(CliRollAll, RollsOfSeveralFilesAreTheSame) {
  const Folder folder;
  folder.write("run.csv", log_of_two());
  folder.write("one.csv", header(true) + rows_of(0.5, 0.8, 0, true));
  folder.write("two.csv", header(true) + rows_of(3.1, -0.9, 0, true));
  const Json together = run("locate gallery:limacon --log run.csv" + kRest + " --json").json();
  const Json apart = run("locate gallery:limacon --log one.csv --log two.csv" + kRest + " --json").json();
  EXPECT_EQ(together["placements"], apart["placements"]);
}

TEST(CliRollAll, ALogOfOneRollIsAnsweredAsEver) {
  const Folder folder;
  folder.write("one.csv", header(true) + rows_of(0.5, 0.8, 0, true));
  EXPECT_EQ(run("locate gallery:limacon --log one.csv" + kRest + " --json").out,
            run("locate gallery:limacon --log one.csv --finger disk,r=0.2 --json").out);
}

TEST(CliRollAll, ATouchCountsWithARoll) {
  const Folder folder;
  folder.write("one.csv", header(true) + rows_of(0.5, 0.8, 0, true));
  const rollfix::Part part = rollfix::load_part("gallery:limacon");
  const double s = 5;
  const rollfix::Vec2 at = rollfix::Pose{3, 1, 0.5}.world(part.point(s) + 0.2 * touch_cases::outward(part.tangent(s)));
  const std::string touch = fmt::format(" --touch {:.6f},{:.6f}", at.x(), at.y());
  const std::string noise = " --noise contact=0.002,angle=0.1deg,position=0.002";
  const Ran ran = run("locate gallery:limacon --log one.csv" + touch + kRest + noise + " --json");
  ASSERT_EQ(ran.code, 0) << ran.err;
  const Json found = ran.json()["placements"][0];
  ASSERT_EQ(found["start"].size(), 2U);
  EXPECT_NEAR(found["start"][0].get<double>(), 0.5, 0.05);
  EXPECT_NEAR(found["start"][1].get<double>(), s, 0.05);
  EXPECT_TRUE(found["end"][1].is_null());
  EXPECT_THAT(run("locate gallery:limacon --log one.csv" + touch + " --finger disk,r=0.2" + noise).err,
              HasSubstr("--roll all"));
}

TEST(CliRollAll, AFigureShowsTheRollsInTheWorld) {
  const Folder folder;
  folder.write("run.csv", log_of_two());
  const Ran ran = run("locate gallery:limacon --log run.csv" + kRest + " -o world.svg");
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_THAT(cli::read("world.svg"), HasSubstr("2 rolls"));
}

TEST(CliRollAll, APartThatWasMovedIsInconsistentAndSaidToBe) {
  const Folder folder;
  std::string rows = rows_of(3.1, -0.9, 100, true);
  const rollfix::Part part = rollfix::load_part("gallery:limacon");
  std::string moved;
  std::size_t from = 0;
  while (from < rows.size()) {  // the part was pushed by 0.5 along x
    const std::size_t to = rows.find('\n', from);
    const std::string row = rows.substr(from, to - from);
    const std::size_t y = row.rfind(',');
    const std::size_t x = row.rfind(',', y - 1);
    moved += row.substr(0, x + 1) + fmt::format("{:.9f}", std::stod(row.substr(x + 1)) + 0.5) + row.substr(y) + "\n";
    from = to + 1;
  }
  folder.write("run.csv", header(true) + rows_of(0.5, 0.8, 0, true) + "50,0,0,0,0,0\n" + moved);
  const Ran ran = run("locate gallery:limacon --log run.csv" + kRest);
  EXPECT_EQ(ran.code, 1) << ran.err;
  EXPECT_THAT(ran.out, HasSubstr("inconsistent"));
  EXPECT_THAT(ran.out, HasSubstr("the part was moved between roll 1 and roll 2"));
  const Json document = run("locate gallery:limacon --log run.csv" + kRest + " --json").json();
  EXPECT_EQ(document["diagnosis"][0]["cause"], "moved");
  EXPECT_EQ(document["diagnosis"][0]["what"],
            "the part was moved between roll 1 and roll 2: before and after it each fits by itself");
  EXPECT_EQ(document["diagnosis"][0]["after_roll"], 1);
}

TEST(CliRollAll, ABudgetThatRunsOutNamesTheRollThatIsOpen) {
  const Folder folder;
  folder.write("run.csv", log_of_two());
  const std::string noise = " --noise contact=0.002,angle=0.1deg,position=0.002 --budget 3";
  const Ran ran = run("locate gallery:limacon --log run.csv" + kRest + noise);
  EXPECT_EQ(ran.code, 3) << ran.err;
  EXPECT_THAT(ran.out, HasSubstr("not decided: roll 1 at s from"));
}

TEST(CliRollAll, WhatOnlyOneRollHasIsRefused) {
  const Folder folder;
  folder.write("run.csv", log_of_two());
  const std::string all = "locate gallery:limacon --log run.csv" + kRest;
  for (const char* option :
       {" --at 1", " --prior 1,0.1 --noise angle=1deg,contact=0.1", " --direction cw", " --explain", " --map a.csv"}) {
    const Ran ran = run(all + option);
    EXPECT_EQ(ran.code, 2) << option;
    EXPECT_THAT(ran.err, HasSubstr("--roll N")) << option;
  }
  EXPECT_EQ(run("locate gallery:limacon --reading 1,2 --roll all").code, 2);
  EXPECT_THAT(run("locate gallery:limacon --reading 1,2 --roll all").err, HasSubstr("--log"));
}

TEST(CliRollAll, ATableOfTouchesAndTheSameLogTwiceAreRefused) {
  const Folder folder;
  folder.write("touches.csv", "x,y\n1,2\n2,3\n");
  folder.write("run.csv", log_of_two());
  EXPECT_THAT(run("locate gallery:limacon --log touches.csv" + kRest).err,
              HasSubstr("touches.csv: expected a log of a roll, with u and psi, found a table of touches"));
  EXPECT_THAT(run("locate gallery:limacon --log run.csv --log run.csv" + kRest).err,
              HasSubstr("--log run.csv: it is given twice"));
}

TEST(CliRollAll, PathsLeaveOutThePosesThatAreInTheWay) {
  const Folder folder;
  folder.write("run.csv", log_of_two());
  const std::string asked = "locate gallery:limacon --log run.csv" + kRest + " --clear ";
  EXPECT_EQ(run(asked + "50,50,60,50").code, 0);
  const Ran through = run(asked + "3.6,1.3,3.7,1.3");
  EXPECT_EQ(through.code, 1);
  EXPECT_THAT(through.out, HasSubstr("inconsistent"));
}

TEST(CliRollAll, PathsAreTheRowsBetweenRolls) {
  const Folder folder;
  folder.write("run.csv", header(true) + rows_of(0.5, 0.8, 0, true) + "50,0,0,0,90,0\n51,0,0,0,90,90\n" +
                              rows_of(3.1, -0.9, 100, true));
  const Ran ran = run("locate gallery:limacon --log run.csv" + kRest + " --clear rows --json");
  ASSERT_EQ(ran.json()["clear"].size(), 2U) << ran.err;
  EXPECT_EQ(ran.json()["clear"][0], (Json{90, 0, 90, 90}));
}

TEST(CliRollAll, PathsAreRefusedWhereNothingTellsThePlace) {
  const Folder folder;
  folder.write("run.csv", log_of_two(false));
  const Ran ran = run("locate gallery:limacon --log run.csv" + kRest + " --clear 0,0,1,1");
  EXPECT_EQ(ran.code, 2);
  EXPECT_THAT(ran.err, HasSubstr("give logs with x and y, or a touch"));
}

TEST(CliRollAll, TheProofOfTwoRollsIsProvedAgain) {
  const Folder folder;
  folder.write("run.csv", log_of_two());
  const std::string asked = "locate gallery:limacon --log run.csv" + kRest;
  EXPECT_EQ(run(asked + " --tolerance 0.001,0.1deg --certify proof.json").code, 0);
  const Ran proved = cli::shell("rollfix-verify proof.json");
  EXPECT_EQ(proved.code, 0) << proved.out;
  EXPECT_EQ(proved.out.substr(0, proved.out.find('\n')), "proved: 1 set of poses, nothing else");
  EXPECT_THAT(run(asked + " --noise contact=0.002,angle=0.1deg,position=0.002 --certify noisy.json").err,
              HasSubstr("give --tolerance LENGTH,ANGLE"));
}

TEST(CliRollAll, IsNoQuestionOfAdvise) {
  const Folder folder;
  folder.write("run.csv", log_of_two());
  EXPECT_THAT(run("advise gallery:limacon --log run.csv" + kRest + " --touch 1,2").err,
              HasSubstr("the next touch is advised after touches alone"));
}

}  // namespace cli_roll_all_test
