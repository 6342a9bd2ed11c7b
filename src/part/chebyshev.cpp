#include "chebyshev.hpp"

#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

// Notation:
//   x               in [-1, 1]; the points x_j = -cos(pi j / Degree), from -1 to 1: `points_`
//   T_k             Chebyshev polynomials; `coefficients` are a polynomial's over these, `powers` those over x^k
//   y               in [-1, 1] on either half, x = (y - 1) / 2 and x = (y + 1) / 2: `halves`
//   even, odd       terms of even and odd order, kept apart in all tables: each entry serves one of either
//   reach           how far a polynomial gets from its value in the middle of an interval: the sum of |c_k| half^k
// Follows docs/search.md, "Once per part". Signs change where Alefeld, Potra and Shi, "Algorithm 748" (1995) closes a
// bracket.
// Idea: values at Chebyshev points give a polynomial that is nearly the best one of its degree. An interval is left
// without a sign change only when `reach` says so, else its slope has one sign there, or it is halved down to
// `kNarrow`.
namespace rollfix::chebyshev {

/// The tables of this degree; filled once.
template <int Degree>
const Grid<Degree>& Grid<Degree>::instance() {
  static const Grid grid;
  return grid;
}

/// Of a table only the entries that can be other than 0: those between orders of the same parity, the even-even one and
/// the odd-odd one as a pair; `mixed`: those between orders of different parity, (even row, odd column) and (odd row,
/// even column).
template <int Degree>
typename Grid<Degree>::Columns Grid<Degree>::columns(const Table& table, bool mixed) {
  Columns result;
  for (std::size_t k = 0; k < kPairs; ++k) {
    for (std::size_t i = 0; i < kPairs; ++i) {
      const auto row = static_cast<Eigen::Index>(2 * i);
      const auto column = static_cast<Eigen::Index>(2 * k);
      result[k][i] = {table(row, column + (mixed ? 1 : 0)), table(row + 1, column + (mixed ? 0 : 1))};
    }
  }
  return result;
}

/// Fills the points and the three tables of conversions; (Degree + 2)^2 entries each, half of which are 0.
template <int Degree>
Grid<Degree>::Grid() {
  const double angle = std::numbers::pi / Degree;
  // sin(pi j / Degree - pi / 2) = -cos(pi j / Degree); the argument changes its sign between opposite points, so that
  // they are opposite to the last bit.
  for (int j = 0; j <= Degree; ++j) points_[j] = std::sin(0.5 * angle * (2 * j - Degree));  // exactly symmetric
  inner_ = Inner::Zero();
  inner_.template head<Degree - 1>() = points_.template segment<Degree - 1>(1);

  // c_k = (2 / Degree) sum of f(x_j) T_k(x_j), where the terms of both ends, and c_0 and c_Degree, count half. T_k is
  // even or odd as k is: column 2 j + k % 2 belongs to the sum or to the difference.
  Table transform = Table::Zero();  // from the sum (k even) or the difference of the values at point j and its opposite
  for (int j = 0; j <= Degree / 2; ++j) {
    for (int k = 0; k <= Degree; ++k) {
      const bool is_end = k == 0 || k == Degree;
      const double weight = (j == 0 ? 0.5 : 1.0) * (is_end ? 1.0 : 2.0) / Degree;
      // T_k(x_j) = cos(k pi (Degree - j) / Degree); the whole number is reduced first, so that the cosine's argument
      // stays within 2 pi.
      transform(k, 2 * j + k % 2) = weight * std::cos(angle * ((k * (Degree - j)) % (2 * Degree)));
    }
  }
  transform_ = columns(transform, false);

  // Column k holds T_k by powers of x.
  Table powers = Table::Zero();  // T_{k+1} = 2 x T_k - T_{k-1}
  powers(0, 0) = powers(1, 1) = 1;
  for (int k = 2; k <= Degree; ++k) {
    powers.col(k).template tail<Degree + 1>() = 2 * powers.col(k - 1).template head<Degree + 1>();
    powers.col(k) -= powers.col(k - 2);
  }
  powers_ = columns(powers, false);

  // Column k holds ((y + 1) / 2)^k by powers of y. For the first half, x = (y - 1) / 2, the signs of the mixed terms
  // change: `halves`.
  Table binomials = Table::Zero();  // ((y + 1) / 2)^k
  binomials(0, 0) = 1;
  for (int k = 1; k <= Degree; ++k) {
    binomials.col(k) = 0.5 * binomials.col(k - 1);
    binomials.col(k).template tail<Degree + 1>() += 0.5 * binomials.col(k - 1).template head<Degree + 1>();
  }
  halves_ = columns(binomials, false);
  halves_mixed_ = columns(binomials, true);
}

/// The columns times their weights, a pair each; the sums stay in registers.
template <int Degree>
template <class Weight>
Terms<Degree> Grid<Degree>::product(const Columns& columns, const Weight& weight) {
  std::array<Pair, kPairs> sums;
  sums.fill(Pair::Zero());
  for (std::size_t k = 0; k < kPairs; ++k) {
    const Pair factor = weight(static_cast<Eigen::Index>(k));
    for (std::size_t i = 0; i < kPairs; ++i) sums[i] += columns[k][i] * factor;
  }
  Terms<Degree> result;
  for (std::size_t i = 0; i < kPairs; ++i) result.template segment<2>(static_cast<Eigen::Index>(2 * i)) = sums[i];
  return result;
}

/// What two points opposite to each other have in common is even, what they have not is odd.
template <int Degree>
Terms<Degree> Grid<Degree>::coefficients(const Terms<Degree>& values) const {
  return product(transform_, [&](Eigen::Index j) -> Pair {
    // The point in the middle, x = 0, is its own opposite.
    if (2 * j == Degree) return {values[j], 0};
    return {values[j] + values[Degree - j], values[j] - values[Degree - j]};
  });
}

/// Even and odd coefficients do not mix here: T_k holds powers of one parity only.
template <int Degree>
Terms<Degree> Grid<Degree>::powers(const Terms<Degree>& coefficients) const {
  return product(powers_, [&](Eigen::Index k) -> Pair { return coefficients.template segment<2>(2 * k); });
}

/// With y to -y and x to -x the second half's formula becomes the first's: terms that keep the parity are the same on
/// both halves, the mixed ones change their sign.
template <int Degree>
std::array<Terms<Degree>, 2> Grid<Degree>::halves(const Terms<Degree>& powers) const {
  const Terms<Degree> same =
      product(halves_, [&](Eigen::Index k) -> Pair { return powers.template segment<2>(2 * k); });
  const Terms<Degree> mixed = product(halves_mixed_, [&](Eigen::Index k) -> Pair {
    return {powers[2 * k + 1], powers[2 * k]};
  });
  return {same - mixed, same + mixed};
}

template class Grid<8>;
template class Grid<16>;

namespace {

// Two sign changes closer together than this share of a panel are a double root: no change at all.
constexpr double kNarrow = 1e-8;

/// The polynomial at x, by Horner's scheme.
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

/// Appends the sign changes of the polynomial within (lo, hi) in rising order, and one at hi if hi < 1. Recursive: each
/// call either decides its interval or halves it. The bounds hold for all x of the interval, because |x - centre| <=
/// half.
void search(const Series& powers, double lo, double hi, std::vector<double>& found) {
  // p(centre + d) = c_0 + c_1 d + ... with the coefficients `local`.
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
  // |p - c_0| <= reach < |c_0|: p has the sign of c_0 everywhere here.
  if (std::abs(local[0]) > reach) return;
  // Likewise |p' - c_1| <= slope_reach < |c_1|: p' has one sign, so at most one sign change. An interval that is
  // neither, and narrower than kNarrow, is decided by the signs at its ends alone.
  const bool monotone = local.size() > 1 && std::abs(local[1]) > slope_reach;
  if (!monotone && half > kNarrow) {
    search(powers, lo, lo + half, found);
    search(powers, lo + half, hi, found);
    return;
  }
  const double before = value(powers, lo);
  const double after = value(powers, hi);
  if (before == 0) return;  // a zero at lo is the end of the interval before
  if (after == 0) {
    // A double root touches 0, and the signs on both sides of it are the same.
    const bool changes = monotone || (before < 0) != (value(powers, hi + half) < 0);
    if (changes && hi < 1) found.push_back(hi);
    return;
  }
  if ((before < 0) == (after < 0)) return;
  // The signs at lo and hi differ: a bracket, closed to the last bits.
  std::uintmax_t rounds = 100;
  const auto bracket = boost::math::tools::toms748_solve([&](double x) { return value(powers, x); }, lo, hi, before,
                                                         after, boost::math::tools::eps_tolerance<double>(52), rounds);
  found.push_back(0.5 * (bracket.first + bracket.second));
}

}  // namespace

/// A constant has none, also the constant 0.
std::vector<double> sign_changes(const Series& powers) {
  std::vector<double> found;
  if (powers.size() > 1) search(powers, -1, 1, found);
  return found;
}

}  // namespace rollfix::chebyshev
