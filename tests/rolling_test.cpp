// A disk that rolls on a part: what its sensors say.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <boost/numeric/odeint/integrate/integrate_const.hpp>
#include <boost/numeric/odeint/stepper/dense_output_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "disk_rolls.hpp"
#include "integrated_rolls.hpp"
#include "rollfix/rolling.hpp"

namespace rollfix::rolling_test {
namespace {

using namespace disk_rolls;
using integrated_rolls::integrated_roll;
constexpr double kPi = std::numbers::pi;

// --- Signs, on a disk of radius r on a circle of radius R: everything is known there.

TEST(Rolling, on_a_circle_all_signs_are_as_in_the_picture) {
  const double R = 2;
  const DiskFinger finger{0.5};
  const Part circle = part_of("circle,r=2");
  const double travelled = 0.75;  // angle around the circle's centre
  Roll found = roll(circle, finger, by_distance(0, R * travelled));
  EXPECT_NEAR(contact_at(found, 0).normal_direction(), kPi,
              1e-12);  // it touches (2, 0) from outside: its contact lies to the left
  EXPECT_NEAR(found.log.fingers[0].x.front(), R + finger.radius, 1e-12);
  EXPECT_NEAR(found.log.fingers[0].y.front(), 0, 1e-12);
  EXPECT_NEAR(found.log.fingers[0].u.back() - found.log.fingers[0].u.front(), -R * travelled / finger.radius, 1e-10);
  EXPECT_NEAR(found.log.fingers[0].psi.back() - found.log.fingers[0].psi.front(), travelled * (1 + R / finger.radius),
              1e-10);
  EXPECT_NEAR(found.log.fingers[0].x.back(), (R + finger.radius) * std::cos(travelled), 1e-10);
  EXPECT_NEAR(found.log.fingers[0].y.back(), (R + finger.radius) * std::sin(travelled), 1e-10);
  const Reading reading = reading_at(found, finger, found.s[0].size() - 1);
  EXPECT_NEAR(reading.length[0], R * travelled, 1e-10);
  EXPECT_NEAR(reading.turn, travelled, 1e-10);
}

TEST(Rolling, a_coin_around_an_equal_coin_turns_twice) {
  const Part coin = part_of("circle,r=1");
  const Roll found = roll(coin, {1}, by_distance(0, coin.perimeter()));
  EXPECT_NEAR(found.log.fingers[0].psi.back() - found.log.fingers[0].psi.front(), 4 * kPi, 1e-10);
}

TEST(Rolling, backwards_turns_every_sign_around) {
  const Part circle = part_of("circle,r=2");
  const DiskFinger finger{0.5};
  const Roll found = roll(circle, finger, by_distance(1, -1.5));
  const Reading reading = reading_at(found, finger, found.s[0].size() - 1);
  EXPECT_NEAR(reading.length[0], -1.5, 1e-10);
  EXPECT_NEAR(reading.turn, -0.75, 1e-10);
  EXPECT_LT(found.log.fingers[0].psi.back(), found.log.fingers[0].psi.front());
  EXPECT_GT(found.log.fingers[0].u.back(), found.log.fingers[0].u.front());
}

TEST(Rolling, a_straight_side_turns_nothing_but_the_finger) {
  const Part square = part_of("polygon,n=4,r=2");
  const DiskFinger finger{0.25};
  const Roll found = roll(square, finger, by_distance(0.5, 1));
  const Reading reading = reading_at(found, finger, found.s[0].size() - 1);
  EXPECT_NEAR(reading.length[0], 1, 1e-12);
  EXPECT_NEAR(reading.turn, 0, 1e-12);
  EXPECT_NEAR(found.log.fingers[0].psi.back(), 1 / finger.radius, 1e-12);
}

TEST(Rolling, contact_after_a_reading_gives_that_reading_back) {
  const DiskFinger finger{0.37};
  const Contact first{2.5, -1.25};
  const Contact last = contact_after(finger, first, {-3.5, 7.75});
  const Reading reading = reading_between(finger, first, last);
  EXPECT_NEAR(reading.length[0], -3.5, 1e-14);
  EXPECT_NEAR(reading.turn, 7.75, 1e-14);
}

// --- What rolling is, without any formula of ours.

TEST(Rolling, the_fingers_point_in_contact_is_at_rest) {
  const Part part = part_of("limacon");
  const DiskFinger finger{0.1};
  const Roll found = roll(part, finger, by_distance(0.3, 5, 4001));
  const auto material_point = [&](double u, std::size_t row) {
    const double direction = u + found.log.fingers[0].psi[row];
    return Vec2(centre_at(found, row) + finger.radius * Vec2(std::cos(direction), std::sin(direction)));
  };
  for (std::size_t row = 1; row + 1 < found.s[0].size(); row += 97) {
    const double u = found.log.fingers[0].u[row];
    EXPECT_LT((material_point(u, row) - part.point(found.s[0][row])).norm(), 1e-11);
    const double moved = (material_point(u, row + 1) - material_point(u, row - 1)).norm();
    const double centre_moved = (centre_at(found, row + 1) - centre_at(found, row - 1)).norm();
    EXPECT_LT(moved, 0.01 * centre_moved) << "row " << row;
  }
}

TEST(Rolling, the_finger_stays_outside_the_part) {
  const Part part = part_of("ellipse");
  const DiskFinger finger{0.4};
  const Roll found = roll(part, finger, by_distance(0, part.perimeter(), 61));
  const std::vector<Vec2> boundary = part.polyline(0, part.perimeter(), 2000);
  for (std::size_t row = 0; row < found.s[0].size(); ++row) {
    double nearest = 1e300;
    for (const Vec2& point : boundary) nearest = std::min(nearest, (point - centre_at(found, row)).norm());
    EXPECT_NEAR(nearest, finger.radius, 1e-4);
    const Vec2 centre = centre_at(found, row);
    EXPECT_GT(centre.x() * centre.x() / 4 + centre.y() * centre.y(), 1);
  }
}

/// Eqs. (1) and (2) as the paper has them, in the curve's own parameter, on a part of one smooth curve. Shares nothing
/// with the library but the curve.
struct Paper {
  const Curve& curve;
  double r;
  double omega;
  using State = std::array<double, 2>;  // u, parameter

