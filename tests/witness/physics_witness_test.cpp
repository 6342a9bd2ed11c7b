// The witness is a physics engine: its finger rolls because friction makes it, and slips where friction does not hold.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "cli.hpp"
#include "physics_trial.hpp"
#include "shapes.hpp"

namespace rollfix::physics_witness_test {
namespace {

using physics::Stand;
using physics::Surface;
using physics::Trial;

constexpr std::size_t kRolls = 3;  // on each part
const Surface kGrips;
const Surface kSlippery{0.05, 0, 0, 0};      // half of what is rolled slips
const Surface kOilStain{1, 0.4, 0.2, 0.03};  // a fifth of the way, two fifths after the start

class EngineRollsOn : public testing::TestWithParam<std::string> {
 protected:
  std::vector<Trial> trials(const Surface& surface) const {
    return stand_.run_many(kRolls, surface, physics::noise_of(stand_.part()));
  }
  double perimeter() const { return stand_.part().perimeter(); }

  Stand stand_{GetParam()};
};

/// Otherwise the other tests would locate with noise that is not what the engine does.
TEST_P(EngineRollsOn, length_and_turn_are_those_of_the_part_within_the_noise_that_is_stated) {
  const Noise noise = physics::noise_of(stand_.part());
  for (const Trial& trial : trials(kGrips)) {
    EXPECT_LT(std::abs(trial.slip), noise.slip);
    EXPECT_LT(trial.contact_error, noise.contact);
    EXPECT_LT(trial.angle_error, noise.angle);
  }
}

TEST_P(EngineRollsOn, the_finger_that_grips_is_found_where_it_was_put) {
  for (const Trial& trial : trials(kGrips)) {
    ASSERT_TRUE(trial.is_among()) << "started at " << trial.start << ", " << trial.verdict;
    EXPECT_LT(std::abs(trial.error), 4 * trial.sd + 1e-4 * perimeter());
    EXPECT_GT(trial.probability, 0.1);
  }
}

TEST_P(EngineRollsOn, four_of_the_readings_and_a_tolerance_find_it_as_well) {
  for (const Trial& trial : trials(kGrips)) {
    EXPECT_TRUE(trial.is_placed) << "started at " << trial.start;
    EXPECT_LE(trial.placements, 3u);  // a reuleaux is three-fold
  }
}

INSTANTIATE_TEST_SUITE_P(Physics, EngineRollsOn,
                         testing::Values("ellipse", "cam", "spline,wobble=0.12", "limacon,a=2.5", "superellipse",
                                         "stadium", "naca,chord=5", "reuleaux"),
                         shapes::as_identifier);

class EngineSlipsOn : public EngineRollsOn {};

TEST_P(EngineSlipsOn, a_finger_that_slips_all_the_way_fits_nowhere) {
  for (const Trial& trial : trials(kSlippery)) {
    EXPECT_GT(trial.slip, 0.3);
    EXPECT_TRUE(trial.is_inconsistent()) << "started at " << trial.start << ", " << trial.verdict;
    EXPECT_FALSE(trial.is_placed);
  }
}

TEST_P(EngineSlipsOn, a_finger_that_slips_on_an_oil_stain_fits_nowhere) {
  for (const Trial& trial : trials(kOilStain)) {
    EXPECT_GT(trial.slip, 0.1);
    EXPECT_TRUE(trial.is_inconsistent()) << "started at " << trial.start << ", " << trial.verdict;
  }
}

INSTANTIATE_TEST_SUITE_P(Physics, EngineSlipsOn,
                         testing::Values("ellipse", "cam", "spline,wobble=0.12", "superellipse"),
                         shapes::as_identifier);

/// The engine's world is turned and shifted against the part's frame: the program says how.
TEST(EngineAndProgram, locate_finds_where_the_part_is_in_the_engines_world) {
  const cli::Folder folder;
  const Stand stand("cam");
  const Trial trial = stand.run(2.3, kGrips, physics::noise_of(stand.part()));
  folder.write("physics.csv", trial.log);
  const cli::Json found =
      cli::run("locate gallery:cam --json --log physics.csv --finger disk,r=" + cli::exact(stand.radius()) +
               " --noise contact=0.0004,angle=0.0015,slip=0.0005")
          .json();
  EXPECT_EQ(found["verdict"], "unique");
  const cli::Json& first = found["placements"][0];
  EXPECT_NEAR(first["mean"][0].get<double>(), trial.start, 4 * first["sd"][0].get<double>());
  const Pose pose = stand.pose();
  EXPECT_NEAR(first["pose_mean"][0].get<double>(), pose.x, 5e-3);
  EXPECT_NEAR(first["pose_mean"][1].get<double>(), pose.y, 5e-3);
  EXPECT_NEAR(first["pose_mean"][2].get<double>(), pose.heading, 5e-3);
}

}  // namespace
}  // namespace rollfix::physics_witness_test
