#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "cli.hpp"
#include "paths.hpp"

namespace cli_touch_test {

using cli::Folder;
using cli::Json;
using cli::Ran;
using cli::run;
using testing::HasSubstr;
using testing::Not;

const std::string kBracket = checked_out("examples/bracket.dxf");

// A ball of 3 mm at five places of the bracket, which lies at x = 120, y = 45, turned by 12 degrees; 0.02 mm of noise.
const std::string kFive =
    "--touch 108.088,86.821 --touch 124.014,51.172 --touch 180.292,54.717 --touch 178.374,82.953 "
    "--touch 134.488,101.138 --finger disk,r=3 --noise position=0.02";
const std::string kTable = "x,y\n108.088,86.821\n124.014,51.172\n180.292,54.717\n178.374,82.953\n134.488,101.138\n";

double number_of(const Json& document, const char* field, std::size_t which) {
  return document["placements"][0][field][which].get<double>();
}

TEST(CliTouch, FiveCentresOfABallGiveTheWorkOffset) {
  const Ran ran = run("locate " + kBracket + " " + kFive + " --json");
  ASSERT_EQ(ran.code, 0) << ran.err;
  const Json document = ran.json();
  EXPECT_EQ(document["schema"], "rollfix/locate/1");
  EXPECT_EQ(document["status"], "complete");
  EXPECT_EQ(document["verdict"], "unique");
  ASSERT_EQ(document["placements"].size(), 1U);
  const Json& mean = document["placements"][0]["pose_mean"];
  const Json& interval = document["placements"][0]["pose_interval"];
  const double truth[3] = {120, 45, 12 * std::acos(-1.0) / 180};
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_LE(interval[k][0].get<double>(), truth[k]);
    EXPECT_GE(interval[k][1].get<double>(), truth[k]);
    EXPECT_NEAR(mean[k].get<double>(), truth[k], k < 2 ? 0.3 : 0.01);
  }
  EXPECT_EQ(document["placements"][0]["start"].size(), 5U);
  EXPECT_EQ(document["contacts"].size(), 5U);
}

TEST(CliTouch, AnOutlierIsNamedByRobust) {
  const std::string asked = "locate " + kBracket + " --touch 112.243,107.744 --touch 150,70 " + kFive + " --robust";
  const Ran ran = run(asked + " --verbose");
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_THAT(ran.out, HasSubstr("robust     any touch may be an outlier; most probably touch 2 (probability 1.0000)"));
  EXPECT_THAT(ran.out, HasSubstr("2 (outlier)"));
  const Json document = run(asked + " --json").json();
  EXPECT_EQ(document["placements"][0]["outliers"], Json({1}));
  EXPECT_EQ(document["placements"][0]["start"].size(), 7U);
  EXPECT_EQ(document["outlier"].size(), 7U);
  EXPECT_GT(document["outlier"][1].get<double>(), 0.999);
  EXPECT_LT(document["anywhere"].get<double>(), 1e-6);
}

TEST(CliTouch, ATableSaysTheSame) {
  const Folder folder;
  folder.write("touches.csv", kTable);
  const std::string rest = " --finger disk,r=3 --noise position=0.02 --json";
  const Ran of_table = run("locate " + kBracket + " --log touches.csv" + rest);
  const Ran typed = run("locate " + kBracket + " " + kFive + " --json");
  ASSERT_EQ(of_table.code, 0) << of_table.err;
  EXPECT_EQ(of_table.out, typed.out);
}

TEST(CliTouch, ATableMayHaveUnitsNormalsAndItsOwnNoise) {
  const Folder folder;
  folder.write("touches.csv",
               "x [cm];y [cm];normal [deg];position_sd;normal_sd;note\n"
               "10.8088;8.6821;-167.6;0.02;0.02;first\n12.4009;5.1185;-124.4;0.02;;\n18.0267;5.4730;;0.05;;\n");
  const Ran ran =
      run("locate " + kBracket + " --log touches.csv --finger disk,r=3 --noise position=0.1,angle=1deg --json");
  ASSERT_EQ(ran.code, 0) << ran.err;
  const Json touches = ran.json()["touches"];
  EXPECT_NEAR(touches[0]["at"][0].get<double>(), 108.088, 1e-9);
  EXPECT_NEAR(touches[0]["normal"].get<double>(), -167.6 * std::acos(-1.0) / 180, 1e-9);
  EXPECT_TRUE(touches[2]["normal"].is_null());
  EXPECT_TRUE(touches[1]["normal_sd"].is_null());
  EXPECT_EQ(touches[2]["position_sd"].get<double>(), 0.05);
  EXPECT_NEAR(number_of(ran.json(), "pose_mean", 0), 120, 1);
}

