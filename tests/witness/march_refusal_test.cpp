// What the paper excludes is refused with the reason and the place.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "march_oracle.hpp"
#include "march_shapes.hpp"
#include "rollfix/curve.hpp"
#include "rollfix/march.hpp"

namespace march_refusal_test {
namespace {

using namespace rollfix::march;
using namespace march_shapes;
using rollfix::InputError;
using testing::HasSubstr;

/// (u, u^power): an inflection of any order at 0, or a point without curvature.
struct Power {
  int power;
  Interval domain() const { return {-1, 1}; }
  double derivative(double u, int order) const {
    double factor = 1;
    for (int i = 0; i < order; ++i) factor *= power - i;
    return factor * std::pow(u, power - order);
  }
  Jet jet(double u) const {
    return {{u, derivative(u, 0)}, {1, derivative(u, 1)}, {0, derivative(u, 2)}, {0, derivative(u, 3)}};
  }
};

template <class Action>
void expect_refusal(Reason reason, double where, const Action& action) {
  try {
    action();
    ADD_FAILURE() << "no refusal";
  } catch (const Refusal& refusal) {
    EXPECT_EQ(refusal.reason(), reason) << refusal.what();
    EXPECT_NEAR(refusal.where(), where, 1e-5);
    EXPECT_THAT(refusal.what(), HasSubstr("expected"));
  }
}

void expect_refusal(Reason reason, double where, const rollfix::Outline& outline) {
  expect_refusal(reason, where, [&] { March(outline, curvature_density()); });
}

TEST(MarchRefusal, lines) {
  const Trigonometric half{{{1, 1, 0}}, {{1.5, 1, -kPi / 2}}, {0, kPi}};
  const rollfix::Outline bow{"bow", {half, rollfix::Line({-1, 0}, {1, 0})}, true, false};
  const double length = march_oracle::Exhaustive(outline_of("half", half, false)).perimeter();
  expect_refusal(Reason::line, length, bow);
}

TEST(MarchRefusal, circular_arcs) {
  expect_refusal(Reason::arc, 0, outline_of("circle", rollfix::Arc({0, 0}, 2, 0, 2 * kPi)));
}

TEST(MarchRefusal, corners) {
  const Trigonometric lower{{{1, 1, 0}}, {{1.5, 1, -kPi / 2}}, {kPi + 0.5, 2 * kPi - 0.5}};
  const Trigonometric upper{{{1, 1, 0}}, {{1.5, 1, -kPi / 2}}, {0.5, kPi - 0.5}};
  const double drop = 3 * std::sin(0.5);
  Trigonometric raised = lower;
  raised.y.push_back({drop, 0, 0});
  const double length = march_oracle::Exhaustive(outline_of("half", upper, false)).perimeter();
  expect_refusal(Reason::corner, length, {"lens", {upper, raised}, true, false});
}

TEST(MarchRefusal, inflections_that_are_not_simple) {
  const rollfix::Outline quintic = outline_of("u^5", Power{5}, false);
  const double middle = 0.5 * march_oracle::Exhaustive(quintic).perimeter();
  expect_refusal(Reason::degenerate_zero, middle, quintic);
  EXPECT_EQ(March(outline_of("u^3", Power{3}, false), curvature_density()).breakpoints().size(), 1U);
}

TEST(MarchRefusal, curvature_that_touches_zero) {
  expect_refusal(Reason::degenerate_zero,
                 0.5 * march_oracle::Exhaustive(outline_of("u^4", Power{4}, false)).perimeter(),
                 outline_of("u^4", Power{4}, false));
  // r = 1 + cos(4 u) / 17 has four points of zero curvature and is convex everywhere else
  const rollfix::Outline flat = outline_of("flat", polar(1, {{1.0 / 17, 4, 0}}));
  expect_refusal(Reason::degenerate_zero, march_oracle::Exhaustive(flat).perimeter() / 8, flat);
}

TEST(MarchRefusal, jumps_of_the_curvature_for_stationary_points_only) {
  // Two half ellipses with a common vertical axis meet smoothly, and with different curvature.
  const Trigonometric right{{{2, 1, 0}}, {{1, 1, -kPi / 2}}, {-kPi / 2, kPi / 2}};
  const Trigonometric left{{{1.3, 1, 0}}, {{1, 1, -kPi / 2}}, {kPi / 2, 3 * kPi / 2}};
  const rollfix::Outline egg_of_two{"two halves", {right, left}, true, false};
  EXPECT_NO_THROW(March(egg_of_two, curvature_density()));
  EXPECT_THROW(March(egg_of_two, curvature_rate_density()), Refusal);
}

TEST(MarchRefusal, a_density_that_is_zero_along_a_curve) {
  const auto positive_part = [](const Site& site) { return std::fmax(site.jet.position.y(), 0.0); };
  const Trigonometric upper{{{2, 1, 0}}, {{1, 1, -kPi / 2}}, {0, kPi}};
  const Trigonometric lower{{{2, 1, 0}}, {{1, 1, -kPi / 2}}, {kPi, 2 * kPi}};
  const rollfix::Outline halves{"halves", {upper, lower}, true, false};
  EXPECT_THROW(segments_with_integral(halves, positive_part, 1, 0.3), Refusal);
}

TEST(MarchRefusal, a_near_cusp_that_no_automatic_step_resolves) {
  EXPECT_THROW(March(ellipse(1, 1e-4), curvature_density()), Refusal);
  Options coarse;
  coarse.step = 0.05;
  const Result result = locate(ellipse(1, 0.005), {1, 1}, coarse);  // a given step is taken, and its error reported
  EXPECT_GT(result.integral_error, 0.01);
}

TEST(MarchRefusal, a_continuum_of_segments) {
  const double perimeter = march_oracle::Exhaustive(ellipse(2, 1)).perimeter();
  const March march(ellipse(2, 1), curvature_density());
  expect_refusal(Reason::continuum, 0, [&] { march.segments(0.5 * perimeter, kPi); });  // two-fold symmetry
  expect_refusal(Reason::continuum, 0, [&] { march.segments(perimeter, 2 * kPi); });
  expect_refusal(Reason::continuum, 0, [&] { march.segments(-3 * perimeter, -6 * kPi); });
  expect_refusal(Reason::continuum, 0, [&] { march.segments(0, 0); });
  expect_refusal(Reason::continuum, 0, [&] { stationary_points(ellipse(2, 1), 0.5 * perimeter); });
}

TEST(MarchRefusal, whole_loops_with_another_turn_fit_nowhere) {
  const double perimeter = march_oracle::Exhaustive(ellipse(2, 1)).perimeter();
  EXPECT_TRUE(locate(ellipse(2, 1), {perimeter, 2 * kPi + 1e-3}).segments.empty());
  EXPECT_TRUE(locate(ellipse(2, 1), {0.5 * perimeter, kPi + 1e-3}).segments.empty());
}

TEST(MarchRefusal, numbers_that_are_out_of_range) {
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_THROW(locate(ellipse(2, 1), {infinity, 1}), InputError);
  EXPECT_THROW(locate(ellipse(2, 1), {1, std::nan("")}), InputError);
  EXPECT_THROW(locate(open_wave(), {100, 1}), InputError);
  EXPECT_THROW(locate({"nothing", {}, true, false}, {1, 1}), InputError);
  for (const Options& bad : {Options{-1, 1e-11, 1e-8, 10, false}, Options{0, 0, 1e-8, 10, false},
                             Options{0, 1e-11, 0, 10, false}, Options{0, 1e-11, 1e-8, 0, false}}) {
    EXPECT_THROW(locate(ellipse(2, 1), {1, 1}, bad), InputError);
  }
}

}  // namespace
}  // namespace march_refusal_test
