#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "cli.hpp"
#include "random.hpp"
#include "refusal.hpp"
#include "roll_cases.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/touch.hpp"

// Contacts that say less than a touch with its place, or come as a roll of a single row.
namespace single_contact_test {

using namespace roll_cases;
using rollfix::Finger;
using testing::HasSubstr;

constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();
constexpr double kRightAngle = 0.5 * std::numbers::pi;

MeasuredTouch normal_alone(double normal) {
  MeasuredTouch touch;
  touch.at = {kNowhere, kNowhere};
  touch.normal = normal;
  return touch;
}

/// The likelihood of a normal in a pose, wherever on the boundary it was felt: summed by small steps.
double summed(const Part& part, double heading, double normal, double sd) {
  constexpr int kSteps = 20000;
  double sum = 0;
  for (int k = 0; k < kSteps; ++k) {
    const double s = part.perimeter() * (k + 0.5) / kSteps;
    const double off = rollfix::nearest_angle(normal + kRightAngle - part.tangent(s) - heading) / sd;
    sum += std::exp(-0.5 * off * off);
  }
  return sum;
}

/// Balls without normals, of which several poses remain, of a part without corners.
Case several_poses(std::mt19937_64& generator) {
  const Part part = rollfix::load_part("gallery:spline,n=9,seed=7,wobble=0.2");
  for (;;) {
    Case one = random_case(part, {4, 0, 0.1, 0.004, 0.05}, generator);
    if (rollfix::solve(one.problem).poses.size() > 1) return one;
  }
}

TEST(NormalAlone, WeighsPosesByTheBoundaryThatHasIt) {
  auto generator = test_generator(81);
  for (int k = 0; k < test_count(3); ++k) {
    Case one = several_poses(generator);
    const TouchAnswer before = rollfix::solve(one.problem);
    const double normal = uniform(generator, -3, 3);
    one.problem.touches.push_back(normal_alone(normal));
    const TouchAnswer after = rollfix::solve(one.problem);
    ASSERT_EQ(after.status, rollfix::Status::complete);
    const double size = diagonal(before.part);
    double total = 0;
    std::vector<double> expected;
    for (const TouchPose& pose : before.poses) {
      expected.push_back(pose.probability * summed(before.part, pose.spread.mean.heading, normal, 0.05));
      total += expected.back();
    }
    for (const TouchPose& pose : after.poses) {
      for (std::size_t i = 0; i < before.poses.size(); ++i) {
        if (apart(pose.pose, before.poses[i].pose, {0, 0}, size) > 0.05 * size) continue;
        EXPECT_NEAR(pose.probability, expected[i] / total, 0.03) << "seed " << test_seed() << ", case " << k;
      }
    }
  }
}

TEST(NormalAlone, TellsNothingOfACircle) {
  TouchProblem problem{rollfix::load_part("gallery:circle,r=2"), {}};
  problem.tolerance = rollfix::TouchTolerance{1e-3, 0.01};
  for (const double angle : {0.1, 2.0, 4.0}) {
    problem.touches.push_back({2 * Vec2(std::cos(angle), std::sin(angle))});
  }
  problem.touches.push_back(normal_alone(1));
  const TouchAnswer answer = rollfix::solve(problem);
  ASSERT_EQ(answer.poses.size(), 1U);
  EXPECT_TRUE(answer.poses.front().any_heading);
}

TEST(NormalAlone, HoldsAPartByItsFlatSides) {  // a square that is pinned at its middle turns to one of four headings
  TouchProblem problem{polygon({{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}), {}};
  problem.noise = rollfix::Noise{.angle = 0.01, .position = 0.05};
  for (const Vec2& at : {Vec2(1, 0), Vec2(0, 1), Vec2(-1, 0), Vec2(0, -1)}) problem.touches.push_back({at});
  const double loose = rollfix::solve(problem).poses.front().spread.covariance(2, 2);
  problem.touches.push_back(normal_alone(0.05));
  const TouchAnswer answer = rollfix::solve(problem);
  const rollfix::TouchPose& pose = answer.poses.front();
  EXPECT_NEAR(std::remainder(pose.spread.mean.heading - 0.05, kRightAngle), 0, 0.02);
  EXPECT_LT(pose.spread.covariance(2, 2), 0.1 * loose);
}

TEST(NormalAlone, WithoutAnyPlaceIsRefused) {
  TouchProblem problem{bracket(), {normal_alone(0), normal_alone(1)}};
  problem.noise = rollfix::Noise{.angle = 0.01};
  EXPECT_THAT(refusal_of([&] { rollfix::solve(problem); }), HasSubstr("expected a place, x and y, of at least one"));
}

TEST(NormalAlone, IsARowOfATableWithoutItsPlace) {
  const auto table = rollfix::parse_touches("x,y,normal\n1,2,\n,,30deg\n", "t.csv");
  ASSERT_EQ(table.touches.size(), 2U);
  EXPECT_FALSE(table.touches[1].has_place());
  EXPECT_NEAR(*table.touches[1].normal, std::numbers::pi / 6, 1e-15);
  for (const char* text : {"x,y,normal\n1,,30deg\n", "x,y,normal\n,,\n", "x,y,normal,contact\n,,30deg,0\n"}) {
    EXPECT_THAT(refusal_of([&] { rollfix::parse_touches(text, "t.csv"); }), HasSubstr("t.csv:2: column"));
  }
}

/// Rolls of a single row each, and what a probe's touches would be.
struct Singles {
  TouchProblem rolls;
  TouchProblem touches;
};

/// A finger that touches here and there: of a disk its centre is what a probe would say, else the contact.
Singles singles_of(const Part& part, const Finger& finger, double arm, const std::vector<double>& starts) {
  Singles result{{part, {}}, {part, {}}};
  const Pose pose{3, -2, 0.7};
  for (const double s : starts) {
    const rollfix::Contact contact = rollfix::contact_at(finger, part.tangent(s) + pose.heading, arm);
    const Vec2 origin = rollfix::centre_of(finger, pose.world(part.point(s)), contact);
    Log log;
    rollfix::FingerRows& rows = log.fingers.front();
    rows.u = {contact.u};
    rows.psi = {contact.psi};
    rows.x = {origin.x()};
    rows.y = {origin.y()};
    result.rolls.rolls.push_back(log);
    MeasuredTouch touch;
    touch.at = finger.is_disk() ? origin : pose.world(part.point(s));
    touch.normal = part.tangent(s) + pose.heading - kRightAngle;
    result.touches.touches.push_back(touch);
  }
  result.rolls.finger = finger;
  if (finger.is_disk()) result.touches.finger = finger;
  return result;
}

void expect_alike(const Singles& both, const Pose& truth) {
  const TouchAnswer rolled = rollfix::solve(both.rolls);
  const TouchAnswer touched = rollfix::solve(both.touches);
  ASSERT_EQ(rolled.poses.size(), touched.poses.size());
  ASSERT_FALSE(rolled.poses.empty());
  for (const TouchPose& pose : rolled.poses) {  // those that are as probable are in any order
    const auto is_same = [&](const TouchPose& other) {
      const bool is_as_probable = !both.rolls.noise || std::abs(pose.probability - other.probability) < 1e-3;
      return is_as_probable && apart(pose.pose, other.pose, {0, 0}, 5) < 1e-3;
    };
    EXPECT_EQ(std::count_if(touched.poses.begin(), touched.poses.end(), is_same), 1) << pose.pose.heading;
  }
  EXPECT_TRUE(in_extent(rolled.poses.front(), truth) || rolled.poses.size() > 1);
}

TEST(RollOfOneRow, OfADiskIsATouchWithItsNormal) {
  Singles both = singles_of(rollfix::load_part("gallery:cam"), rollfix::disk(0.2), 0.3, {0.3, 1.9, 4});
  both.rolls.noise = both.touches.noise = rollfix::Noise{.angle = 0.01, .position = 0.01};
  expect_alike(both, {3, -2, 0.7});
  both.rolls.noise = both.touches.noise = std::nullopt;
  both.rolls.tolerance = both.touches.tolerance = rollfix::TouchTolerance{0.002, 0.002};
  expect_alike(both, {3, -2, 0.7});
}

TEST(RollOfOneRow, OfAJawIsATouchOfItsContact) {
  Singles both = singles_of(rollfix::load_part("gallery:ellipse,a=3,b=2"), rollfix::jaw(), 0, {0.3, 3.9, 7});
  both.rolls.noise = both.touches.noise = rollfix::Noise{.angle = 0.01, .position = 0.01};
  expect_alike(both, {3, -2, 0.7});
}

TEST(RollOfOneRow, WithoutItsPlaceIsANormalAlone) {
  Singles both = singles_of(rollfix::load_part("gallery:cam"), rollfix::disk(0.2), 0.3, {0.3, 1.9, 4, 5.5});
  both.rolls.rolls[3].fingers[0].x.clear();
  both.rolls.rolls[3].fingers[0].y.clear();
  both.touches.touches[3].at = {kNowhere, kNowhere};
  both.rolls.noise = both.touches.noise = rollfix::Noise{.angle = 0.01, .position = 0.01};
  expect_alike(both, {3, -2, 0.7});
}

TEST(RollOfOneRow, WithNoPlaceAtAllLeavesTheHeadingOpen) {
  Singles both = singles_of(rollfix::load_part("gallery:cam"), rollfix::disk(0.2), 0.3, {0.3, 1.9});
  for (Log& log : both.rolls.rolls) log.fingers[0].x = log.fingers[0].y = {};
  for (const bool noisy : {false, true}) {
    both.rolls.noise.reset();
    if (noisy) both.rolls.noise = rollfix::Noise{.angle = 0.01};
    const TouchAnswer answer = rollfix::solve(both.rolls);
    EXPECT_EQ(answer.status, rollfix::Status::complete);
    EXPECT_NE(answer.verdict.name, rollfix::Verdict::unique);
    EXPECT_NE(answer.verdict.name, rollfix::Verdict::inconsistent);
  }
}

TEST(RollOfOneRow, StandsBesideARollInTheLog) {
  const cli::Folder folder;
  folder.write("rows.csv",
               "u,psi,x,y,contact\n0,3.141593,5.2,0,1\n0,0,0,0,0\n"
               "0,4.712389,0,3.2,1\n0,0,0,0,0\n0,0,-5.2,0,1\n");
  const cli::Ran ran = cli::run(
      "locate gallery:ellipse,a=5,b=3 --log rows.csv --roll all --finger disk,r=0.2 --noise "
      "position=0.02,angle=0.02 --json");
  ASSERT_NE(ran.code, 2) << ran.err;
  EXPECT_EQ(cli::Json::parse(ran.out)["rolls"].size(), 3U);
}

TEST(RollOfOneRow, AloneLeavesAllPosesAlongTheBoundary) {
  const cli::Folder folder;
  folder.write("row.csv", "u,psi,x,y\n0,3.141593,5.2,0\n");
  for (const std::string more : {"", " --noise position=0.02,angle=0.02"}) {
    const cli::Ran ran = cli::run("locate gallery:ellipse,a=5,b=3 --log row.csv --roll all --finger disk,r=0.2" + more);
    EXPECT_EQ(ran.code, 0) << ran.err;
    EXPECT_THAT(ran.out, HasSubstr("unobservable"));
  }
}

}  // namespace single_contact_test
