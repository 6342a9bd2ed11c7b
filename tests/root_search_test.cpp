// Polynomials through samples of f: where they have a value, and how sure that is.

#include "locate/root_search.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace root_search_test {
namespace {

using namespace rollfix;
using namespace rollfix::locating;

constexpr double kRoot = 0.37;

ResidualSample sample_of(double s, double value, double slope) { return {s, value, 0.25 * slope, 1.25 * slope}; }

/// A polynomial of degree 5 with a simple root.
ResidualSample quintic(double s) {
  const double x = s - kRoot;
  return sample_of(s, x * (2 + x * (0.5 - x * (1 - x * (0.7 + 0.3 * x)))), 2 + x * (1 - x * (3 - x * (2.8 + 1.5 * x))));
}

/// No polynomial.
ResidualSample sine(double s) { return sample_of(s, std::sin(s - kRoot), std::cos(s - kRoot)); }

template <class F>
QuinticRoot root_from(const F& f, double at) {
  return Quintic(at, f(0.3), f(0.6)).root(f(at), 0);
}

}  // namespace

TEST(Interpolation, of_a_polynomial_of_degree_five_has_its_root) {
  EXPECT_NEAR(root_from(quintic, 0.372).step, kRoot - 0.372, 1e-12);
}

TEST(Interpolation, between_the_others_says_by_how_much_it_is_off_at_the_most) {
  for (const double off : {0.1, 0.03, 0.01, -0.02}) {
    const double at = kRoot + off;
    const QuinticRoot root = root_from(sine, at);
    EXPECT_LE(std::abs(std::sin(at + root.step - kRoot)), root.rest) << off;
    EXPECT_LT(root.rest, 1e-4) << off;
  }
}

TEST(Interpolation, far_from_the_root_by_the_first_slope_is_not_sure) {
  // Nearly an extremum: the root is ten times further off than the slope says.
  const auto parabola = [](double s) { return sample_of(s, s * s - 1e-4, 2 * s); };
  const QuinticRoot root = Quintic(1e-4, parabola(0.5), parabola(0.9)).root(parabola(1e-4), 0);
  EXPECT_GT(root.rest, 1e-6);
}

TEST(Interpolation, beside_a_sample_goes_on_with_its_slope) {
  const ResidualSample at = quintic(0.371);
  const ResidualSample near = beside(at, quintic(0.3705), kRoot);
  EXPECT_NEAR(near.value, 0, 1e-8);
  EXPECT_NEAR(near.slope(), 2, 1e-5);
}

}  // namespace root_search_test
