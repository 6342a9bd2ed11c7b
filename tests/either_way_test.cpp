// A roll that may have gone either way round the part: the answer holds both, and with noise it says how likely each
// is.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "cli.hpp"
#include "random.hpp"
#include "rollfix/locate.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/solve.hpp"

namespace either_way_test {
namespace {

using rollfix::Answer;
using rollfix::Noise;
using rollfix::Part;
using rollfix::Placement;
using rollfix::Problem;
using rollfix::Reading;
using testing::DoubleNear;
using testing::HasSubstr;
using testing::Pointwise;

const Part& part() {
  static const Part part(rollfix::gallery("limacon,a=1,b=0.8"));
  return part;
}

double turn(double s, double length) { return part().turning().angle(s + length) - part().turning().angle(s); }

Answer either(const std::vector<Reading>& readings, const std::optional<Noise>& noise = {}) {
  Problem problem{part(), readings, {}, noise};
  problem.either_way = true;
  return rollfix::solve(problem);
}

std::vector<double> starts(const std::vector<Placement>& placements, bool clockwise) {
  std::vector<double> starts;
  for (const Placement& placement : placements) {
    if (placement.clockwise == clockwise) starts.push_back(placement.start[0]);
  }
  return starts;
}

double probability_of_clockwise(const Answer& answer) {
  double sum = 0;
  for (const Placement& placement : answer.placements) sum += placement.clockwise ? placement.probability : 0;
  return sum;
}

/// By a plain sum over the boundary: of bare readings, how likely it is that their lengths count clockwise.
double summed_probability(const std::vector<Reading>& readings, const Noise& noise) {
  constexpr int kSteps = 40000;
  std::array<double, 2> way{};
  for (int k = 0; k < kSteps; ++k) {
    const double s = part().perimeter() * k / kSteps;
    for (const int sign : {1, -1}) {
      double squared = 0;
      for (const Reading& reading : readings) {
        const double length = sign * reading.length[0];
        const double kappa = part().turning().curvature(s + length);
        const double f = turn(s, length) - reading.turn;
        squared += f * f / (noise.angle * noise.angle + kappa * kappa * noise.contact * noise.contact);
      }
      way.at(sign > 0 ? 0 : 1) += std::exp(-0.5 * squared);
    }
  }
  return way[1] / (way[0] + way[1]);
}

TEST(EitherWay, holds_what_fits_one_way_and_what_fits_the_other) {
  const Reading ccw(0.7, turn(2, 0.7));
  const Answer answer = either({ccw});
  const auto expected = [](double length, double theta) {
    std::vector<double> starts;
    for (const Placement& one : rollfix::locate(part(), {{length, theta}}).placements) starts.push_back(one.start[0]);
    return starts;
  };
  EXPECT_THAT(starts(answer.placements, false), Pointwise(DoubleNear(1e-9), expected(0.7, ccw.turn)));
  EXPECT_THAT(starts(answer.placements, true), Pointwise(DoubleNear(1e-9), expected(-0.7, ccw.turn)));
  EXPECT_EQ(answer.verdict.places, answer.placements.size());
  EXPECT_EQ(answer.readings.front().length[0], 0.7);
}

TEST(EitherWay, sensitivities_are_to_the_lengths_as_given) {
  // A turn that both ways round have.
  const double theta = 0.05;
  const Answer answer = either({{0.4, theta}});
  const double step = 1e-5;
  const Answer further = either({{0.4 + step, theta}});
  ASSERT_EQ(answer.placements.size(), further.placements.size());
  ASSERT_FALSE(starts(answer.placements, true).empty());
  for (std::size_t k = 0; k < answer.placements.size(); ++k) {
    const Placement& placement = answer.placements[k];
    ASSERT_EQ(placement.clockwise, further.placements[k].clockwise);
    if (placement.kind != rollfix::Kind::crossing) continue;
    const double moved = (further.placements[k].start[0] - placement.start[0]) / step;
    EXPECT_NEAR(placement.sensitivity.per_length[0][0][0], moved, 1e-3 * std::max(1.0, std::abs(moved)));
  }
}

TEST(EitherWay, each_way_is_as_likely_as_a_plain_sum_over_the_boundary_has_it) {
  const Noise noise{0.003, 0.02, 0, 0};
  std::mt19937_64 random = test_generator();
  std::uniform_real_distribution<double> place(0, part().perimeter());
  std::normal_distribution<double> normal;
  for (int k = 0; k < test_count(40); ++k) {
    const double s = place(random);
    const double sign = normal(random) > 0 ? 1 : -1;
    std::vector<Reading> readings;
    for (const double length : {0.15, 0.3}) {
      readings.emplace_back(length + noise.contact * normal(random),
                            turn(s, sign * length) + noise.angle * normal(random));
    }
    const double expected = summed_probability(readings, noise);
    const Answer answer = either(readings, noise);
    if (answer.verdict.name == rollfix::Verdict::inconsistent || answer.verdict.fits_badly) continue;
    EXPECT_NEAR(probability_of_clockwise(answer), expected, 0.02);
  }
}

TEST(EitherWay, where_both_ways_fit_each_is_as_likely_as_a_plain_sum_has_it) {
  const Noise noise{0.003, 0.1, 0, 0};
  for (const double off : {0.08, 0.1}) {
    const double s = part().inflections().front() + off;
    const std::vector<Reading> readings{{0.15, turn(s, 0.15)}, {0.3, turn(s, 0.3)}};
    const double expected = summed_probability(readings, noise);
    EXPECT_NEAR(std::abs(expected - 0.5), 0.3, 0.1) << off;  // neither surely nor as well either way
    EXPECT_NEAR(probability_of_clockwise(either(readings, noise)), expected, 0.02) << off;
  }
}

TEST(EitherWay, all_that_is_listed_and_the_rest_are_one_where_a_finger_can_go_one_way_alone) {
  Problem problem{part(), {{0.3, turn(2, 0.3)}}, {rollfix::jaw()}, Noise{0.003, 0.02}};
  problem.either_way = true;
  const Answer answer = rollfix::solve(problem);
  EXPECT_TRUE(starts(answer.placements, true).empty());
  double sum = answer.weighing->rest;
  for (const Placement& placement : answer.placements) sum += placement.probability;
  EXPECT_NEAR(sum, 1, 1e-4);
}

TEST(EitherWay, places_out_of_reach_are_counted_both_ways) {
  Problem problem{part(), {{0.4, 0.05}}};
  problem.either_way = true;
  const Answer all = rollfix::solve(problem);
  problem.fingers = {rollfix::jaw()};
  const Answer answer = rollfix::solve(problem);
  for (const bool clockwise : {false, true}) {
    EXPECT_LT(starts(answer.placements, clockwise).size(), starts(all.placements, clockwise).size()) << clockwise;
  }
  EXPECT_EQ(answer.dropped.reach, all.placements.size() - answer.placements.size());
}

TEST(EitherWay, two_fingers_find_their_pair_whichever_way_they_count) {
  for (const double sign : {1.0, -1.0}) {
    const auto reading = [&](double a, double b) { return Reading(sign * a, sign * b, turn(1, a) - turn(4, b)); };
    const Answer answer = either({reading(0.7, -0.4), reading(1.5, -0.8)});
    EXPECT_TRUE(std::any_of(answer.placements.begin(), answer.placements.end(), [&](const Placement& placement) {
      return placement.clockwise == (sign < 0) && std::abs(placement.start[0] - 1) < 1e-6 &&
             std::abs(placement.start[1] - 4) < 1e-6;
    }));
  }
}

TEST(EitherWay, a_log_that_says_it_itself_is_refused) {
  const cli::Folder folder;
  folder.write("roll.csv", "u,psi\n0,0\n-1,1.2\n-2,2.5\n");
  EXPECT_THAT(cli::run("locate gallery:cam --finger disk,r=0.2 --direction either --log roll.csv").err,
              HasSubstr("u and psi, which say the direction themselves"));
}

TEST(EitherWay, a_log_tells_which_way_it_went_as_it_goes_on) {
  const cli::Folder folder;
  std::string rows = "length,turn\n";
  for (int k = 1; k <= 60; ++k) rows += fmt::format("{:.6f},{:.6f}\n", 0.05 * k, turn(2, -0.05 * k));
  folder.write("track.csv", rows);
  const std::string noise = " --noise contact=0.002,angle=0.2deg";
  const cli::Json found =
      cli::run("locate gallery:limacon,a=1,b=0.8 --log track.csv --direction either --json" + noise).json();
  ASSERT_EQ(found["verdict"], "unique");
  EXPECT_EQ(found["placements"][0]["direction"], "cw");
  EXPECT_NEAR(found["placements"][0]["start"][0], 2, 0.02);
  EXPECT_GT(found["placements"][0]["probability"], 0.99);
  const cli::Ran text = cli::run("locate gallery:limacon,a=1,b=0.8 --log track.csv --direction either" + noise);
  EXPECT_THAT(text.out, HasSubstr("lengths counted cw with probability 1.0000"));
  EXPECT_THAT(text.out, HasSubstr(", lengths counted cw\n"));
}

TEST(EitherWay, rows_that_can_only_go_one_way_are_no_mistake) {
  const cli::Folder folder;
  const Part ellipse(rollfix::gallery("ellipse,a=2,b=1"));
  // Slowly, and then a gap: backwards round a convex part no stretch as long turns to the left.
  std::string rows = "length,turn\n";
  for (int k = 1; k <= 40; ++k) {
    const double length = 0.001 * k + (k > 20 ? 2 : 0);
    rows += fmt::format("{},{:.9f}\n", length, ellipse.turning().angle(1 + length) - ellipse.turning().angle(1));
  }
  folder.write("roll.csv", rows);
  EXPECT_EQ(cli::run("locate gallery:ellipse,a=2,b=1 --log roll.csv --direction cw").code, 2);
  const cli::Ran ran = cli::run("locate gallery:ellipse,a=2,b=1 --log roll.csv --direction either");
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_THAT(ran.out, HasSubstr("ambiguous (2)"));
  EXPECT_THAT(ran.err, HasSubstr("the other way round no such roll can be: roll.csv:22: "));
}

TEST(EitherWay, is_asked_of_locate_alone) {
  EXPECT_THAT(cli::run("advise gallery:cam --reading 1,0.5 --direction either").err, HasSubstr("by locate alone"));
  EXPECT_THAT(cli::run("locate gallery:cam --march --reading 1,0.5 --direction either").err,
              HasSubstr("no use for --direction either"));
}

}  // namespace
}  // namespace either_way_test
