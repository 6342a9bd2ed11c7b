#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

namespace rollfix::chebyshev {

/// The coefficients of a polynomial, of rising order: at most those of the finest grid, and one more after integration.
inline constexpr int kMostTerms = 18;
using Series = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostTerms, 1>;

/// Those of a polynomial of a degree that is known, and one more: an even number.
template <int Degree>
using Terms = Eigen::Array<double, Degree + 2, 1>;

/// The points -cos(pi j / Degree), j = 0 ... Degree, from -1 to 1, and the tables that turn values at them into a
/// polynomial. All tables depend on the degree alone.
template <int Degree>
class Grid {
  static_assert(Degree % 2 == 0 && Degree + 2 <= kMostTerms);

 public:
  static constexpr int kPoints = Degree + 1;
  /// All points but the two at the ends, and one that counts for nothing, 0: an even number.
  using Inner = Eigen::Array<double, Degree, 1>;

  /// Built at the first call, then shared by all threads.
  static const Grid& instance();

  /// x_j, j = 0 ... Degree, in rising order.
  double point(int j) const { return points_[j]; }
  /// x_1 ... x_(Degree - 1), and a 0 behind them.
  const Inner& inner() const { return inner_; }
  /// The polynomial through these values at the points (the last one is not looked at) by its coefficients over the
  /// Chebyshev polynomials.
  Terms<Degree> coefficients(const Terms<Degree>& values) const;
  /// From there to the powers of x. Safe where the coefficients fall faster than the conversion's factor (1 + sqrt 2)^k
  /// grows, as a resolved panel's do.
  Terms<Degree> powers(const Terms<Degree>& coefficients) const;
  /// A polynomial by powers of x, by those of y on either half: x = (y - 1) / 2 and x = (y + 1) / 2.
  std::array<Terms<Degree>, 2> halves(const Terms<Degree>& powers) const;

 private:
  static constexpr std::size_t kPairs = Degree / 2 + 1;
  using Pair = Eigen::Array2d;
  /// A matrix by columns that keeps even terms and odd ones apart: each entry serves one of either, which is half the
  /// work, and one vector instruction does both.
  using Columns = std::array<std::array<Pair, kPairs>, kPairs>;

  Grid();
  using Table = Eigen::Array<double, Degree + 2, Degree + 2>;
  /// What a table makes of even terms for even ones and of odd terms for odd ones; or of one kind for the other.
  static Columns columns(const Table& table, bool mixed);
  template <class Weight>
  static Terms<Degree> product(const Columns& columns, const Weight& weight);

  Eigen::Array<double, kPoints, 1> points_;
  Inner inner_;
  Columns transform_;     // values at the points to coefficients over T_k
  Columns powers_;        // coefficients over T_k to powers of x
  Columns halves_;        // what even powers do to even ones, odd to odd: the same on either half, ...
  Columns halves_mixed_;  // ... and even to odd, odd to even: the other way round on the first
};
extern template class Grid<8>;
extern template class Grid<16>;

/// The values of a polynomial, given by its powers, at all of these x at once (Horner's scheme).
template <class Powers, class Places>
Places values(const Powers& powers, const Places& x) {
  Places sum = Places::Constant(powers[powers.size() - 1]);
  for (Eigen::Index k = powers.size() - 1; k-- > 0;) sum = sum * x + powers[k];
  return sum;
}

/// The antiderivative of a polynomial, given by its powers, that vanishes at x = -1, times a factor. The last power of
/// `powers` must be 0.
template <class Powers>
Powers antiderivative(const Powers& powers, double factor) {
  static const Powers reciprocals = Powers::LinSpaced(0, static_cast<double>(Powers::SizeAtCompileTime - 1)).inverse();
  constexpr Eigen::Index kRest = Powers::SizeAtCompileTime - 1;
  Powers result;
  result[0] = 0;
  result.template tail<kRest>() = factor * powers.template head<kRest>() * reciprocals.template tail<kRest>();
  // What the sum of the other terms is at x = -1: odd powers count with the other sign.
  double at_start = 0;
  for (Eigen::Index k = 0; k < kRest; k += 2) at_start += result[k] - result[k + 1];
  result[0] = -at_start;
  return result;
}

/// Where a polynomial, given by its powers, changes sign strictly inside (-1, 1), in rising order.
/// All of them: an interval is left only when a bound on the polynomial, or on its derivative, excludes more.
std::vector<double> sign_changes(const Series& powers);

}  // namespace rollfix::chebyshev
