// A part face down, and lengths that count the other way round. The witness is the outline's mirror image as a file of
// its own: what is felt of that one is what is felt of the part face down.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "cli.hpp"

namespace cli_mirror_test {
namespace {

using cli::Json;
using cli::run;
using testing::HasSubstr;

/// A loop without any symmetry, and its mirror image with the same first point.
void write_parts(const cli::Folder& folder) {
  std::string drawn;
  std::string image;
  for (int k = 0; k < 60; ++k) {
    const double angle = k * std::numbers::pi / 30;
    const double r = 10 + 1.5 * std::cos(2 * angle + 0.4) + 0.8 * std::cos(3 * angle + 1.1);
    drawn += fmt::format("{} {}\n", r * std::cos(angle), r * std::sin(angle));
    image += fmt::format("{} {}\n", -r * std::cos(angle), r * std::sin(angle));
  }
  folder.write("part.csv", drawn);
  folder.write("image.csv", image);
}

double perimeter() { return run("inspect part.csv --json").json()["part"]["perimeter"]; }

TEST(CliMirror, a_log_felt_face_down_is_placed_along_the_outline_as_drawn) {
  const cli::Folder folder;
  write_parts(folder);
  ASSERT_EQ(run("simulate image.csv --finger disk,r=1 --start 12.5 --length 30 --samples 200 -o roll.csv").code, 0);
  const Json image = run("locate image.csv --finger disk,r=1 --at 20,32.4 --log roll.csv --json").json();
  const Json found = run("locate part.csv --finger disk,r=1 --at 20,32.4 --log roll.csv --mirror --json").json();
  EXPECT_TRUE(found["mirrored"]);
  ASSERT_EQ(found["placements"].size(), image["placements"].size());
  ASSERT_EQ(found["placements"].size(), 1U);
  const Json& placement = found["placements"][0];
  EXPECT_NEAR(placement["start"][0], perimeter() - 12.5, 1e-6);
  EXPECT_NEAR(placement["end"][0], perimeter() - image["placements"][0]["end"][0].get<double>(), 1e-6);
  // The image lies at rest as it was drawn.
  for (const double value : placement["pose"].back().get<std::vector<double>>()) EXPECT_NEAR(value, 0, 1e-6);
  EXPECT_EQ(found["readings"], image["readings"]);
}

TEST(CliMirror, sensitivities_are_those_of_the_image_along_the_outline) {
  const cli::Folder folder;
  write_parts(folder);
  ASSERT_EQ(run("simulate image.csv --finger disk,r=1 --start 12.5 --length 30 --samples 200 -o roll.csv").code, 0);
  const Json image = run("locate image.csv --finger disk,r=1 --at 20,32.4 --log roll.csv --json").json();
  const Json found = run("locate part.csv --finger disk,r=1 --at 20,32.4 --log roll.csv --mirror --json").json();
  const auto per_turn = [](const Json& answer) {
    return answer["placements"][0]["sensitivity"]["per_turn"][0][0].get<double>();
  };
  EXPECT_NEAR(per_turn(found), -per_turn(image), 1e-6 * std::abs(per_turn(image)));
}

TEST(CliMirror, readings_two_fingers_and_watch_are_mirrored_alike) {
  const cli::Folder folder;
  write_parts(folder);
  ASSERT_EQ(
      run("simulate image.csv --finger disk,r=1 --start 5 --start 30 --length 8 --length -6 --part-rotation 20deg "
          "-o pair.csv")
          .code,
      0);
  const Json pair = run("locate part.csv --finger disk,r=1 --log pair.csv --mirror --json").json();
  ASSERT_EQ(pair["placements"].size(), 1U);
  EXPECT_NEAR(pair["placements"][0]["start"][0], perimeter() - 5, 1e-6);
  EXPECT_NEAR(pair["placements"][0]["start"][1], perimeter() - 30, 1e-6);

  ASSERT_EQ(run("simulate image.csv --finger disk,r=1 --start 12.5 --length 30 --samples 200 -o roll.csv").code, 0);
  const Json read = run("locate image.csv --finger disk,r=1 --at 20,32.4 --log roll.csv --json").json()["readings"][0];
  const std::string reading = fmt::format("{},{}", read["length"][0].get<double>(), read["turn"].get<double>());
  const Json bare = run("locate part.csv --mirror --tolerance 1e-9 --json --reading " + reading).json();
  ASSERT_FALSE(bare["placements"].empty());
  bool holds_truth = false;
  for (const Json& placement : bare["placements"]) {
    holds_truth |= std::abs(placement["start"][0].get<double>() - (perimeter() - 12.5)) < 1e-4;
  }
  EXPECT_TRUE(holds_truth);

  const cli::Ran watched =
      run("watch part.csv --finger disk,r=1 --noise contact=1e-3,angle=1e-3 --mirror --once --jsonl --log roll.csv");
  const std::size_t last = watched.out.rfind('\n', watched.out.size() - 2);
  EXPECT_THAT(watched.out.substr(last), HasSubstr("unique"));
}

TEST(CliMirror, how_two_fingers_face_each_other_is_mirrored_as_well) {
  const cli::Folder folder;
  write_parts(folder);
  const std::string asked = " --reading 12,9,0.1 --facing 0.7 --tolerance 1e-9 --json";
  const Json image = run("locate image.csv" + asked).json();
  const Json found = run("locate part.csv --mirror" + asked).json();
  EXPECT_EQ(found["facing"], image["facing"]);
  ASSERT_GT(image["placements"].size(), 0U);
  ASSERT_EQ(found["placements"].size(), image["placements"].size());
  const double P = perimeter();
  for (const Json& expected : image["placements"]) {
    bool is_there = false;
    for (const Json& placement : found["placements"]) {
      double off = 0;
      for (const std::size_t k : {0U, 1U}) {
        const double sum = placement["start"][k].get<double>() + expected["start"][k].get<double>();
        const double facing = placement["sensitivity"]["per_facing"][k].get<double>() +
                              expected["sensitivity"]["per_facing"][k].get<double>();
        off = std::max({off, std::abs(std::remainder(sum, P)), 1e-3 * std::abs(facing)});
      }
      is_there |= off < 1e-6;
    }
    EXPECT_TRUE(is_there) << expected["start"];
  }
}

TEST(CliMirror, simulate_writes_what_locate_understands) {
  const cli::Folder folder;
  write_parts(folder);
  ASSERT_EQ(run("simulate part.csv --mirror --finger disk,r=1 --start 12.5 --length 30 --samples 200 -o roll.csv").code,
            0);
  const Json found = run("locate part.csv --finger disk,r=1 --at 20,32.4 --log roll.csv --mirror --json").json();
  ASSERT_EQ(found["placements"].size(), 1U);
  EXPECT_NEAR(found["placements"][0]["start"][0], 12.5, 1e-6);
}

/// Fingers that are no mirror images of themselves: the image of the part is felt by the finger as it is.
class CliMirrorFinger : public testing::TestWithParam<std::string> {};

TEST_P(CliMirrorFinger, with_an_outline_is_turned_over_with_the_part) {
  const cli::Folder folder;
  write_parts(folder);
  std::string pad;
  for (int k = 0; k < 40; ++k) {
    const double angle = k * std::numbers::pi / 20;
    const double r = 2 + 0.1 * std::cos(2 * angle + 0.3) + 0.04 * std::cos(3 * angle);
    pad += fmt::format("{} {}\n", r * std::cos(angle), r * std::sin(angle));
  }
  folder.write("pad.csv", pad);
  folder.write("bow.csv", "-6 0.5\n-3 -0.6\n0 -1.2\n3 -1\n6 -0.2\n9 1.2\n12 3.6\n");
  const std::string finger = " --finger " + GetParam();
  ASSERT_EQ(run("simulate image.csv --start 12.5 --length 7 --samples 100 -o roll.csv" + finger).code, 0);
  const Json image = run("locate image.csv --log roll.csv --json" + finger).json();
  const Json found = run("locate part.csv --log roll.csv --mirror --json" + finger).json();
  ASSERT_EQ(found["placements"].size(), image["placements"].size());
  EXPECT_EQ(found["verdict"], image["verdict"]);
  EXPECT_NEAR(found["readings"][0]["length"][0], image["readings"][0]["length"][0], 1e-9);
  EXPECT_NEAR(found["readings"][0]["turn"], image["readings"][0]["turn"], 1e-9);
  const Json& placement = found["placements"][0];
  EXPECT_NEAR(placement["start"][0], perimeter() - 12.5, 1e-5);
  // The image lies at rest as it was drawn.
  for (const double value : placement["pose"].back().get<std::vector<double>>()) EXPECT_NEAR(value, 0, 1e-5);
}

TEST_P(CliMirrorFinger, is_simulated_as_it_is_felt) {
  const cli::Folder folder;
  write_parts(folder);
  folder.write("pad.csv", "2 0\n1.5 1.2\n0 1.6\n-1.4 1.1\n-1.8 0\n-1.2 -1.3\n0 -1.9\n1.4 -1.4\n");
  folder.write("bow.csv", "-6 0.5\n-3 -0.6\n0 -1.2\n3 -1\n6 -0.2\n9 1.2\n12 3.6\n");
  const std::string finger = " --finger " + GetParam();
  // Backwards along the outline as drawn is forwards round the image.
  ASSERT_EQ(run("simulate image.csv --start 12.5 --length 3 --samples 50 --contact 8 -o image-roll.csv" + finger).code,
            0);
  const std::string start = fmt::format(" --start {:.17g}", perimeter() - 12.5);
  ASSERT_EQ(run("simulate part.csv --mirror --length -3 --samples 50 --contact 8 -o roll.csv" + start + finger).code,
            0);
  const Json image = run("locate image.csv --log image-roll.csv --json" + finger).json()["readings"][0];
  const Json felt = run("locate image.csv --log roll.csv --json" + finger).json()["readings"][0];
  EXPECT_NEAR(felt["length"][0], image["length"][0], 1e-6);
  EXPECT_NEAR(felt["turn"], image["turn"], 1e-6);
}

INSTANTIATE_TEST_SUITE_P(, CliMirrorFinger, testing::Values("pad.csv", "bow.csv,open"),
                         [](const auto& one) { return one.index == 0 ? "closed" : "open"; });

TEST(CliMirror, a_jaw_with_places_above_0_is_where_it_was_felt) {
  const cli::Folder folder;
  write_parts(folder);
  ASSERT_EQ(run("simulate image.csv --finger jaw --start 4 --length 5 --contact 30 --samples 100 -o roll.csv").code, 0);
  const Json found = run("locate part.csv --finger jaw --log roll.csv --mirror --json").json();
  bool is_at_rest = false;
  for (const Json& placement : found["placements"]) {
    const Json& pose = placement["pose"].back();
    is_at_rest |= std::hypot(pose[0].get<double>(), pose[1].get<double>()) < 1e-5;
  }
  EXPECT_TRUE(is_at_rest);
}

TEST(CliMirror, watch_turns_closed_outlines_over_and_says_that_it_does_not_open_ones) {
  const cli::Folder folder;
  write_parts(folder);
  folder.write("pad.csv", "2 0\n1.5 1.2\n0 1.6\n-1.4 1.1\n-1.8 0\n-1.2 -1.3\n0 -1.9\n1.4 -1.4\n");
  folder.write("bow.csv", "-6 0.5\n-3 -0.6\n0 -1.2\n3 -1\n6 -0.2\n9 1.2\n12 3.6\n");
  ASSERT_EQ(run("simulate image.csv --start 12.5 --length 30 --samples 300 -o roll.csv --finger pad.csv").code, 0);
  const std::string watch = "watch part.csv --noise contact=0.01,angle=0.2deg --log roll.csv --once --mirror --finger ";
  // 12.5 less than the perimeter, 65.086.
  EXPECT_THAT(run(watch + "pad.csv").out, HasSubstr("unique: roll 1 started at s = 52.5"));
  EXPECT_THAT(run(watch + "bow.csv,open").err, HasSubstr("bow.csv is open, which watch does not turn over"));
}

TEST(CliDirection, lengths_that_count_clockwise_change_their_signs) {
  const cli::Folder folder;
  write_parts(folder);
  EXPECT_EQ(run("locate part.csv --json --reading 5,0.5").json()["placements"],
            run("locate part.csv --json --direction cw --reading -5,0.5").json()["placements"]);
  folder.write("ccw.csv", "distance,dturn\n2.5,0.2\n2.5,0.3\n");
  folder.write("cw.csv", "distance,dturn\n-2.5,0.2\n-2.5,0.3\n");
  EXPECT_EQ(run("locate part.csv --json --direction ccw --log ccw.csv").json()["placements"],
            run("locate part.csv --json --direction cw --log cw.csv").json()["placements"]);
}

TEST(CliDirection, logs_that_say_it_themselves_and_other_words_are_refused) {
  const cli::Folder folder;
  write_parts(folder);
  folder.write("roll.csv", "u,psi\n0,0\n-1,1.2\n-2,2.5\n");
  EXPECT_THAT(run("locate part.csv --finger disk,r=1 --direction cw --log roll.csv").err, HasSubstr("u and psi"));
  EXPECT_THAT(run("locate part.csv --reading 5,0.5 --direction left").err, HasSubstr("expected ccw, cw or either"));
}

}  // namespace
}  // namespace cli_mirror_test
