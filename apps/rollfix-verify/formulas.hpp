#pragma once

#include <arb.h>
#include <arb_poly.h>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

// Real balls and power series of Arb as values: every result holds the exact one.
namespace rollfix_verify {

inline constexpr slong kPrecision = 128;  // bits
inline constexpr slong kTerms = 14;       // of a series: x^0 to x^13, the last of which bounds what is left out

/// While one of these lives series keep so many terms only: where no more are asked for.
/// The number of terms belongs to the thread; it is restored at the end of the scope.
class FewerTerms {
 public:
  explicit FewerTerms(slong count) : before_(kept()) { kept() = count; }
  FewerTerms(const FewerTerms&) = delete;
  FewerTerms& operator=(const FewerTerms&) = delete;
  ~FewerTerms() { kept() = before_; }

  static slong& kept() {
    thread_local slong terms = kTerms;
    return terms;
  }

 private:
  slong before_;
};

/// A real number as a middle and a radius: an interval that holds the exact number. Not finite: nothing is known of it.
class Ball {
 public:
  /// The exact number 0, or a double.
  Ball() { arb_init(value_); }
  Ball(double value) : Ball() { arb_set_d(value_, value); }  // NOLINT(google-explicit-constructor): exact
  Ball(const Ball& other) : Ball() { arb_set(value_, other.value_); }
  Ball(Ball&& other) noexcept : Ball() { arb_swap(value_, other.value_); }
  Ball& operator=(Ball other) noexcept {
    arb_swap(value_, other.value_);
    return *this;
  }
  ~Ball() { arb_clear(value_); }

  arb_ptr get() { return value_; }
  arb_srcptr get() const { return value_; }

  // Comparisons are of the whole ball: false says that it is not certain, so that neither may be true of two balls.
  bool is_finite() const { return arb_is_finite(value_) != 0; }
  bool is_above(const Ball& other) const { return arb_gt(value_, other.value_) != 0; }  // for certain
  bool is_below(const Ball& other) const { return arb_lt(value_, other.value_) != 0; }
  /// The middle rounded to a double: about where the number is. Proves nothing by itself.
  double middle() const { return arf_get_d(arb_midref(value_), ARF_RND_NEAR); }
  /// Bounds on the whole ball, rounded outwards.
  double lower() const { return end(arb_get_lbound_arf, ARF_RND_FLOOR); }
  double upper() const { return end(arb_get_ubound_arf, ARF_RND_CEIL); }

 private:
  /// One end of the ball as a double, rounded in the direction that keeps it a bound.
  double end(void (*bound)(arf_t, const arb_t, slong), arf_rnd_t rounding) const {
    arf_t limit;
    arf_init(limit);
    bound(limit, value_, kPrecision);
    const double result = arf_get_d(limit, rounding);
    arf_clear(limit);
    return result;
  }

  arb_t value_;
};

/// Calls one of Arb's functions for a new value.
template <class Value, class Function, class... Arguments>
Value made(Function function, const Arguments&... arguments) {
  Value result;
  function(result.get(), arguments...);
  return result;
}

inline Ball operator+(const Ball& a, const Ball& b) { return made<Ball>(arb_add, a.get(), b.get(), kPrecision); }
inline Ball operator-(const Ball& a, const Ball& b) { return made<Ball>(arb_sub, a.get(), b.get(), kPrecision); }
inline Ball operator*(const Ball& a, const Ball& b) { return made<Ball>(arb_mul, a.get(), b.get(), kPrecision); }
inline Ball operator/(const Ball& a, const Ball& b) { return made<Ball>(arb_div, a.get(), b.get(), kPrecision); }
inline Ball operator-(const Ball& a) { return made<Ball>(arb_neg, a.get()); }
inline Ball abs(const Ball& a) { return made<Ball>(arb_abs, a.get()); }
inline Ball sqrt(const Ball& a) { return made<Ball>(arb_sqrt, a.get(), kPrecision); }
/// The length of a vector; where it may be 0 as well.
inline Ball length_of(const Ball& x, const Ball& y) {
  return made<Ball>(arb_sqrtpos, (x * x + y * y).get(), kPrecision);
}
// The ball of a function holds its values at all numbers in the argument.
inline Ball sin(const Ball& a) { return made<Ball>(arb_sin, a.get(), kPrecision); }
inline Ball cos(const Ball& a) { return made<Ball>(arb_cos, a.get(), kPrecision); }
inline Ball atan2(const Ball& y, const Ball& x) { return made<Ball>(arb_atan2, y.get(), x.get(), kPrecision); }
/// The least ball around both.
inline Ball hull(const Ball& a, const Ball& b) { return made<Ball>(arb_union, a.get(), b.get(), kPrecision); }
/// Any number.
inline Ball unknown() {
  Ball result;
  arb_indeterminate(result.get());
  return result;
}
inline Ball full_turn() { return 2.0 * made<Ball>(arb_const_pi, kPrecision); }
/// The angle that differs from it by whole turns and is nearest to 0.
inline Ball to_nearest_turn(const Ball& angle) {
  return angle - std::round((angle / full_turn()).middle()) * full_turn();
}
/// [0, length]
inline Ball up_to(const Ball& length) { return hull(0.0, length); }
/// [-reach, reach]
inline Ball around_zero(const Ball& reach) { return hull(-reach, reach); }
/// 1, -1: for certain; else 0.
inline int sign_of(const Ball& value) { return value.is_above(0.0) ? 1 : value.is_below(0.0) ? -1 : 0; }
/// How wide it is.
inline double spread(const Ball& ball) { return ball.upper() - ball.lower(); }
/// n over k.
inline Ball choices(ulong n, ulong k) { return made<Ball>(arb_bin_uiui, n, k, kPrecision); }

/// The first coefficients of a power series.
class Series {
 public:
  Series() { arb_poly_init(value_); }
  Series(const Ball& constant) : Series() { set(0, constant); }  // NOLINT(google-explicit-constructor)
  Series(double constant) : Series(Ball(constant)) {}            // NOLINT(google-explicit-constructor)
  Series(const Series& other) : Series() { arb_poly_set(value_, other.value_); }
  Series(Series&& other) noexcept : Series() { arb_poly_swap(value_, other.value_); }
  Series& operator=(Series other) noexcept {
    arb_poly_swap(value_, other.value_);
    return *this;
  }
  ~Series() { arb_poly_clear(value_); }

