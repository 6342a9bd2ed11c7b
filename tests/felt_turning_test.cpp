// The tangent that is felt about a place, where the integral over the place's error has a closed form.
#include <gtest/gtest.h>

#include <cmath>

#include "belief/two/pair_filter.hpp"
#include "rollfix/outline.hpp"
#include "shapes.hpp"

namespace felt_turning_test {
namespace {

using rollfix::belief::Felt;
using rollfix::belief::FeltTurning;
using shapes::kPi;

TEST(FeltTurning, on_a_circle_is_off_by_the_contacts_error_under_both_curvatures) {
  const rollfix::Part circle(rollfix::gallery("circle,r=2"));
  const double sd = 0.01;
  const double normal_turn = 3;
  const Felt felt = FeltTurning(circle.turning(), sd, 0, normal_turn, 1e-6).at(1);
  EXPECT_NEAR(felt.angle, circle.turning().angle(1), 1e-6);
  EXPECT_NEAR(std::sqrt(felt.variance), (0.5 + normal_turn) * sd, 1e-4 * sd);
}

TEST(FeltTurning, at_a_corner_is_any_direction_of_the_pivot_alike) {
  const rollfix::Part square = shapes::unit_square();
  const double far = 100;  // the finger's centre goes all along the pivot, next to which the sides are nothing
  const Felt felt = FeltTurning(square.turning(), 1e-3, far, 0, 1e-4).at(1);
  EXPECT_NEAR(felt.angle, square.turning().angle(0.5) + kPi / 4, 1e-3);
  EXPECT_NEAR(felt.variance, (kPi / 2) * (kPi / 2) / 12, 1e-3);
}

}  // namespace
}  // namespace felt_turning_test
