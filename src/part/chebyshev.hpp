#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace rollfix::chebyshev {

/// Values at, or coefficients over, the Chebyshev points of a panel: at most 17 and one more after integration.
inline constexpr int kMostTerms = 18;
using Series = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostTerms, 1>;

/// A matrix by columns, padded with zeros, for products with a series: vector instructions serve two rows at a time.
using Columns = std::array<std::array<Eigen::Array2d, kMostTerms / 2>, kMostTerms>;

/// The points cos(pi j / degree), from -1 to 1, and the matrix that turns values at them into coefficients.
class Grid {
 public:
  explicit Grid(int degree);
  int degree() const { return static_cast<int>(points_.size()) - 1; }
  const Series& points() const { return points_; }
  Series coefficients(const Series& values) const;

 private:
  Series points_;
  Columns transform_{};
};

/// The series' values at all of these x in [-1, 1], by Clenshaw's recurrence.
Series values(const Series& coefficients, const Series& x);

/// Coefficients of the antiderivative that vanishes at x = -1.
Series antiderivative(const Series& coefficients);

/// The same polynomial in powers of x. Safe here because a resolved panel's coefficients fall
/// faster than the conversion's factor (1 + sqrt 2)^k grows.
Series powers(const Series& coefficients);

/// The largest of the last three coefficients: what interpolation has not resolved.
double tail(const Series& coefficients);

/// Where a polynomial, given by its powers, changes sign strictly inside (-1, 1), in rising order.
/// All of them: an interval is left only when a bound on the polynomial, or on its derivative, excludes more.
std::vector<double> sign_changes(const Series& powers);

}  // namespace rollfix::chebyshev
