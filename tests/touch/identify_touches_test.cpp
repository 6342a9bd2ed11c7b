// Which part is it, by touches: the words, the weights, and no part lost by bounds.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include "catalogs.hpp"
#include "random.hpp"
#include "refusal.hpp"
#include "rollfix/identify.hpp"
#include "touch/touch_cases.hpp"

namespace identify_touches_test {

using namespace touch_cases;
using catalogs::Catalog;
using cli::Json;
using cli::run;
using rollfix::IdentifiedByTouches;
using rollfix::IdentifyOptions;
using rollfix::PartTouched;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

std::vector<std::string> names_of(const Catalog& catalog, const IdentifiedByTouches& found) {
  std::vector<std::string> names;
  for (const PartTouched& part : found.parts) names.push_back(catalog.entry(part.part).name);
  return names;
}

IdentifiedByTouches without_index(const Catalog& catalog, const TouchProblem& problem) {
  IdentifyOptions options;
  options.use_index = false;
  return identify(catalog, problem, options);
}

/// Everything that is said of the parts, to the last bit; how many were searched aside.
std::string all_of(const Catalog& catalog, const IdentifiedByTouches& found) {
  Json document = Json::parse(format_identified(catalog, found));
  document["catalog"].erase("searched");
  return document.dump();
}

/// The same outline as some part, as the mirror shows it.
TouchProblem face_down(TouchProblem problem) {
  for (MeasuredTouch& touch : problem.touches) {
    touch.at.x() = -touch.at.x();
    if (touch.normal) touch.normal = std::numbers::pi - *touch.normal;
  }
  problem.mirrored = true;
  return problem;
}

const std::vector<std::string> kShapes = {"ellipse,a=2,b=1",
                                          "cam",
                                          "polygon,n=4",
                                          "gear",
                                          "naca,digits=4415",
                                          "spline,n=9,wobble=0.2,seed=1",
                                          "spline,n=9,wobble=0.2,seed=2"};
constexpr std::size_t kEllipse = 0, kCam = 1, kSquare = 2, kSection = 4, kSpline = 5;
const Making kGood{5, 5, 0.02, 0.001, 0.01};

class IdentifyTouches : public testing::Test {
 protected:
  IdentifyTouches() : catalog_(catalogs::of(kShapes)) {}

  /// Touches of a part: shares of its size.
  Case touched(std::size_t part, const Making& shares, std::uint64_t seed) const {
    std::mt19937_64 generator = test_generator(seed);
    const Part one = catalog_.part(part);
    const double size = diagonal(one);
    return random_case(
        one, {shares.count, shares.normals, shares.radius * size, shares.place_sd * size, shares.angle_sd}, generator);
  }
  void expect_no_loss(const TouchProblem& problem) const {
    EXPECT_TRUE(all_of(catalog_, identify(catalog_, problem)) == all_of(catalog_, without_index(catalog_, problem)));
  }
  std::string name(std::size_t part) const { return catalog_.entry(part).name; }

