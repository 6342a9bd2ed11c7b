// The march's only source of lengths and turns: quadrature over steps of the parameter.

#include <gtest/gtest.h>

#include <cmath>

#include <boost/math/special_functions/ellint_2.hpp>

#include "march/path.hpp"
#include "march/sweep.hpp"
#include "march_shapes.hpp"

namespace march_integration_test {
namespace {

using namespace rollfix::march;
using namespace march_shapes;

/// Arc length of the ellipse (2 cos u, sin u) from u = 0, by the incomplete elliptic integral.
double ellipse_length(double u) {
  const double k = std::sqrt(0.75);
  return 2 * (boost::math::ellint_2(k) - boost::math::ellint_2(k, kPi / 2 - u));
}

double perimeter_error(double step) {
  const Path path(ellipse(2, 1), curvature_density(), step);
  return std::fabs(preprocess(path).loop.length - ellipse_length(2 * kPi));
}

TEST(MarchIntegration, perimeter_and_total_curvature_come_out_to_rounding_at_the_automatic_step) {
  const Path path(ellipse(2, 1), curvature_density(), 0);
  const Span loop = preprocess(path).loop;
  EXPECT_NEAR(loop.length, ellipse_length(2 * kPi), 1e-14 * loop.length);
  EXPECT_NEAR(loop.integral, 2 * kPi, 1e-14);
}

TEST(MarchIntegration, five_gauss_points_are_of_order_ten_on_an_open_curve) {
  const auto error = [](int steps) {
    const Trigonometric quarter{{{2, 1, 0}}, {{1, 1, -kPi / 2}}, {0.1, 1.5}};
    const Path path(outline_of("arc", quarter, false), curvature_density(), 1.4 / steps);
    return std::fabs(preprocess(path).loop.length - (ellipse_length(1.5) - ellipse_length(0.1)));
  };
  EXPECT_GT(error(2), 300 * error(4));  // 2^10 in the limit, which rounding hides
  EXPECT_LT(error(8), 1e-13);
}

TEST(MarchIntegration, a_given_step_divides_the_parameter_range_evenly) {
  const Path path(ellipse(2, 1), curvature_density(), 0.1);
  EXPECT_EQ(path.steps_per_loop(), 63U);  // 2 pi / 0.1, rounded up
  EXPECT_DOUBLE_EQ(path.step(0, 62).hi, 2 * kPi);
  EXPECT_LT(perimeter_error(0.1), 1e-14);
}

TEST(MarchIntegration, a_walker_lands_on_a_length_wherever_it_lies_within_its_step) {
  const Path path(ellipse(2, 1), curvature_density(), 0.05);
  Tally tally;
  Walker walker(path, first_position(path), tally);
  for (const double u : {0.01, 0.1, 0.249, 0.26, 1.0, 2.0, 2.0001, 3.0}) {
    walker.to_length(ellipse_length(u));
    EXPECT_NEAR(walker.position().u, u, 1e-13);
    const double turn = std::atan2(std::cos(u), -2 * std::sin(u)) - kPi / 2;
    EXPECT_NEAR(std::remainder(walker.integral() - turn, 2 * kPi), 0, 1e-13);
  }
  EXPECT_EQ(tally.steps, 60U);  // steps of 2 pi / 126 passed on the way to u = 3, wherever it stopped
}

TEST(MarchIntegration, a_walker_lands_on_a_turn_and_goes_round_the_loop_again) {
  const Path path(ellipse(2, 1), curvature_density(), 0.05);
  Tally tally;
  Walker walker(path, first_position(path), tally);
  EXPECT_TRUE(walker.to_integral(2 * kPi + kPi / 4, 1, 100.0));
  const double u = std::atan2(std::sin(kPi / 4), 2 * std::cos(kPi / 4));  // tangent (-2 sin u, cos u) turned by 45 deg
  EXPECT_NEAR(walker.length(), ellipse_length(2 * kPi) + ellipse_length(u), 1e-13);
}

TEST(MarchIntegration, a_walker_stops_at_the_end_of_its_mode_when_the_turn_is_not_reached_there) {
  const Path path(ellipse(2, 1), curvature_density(), 0.05);
  Tally tally;
  Walker walker(path, first_position(path), tally);
  EXPECT_FALSE(walker.to_integral(kPi, 1, 2.0));
  EXPECT_EQ(walker.length(), 2.0);
}

TEST(MarchIntegration, a_chain_of_curves_is_stepped_curve_by_curve) {
  const Trigonometric first{{{2, 1, 0}}, {{1, 1, -kPi / 2}}, {0, 2}};
  const Trigonometric second{{{2, 1, 0}}, {{1, 1, -kPi / 2}}, {2, 2 * kPi}};
  const Path path({"ellipse in two", {first, second}, true, false}, curvature_density(), 0.05);
  const Preprocessed prepared = preprocess(path);
  EXPECT_EQ(path.steps(0) + path.steps(1), path.steps_per_loop());
  EXPECT_NEAR(prepared.curve_starts[1], ellipse_length(2), 1e-13);
  EXPECT_NEAR(prepared.loop.length, ellipse_length(2 * kPi), 1e-12);
}

}  // namespace
}  // namespace march_integration_test
