// A jaw and a wheel on a pin that the robot moves: the contacts that follow, against rigid bodies that are simulated
// apart, and against what is known of a circle.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "../random.hpp"
#include "../refusal.hpp"
#include "rigid_body.hpp"
#include "rigs.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/rolling.hpp"

namespace rollfix::rig_test {
namespace {

using rigs::evenly;
using rigs::gap_in;
using rigs::part_of;
using rigs::pin_in_jaw;
using testing::AllOf;
using testing::HasSubstr;

const double kPi = std::numbers::pi;

double largest_gap(const Part& part, const Roll& roll, double radius) {
  double most = 0;
  for (std::size_t row = 0; row < roll.pose.size(); ++row) most = std::max(most, gap_in(part, roll, radius, row));
  return most;
}

/// Everything that differs between a row and the rigid bodies of that instant.
double difference(const Roll& roll, std::size_t row, const rigid_body::State& state) {
  const FingerRows& jaw = roll.log.fingers[0];
  const FingerRows& wheel = roll.log.fingers[1];
  const Pose& pose = roll.pose[row];
  double most = 0;
  for (const double off :
       {roll.s[0][row] - state.s, roll.s[1][row] - state.t, jaw.u[row] - state.u, wheel.u[row] - state.v,
        jaw.psi[row] - state.jaw_heading, wheel.psi[row] - state.wheel_heading, jaw.x[row] - state.jaw.x(),
        jaw.y[row] - state.jaw.y(), wheel.x[row] - state.pin.x(), wheel.y[row] - state.pin.y(), pose.x - state.part.x(),
        pose.y - state.part.y(), pose.heading - state.part_heading}) {
    most = std::max(most, std::abs(off));
  }
  return most;
}

}  // namespace

TEST(Rig, does_what_rigid_bodies_with_equal_contact_velocities_do) {
  const Part part = part_of("ellipse,a=2,b=1");
  RigPlan plan = evenly(0.4, 2.4, 6.3, {0, 0}, 21);
  plan.pin = [](double time) { return Vec2(-0.5 * time + 0.1 * std::sin(3 * time), -0.15 * std::sin(2 * time)); };
  plan.jaw = [](double time) { return Pose{0.3 * time, -0.2 * time * time, 0.7 * std::sin(time)}; };
  rigid_body::Rig rig(
      part, 0.4,
      {[](double time) { return Vec2(-0.5 + 0.3 * std::cos(3 * time), -0.3 * std::cos(2 * time)); },
       [](double time) { return Vec2(0.3, -0.4 * time); }, [](double time) { return 0.7 * std::cos(time); }});
  rigid_body::State state = rig.start(2.4, 6.3);
  plan.psi = 0;
  const Roll found = roll_rig(part, plan);
  const double whole = found.log.fingers[1].u[0] - state.v;  // turns: u is in (-pi, pi]
  EXPECT_NEAR(std::remainder(whole, 2 * kPi), 0, 1e-12);
  state.v += whole;
  state.jaw_heading += found.log.fingers[0].psi[0] - state.jaw_heading;
  for (std::size_t row = 1; row < plan.rows; ++row) {
    state = rig.after(state, found.log.time[row - 1], 1 / 20.0, 40);
    EXPECT_LT(difference(found, row, state), 1e-9) << "row " << row;
  }
}

TEST(Rig, keeps_both_contacts_together_on_every_part) {
  std::mt19937_64 generator = test_generator(701);
  std::uniform_real_distribution<double> share(0, 1);
  int rolled = 0;
  for (const char* shape : {"ellipse", "cam", "circle,r=1.3", "superellipse", "reuleaux", "limacon", "naca",
                            "spline,n=9,seed=7,wobble=0.2"}) {
    const Part part = part_of(shape);
    for (int round = 0; round < test_count(12); ++round) {
      const double P = part.perimeter();
      const double radius = (0.02 + 0.1 * share(generator)) * P;
      const double turn = 2 * kPi * share(generator);
      const Vec2 moved = 0.05 * P * rigs::along(turn);
      RigPlan plan = evenly(radius, P * share(generator), P * share(generator), moved, 11);
      plan.jaw = [](double time) { return Pose{time, -time, 2 * time}; };
      try {
        const Roll roll = roll_rig(part, plan);
        ++rolled;
        EXPECT_LT(largest_gap(part, roll, radius), 1e-9) << shape << ", seed " << test_seed();
        for (std::size_t row = 0; row < plan.rows; ++row) {
          EXPECT_LT((pin_in_jaw(roll, row) - pin_in_jaw(roll, 0) - plan.pin(roll.log.time[row])).norm(), 1e-9);
        }
      } catch (const InputError&) {
        continue;  // a place where it can't be, or where the pin's motion does not say how it rolls
      }
    }
  }
  EXPECT_GT(rolled, 20);
}

TEST(Rig, on_a_circle_everything_is_known) {
  // In the jaw's frame the circle's centre goes along with the contact, R below the jaw, and the pin stays R + r away.
  const double R = 1.5;
  const double r = 0.4;
  const Part part = part_of("circle,r=1.5");
  const RigPlan plan = evenly(r, R * 0.3, R * 2.2, {-0.3, 0.3});
  const Roll found = roll_rig(part, plan);
  const Vec2 first = pin_in_jaw(found, 0);
  for (std::size_t row = 0; row < plan.rows; ++row) {
    const Vec2 pin = first + plan.pin(found.log.time[row]);
    const double across = std::sqrt((R + r) * (R + r) - (pin.y() + R) * (pin.y() + R));
    const double centre = pin.x() - std::copysign(across, first.x());
    EXPECT_NEAR(found.log.fingers[0].u[row], centre, 1e-12);
    EXPECT_NEAR(found.s[0][row], R * 0.3 - centre, 1e-12);
    const double seen = std::atan2(pin.y() + R, pin.x() - centre) - std::atan2(first.y() + R, first.x());
    // From the circle's centre the pin has turned by so much, and the circle by centre / R.
    EXPECT_NEAR(std::remainder(found.s[1][row] / R - (2.2 + seen - centre / R), 2 * kPi), 0, 1e-11);
  }
}

TEST(Rig, that_turns_and_moves_as_a_whole_rolls_as_one_whose_jaw_stays) {
  const Part part = part_of("cam");
  RigPlan plan = evenly(0.3, 1.2, 4.4, {-0.3, -0.1});
  const Roll still = roll_rig(part, plan);
  plan.jaw = [](double time) { return Pose{5 * time, time * time, 3 * time}; };
  const Roll moved = roll_rig(part, plan);
  EXPECT_EQ(still.s[0], moved.s[0]);
  EXPECT_EQ(still.s[1], moved.s[1]);
  EXPECT_NEAR(moved.pose.back().heading - still.pose.back().heading, 3, 1e-12);
}

TEST(Rig, comes_back_where_the_pin_comes_back) {
  const Part part = part_of("reuleaux");
  RigPlan plan = evenly(0.3, 0.5, 2.4, {0, 0});
  plan.pin = [](double time) { return Vec2(0.2 * std::sin(kPi * time), 0.1 * std::sin(2 * kPi * time)); };
  const Roll found = roll_rig(part, plan);
  EXPECT_NEAR(found.s[0].back(), found.s[0].front(), 1e-9);
  EXPECT_NEAR(found.s[1].back(), found.s[1].front(), 1e-9);
  EXPECT_NEAR(found.log.fingers[1].psi.back(), found.log.fingers[1].psi.front(), 1e-9);
}

TEST(Rig, pivots_over_convex_corners_and_stays_closed) {
  const Part part = part_of("reuleaux");
  const Roll found = roll_rig(part, evenly(0.3, 0.5, 2.4, {0.4, -0.15}, 201));
  for (const std::size_t finger : {0U, 1U}) {
    const std::vector<double>& s = found.s[finger];
    EXPECT_NE(std::adjacent_find(s.begin(), s.end()), s.end()) << "from " << s.front() << " to " << s.back();
  }
  EXPECT_LT(largest_gap(part, found, 0.3), 1e-9);
}

TEST(Rig, stops_where_the_wheels_normal_passes_through_the_jaws_contact) {
  const Part part = part_of("ellipse");
  const std::string why = refusal_of([&] { roll_rig(part, evenly(0.4, 2.4, 5.8, {0.4, -0.1}, 101)); });
  EXPECT_THAT(why,
              AllOf(HasSubstr("row 47 of the log"), HasSubstr("the wheel's normal passes through the jaw's contact"),
                    HasSubstr("the pin can move by (0.183")));
  EXPECT_NO_THROW(roll_rig(part, evenly(0.4, 2.4, 5.8, 0.4577 * Vec2(0.4, -0.1))));
  EXPECT_THROW(roll_rig(part, evenly(0.4, 2.4, 5.8, 0.4579 * Vec2(0.4, -0.1))), InputError);
}

TEST(Rig, says_which_finger_can_not_go_on_and_how_far_the_pin_can) {
  EXPECT_THAT(refusal_of([] {
                roll_rig(part_of("stadium"), evenly(0.3, 0.5, 5, {0.1, 0}));
              }),
              AllOf(HasSubstr("finger a: "), HasSubstr("a flat jaw can't roll")));
  EXPECT_THAT(refusal_of([] {
                roll_rig(part_of("limacon"), evenly(1, 2, 6, {1.2, 0.45}));
              }),
              AllOf(HasSubstr("finger b: "), HasSubstr("too big for the concavity"), HasSubstr("the pin can move by")));
}

TEST(Rig, refuses_plans_that_are_none) {
  const Part part = part_of("cam");
  EXPECT_THAT(refusal_of([&] { roll_rig(part, evenly(0, 1, 4, {0.1, 0})); }), HasSubstr("above 0"));
  EXPECT_THAT(refusal_of([&] { roll_rig(part, evenly(0.3, 1, 4, {0, 0})); }), HasSubstr("found one that stays"));
  EXPECT_THAT(refusal_of([&] { roll_rig(part, evenly(0.3, 1, 4, {0.1, 0}, 1)); }), HasSubstr("at least 2 rows"));
  RigPlan plan = evenly(0.3, 1, 4, {0.1, 0});
  plan.pin = {};
  EXPECT_THAT(refusal_of([&] { roll_rig(part, plan); }), HasSubstr("how the pin"));
}

TEST(Rig, has_the_columns_that_its_wheel_measures) {
  const Log log = roll_rig(part_of("cam"), evenly(0.3, 1, 4.4, {-0.1, 0.03}, 3)).log;
  const auto header = [](const Log& one) { return format_log(one).substr(0, format_log(one).find('\n')); };
  EXPECT_EQ(header(sensed_by(WheelSensors::skin, log)), "time,u_a,psi_a,x_a,y_a,u_b,psi_b,x_b,y_b");
  EXPECT_EQ(header(sensed_by(WheelSensors::encoder, log)), "time,u_a,psi_a,x_a,y_a,psi_b,x_b,y_b");
  EXPECT_EQ(header(sensed_by(WheelSensors::pin, log)), "time,u_a,psi_a,x_a,y_a,x_b,y_b");
  EXPECT_EQ(header(one_finger(sensed_by(WheelSensors::encoder, log), 1)), "time,psi,x,y");
  EXPECT_EQ(header(one_finger(sensed_by(WheelSensors::pin, log), 1)), "time,x,y");
}

}  // namespace rollfix::rig_test
