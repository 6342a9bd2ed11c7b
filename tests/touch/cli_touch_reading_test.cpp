#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <sstream>
#include <string>
#include <vector>

#include "cli.hpp"
#include "paths.hpp"

// Tables of touches as controllers, data loggers and spreadsheets write them.
namespace cli_touch_reading_test {

using cli::Folder;
using cli::Json;
using cli::Ran;
using cli::run;
using testing::HasSubstr;

const std::string kBracket = checked_out("examples/bracket.dxf");
const std::string kBall = " --finger disk,r=3 --noise position=0.02";

// Of a bracket at x = 120, y = 45, turned by 12 degrees; what all forms below say.
constexpr double kPlaces[4][2] = {{108.088, 86.821}, {124.014, 51.172}, {180.292, 54.717}, {178.374, 82.953}};

Ran located(const std::string& file, const std::string& text, const std::string& rest = kBall) {
  const Folder folder;
  folder.write(file, text);
  return run("locate " + kBracket + " --log " + file + rest + " --json");
}

/// The program with this file as its standard input.
Ran run_with_input(const std::string& file, const std::string& command) {
  const int before = dup(STDIN_FILENO);
  const int input = open(file.c_str(), O_RDONLY);
  dup2(input, STDIN_FILENO);
  const Ran ran = run(command);
  dup2(before, STDIN_FILENO);
  close(input);
  close(before);
  std::clearerr(stdin);
  return ran;
}

/// The four places, whatever they were written in.
void expect_read(const Ran& ran) {
  ASSERT_EQ(ran.code, 0) << ran.err;
  const Json touches = ran.json()["touches"];
  ASSERT_EQ(touches.size(), 4U);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_NEAR(touches[k]["at"][0].get<double>(), kPlaces[k][0], 1e-9);
    EXPECT_NEAR(touches[k]["at"][1].get<double>(), kPlaces[k][1], 1e-9);
  }
}

TEST(CliTouchReading, CapitalsAndAThirdCoordinateAreNoObstacle) {
  const Ran ran = located("t.csv",
                          "X, Y, Z\n108.088, 86.821, -1\n124.014, 51.172, -1\n180.292, 54.717, -1\n178.374, 82.953, "
                          "-1\n");
  expect_read(ran);
  EXPECT_THAT(ran.err, HasSubstr("this column is not used: Z; known are x, y, normal"));
}

TEST(CliTouchReading, UnitsStandBehindNamesOrInBrackets) {
  expect_read(located("t.csv", "x_cm,Y (mm)\n10.8088,86.821\n12.4014,51.172\n18.0292,54.717\n17.8374,82.953\n"));
  expect_read(located("t.csv", "x [CM]\ty_mm\n10.8088\t86.821\n12.4014\t51.172\n18.0292\t54.717\n17.8374\t82.953\n"));
}

TEST(CliTouchReading, SemicolonsWithDecimalCommasAndNormalsInDegrees) {
  const Ran ran = located("t.csv",
                          "x_mm;y_mm;Normal [deg]\r\n108,088;86,821;-167,6\r\n124,014;51,172;\r\n180,292;54,717;\r\n"
                          "178,374;82,953;\r\n",
                          kBall + ",angle=1deg");
  expect_read(ran);
  EXPECT_NEAR(ran.json()["touches"][0]["normal"].get<double>(), -167.6 * std::acos(-1.0) / 180, 1e-12);
  EXPECT_TRUE(ran.json()["touches"][1]["normal"].is_null());
}

TEST(CliTouchReading, ColumnsSayWhatAHeaderCallsThem) {
  expect_read(located("t.csv", "px,py,dist\n10.8088,86.821,1\n12.4014,51.172,1\n18.0292,54.717,1\n17.8374,82.953,1\n",
                      kBall + " --columns x=px:cm,y=py"));
}

TEST(CliTouchReading, AGrblConsoleLogHasItsProbesAmongOtherLines) {
  const Ran ran = located("console.log",
                          "Grbl 1.1h ['$' for help]\n>G38.2 X0 F100\n[PRB:108.088,86.821,-1.000:1]\nok\n"
                          "<Idle|MPos:1.000,2.000,0.000|FS:0,0>\n[prb:124.014,51.172,-1.000:1]\n"
                          "[PRB:0.000,51.172,-1.000:0]\nALARM:5\n[PRB:180.292,54.717,-1.000:1]\n"
                          "[PRB:178.374,82.953,-1.000,0.000:1]\n");
  expect_read(ran);
  EXPECT_THAT(ran.err, HasSubstr("console.log: 1 report left out: the probe did not touch"));
  EXPECT_THAT(ran.err, HasSubstr("taken as mm, which they are unless $13=1"));
}