  void operator()(const State& state, State& rate, double /*time*/) const {
    const Jet jet = curve.jet(state[1]);
    const double kappa = cross(jet.first, jet.second) / std::pow(jet.first.norm(), 3);
    rate[0] = -omega / (1 + r * kappa);
    rate[1] = omega / (jet.first.norm() * (1 / r + kappa));
  }
};

TEST(Rolling, agrees_with_the_papers_equations_in_the_curves_own_parameter) {
  namespace odeint = boost::numeric::odeint;
  for (const char* shape : {"ellipse", "limacon", "cam", "gear,teeth=5,depth=0.08"}) {
    const Part part = part_of(shape);
    ASSERT_EQ(part.outline().curves.size(), 1U) << shape;
    const DiskFinger finger{0.1};
    const Roll found = roll(part, finger, by_distance(0, 0.8 * part.perimeter(), 51));
    const Paper paper{part.outline().curves.front(), finger.radius, 1};
    Paper::State state{found.log.fingers[0].u.front(), paper.curve.domain().lo};
    std::size_t row = 0;
    const auto compare = [&](const Paper::State& now, double /*time*/) {
      ASSERT_LT(row, found.s[0].size());
      EXPECT_NEAR(now[0], found.log.fingers[0].u[row], 1e-9) << shape << " row " << row;
      EXPECT_LT((paper.curve.position(now[1]) - part.point(found.s[0][row])).norm(), 1e-9) << shape << " row " << row;
      ++row;
    };
    const auto stepper = odeint::make_dense_output(1e-13, 1e-13, odeint::runge_kutta_dopri5<Paper::State>());
    const double step = found.log.time[1];
    odeint::integrate_const(stepper, paper, state, 0.0, found.log.time.back() + step / 2, step, compare);
    EXPECT_EQ(row, found.s[0].size()) << shape;
  }
}

// --- How the robot turns the finger.

TEST(Rolling, a_rotation_turns_the_finger_by_just_that) {
  const Part part = part_of("ellipse");
  for (const double rotation : {7.5, -20.0}) {
    const Roll found = integrated_roll(part, {0.1}, by_rotation(1, rotation));
    EXPECT_NEAR(found.log.fingers[0].psi.back() - found.log.fingers[0].psi.front(), rotation, 1e-12);
    EXPECT_LT(difference(found, roll(part, {0.1}, by_rotation(1, rotation)), {0.1}), 1e-9);
  }
}

TEST(Rolling, speed_changes_the_times_and_nothing_else) {
  const Part part = part_of("limacon");
  RollPlan plan = by_distance(0.4, 2);
  const Roll slow = roll(part, {0.1}, plan);
  plan.speed = 4;
  const Roll fast = roll(part, {0.1}, plan);
  EXPECT_EQ(difference(slow, fast, {0.1}), 0);
  EXPECT_NEAR(slow.log.time.back(), 4 * fast.log.time.back(), 1e-12 * slow.log.time.back());
}

TEST(Rolling, a_profile_that_swings_forth_and_back_returns_to_the_start) {
  const auto omega = [](double time) { return 20 * std::sin(time); };
  for (const char* shape : {"limacon", "stadium", "polygon", "reuleaux", "spline"}) {
    const Part part = part_of(shape);
    const RollPlan plan = by_profile(0.1, 2 * kPi, omega);
    const Roll found = integrated_roll(part, {0.1}, plan);
    EXPECT_NEAR(found.s[0].back(), found.s[0].front(), 1e-10) << shape;
    EXPECT_NEAR(found.log.fingers[0].psi[100] - found.log.fingers[0].psi[0], 40, 1e-10) << shape;
    EXPECT_LT(difference(found, roll(part, {0.1}, plan), {0.1}), 1e-9) << shape;
  }
}

TEST(Rolling, orientation_at_the_start_shifts_psi_and_turns_u_back) {
  const Part part = part_of("ellipse");
  RollPlan plan = by_distance(1, 1);
  const Roll plain = roll(part, {0.2}, plan);
  plan.psi = 1.25;
  const Roll turned = roll(part, {0.2}, plan);
  EXPECT_NEAR(turned.log.fingers[0].psi[50] - plain.log.fingers[0].psi[50], 1.25, 1e-12);
  EXPECT_NEAR(std::remainder(turned.log.fingers[0].u[50] - plain.log.fingers[0].u[50] + 1.25, 2 * kPi), 0, 1e-12);
  EXPECT_NEAR(turned.log.fingers[0].x[50], plain.log.fingers[0].x[50], 1e-12);
}

TEST(Rolling, the_start_may_be_given_on_any_lap) {
  const Part part = part_of("ellipse");
  const Roll once = roll(part, {0.2}, by_distance(1, 1));
  const Roll again = roll(part, {0.2}, by_distance(1 - 3 * part.perimeter(), 1));
  EXPECT_LT(difference(once, again, {0.2}), 1e-12);
}

// --- An outline that was given in the other direction.

/// How far a curve's tangent turns between two parameters, by looking at many places: no formula of ours.
double turn_along(const Curve& curve, double from, double to) {
  constexpr int kLooks = 4000;
  double turn = 0;
  Vec2 last = curve.velocity(from);
  for (int k = 1; k <= kLooks; ++k) {
    const Vec2 next = curve.velocity(from + (to - from) * k / kLooks);
    turn += std::atan2(cross(last, next), last.dot(next));
    last = next;
  }
  return turn;
}

double length_along(const Curve& curve, double from, double to) {
  constexpr int kLooks = 400000;
  double length = 0;
  for (int k = 0; k < kLooks; ++k) length += curve.velocity(from + (to - from) * (k + 0.5) / kLooks).norm();
  return length * (to - from) / kLooks;
}

TEST(Rolling, against_the_given_direction_the_length_changes_its_sign_and_the_turn_does_not) {
  Outline given = reversed(gallery("limacon"));
  given.reversed = false;  // a user draws it clockwise
  const Part part(given);
  ASSERT_TRUE(part.reversed());
  const Curve& curve = given.curves.front();
  const double u0 = curve.domain().lo + 0.2 * curve.domain().width();
  const double u1 = curve.domain().lo + 0.45 * curve.domain().width();
  const Reading as_given{length_along(curve, u0, u1), turn_along(curve, u0, u1)};
  const Reading stored = in_stored_direction(as_given, part);

  const double s0 = part.perimeter() - length_along(curve, curve.domain().lo, u0);  // s = P - s'
  EXPECT_LT((part.point(s0) - curve.position(u0)).norm(), 1e-6);
  EXPECT_LT((part.point(s0 + stored.length[0]) - curve.position(u1)).norm(), 1e-6);
  EXPECT_NEAR(part.turning().angle(s0 + stored.length[0]) - part.turning().angle(s0), stored.turn, 1e-6);
}

}  // namespace
}  // namespace rollfix::rolling_test
