// A disk at the corners of a part, and where it can't go.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>

#include "disk_rolls.hpp"
#include "integrated_rolls.hpp"
#include "refusal.hpp"
#include "rollfix/rolling.hpp"

namespace rollfix::track_test {
namespace {

using namespace disk_rolls;
using integrated_rolls::integrated_roll;
using testing::AllOf;
using testing::HasSubstr;
constexpr double kPi = std::numbers::pi;

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

}  // namespace
}  // namespace rollfix::track_test
