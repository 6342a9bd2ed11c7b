// Which part is it, and where on it: the words, the weights, and the same answer however the work is shared.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "catalog/weights.hpp"
#include "catalogs.hpp"
#include "refusal.hpp"
#include "rollfix/identify.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/rolling.hpp"
#include "rollfix/solve.hpp"

namespace identify_test {
namespace {

using namespace catalogs;
using cli::Json;
using cli::run;
using testing::ElementsAre;
using testing::HasSubstr;

const std::vector<std::string> kShapes = {"cam", "limacon", "spline,n=9,seed=7,wobble=0.2", "naca", "ellipse,a=2,b=1"};

class Identify : public testing::Test {
 protected:
  Identify() : catalog_(of(kShapes)) {}

  /// A roll of three readings on a part of the catalog, as options of the program.
  std::string typed_roll(std::size_t part, double s, const std::string& noise = "") {
    std::string text;
    for (const Reading& reading : roll_on(catalog_.part(part), s, {0.3, 0.7, 1.1})) {
      text += " --reading " + cli::exact(reading.length[0]) + "," + cli::exact(reading.turn);
    }
    return text + noise;
  }
  Identified found_on(std::size_t part, double s) {
    return identify(catalog_, {catalog_.part(part), roll_on(catalog_.part(part), s, {0.3, 0.7, 1.1})});
  }

