#include "chebyshev.hpp"

#include <cmath>
#include <numbers>

namespace rollfix::chebyshev {

Grid::Grid(int degree) : points_(degree + 1), transform_(degree + 1, degree + 1) {
  const double angle = std::numbers::pi / degree;
  for (int j = 0; j <= degree; ++j) points_[j] = std::sin(0.5 * angle * (2 * j - degree));  // exactly symmetric
  for (int k = 0; k <= degree; ++k) {
    for (int j = 0; j <= degree; ++j) {
      const bool end_point = j == 0 || j == degree;
      const bool end_order = k == 0 || k == degree;
      const double weight = (end_point ? 0.5 : 1.0) * (end_order ? 1.0 : 2.0) / degree;
      transform_(k, j) = weight * std::cos(angle * ((k * (degree - j)) % (2 * degree)));
    }
  }
}

Series values(const Series& coefficients, const Series& x) {
  const Eigen::Index count = x.size();
  const Series twice = 2 * x;
  Series next = Series::Zero(count);
  Series after = Series::Zero(count);
  for (Eigen::Index k = coefficients.size() - 1; k > 0; --k) {
    for (Eigen::Index j = 0; j < count; ++j) {
      const double current = coefficients[k] + twice[j] * next[j] - after[j];
      after[j] = next[j];
      next[j] = current;
    }
  }
  return ((x.array() * next.array() - after.array()) + coefficients[0]).matrix();
}

Series antiderivative(const Series& coefficients) {
  const Eigen::Index count = coefficients.size();
  Series result = Series::Zero(count + 1);
  const auto at = [&](Eigen::Index k) { return k < count ? coefficients[k] : 0.0; };
  result[1] = at(0) - 0.5 * at(2);
  for (Eigen::Index k = 2; k <= count; ++k) result[k] = (at(k - 1) - at(k + 1)) / (2.0 * static_cast<double>(k));
  double at_start = 0;  // T_k(-1) = (-1)^k
  for (Eigen::Index k = 1; k <= count; ++k) at_start += k % 2 == 0 ? result[k] : -result[k];
  result[0] = -at_start;
  return result;
}

namespace {

using Square = Eigen::Matrix<double, kMostTerms, kMostTerms>;

/// Row k holds the powers of T_k, by T_{k+1} = 2 x T_k - T_{k-1}.
Square polynomials() {
  Square table = Square::Zero();
  table(0, 0) = 1;
  table(1, 1) = 1;
  for (int k = 2; k < kMostTerms; ++k) {
    table.row(k).tail(kMostTerms - 1) = 2 * table.row(k - 1).head(kMostTerms - 1);
    table.row(k) -= table.row(k - 2);
  }
  return table;
}

}  // namespace

Series powers(const Series& coefficients) {
  static const Square table = polynomials();
  const Eigen::Index count = coefficients.size();
  return table.topLeftCorner(count, count).transpose() * coefficients;
}

double tail(const Series& coefficients) {
  double largest = 0;
  for (Eigen::Index k = std::max<Eigen::Index>(coefficients.size() - 3, 0); k < coefficients.size(); ++k) {
    largest = std::max(largest, std::abs(coefficients[k]));
  }
  return largest;
}

}  // namespace rollfix::chebyshev