  cli::Folder folder_;
  Catalog catalog_;
};

TEST_F(IdentifyTouches, name_the_part_and_its_pose) {
  const Case one = touched(kSpline, kGood, 1);
  const IdentifiedByTouches found = identify(catalog_, one.problem);
  EXPECT_EQ(found.verdict, "unique part, unique pose");
  EXPECT_THAT(names_of(catalog_, found), ElementsAre(name(kSpline)));
  EXPECT_NEAR(found.parts[0].answer.poses[0].pose.x, one.truth.x, 0.02);
}

TEST_F(IdentifyTouches, lose_nothing_by_bounds) {
  const std::vector<Making> kinds = {{3, 3, 0, 0.001, 0.02}, {4, 4, 0.1, 0.001, 0.01}, {4, 2, 0.03, 0.001, 0.02}};
  for (int k = 0; k < test_count(3); ++k) {
    const auto seed = static_cast<std::uint64_t>(k);
    const TouchProblem problem = touched(kSection + seed % 3, kinds[seed % 3], seed).problem;
    expect_no_loss(k % 2 == 1 ? face_down(problem) : problem);
  }
}

TEST_F(IdentifyTouches, lose_nothing_within_a_tolerance) {
  for (int k = 0; k < test_count(2); ++k) {
    TouchProblem problem = touched(kSpline, {4, 2, 0.02, 0, 0}, static_cast<std::uint64_t>(k)).problem;
    problem.noise.reset();
    problem.tolerance = {0.003, 0.02};
    expect_no_loss(problem);
  }
}

TEST_F(IdentifyTouches, list_the_part_that_was_touched) {
  for (int k = 0; k < test_count(6); ++k) {
    const auto seed = static_cast<std::uint64_t>(k);
    const std::size_t part = kSection + seed % 3;
    const Case one = touched(part, kGood, 100 + seed);
    const IdentifiedByTouches found = identify(catalog_, k % 3 == 0 ? face_down(one.problem) : one.problem);
    EXPECT_THAT(names_of(catalog_, found), Contains(name(part))) << k;
  }
}

TEST_F(IdentifyTouches, know_nothing_by_one_touch) {
  const IdentifiedByTouches found = identify(catalog_, touched(kCam, {1, 1, 0, 0.001, 0.01}, 2).problem);
  EXPECT_EQ(found.verdict, "7 parts");
  EXPECT_EQ(found.parts.size(), catalog_.size());
  for (const PartTouched& part : found.parts) EXPECT_NEAR(part.probability, 1.0 / 7, 1e-12);
}

TEST_F(IdentifyTouches, list_every_pose_of_a_part_with_a_symmetry) {
  const IdentifiedByTouches found = identify(catalog_, touched(kEllipse, kGood, 3).problem);
  EXPECT_EQ(found.verdict, "unique part, 2 poses");
  EXPECT_EQ(identify(catalog_, touched(kSquare, kGood, 4).problem).verdict, "unique part, 4 poses");
}

TEST_F(IdentifyTouches, find_a_part_face_down_only_where_it_is_said_to_be) {
  const TouchProblem mirrored = face_down(touched(kSpline, kGood, 6).problem);
  EXPECT_THAT(names_of(catalog_, identify(catalog_, mirrored)), ElementsAre(name(kSpline)));
  TouchProblem upright = mirrored;
  upright.mirrored = false;
  EXPECT_THAT(identify(catalog_, upright).verdict, testing::AnyOf("none", HasSubstr("contradict the stated noise")));
}

TEST_F(IdentifyTouches, say_that_no_part_fits_where_the_noise_is_understated) {
  TouchProblem problem = touched(kSpline, {6, 6, 0.02, 0.01, 0.05}, 7).problem;
  problem.noise->position /= 30;
  problem.noise->angle /= 30;
  EXPECT_EQ(identify(catalog_, problem).verdict, "none");
}

TEST_F(IdentifyTouches, weigh_by_how_many_of_each_there_are) {
  rollfix::build_catalog("bin.db", {{"gallery:cam", "one", 1}, {"gallery:cam,lift=0.5", "three", 3}});
  const Catalog bin("bin.db");
  TouchProblem problem = touched(kCam, {1, 0, 0, 0.001, 0}, 8).problem;
  const IdentifiedByTouches found = identify(bin, problem);
  EXPECT_THAT(names_of(bin, found), ElementsAre("three", "one"));
  EXPECT_NEAR(found.parts[0].probability, 0.75, 1e-12);
  EXPECT_EQ(found.verdict, "2 congruent parts");
}

TEST_F(IdentifyTouches, report_parts_that_no_touch_separates) {
  rollfix::build_catalog("twins.db",
                         {{"gallery:cam", "one"}, {"gallery:cam,lift=0.5", "other"}, {"gallery:gear", "gear"}});
  const Catalog twins("twins.db");
  const IdentifiedByTouches found = identify(twins, touched(kCam, kGood, 9).problem);
  EXPECT_EQ(found.verdict, "2 congruent parts");
  EXPECT_NEAR(found.parts[0].probability, 0.5, 1e-9);
}

TEST_F(IdentifyTouches, say_undecided_where_a_budget_runs_out) {
  TouchProblem problem = touched(kSpline, {3, 1, 0, 0.001, 0.01}, 10).problem;
  problem.budget = 100;
  const IdentifiedByTouches found = identify(catalog_, problem);
  EXPECT_EQ(found.verdict, "undecided");
  EXPECT_FALSE(found.undecided.empty());
}

TEST_F(IdentifyTouches, say_the_same_with_any_number_of_threads) {
  const TouchProblem problem = touched(kSpline, {2, 2, 0, 0.001, 0.01}, 11).problem;
  IdentifyOptions alone;
  alone.threads = 1;
  EXPECT_EQ(format_identified(catalog_, identify(catalog_, problem, alone)),
            format_identified(catalog_, identify(catalog_, problem)));
}

TEST_F(IdentifyTouches, say_of_each_part_what_locate_says) {
  catalogs::of({"cam", "gear", "limacon"}, "few.db");
  const std::string asked = " --touch 0,0,-2 --touch 1.9,0.1,0.2 --tolerance 0.01,0.1 --json";
  const Json found = run("identify few.db" + asked).json();
  ASSERT_GT(found["parts"].size(), 0U);
  for (const Json& part : found["parts"]) {
    const Json alone = run("locate gallery:" + part["name"].get<std::string>() + asked).json();
    EXPECT_EQ(part["placements"], alone["placements"]);
    EXPECT_EQ(part["verdict"], alone["verdict"]);
  }
}

TEST_F(IdentifyTouches, end_with_the_exit_codes_of_identify) {
  const std::string first = "identify parts.db --touch 0,0,-1.6 --touch ";
  EXPECT_EQ(run(first + "0,1,1.5 --tolerance 0.01,0.1").code, 0);
  EXPECT_EQ(run(first + "0,190,1.5 --tolerance 0.01,0.1").code, 1);
  EXPECT_EQ(run(first + "0,1,1.5").code, 2);
  EXPECT_EQ(run(first + "0,1,1.5 --tolerance 0.01,0.1 --budget 10").code, 3);
}

TEST_F(IdentifyTouches, say_what_to_do_next) {
  EXPECT_THAT(run("identify parts.db --touch 0,0 --noise position=0.01").out, HasSubstr("touch the part elsewhere"));
  EXPECT_THAT(run("identify parts.db --touch 0,0 --touch 0,190 --noise position=0.01").out,
              AllOf(StartsWith("none\n"), HasSubstr("--mirror")));
}

TEST_F(IdentifyTouches, refuse_what_can_not_be_meant) {
  std::ofstream("roll.csv") << "time,u,psi\n0,0,0\n1,1,1\n";
  const auto said = [](const std::string& more) { return run("identify parts.db --touch 0,0 " + more).err; };
  EXPECT_THAT(said(""), HasSubstr("--noise position="));
  EXPECT_THAT(said("--log roll.csv --noise position=1"), HasSubstr("share a pose with --roll all: add it"));
  EXPECT_THAT(said("--noise position=0.1 --facing 1"), HasSubstr("--facing: touches do not roll"));
  EXPECT_THAT(said("--noise position=0.1 -o which.svg"), HasSubstr("rollfix locate PART"));
}

}  // namespace identify_touches_test
