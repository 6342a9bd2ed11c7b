// rollfix teach, and points that are smoothed, from the command line.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "cli.hpp"

namespace cli_teach_test {
namespace {

using cli::Json;
using cli::run;
using testing::HasSubstr;
using testing::Not;

double perimeter_of(const std::string& part) { return run("inspect " + part + " --json").json()["part"]["perimeter"]; }

TEST(CliTeach, roll_around_a_part_is_taught_saved_and_located_on) {
  const cli::Folder folder;
  const double perimeter = perimeter_of("gallery:cam");
  run(fmt::format("simulate gallery:cam --finger disk,r=0.2 --start 0 --length {} --samples 800 -o around.csv",
                  perimeter));
  const cli::Ran taught = run("teach around.csv --finger disk,r=0.2 -o taught.json");
  EXPECT_EQ(taught.code, 0) << taught.err;
  EXPECT_THAT(taught.err, HasSubstr("closed: the turn is off 1 x 360 deg"));
  EXPECT_NEAR(perimeter_of("taught.json"), perimeter, 1e-9);

  run("simulate gallery:cam --finger disk,r=0.2 --start 1.3 --length 0.9 -o later.csv");
  const cli::Ran found = run("locate taught.json --log later.csv --finger disk,r=0.2 --tolerance 0.01deg --json");
  double least = perimeter;
  const Json answer = found.json();
  for (const Json& placement : answer["placements"]) {
    least = std::min(least, std::abs(placement["start"][0].get<double>() - 1.3));
  }
  EXPECT_LT(least, 1e-6);
}

TEST(CliTeach, json_says_how_it_was_closed) {
  const cli::Folder folder;
  folder.write("lap.csv", "length,turn\n1,0\n1.5,90deg\n2.5,90deg\n3,180deg\n4,180deg\n4.5,270deg\n5.5,270deg\n");
  const Json open = run("teach lap.csv --json").json();
  EXPECT_EQ(open["schema"], "rollfix/teach/1");
  EXPECT_EQ(open["taught"]["closing"], "kept_open");
  EXPECT_EQ(open["part"]["closed"], false);
  const Json bridged = run("teach lap.csv --bridge --json").json();
  EXPECT_EQ(bridged["taught"]["closing"], "bridged");
  EXPECT_EQ(bridged["part"]["closed"], true);
  EXPECT_GT(bridged["taught"]["bridge"], 0.1);
}

TEST(CliTeach, noise_decides_what_is_drift) {
  const cli::Folder folder;
  std::string text = "length,turn\n";
  for (int k = 1; k <= 200; ++k) text += fmt::format("{:.9f},{:.9f}\n", 0.01 * k * 3.14159265359, 0.01 * k * 3.08);
  folder.write("lap.csv", text);  // a circle of radius 1, and a gyroscope that drifts by 0.123 rad
  EXPECT_EQ(run("teach lap.csv --json").json()["taught"]["closing"], "kept_open");
  EXPECT_EQ(run("teach lap.csv --noise angle=2deg --json").json()["taught"]["closing"], "spread");
}

TEST(CliTeach, rows_that_jitter_are_told_with_the_noise_to_give) {
  const cli::Folder folder;
  const std::string roll = "simulate gallery:cam --finger disk,r=0.2 --start 0 --length 7.6 --samples 800 ";
  run(roll + "--noise angle=0.3deg --seed 1 -o noisy.csv");
  run(roll + "-o exact.csv");
  const std::string noisy = run("teach noisy.csv --finger disk,r=0.2").err;
  EXPECT_THAT(noisy, HasSubstr("jitter by 0."));
  EXPECT_THAT(noisy, HasSubstr("smooth it with --noise angle=0."));
  EXPECT_THAT(run("teach exact.csv --finger disk,r=0.2").err, Not(HasSubstr("jitter")));
  EXPECT_THAT(run("teach noisy.csv --finger disk,r=0.2 --noise angle=0.3deg").err, Not(HasSubstr("jitter by")));
}

TEST(CliTeach, what_can_not_be_meant_is_refused) {
  const cli::Folder folder;
  folder.write("lap.csv", "length,turn\n1,0\n2,90deg\n");
  EXPECT_THAT(run("teach").err, HasSubstr("expected a LOG"));
  EXPECT_THAT(run("teach lap.csv --bridge --open").err, HasSubstr("give one of them"));
  EXPECT_THAT(run("teach lap.csv --noise anlge=1").err, HasSubstr("did you mean 'angle'?"));
  EXPECT_THAT(run("teach lap.csv --noise angle=1,angle=2").err, HasSubstr("angle is given twice"));
  EXPECT_THAT(run("teach lap.csv --noise angle=-1").err, HasSubstr("below 0"));
  EXPECT_THAT(run("teach lap.csv --noise slip=x").err, HasSubstr("'x' is not a number"));
  EXPECT_EQ(run("teach nothing.csv").code, 2);
  EXPECT_EQ(run("teach lap.csv -o part.txt").code, 2);
}

TEST(CliSmooth, note_says_how_near_the_points_are) {
  const cli::Folder folder;
  std::string text;
  for (int k = 0; k < 400; ++k) {
    const double u = 2 * 3.14159265359 * k / 400;
    text += fmt::format("{:.6f},{:.6f}\n", 2 * std::cos(u) + 0.01 * std::sin(37 * k),
                        std::sin(u) + 0.01 * std::sin(91 * k));
  }
  folder.write("scan.csv", text);
  const cli::Ran smooth = run("inspect scan.csv --smooth 0.02 --json");
  EXPECT_THAT(smooth.err, HasSubstr("smoothed: within 0.02 of all 400 points (largest deviation 0.01"));
  EXPECT_EQ(smooth.json()["part"]["inflections"], 0);
  EXPECT_EQ(run("inspect scan.csv --smooth 0").code, 2);
  EXPECT_EQ(run("inspect scan.csv --smooth -1").code, 2);
  EXPECT_EQ(run("inspect scan.csv --smooth 5").code, 2);
  EXPECT_EQ(run("inspect gallery:ellipse --smooth 0.1").code, 2);
}

}  // namespace
}  // namespace cli_teach_test
