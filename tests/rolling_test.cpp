// A disk that rolls on a part: what its sensors say, and where it can't go.
#include "rollfix/rolling.hpp"
#include "integrated_rolls.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <boost/numeric/odeint/integrate/integrate_const.hpp>
#include <boost/numeric/odeint/stepper/dense_output_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <ostream>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "random.hpp"
#include "refusal.hpp"
#include "rollfix/error.hpp"
#include "rollfix/outline.hpp"

namespace rollfix::rolling_test {
namespace {

using integrated_rolls::integrated_roll;
using testing::AllOf;
using testing::HasSubstr;
constexpr double kPi = std::numbers::pi;

Part part_of(const std::string& shape) { return Part(gallery(shape)); }

RollPlan by_distance(double start, double distance, std::size_t rows = 201) {
  RollPlan plan;
  plan.start = start;
  plan.distance = distance;
  plan.rows = rows;
  return plan;
}

RollPlan by_rotation(double start, double rotation, std::size_t rows = 201) {
  RollPlan plan;
  plan.start = start;
  plan.rotation = rotation;
  plan.rows = rows;
  return plan;
}

RollPlan by_profile(double start, double duration, std::function<double(double)> omega, std::size_t rows = 201) {
  RollPlan plan;
  plan.start = start;
  plan.duration = duration;
  plan.omega = std::move(omega);
  plan.rows = rows;
  return plan;
}

Contact contact_at(const Roll& roll, std::size_t row) {
  return {roll.log.fingers[0].u[row], roll.log.fingers[0].psi[row]};
}
Vec2 centre_at(const Roll& roll, std::size_t row) { return {roll.log.fingers[0].x[row], roll.log.fingers[0].y[row]}; }
Reading reading_at(const Roll& roll, const DiskFinger& finger, std::size_t row) {
  return reading_between(finger, contact_at(roll, 0), contact_at(roll, row));
}

/// The largest difference between two rolls in what the sensors read and where the contact is.
double difference(const Roll& a, const Roll& b, const DiskFinger& finger) {
  double most = a.s[0].size() == b.s[0].size() ? 0 : 1e300;
  for (std::size_t k = 0; k < a.s[0].size() && most < 1e300; ++k) {
    const Reading reading_a = reading_at(a, finger, k);
    const Reading reading_b = reading_at(b, finger, k);
    most = std::max({most, std::abs(a.s[0][k] - b.s[0][k]), std::abs(reading_a.length[0] - reading_b.length[0]),
                     std::abs(reading_a.turn - reading_b.turn), (centre_at(a, k) - centre_at(b, k)).norm(),
                     std::abs(a.angle[0][k] - b.angle[0][k])});
  }
  return most;
}

// --- Signs, on a disk of radius r on a circle of radius R: everything is known there.

TEST(Rolling, on_a_circle_all_signs_are_as_in_the_picture) {
  const double R = 2;
  const DiskFinger finger{0.5};
  const Part circle = part_of("circle,r=2");
  const double travelled = 0.75;  // angle around the circle's centre
  Roll found = roll(circle, finger, by_distance(0, R * travelled));
  EXPECT_NEAR(contact_at(found, 0).facing(), kPi,
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

// --- The integrated equations and the closed form which they imply.

struct Case {
  const char* shape;
  double radius;
  double start;  // share of the perimeter
  double laps;
};

void PrintTo(const Case& one, std::ostream* out) {
  *out << one.shape << " r=" << one.radius << " from " << one.start << " over " << one.laps;
}

class RollingCases : public testing::TestWithParam<Case> {};

TEST_P(RollingCases, integration_and_closed_form_agree) {
  const Case& one = GetParam();
  const Part part = part_of(one.shape);
  const RollPlan plan = by_distance(one.start * part.perimeter(), one.laps * part.perimeter(), 301);
  const Roll integrated = integrated_roll(part, {one.radius}, plan);
  const Roll closed = roll(part, {one.radius}, plan);
  EXPECT_LT(difference(integrated, closed, {one.radius}), 1e-9);
  EXPECT_NEAR(closed.s[0].back() - closed.s[0].front(), *plan.distance, 1e-12 * (1 + part.perimeter()));
}

TEST_P(RollingCases, readings_are_the_length_and_turn_of_the_boundary_between) {
  const Case& one = GetParam();
  const Part part = part_of(one.shape);
  const DiskFinger finger{one.radius};
  const Roll found = roll(part, finger, by_distance(one.start * part.perimeter(), one.laps * part.perimeter(), 97));
  for (std::size_t row = 1; row < found.s[0].size(); ++row) {
    const Reading reading = reading_at(found, finger, row);
    EXPECT_NEAR(reading.length[0], found.s[0][row] - found.s[0][0], 1e-9);
    constexpr double kNear = 1e-11;  // a corner's own place is known up to rounding
    const double before = part.turning().angle(found.s[0][row] - kNear) - found.angle[0][0];
    const double after = part.turning().angle(found.s[0][row] + kNear) - found.angle[0][0];
    EXPECT_GE(reading.turn, std::min(before, after) - 1e-9) << "row " << row;
    EXPECT_LE(reading.turn, std::max(before, after) + 1e-9) << "row " << row;
  }
}

INSTANTIATE_TEST_SUITE_P(Gallery, RollingCases,
                         testing::Values(Case{"circle", 0.3, 0.2, 0.7}, Case{"ellipse", 0.1, 0.123, 2.3},
                                         Case{"ellipse", 3, 0.9, -1.4}, Case{"superellipse", 0.1, 0.6, 1.1},
                                         Case{"limacon", 0.02, 0.123, 2.3}, Case{"limacon,a=1.05", 0.002, 0.2, -1.2},
                                         Case{"cam", 0.2, 0.5, 0.9}, Case{"gear", 0.02, 0.1, 1.5},
                                         Case{"spline", 0.1, 0.05, 2.1},
                                         Case{"spline,n=40,seed=3,wobble=0.05", 0.01, 0.77, -1.6},
                                         Case{"stadium", 0.5, 0, 1}, Case{"stadium", 0.1, 0.3, -2.3},
                                         Case{"rounded-rectangle", 0.1, 0.4, 1.2}, Case{"polygon", 0.1, 0.05, 1.7},
                                         Case{"polygon,n=3", 0.3, 0.4, -3.2}, Case{"reuleaux", 0.2, 0.1, 2.2},
                                         Case{"naca,digits=0012", 0.05, 0.9, 0.2}, Case{"log-spiral", 0.1, 0.1, 0.8},
                                         Case{"log-spiral", 0.1, 1, -1}, Case{"exponential", 0.2, 0, 1}));

TEST(Rolling, integration_and_closed_form_agree_on_random_splines) {
  std::mt19937_64 generator = test_generator(31);
  std::uniform_real_distribution<double> share(0, 1);
  for (int k = 0; k < test_count(20); ++k) {
    const Part part = part_of("spline,n=12,wobble=0.1,seed=" + std::to_string(generator() % 100000));
    const DiskFinger finger{0.02 + 0.05 * share(generator)};
    const RollPlan plan = by_distance(share(generator) * part.perimeter(), 4 * (share(generator) - 0.5), 41);
    EXPECT_LT(difference(integrated_roll(part, finger, plan), roll(part, finger, plan), finger), 1e-9)
        << part.name() << " r=" << finger.radius << " start=" << plan.start << " distance=" << *plan.distance;
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

// --- Corners.

TEST(Rolling, at_a_convex_corner_the_finger_pivots_in_place) {
  const Part square = part_of("polygon,n=4,r=1.4142135623730951");  // sides of length 2
  const DiskFinger finger{0.5};
  const Roll found = roll(square, finger, by_distance(1, 2, 801));
  std::size_t rows_at_corner = 0;
  for (std::size_t row = 0; row < found.s[0].size(); ++row) {
    const Reading reading = reading_at(found, finger, row);
    if (std::abs(found.s[0][row] - 2) > 1e-12) {
      EXPECT_NEAR(reading.turn, reading.length[0] < 1 ? 0 : kPi / 2, 1e-9);
      continue;
    }
    ++rows_at_corner;
    EXPECT_NEAR(reading.length[0], 1, 1e-9);
    EXPECT_GT(reading.turn, -1e-9);
    EXPECT_LT(reading.turn, kPi / 2 + 1e-9);
    EXPECT_NEAR((centre_at(found, row) - square.point(2)).norm(), finger.radius, 1e-9);
  }
  // The finger turns by 2 / 0.5 rad along the sides and by pi / 2 at the corner, at one speed.
  EXPECT_NEAR(static_cast<double>(rows_at_corner), 800 * (kPi / 2) / (4 + kPi / 2), 2);
}

TEST(Rolling, around_a_polygon_the_finger_turns_once_more_than_along_its_sides) {
  const Part triangle = part_of("polygon,n=3");
  const DiskFinger finger{0.2};
  const Roll found = roll(triangle, finger, by_distance(0.5, triangle.perimeter()));
  EXPECT_NEAR(found.log.fingers[0].psi.back() - found.log.fingers[0].psi.front(),
              triangle.perimeter() / finger.radius + 2 * kPi, 1e-9);
  EXPECT_NEAR(reading_at(found, finger, found.s[0].size() - 1).turn, 2 * kPi, 1e-9);
}

TEST(Rolling, a_rotation_can_end_in_the_middle_of_a_pivot) {
  const Part square = part_of("polygon,n=4,r=1.4142135623730951");
  const RollPlan plan = by_rotation(1, 1 / 0.5 + 0.3);
  for (const Roll& found : {integrated_roll(square, {0.5}, plan), roll(square, {0.5}, plan)}) {
    EXPECT_NEAR(found.s[0].back(), 2, 1e-12);
    EXPECT_NEAR(found.angle[0].back() - found.angle[0].front(), 0.3, 1e-9);
  }
}

TEST(Rolling, from_corner_to_corner_there_is_no_pivot) {
  const Part square = part_of("polygon,n=4,r=1.4142135623730951");
  for (const double side : {2.0, -2.0}) {
    for (const Roll& found :
         {integrated_roll(square, {0.5}, by_distance(4, side)), roll(square, {0.5}, by_distance(4, side))}) {
      EXPECT_NEAR(reading_at(found, {0.5}, found.s[0].size() - 1).turn, 0, 1e-12);
      EXPECT_NEAR(found.s[0].back(), 4 + side, 1e-12);
    }
  }
}

// --- Where a finger can't go.

TEST(Rolling, a_disk_too_big_for_a_concavity_is_told_where_and_how_big_it_may_be) {
  const Part part = part_of("limacon,a=1.2,b=1");
  // At the dimple, opposite to s = 0: curvature (a - 2b)/(a - b)^2 there, in polar form at u = pi.
  const double kappa = (1.2 - 2 * 1.0) / (0.2 * 0.2);
  const std::string message = refusal_of([&] { roll(part, {0.2}, by_distance(0, part.perimeter())); });
  EXPECT_THAT(message,
              AllOf(HasSubstr("radius 0.2 is too big"), HasSubstr("s = " + fmt::format("{:.7g}", part.perimeter() / 2)),
                    HasSubstr("(-0.2, "), HasSubstr(fmt::format("curvature is {:.6g}", kappa)),
                    HasSubstr(fmt::format("radius below {:.6g}", -1 / kappa))));
  EXPECT_NO_THROW(roll(part, {0.999 / -kappa}, by_distance(0, part.perimeter())));
  EXPECT_THROW(roll(part, {1.001 / -kappa}, by_distance(0, part.perimeter())), InputError);
}

TEST(Rolling, closed_form_and_integration_refuse_alike) {
  const Part part = part_of("limacon,a=1.2,b=1");
  for (const RollPlan& plan : {by_distance(0, 5), by_distance(0, -5), by_rotation(0.5, 60), by_rotation(0.5, -60),
                               by_distance(part.perimeter() / 2, 0.1)}) {
    const std::string integrated = refusal_of([&] { integrated_roll(part, {0.2}, plan); });
    EXPECT_EQ(integrated, refusal_of([&] { roll(part, {0.2}, plan); }));
    EXPECT_THAT(integrated, HasSubstr("radius below 0.05;"));
  }
}

TEST(Rolling, a_disk_too_big_for_a_concavity_may_still_roll_elsewhere) {
  const Part part = part_of("limacon,a=1.2,b=1");
  EXPECT_NO_THROW(roll(part, {5}, by_distance(-1, 2)));
}

TEST(Rolling, a_disk_that_almost_fills_a_concavity_still_rolls_through) {
  const Part part = part_of("limacon,a=1.2,b=1");
  const DiskFinger finger{0.05 * (1 - 1e-6)};
  const RollPlan plan = by_distance(0, part.perimeter());
  EXPECT_LT(difference(integrated_roll(part, finger, plan), roll(part, finger, plan), finger), 1e-6);
}

TEST(Rolling, a_concave_corner_is_refused_and_named) {
  const Outline notched = outline_through({{0, 0}, {4, 0}, {4, 3}, {2, 1}, {0, 3}}, "notched", {});
  const Part part(notched);
  const double at_notch = 4 + 3 + std::sqrt(8.0);
  for (const RollPlan& plan : {by_distance(8, 4), by_distance(11, -4), by_rotation(8, 100), by_distance(at_notch, 1),
                               by_distance(8, at_notch - 8)}) {
    const std::string message = refusal_of([&] { integrated_roll(part, {0.1}, plan); });
    EXPECT_THAT(message, AllOf(HasSubstr("notched"), HasSubstr("concave corner at s = 9.8284"), HasSubstr("(2, 1)"),
                               HasSubstr("-90 degrees"), HasSubstr("largest radius that would do is 0")));
    EXPECT_EQ(message, refusal_of([&] { roll(part, {0.1}, plan); }));
  }
  EXPECT_NO_THROW(integrated_roll(part, {0.1}, by_distance(8, 1.5)));
}

TEST(Rolling, an_open_part_ends) {
  const Part part = part_of("exponential");
  const double P = part.perimeter();
  EXPECT_NO_THROW(integrated_roll(part, {0.2}, by_distance(0, P)));
  EXPECT_NO_THROW(integrated_roll(part, {0.2}, by_distance(P, -P)));
  for (const RollPlan& plan : {by_distance(0, 1.01 * P), by_distance(0.1, -0.2), by_distance(-0.1, 1),
                               by_distance(P, 1), by_rotation(0, 1000), by_rotation(1, -1000)}) {
    const std::string message = refusal_of([&] { integrated_roll(part, {0.2}, plan); });
    EXPECT_THAT(message, HasSubstr("runs off the end"));
    EXPECT_EQ(message, refusal_of([&] { roll(part, {0.2}, plan); }));
  }
}

TEST(Rolling, plans_that_make_no_sense_are_refused) {
  const Part part = part_of("ellipse");
  const auto refusal = [&](const RollPlan& plan, double radius = 0.1) {
    return refusal_of([&] { roll(part, {radius}, plan); });
  };
  EXPECT_THAT(refusal({}), HasSubstr("exactly one of distance, rotation and duration"));
  RollPlan both = by_distance(0, 1);
  both.rotation = 1;
  EXPECT_THAT(refusal(both), HasSubstr("exactly one of"));
  RollPlan no_omega;
  no_omega.duration = 1;
  EXPECT_THAT(refusal(no_omega), HasSubstr("angular velocity"));
  EXPECT_THAT(refusal(by_distance(0, 0)), HasSubstr("distance of a roll other than 0"));
  EXPECT_THAT(refusal(by_rotation(0, NAN)), HasSubstr("finite rotation"));
  EXPECT_THAT(refusal(by_distance(INFINITY, 1)), HasSubstr("finite start"));
  EXPECT_THAT(refusal(by_distance(0, 1, 1)), HasSubstr("at least 2 rows"));
  EXPECT_THAT(refusal(by_distance(0, 1e9)), HasSubstr("100000 times the perimeter"));
  EXPECT_THAT(refusal(by_distance(0, 1), 0), HasSubstr("radius"));
  EXPECT_THAT(refusal(by_distance(0, 1), -1), HasSubstr("found -1"));
}

TEST(Rolling, too_few_rows_to_tell_wrapped_angles_apart_are_refused) {
  const Part part = part_of("circle");
  EXPECT_THAT(refusal_of([&] { roll(part, {0.5}, by_distance(0, 1.6, 2)); }), HasSubstr("take more rows"));
  EXPECT_NO_THROW(roll(part, {0.5}, by_distance(0, 1.6, 5)));
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
