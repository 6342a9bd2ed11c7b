// What turns values at Chebyshev points into polynomials.

#include "part/chebyshev.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <vector>

namespace chebyshev_test {
namespace {

using namespace rollfix::chebyshev;

constexpr int kDegree = 16;
using Powers = Terms<kDegree>;
const Grid<kDegree>& grid = Grid<kDegree>::instance();

/// Powers that fall as those of a resolved panel do.
Powers falling_powers() {
  Powers powers = Powers::Zero();
  for (int k = 0; k <= kDegree; ++k) powers[k] = std::cos(1.0 + 2 * k) * std::pow(4.0, -k);
  return powers;
}

double value(const Powers& powers, double x) { return values(powers, Eigen::Array<double, 1, 1>(x))[0]; }

TEST(Chebyshev, finds_the_polynomial_through_its_values) {
  const Powers powers = falling_powers();
  Powers at_points = Powers::Zero();
  for (int j = 0; j <= kDegree; ++j) at_points[j] = value(powers, grid.point(j));
  const Powers found = grid.powers(grid.coefficients(at_points));
  for (double x = -1; x <= 1; x += 1.0 / 64) EXPECT_NEAR(value(found, x), value(powers, x), 1e-15);
}

TEST(Chebyshev, knows_a_polynomial_on_either_half) {
  const Powers powers = falling_powers();
  const auto [first, second] = grid.halves(powers);
  for (double y = -1; y <= 1; y += 1.0 / 64) {
    EXPECT_NEAR(value(first, y), value(powers, 0.5 * (y - 1)), 1e-15);
    EXPECT_NEAR(value(second, y), value(powers, 0.5 * (y + 1)), 1e-15);
  }
}

TEST(Chebyshev, integrates_from_the_start) {
  Powers powers = Powers::Zero();
  powers[0] = 3;
  powers[2] = 6;
  const Powers integral = antiderivative(powers, 0.5);
  for (double x = -1; x <= 1; x += 1.0 / 64) EXPECT_NEAR(value(integral, x), 0.5 * (3 * x + 2 * x * x * x + 5), 1e-15);
}

std::vector<double> sign_changes_of(std::initializer_list<double> terms) {
  Series powers = Series::Zero(static_cast<Eigen::Index>(terms.size()));
  std::copy(terms.begin(), terms.end(), powers.data());
  return sign_changes(powers);
}

/// Halving begins at 0, so that the root there is an end of both halves.
TEST(Chebyshev, finds_a_sign_change_at_an_end_of_its_halves_whichever_way_it_goes) {
  EXPECT_THAT(sign_changes_of({0, -1, 0, 0.9}), testing::ElementsAre(0));
  EXPECT_THAT(sign_changes_of({0, 1, 0, -0.9}), testing::ElementsAre(0));
  EXPECT_THAT(sign_changes_of({0, 0, 0, -1}), testing::ElementsAre(0));
}

TEST(Chebyshev, of_a_double_root_finds_no_sign_change) {
  EXPECT_THAT(sign_changes_of({0, 0, 1}), testing::IsEmpty());
  EXPECT_THAT(sign_changes_of({0, 0, -1, 0, 0.5}), testing::IsEmpty());
}

}  // namespace
}  // namespace chebyshev_test
