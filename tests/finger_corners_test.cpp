// Fingers with corners: they pivot on them, by closed forms, by what touches, and as the limit of roundings.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "corner_fingers.hpp"
#include "refusal.hpp"
#include "rollfix/log.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/rolling.hpp"
#include "shapes.hpp"

namespace rollfix::finger_corners_test {
namespace {

using corner_fingers::square;
using shapes::kPi;
using testing::HasSubstr;

Part circle(double radius) { return Part(gallery(fmt::format("circle,r={}", radius))); }

RollPlan plan(double start, double u) {
  RollPlan plan;
  plan.start = start;
  plan.u = u;
  return plan;
}

Roll rolled(const Part& part, const Finger& finger, double distance, double u = 0, std::size_t rows = 101) {
  RollPlan by_distance = plan(1, u);
  by_distance.distance = distance;
  by_distance.rows = rows;
  return roll(part, finger, by_distance);
}

Roll turned(const Part& part, const Finger& finger, double rotation, double u = 0, double start = 1) {
  RollPlan by_rotation = plan(start, u);
  by_rotation.rotation = rotation;
  return roll(part, finger, by_rotation);
}

double length_after(const Part& part, const Finger& finger, double rotation) {
  const std::vector<double> s = turned(part, finger, rotation).s[0];
  return s.back() - s.front();
}

/// Of a square on a circle that turns from the middle of a side: L by its rotation.
double square_on_circle(double half, double radius, double rotation) {
  const double sides = std::floor((rotation - half / radius) / (2 * half / radius + kPi / 2)) + 1;  // that were begun
  const double last_corner = (2 * sides - 1) * half;
  if (sides < 1) return rotation * radius;
  return std::max(last_corner, (rotation - sides * kPi / 2) * radius);
}

double world_y(const Log& log, std::size_t row, const Vec2& on_finger, const Vec2& along) {
  const double psi = log.fingers[0].psi[row];
  const Vec2 place(log.fingers[0].x[row] + std::cos(psi) * on_finger.x() - std::sin(psi) * on_finger.y(),
                   log.fingers[0].y[row] + std::sin(psi) * on_finger.x() + std::cos(psi) * on_finger.y());
  return place.dot(along);
}

/// No corner of the finger is inside the part's tangent at the contact, and the contact is on the part.
void expect_touching(const Part& part, const corner_fingers::Polygon& polygon, const Finger& finger, const Roll& roll) {
  for (std::size_t row = 0; row < roll.s[0].size(); ++row) {
    const double tangent = corner_fingers::tangent_of(part, roll.s[0][row]);
    const Vec2 outwards(std::sin(tangent), -std::cos(tangent));
    const double contact = part.point(roll.s[0][row]).dot(outwards);
    EXPECT_NEAR(world_y(roll.log, row, finger.point(roll.log.fingers[0].u[row]), outwards), contact, 1e-9);
    for (const Vec2& corner : polygon.corners) EXPECT_GT(world_y(roll.log, row, corner, outwards), contact - 1e-5);
  }
}

TEST(FingerCorners, a_square_on_a_circle_stays_on_its_corners_as_the_closed_form_says) {
  const Roll roll = turned(circle(2), square(0.3).finger(), 5);
  for (std::size_t row = 0; row < roll.s[0].size(); ++row) {
    const double rotation = roll.log.fingers[0].psi[row] - roll.log.fingers[0].psi[0];
    EXPECT_NEAR(roll.s[0][row] - 1, square_on_circle(0.3, 2, rotation), 1e-12) << row;
  }
}

TEST(FingerCorners, backwards_it_is_the_same_the_other_way) {
  const Roll ahead = turned(circle(2), square(0.3).finger(), 5);
  const Roll back = turned(circle(2), square(0.3).finger(), -5);
  for (std::size_t row = 0; row < ahead.s[0].size(); ++row) EXPECT_NEAR(back.s[0][row] - 1, 1 - ahead.s[0][row], 1e-12);
}

TEST(FingerCorners, there_and_back_is_where_it_was) {
  RollPlan swing = plan(1, 0);
  swing.duration = 2 * kPi;
  swing.omega = [](double time) { return 3 * std::cos(time); };
  EXPECT_NEAR(roll(circle(2), square(0.3).finger(), swing).s[0].back(), 1, 1e-9);
}

TEST(FingerCorners, the_finger_touches_and_does_not_enter) {
  for (const auto& polygon : {square(0.1), corner_fingers::chamfered(0.1), corner_fingers::triangle(0.1)}) {
    const Part part(gallery("ellipse"));
    expect_touching(part, polygon, polygon.finger(), turned(part, polygon.finger(), 7));
  }
}

TEST(FingerCorners, roundings_tend_to_the_corner) {
  const Part part(gallery("ellipse"));
  for (const double rotation : {0.1, 0.6, 1.2, 2.9, 4.0}) {
    const double sharp = length_after(part, square(0.2).finger(), rotation);
    EXPECT_NEAR(length_after(part, corner_fingers::rounded_square(0.2, 1e-2), rotation), sharp, 2e-2);
    EXPECT_NEAR(length_after(part, corner_fingers::rounded_square(0.2, 1e-4), rotation), sharp, 2e-4);
    EXPECT_NEAR(length_after(part, corner_fingers::rounded_square(0.2, 1e-6), rotation), sharp, 2e-6);
  }
}

TEST(FingerCorners, both_pivots_add_up_where_corner_meets_corner) {
  const Part reuleaux(gallery("reuleaux"));
  const double first = reuleaux.corners()[1].s;
  const double half = 0.2;
  const Finger finger = square(half).finger();
  const Roll roll = turned(reuleaux, finger, 3, 0, first - half);  // the finger's corner meets the part's
  const double whole = reuleaux.corners()[1].turn + kPi / 2;
  EXPECT_NEAR(roll.log.fingers[0].psi.back() - roll.log.fingers[0].psi[0], 3, 1e-12);
  const double curvature = reuleaux.turning().curvature(first - 0.1);
  EXPECT_NEAR(roll.s[0].back() - first, (3 - whole - curvature * half) / curvature, 1e-9);
}

TEST(FingerCorners, a_start_on_a_corner_has_the_pivot_behind_it_and_an_end_ahead) {
  const Finger finger = square(0.3).finger();
  EXPECT_NEAR(turned(circle(2), finger, 0.2, -0.3).s[0].back(), 1 + 0.2 * 2, 1e-12);
  EXPECT_NEAR(turned(circle(2), finger, -0.2, 0.3).s[0].back(), 1 - 0.2 * 2, 1e-12);
  const Roll to_corner = rolled(circle(2), finger, 0.3);
  EXPECT_NEAR(to_corner.log.fingers[0].psi.back() - to_corner.log.fingers[0].psi[0], 0.3 / 2, 1e-9);
}

TEST(FingerCorners, an_open_finger_has_corners_between_its_ends_only) {
  const Finger jaw = Finger::outlined(shapes::polygon({{-1, 0.5}, {-0.5, 0}, {0.5, 0}, {1, 0.5}}, false));
  EXPECT_TRUE(jaw.has_corners());
  const double middle = jaw.ends().middle();
  EXPECT_NEAR(turned(circle(2), jaw, 0.25 + kPi / 4 + 0.1, middle).s[0].back(), 1 + 0.5 + 0.2, 1e-9);
  EXPECT_THAT(refusal_of([&] { rolled(circle(2), jaw, 1.5, middle); }), HasSubstr("runs off the end of the finger"));
}

TEST(FingerCorners, a_flat_side_does_not_roll_on_a_flat_side) {
  EXPECT_THAT(refusal_of([] { rolled(shapes::unit_square(), square(0.1).finger(), 0.3); }),
              HasSubstr("would lie flat where it and the part are straight"));
}

TEST(FingerCorners, a_concave_corner_is_refused) {
  EXPECT_THAT(refusal_of([] {
                Finger::outlined(shapes::polygon({{0, 0}, {1, 0}, {1, 1}, {0.5, 0.2}, {0, 1}}));
              }),
              HasSubstr("a concave corner of"));
}

TEST(FingerCorners, a_normal_is_an_interval_on_a_corner_alone) {
  const Finger finger = square(0.3).finger();
  EXPECT_NEAR(finger.normals(0.3).lo, -kPi / 2, 1e-12);
  EXPECT_NEAR(finger.normals(0.3).hi, 0, 1e-12);
  EXPECT_EQ(finger.normals(0.31).width(), 0);
  EXPECT_NEAR(finger.normals(0.31, 0.02).width(), kPi / 2, 1e-12);
  EXPECT_NEAR(finger.normals(0.3 - 2.4).hi, -2 * kPi, 1e-12) << "a lap before";
}

TEST(FingerCorners, between_rows_off_the_corners_the_turn_is_exact) {
  const Part part(gallery("ellipse"));
  const Finger finger = square(0.1).finger();
  const Roll roll = turned(part, finger, 9);
  for (const Reading& reading : readings_as_given(roll.log, {finger})) {
    const double turn = part.turning().angle(1 + reading.length[0]) - part.turning().angle(1);
    EXPECT_NEAR(reading.turn, turn, reading.pivot + 1e-9);
    EXPECT_TRUE(reading.is_exact() || reading.pivot < kPi / 4 + 1e-9);
  }
}

TEST(FingerCorners, slip_leaves_the_corner_elsewhere_on_the_part) {
  const Part part = circle(2);
  RollPlan by_rotation = plan(1, 0);
  by_rotation.rotation = 1;
  const NoisyRoll slipped = noisy_roll(part, square(0.3).finger(), by_rotation, {.slip = 0.1}, 4);
  const std::vector<double>& u = slipped.log.fingers[0].u;
  EXPECT_NEAR(u.back(), -0.3, 1e-12) << "in the pivot";
  EXPECT_NEAR(slipped.truth.s[0].back() - 1, 0.3 * (1 + slipped.error[0].slip), 1e-9);
}

}  // namespace
}  // namespace rollfix::finger_corners_test
