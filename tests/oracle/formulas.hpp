#pragma once

// The outlines by their own formulas, written from docs/gallery.md: nothing here knows how the library writes them.

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include "oracle/curve.hpp"

namespace oracle {

// ---- pieces ----

inline std::shared_ptr<const Curve> line(Vector from, Vector to) {
  return curve_of({0, 1}, [=](const auto& u) {
    using S = std::decay_t<decltype(u)>;
    return Point<S>{S(from.x) + (to.x - from.x) * u, S(from.y) + (to.y - from.y) * u};
  });
}

/// Counter-clockwise for sweep > 0. Where its centre is does not matter.
inline std::shared_ptr<const Curve> arc(Real radius, Real from, Real sweep) {
  return std::make_shared<Arc>(radius, from, sweep);
}

/// A Bezier curve by its Bernstein polynomials.
inline std::shared_ptr<const Curve> bezier(const std::vector<Vector>& points) {
  return curve_of({0, 1}, [points](const auto& u) {
    using S = std::decay_t<decltype(u)>;
    const std::size_t degree = points.size() - 1;
    const S rest = S(1) - u;
    Point<S> sum{points[0].x * rest, points[0].y * rest};
    S power = u;
    Real choose = 1;
    for (std::size_t k = 1; k < degree; ++k) {
      choose = choose * static_cast<Real>(degree - k + 1) / static_cast<Real>(k);
      sum = rest * (sum + Point<S>{choose * points[k].x * power, choose * points[k].y * power});
      power = power * u;
    }
    return sum + Point<S>{points[degree].x * power, points[degree].y * power};
  });
}

/// radius(u, cos u) at the angle u, once around.
template <class Radius>
Curves polar(Radius radius) {
  return {curve_of({0, 2 * kPi}, [radius](const auto& u) {
    using S = std::decay_t<decltype(u)>;
    const auto [s, c] = sin_cos(u);
    const S r = radius(u, c);
    return Point<S>{r * c, r * s};
  })};
}

// ---- gallery ----

inline Curves circle(Real r) { return {arc(r, 0, 2 * kPi)}; }

inline Curves ellipse(Real a, Real b) {
  return {curve_of({0, 2 * kPi}, [=](const auto& u) {
    const auto [s, c] = sin_cos(u);
    return Point<std::decay_t<decltype(u)>>{a * c, b * s};
  })};
}

/// n even.
inline Curves superellipse(Real a, Real b, int n) {
  return {curve_of({0, 2 * kPi}, [=](const auto& u) {
    const auto [s, c] = sin_cos(u);
    const auto scale = pow(pow(c, n) + pow(s, n), -1 / static_cast<Real>(n));
    return Point<std::decay_t<decltype(u)>>{a * (scale * c), b * (scale * s)};
  })};
}

inline Curves limacon(Real a, Real b) {
  return polar([=](const auto&, const auto& c) { return b * c + a; });
}

inline Curves cam(Real base, Real lift) {
  return polar([=](const auto&, const auto& c) { return (lift / 4) * pow(c + Real{1}, 2) + base; });
}

inline Curves gear(int teeth, Real r, Real depth) {
  return polar([=](const auto& u, const auto&) { return depth * sin_cos(static_cast<Real>(teeth) * u).second + r; });
}

inline Curves log_spiral(Real a, Real b, Real turns) {
  return {curve_of({0, 2 * kPi * turns}, [=](const auto& u) {
    const auto [s, c] = sin_cos(u);
    const auto r = a * exp(b * u);
    return Point<std::decay_t<decltype(u)>>{r * c, r * s};
  })};
}

inline Curves exponential(Real from, Real to, Real scale) {
  return {curve_of({from, to}, [=](const auto& u) {
    return Point<std::decay_t<decltype(u)>>{scale * u, scale * exp(u)};
  })};
}

inline Curves polygon(const std::vector<Vector>& corners, bool closed = true) {
  Curves sides;
  for (std::size_t k = 0; k + (closed ? 0 : 1) < corners.size(); ++k) {
    sides.push_back(line(corners[k], corners[(k + 1) % corners.size()]));
  }
  return sides;
}

inline Curves regular_polygon(int n, Real r) {
  std::vector<Vector> corners;
  for (int k = 0; k < n; ++k) corners.push_back({r * std::cos(2 * kPi * k / n), r * std::sin(2 * kPi * k / n)});
  return polygon(corners);
}

inline Curves reuleaux(Real width) {
  Curves arcs;
  for (int k = 0; k < 3; ++k) arcs.push_back(arc(width, kPi / 6 + 2 * kPi * k / 3, kPi / 3));
  return arcs;
}

inline Curves rounded_rectangle(Real width, Real height, Real r) {
  const Real x = width / 2 - r, y = height / 2 - r;
  return {line({-x, -y - r}, {x, -y - r}), arc(r, -kPi / 2, kPi / 2),
          line({x + r, -y}, {x + r, y}),   arc(r, 0, kPi / 2),
          line({x, y + r}, {-x, y + r}),   arc(r, kPi / 2, kPi / 2),
          line({-x - r, y}, {-x - r, -y}), arc(r, kPi, kPi / 2)};
}

inline Curves stadium(Real length, Real r) {
  const Real x = length / 2;
  return {line({-x, -r}, {x, -r}), arc(r, -kPi / 2, kPi), line({x, r}, {-x, r}), arc(r, kPi / 2, kPi)};
}

/// Upper (u = -w) or lower (u = w) surface of a 4-digit section, x = w^2, before or behind the highest camber.
inline std::shared_ptr<const Curve> wing(const Interval& domain, Real camber, Real place, Real thickness, bool fore) {
  const bool upper = domain.hi <= 0;
  return curve_of(domain, [=](const auto& u) {
    using S = std::decay_t<decltype(u)>;
    const S w = upper ? Real{-1} * u : u;
    const S x = w * w;
    const S half = (5 * thickness) *
                   (0.2969L * w + -0.126L * x + -0.3516L * pow(x, 2) + 0.2843L * pow(x, 3) + -0.1036L * pow(x, 4));
    if (camber == 0) return Point<S>{x, (upper ? Real{1} : Real{-1}) * half};
    const Real reach = fore ? place : 1 - place;
    const S line = S(camber) - (camber / (reach * reach)) * pow(x + -place, 2);
    const S slope = (-2 * camber / (reach * reach)) * (x + -place);
    const S along = pow(pow(slope, 2) + Real{1}, -0.5L) * half;
    const Real side = upper ? 1 : -1;
    return Point<S>{x - side * (along * slope), line + side * along};
  });
}

/// Chord 1.
inline Curves naca(int digits) {
  const Real camber = static_cast<Real>(digits / 1000) / 100, place = static_cast<Real>(digits / 100 % 10) / 10;
  const Real thickness = static_cast<Real>(digits % 100) / 100, w = std::sqrt(place);
  if (camber == 0) return {wing({-1, 0}, 0, 0, thickness, true), wing({0, 1}, 0, 0, thickness, true)};
  return {wing({-1, -w}, camber, place, thickness, false), wing({-w, 0}, camber, place, thickness, true),
          wing({0, w}, camber, place, thickness, true), wing({w, 1}, camber, place, thickness, false)};
}

// ---- splines ----

/// Solves a x = b by Gauss's elimination with pivots.
inline std::vector<Real> solved(std::vector<std::vector<Real>> a, std::vector<Real> b) {
  const std::size_t n = b.size();
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k; i < n; ++i) pivot = std::abs(a[i][k]) > std::abs(a[pivot][k]) ? i : pivot;
    std::swap(a[k], a[pivot]);
    std::swap(b[k], b[pivot]);
    for (std::size_t i = k + 1; i < n; ++i) {
      const Real factor = a[i][k] / a[k][k];
      for (std::size_t j = k; j < n; ++j) a[i][j] -= factor * a[k][j];
      b[i] -= factor * b[k];
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    for (std::size_t j = k + 1; j < n; ++j) b[k] -= a[k][j] * b[j];
    b[k] /= a[k][k];
  }
  return b;
}