  cli::Folder folder_;
  Catalog catalog_;
};

TEST_F(Identify, names_the_part_and_the_place) {
  const Identified found = found_on(2, 0.8);
  EXPECT_EQ(found.verdict, "unique part, unique place");
  EXPECT_THAT(names_of(catalog_, found), ElementsAre(kShapes[2]));
  EXPECT_NEAR(found.parts[0].answer.placements[0].start[0], 0.8, 1e-9);
}

TEST_F(Identify, says_how_many_places_there_are_on_the_one_part) {
  EXPECT_EQ(found_on(4, 0.8).verdict, "unique part, 2 places");
}

TEST_F(Identify, says_none_where_nothing_fits) {
  const cli::Ran ran = run("identify parts.db --reading 0.50000,-3.00000");
  EXPECT_EQ(ran.code, 1);
  EXPECT_THAT(ran.out, testing::StartsWith("none\n"));
  EXPECT_THAT(ran.out, HasSubstr("no place of any part fits the roll: check"));
}

TEST_F(Identify, says_which_noise_to_state_where_the_rows_jitter) {
  const std::string noise = " --noise contact=0.003,angle=0.01";
  run("simulate gallery:" + kShapes[2] + " --finger disk,r=0.1 --start 0.8 --length 1.5 --samples 60 -o noisy.csv" +
      noise);
  const cli::Ran ran = run("identify parts.db --log noisy.csv --finger disk,r=0.1");
  EXPECT_THAT(ran.out, testing::StartsWith("none\n"));
  EXPECT_THAT(ran.out, HasSubstr("no noise was stated\n  try --noise contact=0.00"));
}

TEST_F(Identify, says_of_each_part_what_locate_says) {
  const Json found = run("identify parts.db --json --reading 0.3,0.2").json();
  ASSERT_GT(found["parts"].size(), 1U);
  for (const Json& part : found["parts"]) {
    const Json alone = run("locate gallery:" + part["name"].get<std::string>() + " --json --reading 0.3,0.2").json();
    EXPECT_EQ(part["placements"], alone["placements"]);
  }
}

TEST_F(Identify, weighs_parts_by_what_the_rows_say_of_them) {
  const Json found = run("identify parts.db --json" + typed_roll(2, 0.8, " --noise contact=0.003,angle=0.01")).json();
  EXPECT_EQ(found["parts"][0]["name"], kShapes[2]);
  EXPECT_GT(found["parts"][0]["probability"], 0.9);
  double all = found["rest"];
  for (const Json& part : found["parts"]) all += part["probability"].get<double>();
  EXPECT_NEAR(all, 1, 1e-9);
}

TEST_F(Identify, weighs_by_how_many_of_each_there_are) {
  build_catalog("bin.db", {{"gallery:cam", "one", 1}, {"gallery:cam,lift=0.5", "three", 3}});
  const Catalog bin("bin.db");
  Problem problem{bin.part(0), roll_on(bin.part(0), 1, {0.5, 1, 1.5})};
  problem.noise = Noise{1e-3, 1e-3};
  const Identified found = identify(bin, problem);
  EXPECT_THAT(names_of(bin, found), ElementsAre("three", "one"));
  EXPECT_NEAR(found.parts[0].probability, 0.75, 1e-6);
  EXPECT_EQ(found.verdict, "2 congruent parts");
  EXPECT_THAT(found.parts[0].congruent, ElementsAre(0U));
}

TEST_F(Identify, weighs_a_rare_part_that_fits_everywhere_against_a_frequent_one_that_hardly_does) {
  // Half a length turns by half a radian from everywhere on a circle, on a long stadium where no side is in it.
  build_catalog("bin.db", {{"gallery:stadium,length=1e4,r=1", "frequent", 1e8}, {"gallery:circle,r=1", "rare", 1}});
  const Catalog bin("bin.db");
  const Identified found = identify(bin, {bin.part(0), {{0.5, 0.5}}, {}, Noise{0.003, 0.003}});
  ASSERT_THAT(names_of(bin, found), ElementsAre("frequent", "rare"));
  const double odds = 1e-8 / (2 * (std::numbers::pi - 0.5) / bin.entry(0).perimeter);
  EXPECT_NEAR(found.parts[1].probability, odds, 0.02 * odds);
}

TEST_F(Identify, adds_parts_that_are_too_rare_to_be_listed_to_the_rest) {
  build_catalog("bin.db", {{"gallery:cam", "one", 1}, {"gallery:cam,lift=0.5", "ten million", 1e7}});
  const Catalog bin("bin.db");
  Problem problem{bin.part(0), roll_on(bin.part(0), 1, {0.5, 1, 1.5})};
  problem.noise = Noise{1e-3, 1e-3};
  const Identified found = identify(bin, problem);
  EXPECT_THAT(names_of(bin, found), ElementsAre("ten million"));
  EXPECT_NEAR(found.rest, 1e-7, 1e-12);
}

TEST_F(Identify, weighs_a_part_alike_in_any_unit) {
  const Part part = catalog_.part(2);
  const Part in_tenths(scaled(part.outline(), 10, ""), {true});
  for (const auto& readings : {roll_on(part, 1, {0.5, 1.1}), rolls_on(part, 1, 4, {{0.5, -0.3}, {1.1, -0.9}})}) {
    Problem problem{part, readings, {}, Noise{1e-3, 1e-3}};
    Problem tenths{in_tenths, readings, {}, Noise{1e-2, 1e-3}};
    for (Reading& reading : tenths.measured.readings) {
      for (double& length : reading.length) length *= 10;
    }
    const rollfix::PartWeight one = rollfix::catalog::weight_of(0, solve(problem));
    const rollfix::PartWeight other = rollfix::catalog::weight_of(0, solve(tenths));
    EXPECT_NEAR(other.peak, one.peak, 1e-6 * std::abs(one.peak) + 1e-6);
    EXPECT_NEAR(other.volume, one.volume, 0.01);
  }
}

TEST(Congruent, are_places_by_the_contacts_noise_and_tangents_by_the_angles) {
  const Part part(rollfix::gallery("ellipse,a=2,b=1"));
  Problem problem{part, roll_on(part, 1, {0.5, -3}), {}, Noise{0.003, 0.02}};
  const rollfix::catalog::Likeness likeness = rollfix::catalog::likeness_of(problem);
  EXPECT_EQ(likeness.length, 0.003);
  EXPECT_EQ(likeness.turn, 0.02);
  EXPECT_EQ(likeness.roll, 3);
}

TEST(Congruent, are_parts_whose_scales_a_roll_of_that_length_does_not_tell_apart) {
  const Part part(rollfix::gallery("ellipse,a=200,b=100"));
  const Part larger(rollfix::gallery("ellipse,a=200.02,b=100.01"));  // by 0.1 over a roll of 1000
  const auto are_congruent = [&](double roll) {
    return rollfix::catalog::are_congruent(part, {0}, larger, {0}, {0.05, 0.01, roll, true});
  };
  EXPECT_TRUE(are_congruent(400));
  EXPECT_FALSE(are_congruent(600));
}

TEST_F(Identify, tells_parts_that_are_scaled_by_less_than_the_noise_as_such) {
  build_catalog("alike.db",
                {{"gallery:ellipse,a=2,b=1", "e"}, {"gallery:ellipse,a=2.0001,b=1.00005", "slightly larger"}});
  const Catalog alike("alike.db");
  Problem problem{alike.part(0), roll_on(alike.part(0), 1, {0.5, 1, 1.5, 2})};
  problem.noise = Noise{0.005, 0.005};
  EXPECT_EQ(identify(alike, problem).parts[0].congruent.size(), 1U);
  problem.noise.reset();
  EXPECT_EQ(identify(alike, problem).verdict, "unique part, 2 places");
}

TEST_F(Identify, tells_one_outline_from_two_first_points_as_such) {
  std::ofstream("one.csv") << "0,0\n10,0\n3,8\n";
  std::ofstream("other.csv") << "10,0\n3,8\n0,0\n";
  build_catalog("turned.db", {{"one.csv", "one"}, {"other.csv", "other"}});
  const Catalog turned("turned.db");
  const Identified found = identify(turned, {turned.part(0), roll_on(turned.part(0), 2, {9, 15})});
  EXPECT_EQ(found.verdict, "2 congruent parts");
}

TEST_F(Identify, tells_one_outline_as_such_where_a_roll_fits_either_way_round) {
  // The place nearest to the first point is one of a roll clockwise on the one, of the other way round on the other.
  const Part limacon(gallery("limacon,a=1,b=0.8"));
  for (const int shift : {0, 200}) {
    std::string points;
    for (int k = 0; k < 400; ++k) {
      const Vec2 point = limacon.point(limacon.perimeter() * (k + shift) / 400);
      points += fmt::format("{:.12f},{:.12f}\n", point.x(), point.y());
    }
    folder_.write(fmt::format("from{}.csv", shift), points);
  }
  build_catalog("turned.db", {{"from0.csv", "one"}, {"from200.csv", "other"}});
  const Catalog turned("turned.db");
  Problem problem{turned.part(0), {{0.4, 0.05}}};
  problem.either_way = true;
  const Identified found = identify(turned, problem);
  EXPECT_EQ(found.verdict, "2 congruent parts");
  EXPECT_NE(found.parts[0].answer.placements[0].clockwise, found.parts[1].answer.placements[0].clockwise);
}

TEST_F(Identify, tells_parts_of_one_length_from_congruent_ones) {
  // A stadium, and the circle as long as that, on which each half of a lap turns by half a turn as well.
  build_catalog("long.db",
                {{"gallery:stadium,length=2,r=0.5", "stadium"},
                 {fmt::format("gallery:circle,r={:.17g}", (4 + std::numbers::pi) / (2 * std::numbers::pi)), "circle"}});
  const Catalog alike("long.db");
  const double half = 0.5 * alike.part(0).perimeter();
  const Identified found = identify(alike, {alike.part(0), {{half, std::numbers::pi}}});
  EXPECT_EQ(found.verdict, "2 parts");
  EXPECT_TRUE(found.parts[0].congruent.empty());
}

TEST_F(Identify, finds_a_part_that_lies_face_down_or_was_rolled_the_other_way) {
  const Part part = catalog_.part(2);
  Problem problem{part, roll_on(part, 2, {-0.4, -0.9, -1.3})};
  for (Reading& reading : problem.measured.readings) reading.length[0] = -reading.length[0];
  EXPECT_EQ(identify(catalog_, problem).verdict, "none");
  problem.either_way = true;
  EXPECT_NEAR(identify(catalog_, problem).parts[0].answer.placements[0].start[0], 2, 1e-9);
  Problem mirrored{part, roll_on(part, 2, {0.4, 0.9, 1.3})};
  for (Reading& reading : mirrored.measured.readings) reading = Reading(-reading.length[0], -reading.turn);
  mirrored.mirrored = true;
  EXPECT_NEAR(identify(catalog_, mirrored).parts[0].answer.placements[0].start[0], 2, 1e-9);
}

TEST_F(Identify, works_with_two_fingers) {
  const Part part = catalog_.part(2);
  const Problem problem{part, rolls_on(part, 1, 4, {{0.5, -0.3}, {1.1, -0.9}, {1.6, -1.4}})};
  const Identified found = identify(catalog_, problem);
  ASSERT_THAT(names_of(catalog_, found), ElementsAre(kShapes[2]));
  EXPECT_EQ(all_of(catalog_, found).find("undecided"), std::string::npos);
}

TEST_F(Identify, holds_a_log_without_noise_against_all_its_rows) {
  run("simulate gallery:" + kShapes[2] + " --finger disk,r=0.1 --start 0.8 --length 1.5 --samples 60 -o roll.csv");
  const cli::Ran ran = run("identify parts.db --log roll.csv --finger disk,r=0.1 --json");
  EXPECT_EQ(ran.json()["verdict"], "unique part, unique place");
  EXPECT_NEAR(ran.json()["parts"][0]["placements"][0]["start"][0].get<double>(), 0.8, 1e-3);
}

TEST_F(Identify, says_that_rows_fit_badly_rather_than_none) {
  run("simulate gallery:" + kShapes[2] +
      " --finger disk,r=0.1 --start 0.8 --length 1.5 --samples 60 --noise contact=0.002,angle=0.004 --seed 3 -o "
      "roll.csv");
  const Json found =
      run("identify parts.db --json --log roll.csv --finger disk,r=0.1 --noise contact=0.001,angle=0.002").json();
  EXPECT_EQ(found["parts"][0]["name"], kShapes[2]);
  EXPECT_THAT(found["verdict"].get<std::string>(), HasSubstr("but the rows fit badly"));
}

TEST_F(Identify, refuses_noise_in_which_a_row_says_nothing) {
  EXPECT_THAT(run("identify parts.db --noise contact=1e9,angle=1e-12" + typed_roll(0, 1)).err,
              HasSubstr("more than the perimeter of the largest part"));
  EXPECT_THAT(run("identify parts.db --noise contact=1,angle=1e9" + typed_roll(0, 1)).err,
              HasSubstr("expected at most 0.5 rad"));
  EXPECT_EQ(run("identify parts.db --noise contact=1,angle=1e-12" + typed_roll(0, 1)).err.find("rollfix:"),
            std::string::npos);
}

TEST_F(Identify, refuses_what_is_not_meant) {
  EXPECT_THAT(run("identify parts.db").err, HasSubstr("expected --reading"));
  EXPECT_THAT(run("identify parts.db --reading 1,1 --noise angle=0.1 --prior 1,0.1").err, HasSubstr("--prior"));
  EXPECT_THAT(run("identify nowhere.db --reading 1,1").err, HasSubstr("there is no such file"));
}

}  // namespace
}  // namespace identify_test
