#include "chebyshev.hpp"

#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

namespace rollfix::chebyshev {

template <int Degree>
const Grid<Degree>& Grid<Degree>::instance() {
  static const Grid grid;
  return grid;
}

template <int Degree>
Grid<Degree>::Grid() {
  const double angle = std::numbers::pi / Degree;
  for (int j = 0; j <= Degree; ++j) points_[j] = std::sin(0.5 * angle * (2 * j - Degree));  // exactly symmetric
  inner_ = Inner::Zero();
  for (int j = 1; j < Degree; ++j) inner_[j - 1] = points_[j];
  for (int j = 0; j < kPairs; ++j) {
    for (int k = 0; k <= Degree; ++k) {
      const bool end_order = k == 0 || k == Degree;
      const double weight = (j == 0 ? 0.5 : 1.0) * (end_order ? 1.0 : 2.0) / Degree;
      transform_[j][k / 2][k % 2] = weight * std::cos(angle * ((k * (Degree - j)) % (2 * Degree)));
    }
    transform_[j].back()[1] = 0;
  }
  // The powers of T_k, by T_{k+1} = 2 x T_k - T_{k-1}.
  Eigen::Array<double, Degree + 2, Degree + 2> table = Eigen::Array<double, Degree + 2, Degree + 2>::Zero();
  table(0, 0) = table(1, 1) = 1;
  for (int k = 2; k <= Degree; ++k) {
    table.col(k).tail(Degree + 1) = 2 * table.col(k - 1).head(Degree + 1);
    table.col(k) -= table.col(k - 2);
  }
  for (int k = 0; k < kPairs; ++k) {
    for (int i = 0; i < kPairs; ++i) powers_[k][i] = {table(2 * i, 2 * k), table(2 * i + 1, 2 * k + 1)};
  }
}

/// The columns times their weights, a pair each; the sums stay in registers.
template <int Degree>
template <class Weight>
Terms<Degree> Grid<Degree>::product(const Columns& columns, const Weight& weight) {
  std::array<Pair, kPairs> sums;
  for (int i = 0; i < kPairs; ++i) sums[i] = Pair::Zero();
  for (int k = 0; k < kPairs; ++k) {
    const Pair factor = weight(k);
    for (int i = 0; i < kPairs; ++i) sums[i] += columns[k][i] * factor;
  }
  Terms<Degree> result;
  for (int i = 0; i < kPairs; ++i) result.template segment<2>(2 * i) = sums[i];
  return result;
}

/// What two points opposite to each other have in common is even, what they have not is odd.
template <int Degree>
Terms<Degree> Grid<Degree>::coefficients(const Terms<Degree>& values) const {
  return product(transform_, [&](int j) -> Pair {
    if (2 * j == Degree) return {values[j], 0};
    return {values[j] + values[Degree - j], values[j] - values[Degree - j]};
  });
}

template <int Degree>
Terms<Degree> Grid<Degree>::powers(const Terms<Degree>& coefficients) const {
  return product(powers_, [&](int k) -> Pair { return coefficients.template segment<2>(2 * k); });
}

template class Grid<8>;
template class Grid<16>;

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
