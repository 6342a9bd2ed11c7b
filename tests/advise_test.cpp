#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "belief_cases.hpp"
#include "cli.hpp"
#include "refusal.hpp"
#include "rollfix/advise.hpp"
#include "rollfix/error.hpp"
#include "rollfix/rolling.hpp"
#include "rollfix/solve.hpp"

// The next roll: what is promised of it, and that it keeps what it promises.
namespace advise_test {

using namespace belief_cases;
using rollfix::Advice;
using rollfix::AdviceOptions;
using rollfix::Hypothesis;
using rollfix::Interval;
using testing::HasSubstr;

namespace {

std::vector<Hypothesis> between(std::initializer_list<double> places) {
  std::vector<Hypothesis> hypotheses;
  for (const double place : places) {
    hypotheses.push_back({place, 0, 1.0 / static_cast<double>(places.size()), hypotheses.size()});
  }
  return hypotheses;
}

/// A disk's centre, seen from the part.
rollfix::Vec2 centre(const Part& part, double s, double radius) {
  const double tangent = part.tangent(s);
  return part.point(s) + radius * rollfix::Vec2(std::sin(tangent), -std::cos(tangent));
}

}  // namespace

TEST(Advise, places_that_look_alike_forever_can_not_be_told_apart) {
  const Part part = part_of("ellipse,a=2,b=1");
  const Advice advice = advise(part, between({1, 1 + 0.5 * part.perimeter()}));
  EXPECT_FALSE(advice.helps);
  EXPECT_NEAR(advice.bits_wanted, 1, 1e-12);
}

TEST(Advise, the_roll_is_just_long_enough_for_the_first_difference) {
  // A stadium's straight side is 2 long: half a unit from its end and a unit from it look alike until the end is there.
  const Part part = part_of("stadium,length=2,r=0.5");
  const std::vector<Hypothesis> hypotheses = between({part.perimeter() - 0.5, part.perimeter() - 1.0});
  const Advice advice = advise(part, hypotheses);
  ASSERT_TRUE(advice.helps);
  const auto turn = [&](const Hypothesis& c) {
    return part.turning().angle(c.place[0] + advice.advised().length) - part.turning().angle(c.place[0]);
  };
  EXPECT_GT(std::abs(turn(hypotheses[0]) - turn(hypotheses[1])), 1e-5);
  EXPECT_NEAR(advice.advised().bits, 1, 0.03);
  EXPECT_NEAR(advice.advised().placements, 1, 0.03);
}

/// On a straight side of a stadium, from 0 to 2: so far from its end, forward, and as probable as said.
std::vector<Hypothesis> before_the_end(const std::vector<std::pair<double, double>>& all) {
  std::vector<Hypothesis> hypotheses;
  for (const auto& [before, probability] : all) {
    hypotheses.push_back({2 - before, 0, probability, hypotheses.size()});
  }
  return hypotheses;
}

const rollfix::ExpectedGain& near(const Advice& advice, double length) {
  return *std::min_element(advice.gains.begin(), advice.gains.end(), [&](const auto& a, const auto& b) {
    return std::abs(a.length - length) < std::abs(b.length - length);
  });
}

// Two places are told apart where the side ends for one of them.
TEST(Advise, the_travel_to_expect_is_that_to_the_nearest_end_and_from_there) {
  const Part part = part_of("stadium,length=2,r=0.5");
  const Advice advice = advise(part, before_the_end({{0.5, 0.5}, {1.1, 0.5}}));
  const double step = part.perimeter() / 400;
  EXPECT_NEAR(advice.advised().length, 0.5, step);
  EXPECT_NEAR(advice.advised().travel, 0.5, step);
  EXPECT_NEAR(near(advice, 0.2).travel, 0.5, step);
  EXPECT_NEAR(near(advice, -0.2).travel, 0.2 + 0.7, step);  // back again, or on to the other end at 0.9: the same
  EXPECT_NEAR(near(advice, -0.6).travel, 0.9, step);
  EXPECT_NEAR(near(advice, -1.5).travel, 1.5, step);
}

TEST(Advise, what_is_most_likely_enough_is_rolled_before_what_surely_is) {
  const Part part = part_of("stadium,length=2,r=0.5");
  // Beyond 0.2 only the second and the third are left, and 0.5 tells these.
  const Advice advice = advise(part, before_the_end({{0.2, 0.49}, {0.5, 0.49}, {1.2, 0.02}}));
  const double step = part.perimeter() / 400;
  EXPECT_NEAR(advice.advised().length, 0.2, step);
  EXPECT_NEAR(advice.advised().travel, 0.2 + 0.51 * 0.3, step);
}

TEST(Advise, one_wide_place_does_not_make_the_roll_longer_that_tells_it_from_another) {
  const Part part = part_of("stadium,length=2,r=0.5");
  std::vector<Hypothesis> hypotheses = before_the_end({{0.2, 0.25}, {1.2, 0.25}, {1.25, 0.25}, {1.3, 0.25}});
  for (std::size_t k = 2; k < 4; ++k) hypotheses[k].label = 1;
  const Advice advice = advise(part, hypotheses);
  EXPECT_NEAR(advice.advised().length, 0.2, part.perimeter() / 400);
  EXPECT_NEAR(advice.advised().travel, 0.2, part.perimeter() / 400);
}

TEST(Advise, it_stays_within_the_travel) {
  const Part part = part_of("limacon");
  AdviceOptions options;
  options.travel = Interval{-0.2, 0.3};
  const Advice advice = advise(part, between({1, 3}), options);
  EXPECT_DOUBLE_EQ(advice.gains.front().length, -0.2);
  EXPECT_DOUBLE_EQ(advice.gains.back().length, 0.3);
}

TEST(Advise, it_takes_no_hypothesis_out_of_reach) {
  const Part part = part_of("limacon,a=1.5,b=1");
  const rollfix::Reach reach = rollfix::reach_of_disk(part, 3);
  ASSERT_FALSE(reach.is_whole());
  AdviceOptions options;
  options.reach = &reach;
  const double place = reach.arcs.front().lo + 0.1;
  const Advice advice = advise(part, between({place, place + 0.3}), options);
  EXPECT_GE(advice.gains.front().length, -0.11);
  const double last = reach.arcs.front().hi - 0.1;
  EXPECT_LE(advise(part, between({last - 0.3, last}), options).gains.back().length, 0.11);
}

TEST(Advise, what_a_roll_tells_is_less_the_worse_turn_length_and_place_are_known) {
  const Part part = part_of("limacon,a=1,b=0.6");
  const double x = 0.1;
  const auto told = [&](const AdviceOptions& options, double sd) {
    AdviceOptions near = options;
    near.travel = Interval{0, x};
    return advise(part, {{1, sd, 0.5, 0}, {2.5, 2 * sd, 0.5, 1}}, near).gains.back().bits;
  };
  // Of two places as likely: what is left of the wrong one where their turns differ by so many standard deviations.
  const auto expected = [&](const AdviceOptions& options, double sd) {
    const auto turn = [&](double s) { return part.turning().angle(s + x) - part.turning().angle(s); };
    const auto variance = [&](double s, double of_place) {
      const double there = part.turning().curvature(s + x);
      const double bend = there - part.turning().curvature(s);
      const double length = std::hypot(options.length_sd, options.length_share_sd * x);
      return std::pow(options.turn_sd, 2) + std::pow(length * there, 2) + std::pow(of_place * bend, 2);
    };
    const double squared = std::pow(turn(1) - turn(2.5), 2) / (variance(1, sd) + variance(2.5, 2 * sd));
    const double left = 1 / (1 + std::exp(0.5 * squared));
    return 1 + left * std::log2(left) + (1 - left) * std::log2(1 - left);
  };
  const AdviceOptions sure{0.01, 0, 0, {}, nullptr};
  AdviceOptions many_rows{0.04, 0.04, 0, {}, nullptr};
  many_rows.rows = 16;  // 0.01 of both
  EXPECT_NEAR(told(many_rows, 0.3), expected({0.01, 0.01, 0, {}, nullptr}, 0.3), 1e-9);
  for (const auto& [options, sd] : std::initializer_list<std::pair<AdviceOptions, double>>{
           {sure, 0}, {{0.01, 0.01, 0, {}, nullptr}, 0}, {{0.01, 0, 0.1, {}, nullptr}, 0}, {sure, 0.3}}) {
    EXPECT_GT(expected(options, sd), 0.05);
    EXPECT_LT(expected(options, sd), 0.95);
    EXPECT_NEAR(told(options, sd), expected(options, sd), 1e-9);
  }
}

TEST(Advise, it_stays_on_an_open_part) {
  const Part part = part_of("exponential");
  const double P = part.perimeter();
  const Advice advice = advise(part, between({0.2 * P, 0.5 * P}));
  EXPECT_NEAR(advice.gains.front().length, -0.2 * P, 1e-9);
  EXPECT_NEAR(advice.gains.back().length, 0.5 * P, 1e-9);
}

TEST(Advise, longer_rolls_are_never_expected_to_tell_less_of_even_odds) {
  const Part part = part_of("spline,n=9,seed=7,wobble=0.2");
  const Advice advice = advise(part, between({1, 4}));
  for (std::size_t k = 1; k < advice.gains.size(); ++k) {
    const rollfix::ExpectedGain& near = advice.gains[k - 1];
    const rollfix::ExpectedGain& far = advice.gains[k];
    if (near.length >= 0) {
      EXPECT_GE(far.bits, near.bits - 1e-9);
    } else if (far.length <= 0) {
      EXPECT_GE(near.bits, far.bits - 1e-9);
    }
  }
}

TEST(Advise, without_hypotheses_there_is_nothing_to_advise) {
  EXPECT_THROW(advise(part_of("cam"), {}), rollfix::InputError);
  AdviceOptions options;
  options.travel = Interval{0.1, 0.2};
  EXPECT_THROW(advise(part_of("cam"), between({1, 2}), options), rollfix::InputError);
}

// ---- before any contact

/// A noisy log, taken as exact: places fit the last row, and none of them all rows.
TEST(Advise, of_places_that_the_rows_contradict_tells_none_apart) {
  const Part part = rollfix::load_part("gallery:spline,n=9,seed=4,wobble=0.2");
  rollfix::RollPlan plan;
  plan.start = 1;
  plan.distance = 1.5;
  const auto roll = rollfix::noisy_roll(part, rollfix::disk(0.1), plan, {.contact = 0.01, .angle = 0.01}, 3);
  const rollfix::Answer answer = rollfix::solve({part, roll.log, {rollfix::disk(0.1)}});
  ASSERT_TRUE(answer.verdict.fits_badly && !answer.placements.empty());
  const rollfix::NextRoll next = rollfix::next_roll(answer);
  EXPECT_FALSE(next.advice);
  EXPECT_THAT(next.why, HasSubstr("the rows contradict all of these places"));
}

TEST(FirstRoll, of_one_finger_tells_places_apart_that_bend_differently) {
  const rollfix::NextRoll next = rollfix::next_roll(
      rollfix::before_contact(part_of("cam"), {rollfix::disk(0.2)}, rollfix::Noise{.contact = 0.005, .angle = 0.003}));
  ASSERT_TRUE(next.helps());
  EXPECT_EQ(next.hypotheses.size(), 90U);
  EXPECT_LT(next.advice->advised().placements, 0.5 * 90);
  EXPECT_NE(next.advice->advised().length, 0);
}

TEST(FirstRoll, on_a_circle_tells_nothing) {
  const rollfix::NextRoll next = rollfix::next_roll(rollfix::before_contact(part_of("circle"), {rollfix::disk(0.2)}));
  EXPECT_FALSE(next.helps());
  EXPECT_THAT(next.why, HasSubstr("looks the same from every place"));
}

TEST(FirstRoll, of_two_fingers_starts_where_both_can_be_apart) {
  const Part part = part_of("cam");
  const rollfix::NextRoll next =
      rollfix::next_roll(rollfix::before_contact(part, {rollfix::disk(0.6), rollfix::disk(0.3)}));
  ASSERT_TRUE(next.helps());
  EXPECT_LT(next.hypotheses.size(), 81U);
  for (const Hypothesis& one : next.hypotheses) {
    EXPECT_GE((centre(part, one.place[0], 0.6) - centre(part, one.place[1], 0.3)).norm(), 0.9 - 1e-9);
  }
}

TEST(FirstRoll, of_fingers_that_may_overlap_starts_anywhere) {
  const std::vector<rollfix::Finger> fingers{rollfix::disk(0.6), rollfix::disk(0.3)};
  EXPECT_EQ(rollfix::before_contact(part_of("cam"), fingers, {}, true).placements.size(), 81U);
  EXPECT_LT(rollfix::before_contact(part_of("cam"), fingers).placements.size(), 81U);
}

TEST(FirstRoll, of_no_finger_or_three_is_refused) {
  EXPECT_THAT(refusal_of([] { rollfix::before_contact(part_of("cam"), {}); }), HasSubstr("one finger or two, found 0"));
}

TEST(FirstRoll, is_what_advise_says_without_a_reading_or_a_log) {
  const cli::Ran said = cli::run("advise gallery:cam --finger disk,r=0.2");
  EXPECT_EQ(said.code, 0) << said.err;
  EXPECT_THAT(said.out, HasSubstr("nothing is known yet: roll on "));
  const cli::Ran refused = cli::run("advise gallery:cam --finger disk,r=0.2 --robust");
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, HasSubstr("--robust: it is about a roll that was"));
  EXPECT_EQ(cli::run("advise gallery:cam").code, 2);
}

}  // namespace advise_test
