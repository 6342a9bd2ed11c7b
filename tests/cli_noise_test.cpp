#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <regex>
#include <string>

#include "cli.hpp"

// Noise and advice on the command line: what is printed, refused and told.
namespace cli_noise_test {

using cli::Folder;
using cli::Json;
using cli::Ran;
using cli::read;
using cli::run;
using testing::HasSubstr;
using testing::Not;

namespace {

constexpr const char* kNoise = " --noise contact=0.005,angle=0.005,slip=0.005";

/// noisy.csv: a roll on the cam from s = 1 over this length, by a disk of radius 0.2.
void write_noisy_roll(const std::string& length, const std::string& part = "gallery:cam") {
  const Ran ran = run("simulate " + part +
                      " --finger disk,r=0.2 --start 1 --samples 200 -o noisy.csv --seed 3 --length " + length + kNoise);
  ASSERT_EQ(ran.code, 0) << ran.err;
}

}  // namespace

TEST(CliNoise, a_gyroscope_is_as_its_datasheet_has_it) {
  const Folder folder;
  folder.write("drive.csv", "time,length,turn\n1,0.2,0.1\n2,0.4,0.3\n3,0.6,0.5\n");
  const auto noise = [](const std::string& typed) {
    return run("locate gallery:cam --log drive.csv --json --noise angle=0.05," + typed).json()["noise"];
  };
  // A degree an hour is pi / 180 / 3600 a second; a degree per root of an hour is pi / 180 / 60 per root of a second.
  EXPECT_NEAR(noise("drift=3600deg/h")["drift"], 0.017453292519943, 1e-14);
  EXPECT_NEAR(noise("drift=60deg/min")["drift"], 0.017453292519943, 1e-14);
  EXPECT_NEAR(noise("drift=0.25")["drift"], 0.25, 1e-15);
  EXPECT_NEAR(noise("walk=60deg/sqrt(h)")["walk"], 0.017453292519943, 1e-14);
  EXPECT_NEAR(noise("walk=1deg/s/sqrt(Hz)")["walk"], 0.017453292519943, 1e-14);
  EXPECT_NEAR(noise("walk=0.5rad/sqrt(s)")["walk"], 0.5, 1e-15);
}

TEST(CliNoise, of_all_that_rows_measure_is_scaled_in_the_cure) {
  const Folder folder;
  run("simulate gallery:cam --finger disk,r=0.2 --start 1 --length 3 --samples 60 --seed 3 -o rough.csv "
      "--noise contact=0.03,angle=0.03,position=0.03");
  const std::string locate = "locate gallery:cam --log rough.csv --finger disk,r=0.2 ";
  const std::string told = run(locate + "--noise contact=0.01,angle=0.01,position=0.01").out;
  std::smatch cure;
  ASSERT_TRUE(
      std::regex_search(told, cure, std::regex("--noise contact=([0-9.]+),angle=[0-9.]+deg,position=([0-9.]+)")))
      << told;
  EXPECT_EQ(cure[1].str(), cure[2].str());
  EXPECT_THAT(run(locate + cure[0].str()).out, Not(HasSubstr("fit badly")));
}

TEST(CliNoise, of_a_kind_that_two_fingers_do_not_have_is_refused) {
  const Folder folder;
  run("simulate gallery:cam --finger disk,r=0.2 --start 1 --start 3 --length 0.5 --length 0.4 -o a.csv -o b.csv");
  EXPECT_EQ(run("locate gallery:cam --log a.csv --log b.csv --finger disk,r=0.2 --noise angle=0.01,drift=0.1").err,
            "rollfix: noise of two fingers is contact, angle, slip, radius, position and correlation, found drift=0.1; "
            "leave it out\n");
}

TEST(CliNoise, a_gyroscopes_noise_without_times_or_unit_is_refused) {
  const Folder folder;
  folder.write("drive.csv", "length,turn\n0.2,0.1\n0.4,0.3\n0.6,0.5\n");
  EXPECT_THAT(run("locate gallery:cam --log drive.csv --noise angle=0.05,walk=0.3deg/sqrt(h)").err,
              HasSubstr("drive.csv: has no times, and the noise's walk gathers with time"));
  EXPECT_THAT(run("locate gallery:cam --log drive.csv --noise angle=0.05,drift=10deg").err,
              HasSubstr("'10deg' is none of 10deg/h, 5deg/min"));
  EXPECT_THAT(run("locate gallery:cam --log drive.csv --noise angle=0.05,walk=1deg/h").err,
              HasSubstr("'1deg/h' is none of 0.3deg/sqrt(h)"));
}

TEST(CliNoise, a_cure_after_which_nothing_fits_names_no_place) {
  const std::string out = run("locate gallery:cam --reading 1,2 --noise contact=0.1").out;
  EXPECT_THAT(out, HasSubstr("slip=0.2; even then nothing fits\n"));
  EXPECT_THAT(out, Not(HasSubstr("then inconsistent")));
}

TEST(CliNoise, every_placement_has_a_probability_and_they_come_in_that_order) {
  const Folder folder;
  write_noisy_roll("0.3");
  const Ran ran = run("locate gallery:cam --log noisy.csv --finger disk,r=0.2 --json" + std::string(kNoise));
  ASSERT_EQ(ran.code, 0) << ran.err;
  const Json found = ran.json();
  double last = 1;
  double total = found["rest"].get<double>();
  for (const Json& placement : found["placements"]) {
    const double probability = placement["probability"].get<double>();
    EXPECT_LE(probability, last);
    last = probability;
    total += probability;
    EXPECT_GT(placement["sd"][0].get<double>(), 0);
    EXPECT_EQ(placement["pose_covariance"].size(), 3U);
  }
  EXPECT_NEAR(total, 1, 1e-6);
}

TEST(CliNoise, the_true_start_is_within_a_few_standard_deviations) {
  const Folder folder;
  write_noisy_roll("3");
  const Json found = run("locate gallery:cam --log noisy.csv --finger disk,r=0.2 --json" + std::string(kNoise)).json();
  EXPECT_EQ(found["verdict"], "unique");
  const Json& first = found["placements"][0];
  EXPECT_LT(std::abs(first["start"][0].get<double>() - 1), 4 * first["sd"][0].get<double>());
  EXPECT_EQ(found["samples"], 199);
}

TEST(CliNoise, a_prior_takes_sides) {
  const Folder folder;
  write_noisy_roll("2", "gallery:ellipse,a=2,b=1");
  const std::string locate = "locate gallery:ellipse,a=2,b=1 --log noisy.csv --finger disk,r=0.2" + std::string(kNoise);
  EXPECT_THAT(run(locate).out, HasSubstr("ambiguous (2)"));
  EXPECT_THAT(run(locate + " --prior 1.1,0.4").out, HasSubstr("unique"));
}

TEST(CliNoise, where_nothing_fits_the_likeliest_reason_is_given) {
  const Folder folder;
  ASSERT_EQ(run("simulate gallery:cam --finger disk,r=0.2 --start 1 --samples 200 --length 5 -o clean.csv").code, 0);
  const Ran ran =
      run("locate gallery:cam --log clean.csv --finger disk,r=0.22 --noise contact=0.001,angle=0.001 --json");
  EXPECT_EQ(ran.code, 1);
  EXPECT_EQ(ran.json()["verdict"], "inconsistent");
  EXPECT_EQ(ran.json()["diagnosis"]["cause"], "radius");
  EXPECT_NEAR(ran.json()["diagnosis"]["length_scale"].get<double>(), 0.2 / 0.22, 0.01);
  EXPECT_TRUE(ran.json()["placements"].empty());
}

TEST(CliNoise, a_cure_names_the_columns_that_the_log_has) {
  const Folder folder;
  ASSERT_EQ(run("simulate gallery:cam --finger disk,r=0.2 --start 2 --samples 200 --length 3 -o log.csv" +
                std::string(kNoise))
                .code,
            0);
  folder.write("own.csv", std::regex_replace(read("log.csv"), std::regex("^time,u,psi"), "stamp,wheel,yaw"));
  const std::string locate = "locate gallery:cam --log own.csv --finger disk,r=0.2 --json" + std::string(kNoise);
  const Ran ran = run(locate + " --columns time=stamp,u=yaw,psi=wheel");
  EXPECT_EQ(ran.json()["diagnosis"]["cause"], "u_psi_swapped");
  const std::string cure = ran.json()["diagnosis"]["cure"];
  EXPECT_EQ(cure, "--columns time=stamp,u=wheel,psi=yaw");
  EXPECT_EQ(run(locate + " " + cure).json()["verdict"], "unique");
}

TEST(CliNoise, turns_whose_errors_add_up_to_more_than_they_tell_are_told) {
  const Folder folder;
  std::string increments = "distance,dturn\n";
  for (int k = 0; k < 600; ++k) increments += "0.01,0.01\n";
  folder.write("steps.csv", increments);
  const std::string locate = "locate gallery:cam --log steps.csv --noise contact=0.001,angle=";
  EXPECT_THAT(run(locate + "5deg").out, HasSubstr("add up to 122 deg"));
  EXPECT_THAT(run(locate + "0.5deg").out, Not(HasSubstr("add up")));
}

TEST(CliNoise, bare_readings_are_weighed_as_well) {
  const Ran ran = run("locate gallery:cam --reading 2,1.7 --noise contact=0.01,angle=0.01 --json");
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_GT(ran.json()["placements"][0]["probability"].get<double>(), 0);
}

TEST(CliNoise, what_makes_no_sense_is_refused) {
  const std::string locate = "locate gallery:cam --reading 2,1.7 ";
  for (const char* option : {"--noise slip=0.1", "--noise contact=-1", "--noise wobble=1", "--prior 1,0.1", "--robust",
                             "--noise angle=0.01 --prior 1", "--noise angle=0.01 --prior 1,0"}) {
    const Ran ran = run(locate + option);
    EXPECT_EQ(ran.code, 2) << option;
    EXPECT_THAT(ran.err, HasSubstr("rollfix: ")) << option;
    EXPECT_EQ(ran.out, "") << option;
  }
}

TEST(CliAdvise, the_advised_roll_tells_the_places_apart) {
  const std::string reading = "--reading 0.9,30.15deg";
  const Json advice = run("advise gallery:limacon " + reading + " --json").json();
  ASSERT_TRUE(advice["helps"].get<bool>());
  EXPECT_NEAR(advice["expected_placements"].get<double>(), 1, 0.05);
  // Roll on as advised from one of them: what is read then fits no other.
  const double length = 0.9 + advice["length"].get<double>();
  const double turn = 30.15 * M_PI / 180 + advice["contenders"].back()["turn"].get<double>();
  const Ran after = run("locate gallery:limacon " + reading + " --reading " + std::to_string(length) + "," +
                        std::to_string(turn) + " --tolerance 0.0005");
  EXPECT_THAT(after.out, HasSubstr("unique"));
}

TEST(CliAdvise, no_roll_helps_on_a_part_that_looks_the_same_twice) {
  const Folder folder;
  write_noisy_roll("3", "gallery:ellipse,a=2,b=1");
  const Ran ran = run("advise gallery:ellipse,a=2,b=1 --log noisy.csv --finger disk,r=0.2" + std::string(kNoise));
  EXPECT_THAT(ran.out, HasSubstr("ambiguous (2): no roll will tell them apart: the part looks the same from 2 places"));
  const Ran circle = run("advise gallery:circle --reading 1,1 --tolerance 1deg");
  EXPECT_THAT(circle.out, HasSubstr("the part looks the same from every place"));
}

TEST(CliAdvise, it_draws_what_is_to_be_expected) {
  const Folder folder;
  const Ran ran = run("advise gallery:limacon --reading 0.9,30.15deg -o next.svg");
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_THAT(cli::read("next.svg"), HasSubstr("placements that remain, expected"));
}

TEST(CliAdvise, what_makes_no_sense_is_refused) {
  EXPECT_EQ(run("advise gallery:cam").code, 2);
  EXPECT_EQ(run("advise gallery:cam --reading 1,1,1").code, 2);
  EXPECT_EQ(run("advise gallery:cam --reading 1,1 --travel 1,2").code, 2);
  EXPECT_EQ(run("advise gallery:cam --reading 1,1 --travel 0").code, 2);
}

}  // namespace cli_noise_test