  /// at + x.
  static Series variable(const Ball& at) {
    Series result(at);
    result.set(1, 1.0);
    return result;
  }

  arb_poly_struct* get() { return value_; }
  const arb_poly_struct* get() const { return value_; }
  /// The coefficient of x^power; 0 beyond the last one.
  Ball operator[](slong power) const {
    Ball coefficient;
    arb_poly_get_coeff_arb(coefficient.get(), value_, power);
    return coefficient;
  }
  /// Sets the coefficient of x^power; the series grows where that is needed.
  void set(slong power, const Ball& coefficient) { arb_poly_set_coeff_arb(value_, power, coefficient.get()); }

 private:
  arb_poly_t value_;
};

/// Calls one of Arb's functions for a new series of as many terms as are kept.
template <class Function, class... Arguments>
Series cut(Function function, const Arguments&... arguments) {
  return made<Series>(function, arguments..., FewerTerms::kept(), kPrecision);
}

// A sum keeps all terms; a product and what follows keep as many as FewerTerms says, from x^0 on.
inline Series operator+(const Series& a, const Series& b) {
  return made<Series>(arb_poly_add, a.get(), b.get(), kPrecision);
}
inline Series operator-(const Series& a, const Series& b) {
  return made<Series>(arb_poly_sub, a.get(), b.get(), kPrecision);
}
inline Series operator-(const Series& a) { return made<Series>(arb_poly_neg, a.get()); }
inline Series operator*(const Series& a, const Series& b) { return cut(arb_poly_mullow, a.get(), b.get()); }
inline Series operator/(const Series& a, const Series& b) { return cut(arb_poly_div_series, a.get(), b.get()); }
inline Series sqrt(const Series& a) { return cut(arb_poly_sqrt_series, a.get()); }
inline Series sin(const Series& a) { return cut(arb_poly_sin_series, a.get()); }
inline Series cos(const Series& a) { return cut(arb_poly_cos_series, a.get()); }
inline Series exp(const Series& a) { return cut(arb_poly_exp_series, a.get()); }
inline Series pow(const Series& a, const Ball& exponent) {
  return cut(arb_poly_pow_arb_series, a.get(), exponent.get());
}
inline Series whole_power(const Series& a, ulong exponent) {
  return cut(arb_poly_pow_ui_trunc_binexp, a.get(), exponent);
}
/// Its derivative: the last coefficient is lost.
inline Series derivative(const Series& a) { return made<Series>(arb_poly_derivative, a.get(), kPrecision); }
/// Its integral from 0.
inline Series integral(const Series& a) { return made<Series>(arb_poly_integral, a.get(), kPrecision); }
/// x as a series in y = a(x), where a(0) = 0.
inline Series inverse(const Series& a) { return cut(arb_poly_revert_series, a.get()); }
/// a(b(y)), where b(0) = 0.
inline Series composed(const Series& a, const Series& b) { return cut(arb_poly_compose_series, a.get(), b.get()); }
/// Taylor's polynomial of this degree: `thin` around one place, the coefficient that bounds all that is left out from
/// `wide`, around a ball of places that holds all from there to where it is evaluated.
inline Series with_remainder(Series thin, const Series& wide, slong degree) {
  arb_poly_truncate(thin.get(), degree);
  thin.set(degree, wide[degree]);
  return thin;
}

/// a(x): holds the values at all numbers in x.
inline Ball value(const Series& a, const Ball& x) {
  return made<Ball>(arb_poly_evaluate_horner, a.get(), x.get(), kPrecision);
}
/// a(x) and a'(x).
inline std::pair<Ball, Ball> value_and_slope(const Series& a, const Ball& x) {
  std::pair<Ball, Ball> both;
  arb_poly_evaluate2_horner(both.first.get(), both.second.get(), a.get(), x.get(), kPrecision);
  return both;
}

/// Two coordinates, as numbers or as series.
template <class Number>
struct Pair {
  Number x;
  Number y;
};
using Point = Pair<Ball>;

/// The highest power of a Motion's integrals that is right: two derivatives lose two terms.
inline constexpr slong kOrder = kTerms - 2;

/// How a curve runs on from a parameter u, by x = its parameter - u: ds/dx and d(tangent's angle)/dx. Where u is a wide
/// ball each coefficient holds those of all parameters in it.
struct Motion {
  Series speed;
  Series turning;
};

/// A curve by its own formula.
struct Formula {
  double lo = 0;  // its parameter runs from here to there
  double hi = 1;
  double work = 1;  // of an expansion, about as many as of an ellipse's
  std::function<Motion(const Ball&)> motion;
  std::function<Point(const Ball&)> position;
  std::function<Point(const Ball&)> velocity;  // or, where it is at rest, a direction: only that is asked for
};

/// The curve of this kind with these numbers: docs/certificates.md lists the kinds. Throws std::runtime_error.
Formula formula_of(const std::string& kind, const std::vector<double>& numbers);

}  // namespace rollfix_verify