TEST(CliTouch, TheTextHasThePoseWithItsSpreadAndWhatWasAsked) {
  const Ran ran = run("locate " + kBracket + " " + kFive + " --verbose");
  EXPECT_THAT(ran.out, HasSubstr("unique\n"));
  EXPECT_THAT(ran.out, HasSubstr("heading [deg]"));
  EXPECT_THAT(ran.out, HasSubstr("95 % within x 119.9"));
  EXPECT_THAT(ran.out, HasSubstr("touches    5, 0 with normal; finger disk,r=3"));
  EXPECT_THAT(ran.out, HasSubstr("touches on the part in p0:"));
}

TEST(CliTouch, AFigureShowsThePartInTheWorld) {
  const Folder folder;
  const Ran ran = run("locate " + kBracket + " " + kFive + " -o poses.svg");
  EXPECT_EQ(ran.code, 0) << ran.err;
  const std::string figure = cli::read("poses.svg");
  EXPECT_THAT(figure, HasSubstr("class=\"pose\""));
  std::size_t touches = 0;
  for (std::size_t at = figure.find("class=\"touch\""); at != std::string::npos;
       at = figure.find("class=\"touch\"", at + 1)) {
    ++touches;
  }
  EXPECT_EQ(touches, 5U);
}

TEST(CliTouch, TouchesThatFitNowhereExitWithOneAndSayWhatMayBeWrong) {
  const Ran ran =
      run("locate " + kBracket +
          " --touch 108.088,86.821,-167.6deg --touch 124.009,51.185,-124.4deg --touch 180.267,54.73,-79.1deg"
          " --touch 178.366,82.958,101.7deg --finger disk,r=6 --noise position=0.02,angle=1deg");
  EXPECT_EQ(ran.code, 1);
  EXPECT_THAT(ran.out, HasSubstr("inconsistent\n"));
  EXPECT_THAT(ran.out, HasSubstr("possible cause: the finger's radius is 3, not 6"));
}

TEST(CliTouch, PosesThatAreNoCopiesOfOneAnotherAreNotSaidToLookTheSame) {
  const std::string circles =
      run("locate gallery:circle --finger disk,r=0.1 --noise position=0.002 --touch 1.1,0 --touch 0,1.1").out;
  EXPECT_THAT(circles, Not(HasSubstr("looks the same")));
  const std::string ellipse = "locate gallery:ellipse --finger disk,r=0.1 --noise position=0.002 --touch 2.1,0 ";
  EXPECT_THAT(run(ellipse + "--touch 1.1112,0.9367 --touch=-1.6579,0.6816 --touch 0,-1.1").out,
              HasSubstr("looks the same in each of these poses"));
}

TEST(CliTouch, TouchesThatCoincideAreNotTakenForASymmetry) {
  const Ran ran = run("locate gallery:cam --finger disk,r=0.2 --noise position=0.02 --touch 1,2 --touch 1,2");
  EXPECT_THAT(ran.out, HasSubstr("all touches are at one place"));
  EXPECT_THAT(ran.out, Not(HasSubstr("looks the same")));
}

TEST(CliTouch, ABudgetThatRunsOutExitsWithThree) {
  const Ran ran = run("locate " + kBracket + " " + kFive + " --budget 300");
  EXPECT_EQ(ran.code, 3);
  EXPECT_THAT(ran.out, HasSubstr("undecided\n"));
  EXPECT_THAT(ran.out, HasSubstr("not decided: touch "));
}

TEST(CliTouch, AToleranceServesInPlaceOfNoise) {
  const Ran ran = run("locate " + kBracket +
                      " --touch 108.088,86.821 --touch 124.014,51.172 --touch 180.292,54.717 "
                      "--touch 178.374,82.953 --touch 134.488,101.138 --finger disk,r=3 --tolerance 0.1 --json");
  ASSERT_EQ(ran.code, 0) << ran.err << ran.out;
  const Json document = ran.json();
  EXPECT_TRUE(document["placements"][0]["probability"].is_null());
  EXPECT_LE(document["placements"][0]["worst"].get<double>(), 1);
}