TEST(CliTouchReading, ALinuxCncProbeFileHasNineNumbersInARow) {
  expect_read(located("probe.txt",
                      "108.088000 86.821000 -1.0 0.0 0.0 0.0 0.0 0.0 0.0\n124.014000 51.172000 -1.0 0 0 0 0 0 0\n"
                      "180.292000 54.717000 -1.0 0 0 0 0 0 0\n178.374000 82.953000 -1.0 0 0 0 0 0 0\n"));
}

TEST(CliTouchReading, StandardInputServesAsAFile) {
  const Folder folder;
  folder.write("t.csv", "X,Y\n108.088,86.821\n124.014,51.172\n180.292,54.717\n178.374,82.953\n");
  expect_read(run_with_input("t.csv", "locate " + kBracket + " --log -" + kBall + " --json"));
}

TEST(CliTouchReading, ALogOfARollFromStandardInputIsReadAsBefore) {
  const Folder folder;
  std::string log = "time,u,psi\n";
  for (int k = 0; k < 6000; ++k) {  // beyond what is looked at
    log += std::to_string(k) + "," + std::to_string(-0.0005 * k) + "," + std::to_string(0.0009 * k) + "\n";
  }
  folder.write("roll.csv", log);
  const std::string rest = " --finger disk,r=0.2 --tolerance 1e-3 --json";
  const Ran of_file = run("locate gallery:cam --log roll.csv" + rest);
  const Ran of_input = run_with_input("roll.csv", "locate gallery:cam --log -" + rest);
  EXPECT_EQ(of_input.code, of_file.code);
  EXPECT_EQ(of_input.json()["placements"], of_file.json()["placements"]);
}

TEST(CliTouchReading, TouchesWithTheirOwnNoiseNeedNoOther) {
  const std::string table =
      "x,y,position_sd\n108.088,86.821,0.02\n124.014,51.172,0.02\n180.292,54.717,0.02\n178.374,82.953,0.02\n";
  const Ran own = located("t.csv", table, " --finger disk,r=3");
  expect_read(own);
  const Ran common = located("t.csv", table, kBall);
  EXPECT_EQ(own.json()["placements"], common.json()["placements"]);
  const Ran lacking = located("t.csv", table + "1,2,\n", " --finger disk,r=3");
  EXPECT_EQ(lacking.code, 2);
  EXPECT_THAT(lacking.err, HasSubstr("found neither --noise nor --tolerance"));
}

TEST(CliTouchReading, RowsWithoutContactAreNoTouches) {
  const Ran ran = located("t.csv",
                          "x,y,contact\n108.088,86.821,1\n0,0,0\n124.014,51.172,1\n180.292,54.717,1\n178.374,82.953,1"
                          "\n5,5,0\n");
  expect_read(ran);
  EXPECT_THAT(ran.err, HasSubstr("2 rows with contact 0 are no touches"));
}

TEST(CliTouchReading, ClearRowsAreFreeSpace) {
  const std::string table =
      "x,y,contact\n60,86,0\n108.088,86.821,1\n124.014,51.172,1\n180,20,0\n200,20,0\n180.292,54.717,1\n"
      "178.374,82.953,1\n";
  const Ran ran = located("t.csv", table, kBall + " --clear rows --clear 0,0,1,1");
  expect_read(ran);
  const Json clear = ran.json()["clear"];
  ASSERT_EQ(clear.size(), 4U);  // the way back from a touch is not one of them
  EXPECT_EQ(clear[0], Json({60, 86, 108.088, 86.821}));
  EXPECT_EQ(clear[1], Json({180, 20, 200, 20}));
  EXPECT_EQ(clear[2], Json({200, 20, 180.292, 54.717}));
  EXPECT_EQ(clear[3], Json({0, 0, 1, 1}));
  EXPECT_THAT(located("t.csv", "x,y\n1,2\n", kBall + " --clear rows").err,
              HasSubstr("expected in the --log a row with contact 0 and a row after it"));
  EXPECT_THAT(located("t.csv", "x,y\n1,2\n", kBall + " --clear 1,2").err, HasSubstr("expected X,Y,X,Y"));
  EXPECT_THAT(run("locate gallery:cam --reading 1,1 --clear 1,2,3,4").err, HasSubstr("--clear is about touches"));
}

TEST(CliTouchReading, NoPathLeadsToATouchWhosePlaceIsUnknown) {
  const std::string table =
      "x,y,normal [deg],contact\n60,86,,0\n,,12,1\n180,20,,0\n200,20,,0\n124.014,51.172,,1\n180.292,54.717,,1\n";
  const Ran ran = located("t.csv", table, kBall + ",angle=1deg --clear rows");
  EXPECT_NE(ran.code, 2) << ran.err;
  EXPECT_EQ(ran.json()["clear"], Json({{180, 20, 200, 20}, {200, 20, 124.014, 51.172}}));
}

