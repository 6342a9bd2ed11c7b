// How the pin of a wheel without skin moves next: what is promised of it, held against simulated motions.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "../cli.hpp"
#include "rollfix/advise.hpp"
#include "rollfix/error.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/rolling.hpp"

namespace advise_rig_test {
namespace {

using cli::Json;
using cli::Ran;
using cli::run;
using rollfix::HoldAnswer;
using rollfix::HoldPlacement;
using rollfix::HoldRoll;
using rollfix::NextPin;
using rollfix::Part;
using rollfix::PerFinger;
using rollfix::Vec2;
using testing::HasSubstr;

constexpr double kRadius = 0.4;

HoldRoll of_jaw() {
  HoldRoll roll;
  roll.is_jaw = true;
  return roll;
}

HoldRoll of_wheel() {
  HoldRoll roll;
  roll.is_wheel = true;
  roll.radius = kRadius;
  return roll;
}

/// An answer that leaves these places of jaw and wheel.
HoldAnswer between(const std::string& shape, const std::vector<std::array<double, 2>>& pairs) {
  HoldAnswer answer{Part(rollfix::gallery(shape)), {of_jaw(), of_wheel()}};
  for (const std::array<double, 2>& pair : pairs) {
    HoldPlacement& one = answer.placements.emplace_back();
    one.contacts.resize(2);
    one.contacts[0].end = pair[0];
    one.contacts[1].end = pair[1];
  }
  return answer;
}

/// By how far the jaw's contact travels if the pin goes there: in another number of rows, straight from the simulator.
double travelled(const Part& part, const PerFinger<double>& from, const PerFinger<double>& by) {
  rollfix::RigPlan plan;
  plan.radius = kRadius;
  plan.start = from;
  plan.pin = [by](double time) -> Vec2 { return time * Vec2(by[0], by[1]); };
  plan.rows = 41;
  const std::vector<double> s = rollfix::roll_rig(part, plan).s[0];
  return s.back() - s.front();
}

const std::string kRig =
    "--log jaw.csv --log pin.csv --finger jaw --finger wheel,r=0.4 --noise contact=0.01,angle=0.3deg,position=0.01 ";

/// jaw.csv and pin.csv after so little that several places fit.
void roll_a_little() {
  ASSERT_EQ(
      run("simulate gallery:cam --finger jaw --finger wheel,r=0.4 --start 3.9 --start 2 --pin 0.05,-0.02 "
          "--samples 9 --seed 3 --wheel pin --noise contact=0.01,angle=0.3deg,position=0.01 -o jaw.csv -o pin.csv")
          .code,
      0);
}

}  // namespace

TEST(AdviseRig, the_motion_that_is_advised_moves_the_jaws_contact_otherwise_from_each_place) {
  const HoldAnswer held = between("cam", {{3.9, 2.0}, {0.7, 6.3}, {5.0, 3.0}});
  const NextPin next = next_pin(held);
  ASSERT_TRUE(next.helps()) << next.why;
  EXPECT_NEAR(next.advice->advised().placements, 1, 0.1);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(next.travels[k], travelled(held.part, next.hypotheses[k].place, next.advice->lengths()), 1e-3);
    EXPECT_GT(std::abs(next.travels[k] - next.travels[(k + 1) % 3]), 1e-3);
  }
}

TEST(AdviseRig, the_pin_stays_within_its_travel) {
  const NextPin next = next_pin(between("cam", {{3.9, 2.0}, {0.7, 6.3}}), rollfix::Interval{-0.02, 0.01});
  ASSERT_TRUE(next.helps()) << next.why;
  for (const double length : next.advice->lengths()) {
    EXPECT_GE(length, -0.02);
    EXPECT_LE(length, 0.01);
  }
}

TEST(AdviseRig, on_an_ellipse_half_turns_can_not_be_told_apart) {
  const double half = 0.5 * Part(rollfix::gallery("ellipse")).perimeter();
  const NextPin next = next_pin(between("ellipse", {{2.4, 6.0}, {2.4 + half, 6.0 - half}}));
  EXPECT_FALSE(next.helps());
  EXPECT_THAT(next.why, HasSubstr("looks the same from 2 places"));
}

TEST(AdviseRig, of_one_place_there_is_nothing_to_tell_apart) {
  EXPECT_EQ(next_pin(between("cam", {{3.9, 2.0}})).why, "there is only one place left");
}

TEST(AdviseRig, fingers_that_are_no_rig_are_refused) {
  HoldAnswer held = between("cam", {{3.9, 2.0}, {0.7, 6.3}});
  held.rolls[0] = HoldRoll{};
  EXPECT_THROW(next_pin(held), rollfix::InputError);
}

TEST(AdviseRig, the_program_says_how_the_pin_moves) {
  const cli::Folder folder;
  roll_a_little();
  const Ran text = run("advise gallery:cam " + kRig);
  EXPECT_EQ(text.code, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr(": move the pin by "));
  const Json json = run("advise gallery:cam --json " + kRig).json();
  EXPECT_EQ(json["pin"].size(), 2U);
  EXPECT_EQ(json["contenders"][0]["contact"].size(), 2U);
}

TEST(AdviseRig, the_program_says_what_it_does_not_take_beside_a_wheel) {
  const cli::Folder folder;
  roll_a_little();
  const auto refusal = [](const std::string& asked) {
    const Ran ran = run("advise gallery:cam " + asked);
    EXPECT_EQ(ran.code, 2);
    return ran.err;
  };
  EXPECT_THAT(refusal("--finger jaw --finger wheel,r=0.4"), HasSubstr("before any contact"));
  EXPECT_THAT(refusal(kRig + "--friction 0.5"), HasSubstr("--friction"));
  EXPECT_THAT(refusal("--reading 1,1 --squeezed"), HasSubstr("--squeezed"));
}

}  // namespace advise_rig_test
