#pragma once

// A curve that is known by a formula for its points: all else follows by differentiating it.

#include <memory>
#include <utility>
#include <vector>

#include "oracle/series.hpp"

namespace oracle {

template <class S>
struct Point {
  S x{};
  S y{};
};

template <class S>
Point<S> operator+(const Point<S>& a, const Point<S>& b) {
  return {a.x + b.x, a.y + b.y};
}
template <class S>
Point<S> operator*(const S& factor, const Point<S>& a) {
  return {factor * a.x, factor * a.y};
}

using Vector = Point<Real>;

inline Real cross(const Vector& a, const Vector& b) { return a.x * b.y - a.y * b.x; }
inline Real dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y; }
inline Real norm(const Vector& a) { return std::sqrt(dot(a, a)); }
/// From one direction to another the shorter way, radians.
inline Real angle_between(const Vector& from, const Vector& to) { return std::atan2(cross(from, to), dot(from, to)); }

/// Bounds over an interval of the parameter.
struct Bend {
  Interval speed;      // |r'|
  Interval curvature;  // 1/length
  Interval rate;       // of the curvature by arc length
};

class Curve {
 public:
  explicit Curve(const Interval& domain) : domain_(domain) {}
  virtual ~Curve() = default;

  const Interval& domain() const { return domain_; }
  virtual Vector velocity(Real u) const = 0;
  virtual Real curvature(Real u) const = 0;
  virtual Bend bend(const Interval& u) const = 0;

 private:
  Interval domain_;
};

using Curves = std::vector<std::shared_ptr<const Curve>>;

/// Speed and curvature, with one derivative, of a curve with these Taylor coefficients.
template <class T>
std::pair<Series<T, 1>, Series<T, 1>> speed_and_curvature(const Point<Series<T, 3>>& r) {
  const auto dx = derivative(r.x), dy = derivative(r.y);
  const auto ddx = derivative(dx), ddy = derivative(dy);
  const auto vx = truncated<1>(dx), vy = truncated<1>(dy);
  const auto square = pow(vx, 2) + pow(vy, 2);
  return {pow(square, 0.5L), (vx * ddy - vy * ddx) * pow(square, -1.5L)};
}

/// `Formula`: takes any scalar and gives a Point of it.
template <class Formula>
class FormulaCurve : public Curve {
 public:
  FormulaCurve(const Interval& domain, Formula formula) : Curve(domain), formula_(std::move(formula)) {}

  Vector velocity(Real u) const override {
    const auto r = formula_(Series<Real, 1>::variable(u));
    return {r.x.c[1], r.y.c[1]};
  }

  Real curvature(Real u) const override {
    return speed_and_curvature(formula_(Series<Real, 3>::variable(u))).second.c[0];
  }

  /// Both as they come out of the formula and by the mean value theorem: the tighter one of the two.
  Bend bend(const Interval& u) const override {
    const auto [speed, curvature] = speed_and_curvature(formula_(Series<Interval, 3>::variable(u)));
    const auto [speed_amid, curvature_amid] = speed_and_curvature(formula_(Series<Real, 3>::variable(u.middle())));
    const Interval off(-u.width() / 2, u.width() / 2);
    const auto around = [&](Real amid, const Series<Interval, 1>& bounds) {
      const Real error = kAmid * bounds.c[0].size();
      return both(bounds.c[0], Interval(amid - error, amid + error) + bounds.c[1] * off);
    };
    return {around(speed_amid.c[0], speed), around(curvature_amid.c[0], curvature), curvature.c[1] / speed.c[0]};
  }

 private:
  static constexpr Real kAmid = 1e-15L;  // a value without bounds is rounded by less, of what is around it

  Formula formula_;
};

/// An arc of a circle: what intervals would not see is that its curvature does not change.
class Arc : public Curve {
 public:
  Arc(Real radius, Real from, Real sweep)
      : Curve({0, std::abs(sweep)}), radius_(radius), from_(from), side_(sweep > 0 ? 1 : -1) {}

  Vector velocity(Real u) const override {
    const Real at = from_ + side_ * u;
    return {-side_ * radius_ * std::sin(at), side_ * radius_ * std::cos(at)};
  }
  Real curvature(Real) const override { return side_ / radius_; }
  Bend bend(const Interval&) const override { return {radius_, side_ / radius_, 0}; }

 private:
  Real radius_, from_, side_;
};

template <class Formula>
std::shared_ptr<const Curve> curve_of(const Interval& domain, Formula formula) {
  return std::make_shared<FormulaCurve<Formula>>(domain, std::move(formula));
}

}  // namespace oracle