TEST(CliTouchReading, ABatchHasTouchesAsWell) {
  const Folder folder;
  folder.write("b.jsonl",
               R"({"id": 1, "touches": [[108.088, 86.821], [124.014, 51.172], [180.292, 54.717], [178.374, 82.953]]})"
               "\n"
               R"({"id": 2, "touches": ["108.088,86.821", {"at": [124.014, 51.172], "normal": null}, [180.292, 54.717,)"
               R"( null], [178.374, 82.953]]})"
               "\n"
               R"({"id": 3, "touches": [[1]]})"
               "\n"
               R"({"id": 4, "readings": [[1, 0.5]], "noise": null, "fingers": null, "touches": [[1, 2]]})"
               "\n");
  const Ran ran = run("locate " + kBracket + " --batch b.jsonl" + kBall);
  EXPECT_EQ(ran.code, 2);
  std::vector<Json> lines;
  std::istringstream text(ran.out);
  for (std::string line; std::getline(text, line);) lines.push_back(Json::parse(line));
  ASSERT_EQ(lines.size(), 4U);
  EXPECT_EQ(lines[0]["verdict"], "unique");
  EXPECT_EQ(lines[0]["placements"], lines[1]["placements"]);
  EXPECT_THAT(lines[2]["error"].get<std::string>(), HasSubstr("b.jsonl:3: --touch 1: expected X,Y or X,Y,NORMAL"));
  EXPECT_THAT(lines[3]["error"].get<std::string>(), HasSubstr("expected one of \"readings\", \"log\" and \"touches\""));
}

TEST(CliTouchReading, ABatchHasNormalsAloneAsTheCommandLineHasThem) {
  const Folder folder;
  folder.write("b.jsonl", R"({"touches": [[108.088, 86.821], [124.014, 51.172], [null, null, 1.2]]})"
                          "\n"
                          R"({"touches": [[108.088, 86.821], [124.014, 51.172], ",,1.2"]})"
                          "\n");
  const Ran ran = run("locate " + kBracket + " --batch b.jsonl --finger disk,r=3 --noise position=0.02,angle=0.01");
  ASSERT_EQ(ran.code, 0) << ran.out;
  std::istringstream text(ran.out);
  std::string lists, typed;
  ASSERT_TRUE(std::getline(text, lists) && std::getline(text, typed));
  EXPECT_EQ(Json::parse(lists)["placements"], Json::parse(typed)["placements"]);
}

TEST(CliTouchReading, WhatIsWrongIsToldWithItsLineItsValueAndTheCure) {
  const auto refused = [](const std::string& text, const std::string& rest = " --noise position=0.1") {
    const Ran ran = located("t.csv", text, rest);
    EXPECT_EQ(ran.code, 2) << text;
    return ran.err;
  };
  EXPECT_THAT(refused("[PRB:1,a,0:1]\n"), HasSubstr("t.csv:1: y: expected a number, found 'a'"));
  EXPECT_THAT(refused("ok\n[PRB:1,2\n"), HasSubstr("t.csv:2: expected a probe's report, as in [PRB:12.300"));
  EXPECT_THAT(refused("[PRB:1,2,3:0]\n"), HasSubstr("found only reports of a probe that did not touch"));
  EXPECT_THAT(refused("1 2 3 4 5 6 7 8 9\n1 2 3\n"), HasSubstr("t.csv:2: expected 9 numbers as in the rows above"));
  EXPECT_THAT(refused("x,y,contact\n1,2,yes\n"), HasSubstr("t.csv:2: column contact: expected 0 or 1, found 'yes'"));
  EXPECT_THAT(refused("x,y,contact\n1,2,0\n"), HasSubstr("found no row with contact 1"));
  EXPECT_THAT(refused("x,y,normal\n1,2,a\n"), HasSubstr("t.csv:2: column normal: expected a number, found 'a'"));
  EXPECT_THAT(refused("p,q\n1,2\n", " --noise position=1 --columns x=p,normal=q"),
              HasSubstr("expected a header with x and y"));
  EXPECT_THAT(refused("p,q\n1,2\n", " --noise position=1 --columns x=p,y=r,normal=q"),
              HasSubstr("t.csv:1: expected a column 'r' for y (--columns), found none"));
  EXPECT_THAT(refused("p,q\n1,2\n", " --noise position=1 --columns x=p,normal=q:mm"),
              HasSubstr("expected of normal rad, deg, found 'mm'"));
  EXPECT_THAT(refused("[PRB:1,2,3:1]\n", " --noise position=1 --columns normal=q"), HasSubstr("leave --columns out"));
}

}  // namespace cli_touch_reading_test
