#pragma once

// A function's value and derivatives at a place, or bounds on them over an interval: Taylor coefficients up to order N,
// computed along with the function by the rules of differentiation.

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "oracle/interval.hpp"

namespace oracle {

/// T: a Real, or an Interval.
template <class T, std::size_t N>
struct Series {
  std::array<T, N + 1> c{};

  Series() = default;
  Series(Real constant) { c[0] = constant; }  // NOLINT(google-explicit-constructor): a number is a function

  static Series variable(const T& at) {
    Series u;
    u.c[0] = at;
    u.c[1] = Real{1};
    return u;
  }
};

template <class T, std::size_t N>
Series<T, N> operator+(Series<T, N> a, const Series<T, N>& b) {
  for (std::size_t k = 0; k <= N; ++k) a.c[k] = a.c[k] + b.c[k];
  return a;
}

template <class T, std::size_t N>
Series<T, N> operator*(const Series<T, N>& a, const Series<T, N>& b) {
  Series<T, N> product;
  for (std::size_t k = 0; k <= N; ++k) {
    for (std::size_t i = 0; i <= k; ++i) product.c[k] = product.c[k] + a.c[i] * b.c[k - i];
  }
  return product;
}

template <class T, std::size_t N>
Series<T, N> operator*(Real factor, Series<T, N> a) {
  for (T& c : a.c) c = T(factor) * c;
  return a;
}

template <class T, std::size_t N>
Series<T, N> operator+(Series<T, N> a, Real constant) {
  a.c[0] = a.c[0] + T(constant);
  return a;
}

template <class T, std::size_t N>
Series<T, N> operator-(const Series<T, N>& a, const Series<T, N>& b) {
  return a + Real{-1} * b;
}

/// a^exponent with a > 0, from a y' = exponent a' y.
template <class T, std::size_t N>
Series<T, N> pow(const Series<T, N>& a, Real exponent) {
  Series<T, N> y;
  y.c[0] = power(a.c[0], exponent);
  for (std::size_t k = 1; k <= N; ++k) {
    for (std::size_t j = 1; j <= k; ++j) {
      const Real weight = (exponent * static_cast<Real>(j) - static_cast<Real>(k - j)) / static_cast<Real>(k);
      y.c[k] = y.c[k] + T(weight) * a.c[j] * y.c[k - j];
    }
    y.c[k] = y.c[k] / a.c[0];
  }
  return y;
}

/// a^n of any a.
template <class T, std::size_t N>
Series<T, N> pow(const Series<T, N>& a, int n) {
  Series<T, N> product = Real{1};
  for (int k = 0; k < n; ++k) product = product * a;
  return product;
}

template <class T, std::size_t N>
Series<T, N> exp(const Series<T, N>& a) {
  using std::exp;
  Series<T, N> y;
  y.c[0] = exp(a.c[0]);
  for (std::size_t k = 1; k <= N; ++k) {
    for (std::size_t j = 1; j <= k; ++j) {
      y.c[k] = y.c[k] + T(static_cast<Real>(j) / static_cast<Real>(k)) * a.c[j] * y.c[k - j];
    }
  }
  return y;
}

/// Sine and cosine together: each is the other's derivative.
template <class T, std::size_t N>
std::pair<Series<T, N>, Series<T, N>> sin_cos(const Series<T, N>& a) {
  using std::cos;
  using std::sin;
  Series<T, N> s, c;
  s.c[0] = sin(a.c[0]);
  c.c[0] = cos(a.c[0]);
  for (std::size_t k = 1; k <= N; ++k) {
    for (std::size_t j = 1; j <= k; ++j) {
      const T step = T(static_cast<Real>(j) / static_cast<Real>(k)) * a.c[j];
      s.c[k] = s.c[k] + step * c.c[k - j];
      c.c[k] = c.c[k] - step * s.c[k - j];
    }
  }
  return {s, c};
}

/// The derivative, known to one order less.
template <class T, std::size_t N>
Series<T, N - 1> derivative(const Series<T, N>& a) {
  Series<T, N - 1> slope;
  for (std::size_t k = 0; k < N; ++k) slope.c[k] = T(static_cast<Real>(k + 1)) * a.c[k + 1];
  return slope;
}

template <std::size_t M, class T, std::size_t N>
Series<T, M> truncated(const Series<T, N>& a) {
  Series<T, M> less;
  for (std::size_t k = 0; k <= M; ++k) less.c[k] = a.c[k];
  return less;
}

}  // namespace oracle
