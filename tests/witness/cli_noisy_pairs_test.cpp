// Two fingers with --noise on the command line.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "cli.hpp"

namespace cli_noisy_pairs_test {

namespace {

using cli::Json;
using testing::HasSubstr;
using testing::StartsWith;

const std::string kTwoReadings =
    "locate gallery:cam --reading 0.7446832,-0.3983439,57.48184deg --reading 1.5,-0.8,110.97000deg";
const std::string kPairNoise = " --noise contact=0.0005,angle=0.02deg,slip=0.0002";

/// A clean log in the current folder, and what is asked about it.
std::string pair_of_rolls() {
  const cli::Ran simulated = cli::run(
      "simulate gallery:spline,seed=3 --finger disk,r=0.05 --start 1 --start 4 --length 1.5 --length -0.8 -o two.csv");
  EXPECT_EQ(simulated.code, 0) << simulated.err;
  return "locate gallery:spline,seed=3 --log two.csv --finger disk,r=0.05";
}

TEST(CliNoisyPairs, lists_the_most_probable_pair_first) {
  const Json found = cli::run(kTwoReadings + kPairNoise + " --json").json();
  double last = 1;
  double sum = found["rest"].get<double>();
  for (const Json& placement : found["placements"]) {
    EXPECT_LE(placement["probability"].get<double>(), last);
    last = placement["probability"].get<double>();
    sum += last;
  }
  EXPECT_GE(sum, 1 - 1e-9);
  EXPECT_GE(found["placements"].size(), 4U);
}

TEST(CliNoisyPairs, says_how_sure_each_finger_s_place_is) {
  const cli::Folder folder;
  const Json found = cli::run(pair_of_rolls() + kPairNoise + " --json").json();
  ASSERT_EQ(found["verdict"], "unique");
  const Json& first = found["placements"][0];
  const double truth[] = {1, 4};
  for (const std::size_t finger : {0U, 1U}) {
    EXPECT_NEAR(first["mean"][finger].get<double>(), truth[finger], 3 * first["sd"][finger].get<double>());
    EXPECT_NEAR(first["covariance"][finger][finger].get<double>(),
                first["sd"][finger].get<double>() * first["sd"][finger].get<double>(), 1e-12);
    EXPECT_LT(first["interval"][finger][0].get<double>(), truth[finger]);
    EXPECT_GT(first["interval"][finger][1].get<double>(), truth[finger]);
  }
  EXPECT_EQ(first["pose_mean"].size(), 3U);
  EXPECT_GT(first["pose_covariance"][2][2].get<double>(), 0);
}

TEST(CliNoisyPairs, takes_all_rows_of_a_log) {
  const cli::Folder folder;
  const Json found = cli::run(pair_of_rolls() + kPairNoise + " --json").json();
  EXPECT_EQ(found["samples"], 100);
  EXPECT_EQ(found["readings"].size(), 2U);
}

TEST(CliNoisyPairs, says_in_words_what_it_weighed) {
  const std::string said = cli::run(kTwoReadings + kPairNoise).out;
  EXPECT_THAT(said, StartsWith("ambiguous (4): the likeliest start is finger a at s = "));
  EXPECT_THAT(said, HasSubstr("noise      contact 0.0005"));
  EXPECT_THAT(said, HasSubstr("probability"));
}

TEST(CliNoisyPairs, is_told_finger_a_s_place_by_the_prior) {
  const Json found = cli::run(kTwoReadings + kPairNoise + " --prior 1,0.1 --json").json();
  EXPECT_EQ(found["verdict"], "unique");
  EXPECT_NEAR(found["placements"][0]["start"][0].get<double>(), 1, 0.1);
}

TEST(CliNoisyPairs, exits_with_1_where_nothing_fits) {
  const cli::Folder folder;
  const std::string log = pair_of_rolls();
  const cli::Ran ran = cli::run(log.substr(0, log.find("--finger")) + "--finger disk,r=0.06" + kPairNoise + " --json");
  EXPECT_EQ(ran.code, 1);
  EXPECT_EQ(ran.json()["verdict"], "inconsistent");
  EXPECT_EQ(ran.json()["diagnosis"]["cause"], "radius");
  EXPECT_NEAR(ran.json()["diagnosis"]["length_scale"].get<double>(), 0.05 / 0.06, 0.01);
}

TEST(CliNoisyPairs, asks_for_the_noise_that_a_prior_needs) {
  EXPECT_EQ(cli::run(kTwoReadings + " --prior 1,0.1").code, 2);
  EXPECT_EQ(cli::run(kTwoReadings + " --robust").code, 2);
}

}  // namespace

}  // namespace cli_noisy_pairs_test