/// The C2 periodic cubic spline in cumulative chord length: its second derivatives at the points solve a linear system.
inline Curves periodic_spline(const std::vector<Vector>& points) {
  const std::size_t n = points.size();
  std::vector<Real> chord(n), rise_x(n), rise_y(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Vector step{points[(i + 1) % n].x - points[i].x, points[(i + 1) % n].y - points[i].y};
    chord[i] = norm(step);
    rise_x[i] = step.x / chord[i];
    rise_y[i] = step.y / chord[i];
  }
  std::vector<std::vector<Real>> matrix(n, std::vector<Real>(n));
  std::vector<Real> x(n), y(n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t before = (i + n - 1) % n, after = (i + 1) % n;
    matrix[i][before] += chord[before] / 6;
    matrix[i][i] += (chord[before] + chord[i]) / 3;
    matrix[i][after] += chord[i] / 6;
    x[i] = rise_x[i] - rise_x[before];
    y[i] = rise_y[i] - rise_y[before];
  }
  x = solved(matrix, x);
  y = solved(matrix, y);
  Curves spans;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t after = (i + 1) % n;
    const Real h = chord[i];
    const std::array<Vector, 4> c{
        Vector{points[i].x, points[i].y},
        {rise_x[i] - h * (2 * x[i] + x[after]) / 6, rise_y[i] - h * (2 * y[i] + y[after]) / 6},
        {x[i] / 2, y[i] / 2},
        {(x[after] - x[i]) / (6 * h), (y[after] - y[i]) / (6 * h)}};
    spans.push_back(curve_of({0, h}, [c](const auto& u) {
      using S = std::decay_t<decltype(u)>;
      const S square = u * u, cube = square * u;
      return Point<S>{S(c[0].x) + c[1].x * u + c[2].x * square + c[3].x * cube,
                      S(c[0].y) + c[1].y * u + c[2].y * square + c[3].y * cube};
    }));
  }
  return spans;
}

/// Radii 1 + wobble (2 k/2^53 - 1) at equal angles, k the top 53 bits of std::mt19937_64.
inline Curves random_spline(int n, std::uint64_t seed, Real wobble) {
  std::mt19937_64 generator(seed);
  std::vector<Vector> points;
  for (int i = 0; i < n; ++i) {
    const Real uniform = 2 * static_cast<Real>(generator() >> 11U) / static_cast<Real>(std::uint64_t{1} << 53U) - 1;
    const Real radius = 1 + wobble * uniform, angle = 2 * kPi * i / n;
    points.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
  return periodic_spline(points);
}

}  // namespace oracle
