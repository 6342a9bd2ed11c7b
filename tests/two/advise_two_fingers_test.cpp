// The next roll of two fingers: what is promised of it, and that it keeps what it promises.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "cli.hpp"
#include "rollfix/advise.hpp"
#include "rollfix/error.hpp"
#include "rollfix/outline.hpp"

namespace advise_two_fingers_test {
namespace {

using cli::run;
using rollfix::Advice;
using rollfix::AdviceOptions;
using rollfix::Hypothesis;
using rollfix::Interval;
using rollfix::Part;
using rollfix::PerFinger;
using testing::HasSubstr;

Part part_of(const std::string& shape) { return Part(rollfix::gallery(shape)); }

std::vector<Hypothesis> between(const std::vector<std::array<double, 2>>& pairs) {
  std::vector<Hypothesis> hypotheses;
  for (const std::array<double, 2>& pair : pairs) {
    hypotheses.push_back({pair, {0.0, 0.0}, 1.0 / static_cast<double>(pairs.size()), hypotheses.size()});
  }
  return hypotheses;
}

/// Straight from the outline's tangents.
double turn(const Part& part, const Hypothesis& hypothesis, const PerFinger<double>& lengths) {
  const auto by = [&](std::size_t k) {
    const double from = hypothesis.place[k];
    return part.turning().angle(from + lengths[k]) - part.turning().angle(from);
  };
  return by(0) - by(1);
}

}  // namespace

TEST(AdviseTwoFingers, pairs_that_look_alike_forever_can_not_be_told_apart) {
  const Part ellipse = part_of("ellipse,a=2,b=1");
  const double half = 0.5 * ellipse.perimeter();
  const Advice advice = advise(ellipse, between({{1, 2}, {1 + half, 2}, {1, 2 + half}, {1 + half, 2 + half}}));
  EXPECT_FALSE(advice.helps);
  EXPECT_NEAR(advice.bits_wanted, 2, 1e-12);
}

TEST(AdviseTwoFingers, on_a_circle_nothing_helps) {
  EXPECT_FALSE(advise(part_of("circle"), between({{1, 2}, {3, 5}})).helps);
}

TEST(AdviseTwoFingers, a_roll_that_the_robot_can_not_do_is_not_advised) {
  const Part cam = part_of("cam");
  const std::vector<Hypothesis> two = between({{1, 4.5}, {2, 5}});
  AdviceOptions options;
  options.can_roll = [](const auto& /*from*/, const PerFinger<double>& by) {
    return std::abs(by[0]) < 1e-3 && std::abs(by[1]) < 1e-3;
  };
  const Advice free = advise(cam, two);
  const Advice bound = advise(cam, two, options);
  ASSERT_TRUE(free.helps && bound.helps);
  EXPECT_GT(std::max(std::abs(free.lengths()[0]), std::abs(free.lengths()[1])), 1e-3);
  EXPECT_LT(std::max(std::abs(bound.lengths()[0]), std::abs(bound.lengths()[1])), 1e-3);
  options.can_roll = [](const auto& /*from*/, const auto& /*by*/) { return false; };
  EXPECT_FALSE(advise(cam, two, options).helps);
}

TEST(AdviseTwoFingers, the_finger_whose_place_is_not_known_rolls_alone) {
  // On a stadium's straight side: half a unit from its end and a unit from it.
  const Part part = part_of("stadium,length=2,r=0.5");
  const double P = part.perimeter();
  const Advice a = advise(part, between({{1.5, 3}, {1.0, 3}}));
  ASSERT_TRUE(a.helps);
  EXPECT_NEAR(a.lengths()[0], 0.5, P / 200);
  EXPECT_EQ(a.lengths()[1], 0);
  const Advice b = advise(part, between({{3, 1.5}, {3, 1.0}}));
  EXPECT_EQ(b.lengths()[0], 0);
  EXPECT_NEAR(b.lengths()[1], 0.5, P / 200);
}

TEST(AdviseTwoFingers, where_both_are_not_known_the_advised_roll_tells_all_of_them) {
  const Part part = part_of("spline,n=9,seed=7,wobble=0.2");
  const std::vector<Hypothesis> hypotheses = between({{0.8, 4.1}, {0.9, 0.5}, {1.2, 3.3}, {2.6, 3.75}, {5.3, 4.0}});
  const Advice advice = advise(part, hypotheses);
  ASSERT_TRUE(advice.helps);
  EXPECT_NEAR(advice.advised().placements, 1, 0.2);
  std::size_t alike = 0;
  for (const Hypothesis& one : hypotheses) {
    EXPECT_NEAR(turn_ahead(part, one, advice.lengths()), turn(part, one, advice.lengths()), 1e-12);
    for (const Hypothesis& other : hypotheses) {
      alike += std::abs(turn(part, one, advice.lengths()) - turn(part, other, advice.lengths())) < 1e-5 ? 1 : 0;
    }
  }
  EXPECT_LE(alike, hypotheses.size() + 2);
}

TEST(AdviseTwoFingers, both_fingers_stay_within_the_travel) {
  AdviceOptions options;
  options.travel = Interval{-0.2, 0.3};
  const Advice advice = advise(part_of("limacon"), between({{1, 2}, {3, 5}}), options);
  for (const rollfix::ExpectedGain& gain : advice.gains) {
    for (const double length : advice.lengths(gain)) {
      EXPECT_GE(length, -0.2 - 1e-12);
      EXPECT_LE(length, 0.3 + 1e-12);
    }
  }
}

TEST(AdviseTwoFingers, one_disk_does_not_roll_into_the_other) {
  const Part part = part_of("stadium,length=4,r=1");
  AdviceOptions options;
  options.disks = PerFinger<double>(0.3, 0.3);
  options.turn_sd = 0.01;
  const std::vector<Hypothesis> hypotheses = between({{0.5, 2.0}, {0.7, 2.2}});
  const Advice advice = advise(part, hypotheses, options);
  for (const Hypothesis& one : hypotheses) {
    // On the straight side, where centres are as far apart as contacts.
    const double a = one.place[0] + advice.lengths()[0];
    const double b = one.place[1] + advice.lengths()[1];
    if (std::max(a, b) < 4 && std::min(a, b) > 0) {
      EXPECT_GE(std::abs(a - b), 0.6 - 1e-9);
    }
  }
}

TEST(AdviseTwoFingers, what_is_not_known_of_both_places_together_counts) {
  const Part part = part_of("limacon,a=1,b=0.6");
  AdviceOptions options;
  options.turn_sd = 0.02;
  options.travel = Interval{0, 0.2};
  const auto bits = [&](double covariance) {
    std::vector<Hypothesis> hypotheses = between({{1, 3}, {1.2, 3.3}});
    for (Hypothesis& one : hypotheses) {
      one.sd = PerFinger<double>(0.3, 0.3);
      one.covariance = covariance;
    }
    return advise(part, hypotheses, options).gains.back().bits;
  };
  EXPECT_NE(bits(0.08), bits(-0.08));
}

TEST(AdviseTwoFingers, the_program_says_which_finger_rolls_and_how_far) {
  const std::string asked =
      "advise gallery:spline,n=9,seed=7,wobble=0.2 --reading 0.58,0.94,-0.725248 --reading 1.01,1.92,-1.99849 ";
  const cli::Ran text = run(asked);
  EXPECT_EQ(text.code, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("ambiguous (16): roll finger "));
  EXPECT_THAT(text.out, HasSubstr("finger a now"));
  const cli::Json json = run(asked + "--json").json();
  EXPECT_EQ(json["length"].size(), 2U);
  EXPECT_EQ(json["contenders"].size(), 16U);
  EXPECT_EQ(json["contenders"][0]["contact"].size(), 2U);
  EXPECT_EQ(json["prospects"][0][0].size(), 2U);
}

TEST(AdviseTwoFingers, places_of_one_and_pairs_of_places_do_not_go_together) {
  std::vector<Hypothesis> hypotheses = between({{1, 2}, {3, 5}});
  hypotheses.push_back({1.0, 0.0, 0.1, 2});
  EXPECT_THROW(advise(part_of("cam"), hypotheses), rollfix::InputError);
}

}  // namespace advise_two_fingers_test
