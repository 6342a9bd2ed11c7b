// Jaws, outlined fingers and noise on the command line, there and back.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string>

#include "cli.hpp"
#include "shapes.hpp"

namespace cli_finger_test {

namespace {

using cli::Json;
using cli::run;
using testing::HasSubstr;

/// The distance from s to the nearest start that was found, round the part.
double miss(const Json& found, double s) {
  const double P = found["part"]["perimeter"];
  double least = P;
  for (const Json& placement : found["placements"]) {
    least = std::min(least, std::abs(std::remainder(placement["start"][0].get<double>() - s, P)));
  }
  return least;
}

/// Points of an ellipse, as a scan of a fingertip gives them.
std::string scanned_pad() {
  std::string text;
  for (int k = 0; k < 32; ++k) {
    const double angle = 2 * shapes::kPi * k / 32;
    text += fmt::format("{} {}\n", 0.3 * std::cos(angle), 0.2 * std::sin(angle));
  }
  return text;
}

/// A square fingertip, from the middle of its lower side.
constexpr const char* kSquareTip = "0 0\n0.2 0\n0.2 0.4\n-0.2 0.4\n-0.2 0\n";

class CliFinger : public testing::TestWithParam<std::string> {};

TEST_P(CliFinger, there_and_back) {
  const cli::Folder folder;
  folder.write("pad.csv", scanned_pad());
  folder.write("bow.csv", "-1 0\n-0.7 -0.4\n0 -0.6\n0.7 -0.4\n1 0\n");
  folder.write("tip.csv", kSquareTip);
  const std::string common = "gallery:cam --finger " + GetParam();
  const cli::Ran rolled = run("simulate " + common + " --start 2.5 --length 0.8 -o roll.csv");
  ASSERT_EQ(rolled.code, 0) << rolled.err;
  const cli::Ran ran = run("locate " + common + " --log roll.csv --json");
  ASSERT_EQ(ran.code, 0) << ran.err;
  const Json found = ran.json();
  EXPECT_LT(miss(found, 2.5), 1e-6);
  EXPECT_NEAR(found["readings"][0]["length"][0], 0.8, 1e-9);
  double nearest = 1;
  for (const Json& placement : found["placements"]) {
    const Json& last = placement["pose"].back();
    nearest = std::min(nearest, std::hypot(last[0].get<double>(), last[1].get<double>()));
  }
  EXPECT_LT(nearest, 1e-6) << "the part is at its own origin";
}

INSTANTIATE_TEST_SUITE_P(Fingers, CliFinger,
                         testing::Values("jaw", "pad.csv", "bow.csv,open", "tip.csv,polygon",
                                         "gallery:ellipse,a=0.3,b=0.2", "gallery:stadium,r=0.1,length=0.2"),
                         shapes::as_identifier);

TEST(CliFingers, what_is_not_looked_at_is_said) {
  const cli::Ran ran = run("locate gallery:cam --reading 1,0.7 --finger gallery:ellipse,a=0.3,b=0.2");
  EXPECT_THAT(ran.err, HasSubstr("whether the finger gallery:ellipse,a=0.3,b=0.2 would hit the part elsewhere"));
}

TEST(CliFingers, rows_on_a_corner_of_the_finger_are_told_and_their_readings_have_a_pivot) {
  const cli::Folder folder;
  folder.write("tip.csv", kSquareTip);
  const cli::Ran rolled = run("simulate gallery:cam --finger tip.csv --start 2 --length 0.2 --samples 9 -o roll.csv");
  ASSERT_EQ(rolled.code, 0) << rolled.err;
  const cli::Ran ran = run("locate gallery:cam --finger tip.csv --log roll.csv --json");
  EXPECT_THAT(ran.err, HasSubstr("1 row is on a corner of the finger"));
  EXPECT_EQ(ran.json()["corner_rows"]["last"], true);
  EXPECT_LT(miss(ran.json(), 2), 1e-6);
  const Json pivot = ran.json()["readings"].back()["pivot"];
  EXPECT_NEAR(pivot[1].get<double>() - pivot[0].get<double>(), shapes::kPi / 2, 1e-9);
}

TEST(CliFingers, a_polygon_with_blunt_corners_is_no_spline) {
  const cli::Folder folder;
  folder.write("jaw.csv", "-1 0.5\n-0.5 0\n0.5 0\n1 0.5\n");
  const cli::Ran ran =
      run("simulate gallery:circle,r=2 --finger jaw.csv,open,polygon --start 1 --rotation 60deg --samples 5");
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_THAT(run("simulate gallery:circle,r=2 --finger jaw.csv,polygon --start 1 --rotation 1").out, HasSubstr("psi"));
}

TEST(CliFingers, a_jaw_drops_what_it_can_not_reach) {
  const cli::Folder folder;
  ASSERT_EQ(run("simulate gallery:ellipse --finger jaw --start 2.5 --length 0.8 -o roll.csv").code, 0);
  const cli::Ran ran = run("locate gallery:ellipse --finger jaw --log roll.csv --json");
  EXPECT_EQ(ran.json()["dropped"]["reach"], 0) << "all of an ellipse is within reach";
}

// --- Noise.

const std::string kNoisy =
    "simulate gallery:cam --finger disk,r=0.2 --start 2 --length 1 --samples 30 --noise "
    "contact=0.002,angle=0.01,slip=0.02";

TEST(CliNoise, a_seed_gives_a_log_again) {
  EXPECT_EQ(run(kNoisy + " --seed 3").out, run(kNoisy + " --seed 3").out);
  EXPECT_NE(run(kNoisy + " --seed 3").out, run(kNoisy + " --seed 4").out);
  EXPECT_EQ(run(kNoisy).out, run(kNoisy + " --seed 0").out);
}

TEST(CliNoise, what_was_drawn_for_the_whole_roll_is_said) {
  EXPECT_THAT(run(kNoisy + ",radius=0.01").err,
              HasSubstr("% farther than the finger was rolled; its radius really is"));
}

TEST(CliNoise, a_noisy_roll_is_found_within_its_tolerance) {
  const cli::Folder folder;
  ASSERT_EQ(run(kNoisy + " -o roll.csv").code, 0);
  const cli::Ran ran = run("locate gallery:cam --finger disk,r=0.2 --log roll.csv --tolerance 0.05 --json");
  ASSERT_EQ(ran.code, 0) << ran.err;
  const Json found = ran.json();
  EXPECT_TRUE(std::any_of(found["placements"].begin(), found["placements"].end(), [](const Json& placement) {
    return placement["extent"][0][0] <= 2 && placement["extent"][0][1] >= 2;
  })) << ran.out;
  EXPECT_NE(found["readings"][0]["length"][0], 1.0);
}

TEST(CliNoise, two_fingers_have_it_too) {
  const cli::Ran ran =
      run("simulate gallery:cam --finger disk,r=0.2 --start 1 --start 4 --length 1 --length -1 --noise slip=0.1 "
          "--samples 5");
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_THAT(ran.err, HasSubstr("finger b: the contact went"));
}

}  // namespace

}  // namespace cli_finger_test
