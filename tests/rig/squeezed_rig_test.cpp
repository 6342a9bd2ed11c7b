// A jaw and a wheel that a spring presses on the part: its force passes through both contacts.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "../random.hpp"
#include "../refusal.hpp"
#include "rigs.hpp"
#include "rollfix/rolling.hpp"

namespace rollfix::squeezed_rig_test {
namespace {

using rigs::gap_in;
using rigs::part_of;
using rigs::pin_in_jaw;
using rigs::squeezed;
using testing::HasSubstr;

constexpr double kRadius = 0.4;

Roll squeezed_roll(const Part& part, double s, double moved) {
  return roll_rig(part, squeezed(kRadius, s, squeezed_places(part, kRadius, s).at(0), moved));
}

/// By how much the line from the pin through the wheel's contact misses the jaw's contact.
double miss_in(const Roll& roll, std::size_t row) {
  const FingerRows& jaw = roll.log.fingers[0];
  const FingerRows& wheel = roll.log.fingers[1];
  const Vec2 to_jaw(jaw.x[row] + jaw.u[row] * std::cos(jaw.psi[row]) - wheel.x[row],
                    jaw.y[row] + jaw.u[row] * std::sin(jaw.psi[row]) - wheel.y[row]);
  return std::abs(to_jaw.dot(rigs::along(wheel.u[row] + wheel.psi[row] + std::numbers::pi / 2)));
}

/// How deep under the jaw the pin is while the jaw touches at s, the part having rolled on the jaw, and the pin is at
/// xi along it: the wheel's contact, near t, is where the closure along the jaw holds.
double depth_of_pin(const Part& part, double s_plus_u, double s, double xi, double t) {
  const double tangent = part.turning().angle(s);
  const auto pin = [&](double at) {
    const double angle = part.turning().angle(at);
    const Vec2 centre = part.point(at) + kRadius * Vec2(std::sin(angle), -std::cos(angle)) - part.point(s);
    return Vec2(s_plus_u - s - centre.dot(rigs::along(tangent)),
                centre.dot(Vec2(std::sin(tangent), -std::cos(tangent))));
  };
  double lo = t - 0.2;
  double hi = t + 0.2;
  const bool grows = pin(hi).x() > pin(lo).x();
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (lo + hi);
    ((pin(middle).x() < xi) == grows ? lo : hi) = middle;
  }
  return -pin(lo).y();
}

}  // namespace

TEST(SqueezedRig, has_its_force_through_both_contacts_in_every_row) {
  const Part part = part_of("ellipse");
  const Roll roll = squeezed_roll(part, 2.4, 1.5);
  for (std::size_t row = 0; row < roll.pose.size(); ++row) {
    EXPECT_LT(miss_in(roll, row), 1e-12);
    EXPECT_LT(gap_in(part, roll, kRadius, row), 1e-11);
  }
  EXPECT_NEAR(pin_in_jaw(roll, 50).x() - pin_in_jaw(roll, 0).x(), 1.5, 1e-12);
}

TEST(SqueezedRig, has_the_spring_at_rest_in_every_row) {
  // Rolled a little either way, with the pin where it is along the jaw, the spring would be pressed together.
  const Part part = part_of("ellipse");
  const Roll roll = squeezed_roll(part, 2.4, 1.5);
  for (std::size_t row = 0; row < roll.pose.size(); row += 10) {
    const double s = roll.s[0][row];
    const auto depth = [&](double step) {
      return depth_of_pin(part, s + roll.log.fingers[0].u[row], s + step, pin_in_jaw(roll, row).x(), roll.s[1][row]);
    };
    EXPECT_NEAR(depth(0), -pin_in_jaw(roll, row).y(), 1e-12);
    EXPECT_GT(depth(1e-3), depth(0));
    EXPECT_GT(depth(-1e-3), depth(0));
  }
}

TEST(SqueezedRig, lets_the_jaws_contact_turn_back_at_the_centre_of_curvature_and_rolls_on) {
  const Part part = part_of("ellipse");
  const Roll roll = squeezed_roll(part, 2.4, 2.1);
  const auto farthest = std::min_element(roll.s[0].begin(), roll.s[0].end());
  const auto row = static_cast<std::size_t>(farthest - roll.s[0].begin());
  ASSERT_GT(row, 0U);
  ASSERT_LT(row, roll.s[0].size() - 1);
  const double distance = (part.point(roll.s[0][row]) - part.point(roll.s[1][row])).norm();
  EXPECT_NEAR(part.turning().curvature(roll.s[1][row]) * distance, 1, 0.1);
}

TEST(SqueezedRig, stops_where_the_grip_is_not_stable_any_more) {
  const std::string why = refusal_of([] { squeezed_roll(part_of("ellipse"), 2.4, 4); });
  EXPECT_THAT(why, HasSubstr("the grip is not stable any more"));
  EXPECT_THAT(why, HasSubstr("the pin can move by 2.16"));
}

TEST(SqueezedRig, stops_where_the_part_gets_flat_under_the_jaw_and_says_so) {
  const Part part = part_of("superellipse");
  std::string why;
  for (double s = 0.02; s < part.perimeter() / 4; s += 0.1) {
    for (const double t : squeezed_places(part, kRadius, s)) {
      for (const double moved : {-1.0, 1.0}) {
        why += refusal_of([&] { roll_rig(part, squeezed(kRadius, s, t, moved)); }) + '\n';
      }
    }
  }
  EXPECT_THAT(why, HasSubstr("under the jaw the part is nearly flat"));
}

TEST(SqueezedRig, can_not_hold_a_circle) {
  // A ball between a plane and another ball pops out.
  EXPECT_TRUE(squeezed_places(part_of("circle,r=1"), kRadius, 0.3).empty());
  const double opposite = 0.3 + std::numbers::pi;
  EXPECT_THAT(refusal_of([&] { roll_rig(part_of("circle,r=1"), squeezed(kRadius, 0.3, opposite, 0.1)); }),
              HasSubstr("expected a stable grip"));
}

TEST(SqueezedRig, wants_a_wheel_opposite_to_the_jaw) {
  EXPECT_THAT(refusal_of([] { roll_rig(part_of("ellipse"), squeezed(kRadius, 2.4, 7.0, 0.1)); }),
              HasSubstr("whose normal passes through the jaw's contact"));
}

}  // namespace rollfix::squeezed_rig_test
