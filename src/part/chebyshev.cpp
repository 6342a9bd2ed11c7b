#include "chebyshev.hpp"

#include <array>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

namespace rollfix::chebyshev {

namespace {

using Pair = Eigen::Array2d;  // one vector instruction serves both

void set(Columns& columns, int row, int column, double value) {
  columns[static_cast<std::size_t>(column)][static_cast<std::size_t>(row / 2)][row % 2] = value;
}

/// The sums stay in registers.
template <std::size_t Pairs>
Series combined(const Columns& columns, const Series& weights) {
  std::array<Pair, kMostTerms / 2> sums;
  for (std::size_t i = 0; i < Pairs; ++i) sums[i] = Pair::Zero();
  for (Eigen::Index k = 0; k < weights.size(); ++k) {
    const auto& column = columns[static_cast<std::size_t>(k)];
    for (std::size_t i = 0; i < Pairs; ++i) sums[i] += column[i] * weights[k];
  }
  Series result(weights.size());
  for (Eigen::Index k = 0; k < result.size(); ++k) result[k] = sums[static_cast<std::size_t>(k / 2)][k % 2];
  return result;
}

/// The product of the square part of a matrix with a series.
Series product(const Columns& columns, const Series& weights) {
  constexpr std::size_t kHalf = 5;  // a coarse grid's
  return weights.size() <= static_cast<Eigen::Index>(2 * kHalf) ? combined<kHalf>(columns, weights)
                                                                : combined<kMostTerms / 2>(columns, weights);
}

}  // namespace

Grid::Grid(int degree) : points_(degree + 1) {
  const double angle = std::numbers::pi / degree;
  for (int j = 0; j <= degree; ++j) points_[j] = std::sin(0.5 * angle * (2 * j - degree));  // exactly symmetric
  for (int k = 0; k <= degree; ++k) {
    for (int j = 0; j <= degree; ++j) {
      const bool end_point = j == 0 || j == degree;
      const bool end_order = k == 0 || k == degree;
      const double weight = (end_point ? 0.5 : 1.0) * (end_order ? 1.0 : 2.0) / degree;
      set(transform_, k, j, weight * std::cos(angle * ((k * (degree - j)) % (2 * degree))));
    }
  }
}

Series Grid::coefficients(const Series& values) const { return product(transform_, values); }

namespace {

// So many pairs are summed up abreast: they stay in registers, and none waits for another's sums.
constexpr std::size_t kAbreast = 4;
constexpr Eigen::Index kPlaces = 2 * kAbreast;
constexpr Eigen::Index kPadded = (kMostTerms + kPlaces - 1) / kPlaces * kPlaces;

/// The sums of Clenshaw's recurrence, one pair of places each: two steps at a time, so that none has to be moved.
void sum_abreast(const Series& coefficients, const double* x, double* sums) {
  std::array<Pair, kAbreast> twice, next, after;
  for (std::size_t i = 0; i < kAbreast; ++i) {
    twice[i] = 2 * Eigen::Map<const Pair>(x + 2 * i);
    next[i] = after[i] = Pair::Zero();
  }
  Eigen::Index k = coefficients.size() - 1;
  if (k % 2 != 0) {
    for (std::size_t i = 0; i < kAbreast; ++i) next[i] = coefficients[k] + twice[i] * next[i] - after[i];
    --k;
  }
  for (; k > 0; k -= 2) {
    for (std::size_t i = 0; i < kAbreast; ++i) after[i] = coefficients[k] + twice[i] * next[i] - after[i];
    for (std::size_t i = 0; i < kAbreast; ++i) next[i] = coefficients[k - 1] + twice[i] * after[i] - next[i];
  }
  for (std::size_t i = 0; i < kAbreast; ++i) {
    Eigen::Map<Pair>(sums + 2 * i) = (Eigen::Map<const Pair>(x + 2 * i) * next[i] - after[i]) + coefficients[0];
  }
}

}  // namespace

Series values(const Series& coefficients, const Series& x) {
  Eigen::Array<double, kPadded, 1> places = Eigen::Array<double, kPadded, 1>::Zero();
  places.head(x.size()) = x.array();
  Eigen::Array<double, kPadded, 1> sums;
  for (Eigen::Index first = 0; first < x.size(); first += kPlaces) {
    sum_abreast(coefficients, places.data() + first, sums.data() + first);
  }
  return sums.head(x.size()).matrix();
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

/// Column k holds the powers of T_k, by T_{k+1} = 2 x T_k - T_{k-1}.
Columns polynomials() {
  Eigen::Matrix<double, kMostTerms, kMostTerms> table = Eigen::Matrix<double, kMostTerms, kMostTerms>::Zero();
  table(0, 0) = 1;
  table(1, 1) = 1;
  for (int k = 2; k < kMostTerms; ++k) {
    table.col(k).tail(kMostTerms - 1) = 2 * table.col(k - 1).head(kMostTerms - 1);
    table.col(k) -= table.col(k - 2);
  }
  Columns columns;
  for (int k = 0; k < kMostTerms; ++k) {
    for (int power = 0; power < kMostTerms; ++power) set(columns, power, k, table(power, k));
  }
  return columns;
}

}  // namespace

Series powers(const Series& coefficients) {
  static const Columns table = polynomials();
  return product(table, coefficients);
}

double tail(const Series& coefficients) {
  double largest = 0;
  for (Eigen::Index k = std::max<Eigen::Index>(coefficients.size() - 3, 0); k < coefficients.size(); ++k) {
    largest = std::max(largest, std::abs(coefficients[k]));
  }
  return largest;
}

namespace {

// Two sign changes closer together than this share of a panel are a double root: no change at all.
constexpr double kNarrow = 1e-8;

double value(const Series& powers, double x) {
  double sum = 0;
  for (Eigen::Index k = powers.size() - 1; k >= 0; --k) sum = sum * x + powers[k];
  return sum;
}

/// The same polynomial around x = centre (Horner's scheme, repeated).
Series shifted(Series powers, double centre) {
  const Eigen::Index count = powers.size();
  for (Eigen::Index first = 0; first + 1 < count; ++first) {
    for (Eigen::Index k = count - 2; k >= first; --k) powers[k] += centre * powers[k + 1];
  }
  return powers;
}

void search(const Series& powers, double lo, double hi, std::vector<double>& found) {
  const double half = 0.5 * (hi - lo);
  const double centre = lo + half;
  const Series local = centre == 0 ? powers : shifted(powers, centre);
  double reach = 0;        // how far the polynomial gets from its middle value
  double slope_reach = 0;  // and its slope
  double power = half;
  for (Eigen::Index k = 1; k < local.size(); ++k, power *= half) {
    reach += std::abs(local[k]) * power;
    if (k > 1) slope_reach += static_cast<double>(k) * std::abs(local[k]) * power / half;
  }
  if (std::abs(local[0]) > reach) return;
  const bool monotone = local.size() > 1 && std::abs(local[1]) > slope_reach;
  if (!monotone && half > kNarrow) {
    search(powers, lo, lo + half, found);
    search(powers, lo + half, hi, found);
    return;
  }
  const double before = value(powers, lo);
  const double after = value(powers, hi);
  if ((before < 0) == (after < 0) || before == 0) return;  // a zero at lo was the end of the interval before
  if (after == 0) {
    if (hi < 1) found.push_back(hi);
    return;
  }
  std::uintmax_t rounds = 100;
  const auto bracket = boost::math::tools::toms748_solve([&](double x) { return value(powers, x); }, lo, hi, before,
                                                         after, boost::math::tools::eps_tolerance<double>(52), rounds);
  found.push_back(0.5 * (bracket.first + bracket.second));
}

}  // namespace

std::vector<double> sign_changes(const Series& powers) {
  std::vector<double> found;
  if (powers.size() > 1) search(powers, -1, 1, found);
  return found;
}

}  // namespace rollfix::chebyshev