TEST(CliTouch, WhatCannotBeMeantIsRefusedWithTheCure) {
  const auto refused = [](const std::string& rest) {
    const Ran ran = run("locate gallery:cam " + rest);
    EXPECT_EQ(ran.code, 2) << rest;
    return ran.err;
  };
  EXPECT_THAT(refused("--touch 1,2 --touch 2,3"),
              HasSubstr("found neither --noise nor --tolerance; standard deviations are given with --noise "
                        "position=0.05,angle=1deg"));
  EXPECT_THAT(refused("--touch 1 --tolerance 0.1"), HasSubstr("expected X,Y or X,Y,NORMAL, as in 12.5,3.1,73deg"));
  EXPECT_THAT(refused("--touch 1,2,90 --tolerance 0.1,1deg"), HasSubstr("degrees are written 90deg"));
  EXPECT_THAT(refused("--touch 1,2,1 --tolerance 0.1"), HasSubstr("expected a --tolerance of the normals above 0"));
  EXPECT_THAT(refused("--touch 1,2,1 --tolerance 0.1,2"), HasSubstr("degrees are written 2deg"));
  EXPECT_THAT(refused("--touch 1,2,1 --noise position=0.1,angle=1"), HasSubstr("at most 0.5 of its normal"));
  EXPECT_THAT(refused("--touch 1,2 --noise position=50"), HasSubstr("beyond which it says nothing"));
  EXPECT_THAT(refused("--touch 1,2,1 --noise position=0.1"), HasSubstr("angle=SD"));
  EXPECT_THAT(refused("--touch 1,2 --finger jaw --tolerance 0.1"), HasSubstr("takes disks only"));
  EXPECT_THAT(refused("--touch 1,2 --tolerance 0.1 --facing 1"), HasSubstr("--facing: touches do not roll"));
  EXPECT_THAT(refused("--touch 1,2 --tolerance 0.1 --squeezed"),
              HasSubstr("--squeezed: it is about a finger with skin and a wheel"));
}

TEST(CliTouch, ATableThatCannotBeReadIsToldWithItsLine) {
  const Folder folder;
  const auto refused = [&](const std::string& text) {
    folder.write("touches.csv", text);
    return run("locate gallery:cam --log touches.csv --noise position=0.1").err;
  };
  EXPECT_THAT(refused("x,y\n1,2\n3,a\n"), HasSubstr("touches.csv:3: column y: expected a number, found 'a'"));
  EXPECT_THAT(refused("x,y\n"), HasSubstr("expected a touch in each row, found no row"));
  EXPECT_THAT(refused("x,y,normal [mm]\n1,2,3\n"), HasSubstr("touches.csv:1: column normal: expected an angle"));
  EXPECT_THAT(refused("x,y,x\n1,2,3\n"), HasSubstr("expected one column x, found two"));
  EXPECT_THAT(refused("x,y\n1,2,3\n"), HasSubstr("touches.csv:2: expected 2 cells as in the header, found 3"));
}

TEST(CliTouch, LogsOfRollsAreReadAsBefore) {
  const Folder folder;
  const auto told = [&](const std::string& text) {
    folder.write("log.csv", text);
    return run("locate gallery:cam --log log.csv --finger disk,r=0.2");
  };
  // x and y beside u and psi are of a roll; neither a header without them nor what is no table is one of touches.
  EXPECT_EQ(told("time,u,psi,x,y\n0,0,0,0,0\n1,0.5,0,0,0\n").code, told("time,u,psi\n0,0,0\n1,0.5,0\n").code);
  EXPECT_THAT(told("stamp,wheel,yaw,x,y\n0,0,0,0,0\n1,0.5,0,0,0\n").err, HasSubstr("--columns"));
  EXPECT_THAT(told("x,z\n1,2\n").err, HasSubstr("log.csv"));
  EXPECT_THAT(told("\xFF\xFEx").err, HasSubstr("UTF-16"));
  EXPECT_THAT(run("locate gallery:cam --log nowhere.csv").err, HasSubstr("nowhere.csv"));
}

TEST(CliTouch, AFaceDownPartTakesMirror) {
  const std::string touches =
      " --touch -108.088,86.821 --touch -124.014,51.172 --touch -180.292,54.717 --touch -178.374,82.953 "
      "--touch -134.488,101.138 --finger disk,r=3 --noise position=0.02 --json";
  const Ran ran = run("locate " + kBracket + touches + " --mirror");
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_NEAR(number_of(ran.json(), "pose_mean", 0), -120, 0.3);
}

}  // namespace cli_touch_test
