#include <fmt/format.h>

#include <cmath>
#include <complex>

#include "outline/shapes/shapes.hpp"
#include "outline/turn.hpp"

namespace rollfix::shapes {

namespace {

/// r = a e^(b u). As a complex number the point is a e^((b + i) u), so each derivative multiplies by (b + i).
class LogSpiral {
 public:
  LogSpiral(double a, double b, double angle) : a_(a), b_(b), angle_(angle) {}

  Interval domain() const { return {0, angle_}; }
  Vec2 velocity(double u) const { return times(point(u), Factor(b_, 1)); }
  Jet jet(double u) const {
    const Vec2 position = point(u);
    const Factor once(b_, 1);
    return {position, times(position, once), times(position, once * once), times(position, once * once * once)};
  }

 private:
  using Factor = std::complex<double>;

  Vec2 point(double u) const {
    const ExactProduct exponent = exact_product(b_, u);
    const double growth = std::exp(exponent.value);
    const double radius = a_ * (growth + growth * exponent.rest);
    return {radius * std::cos(u), radius * std::sin(u)};
  }
  static Vec2 times(const Vec2& v, const Factor& f) {
    return {v.x() * f.real() - v.y() * f.imag(), v.x() * f.imag() + v.y() * f.real()};
  }

  double a_;
  double b_;
  double angle_;
};

/// x = scale u, y = scale e^u.
struct Exponential {
  double scale;
  Interval range;

  Interval domain() const { return range; }
  Vec2 velocity(double u) const { return {scale, scale * std::exp(u)}; }
  Jet jet(double u) const {
    const double y = scale * std::exp(u);
    return {{scale * u, y}, {scale, y}, {0, y}, {0, y}};
  }
};

}  // namespace

Curves log_spiral(const Parameters& parameters) {
  const double a = parameters.number("a");
  const double b = parameters.number("b");
  const double angle = kFullTurn * parameters.number("turns");
  if (b == 0) parameters.refuse("b must not be 0; with b = 0 it is a circle, run through again and again");
  const double growth = std::exp(std::abs(b) * angle);
  if (growth > kMostContrast || a * growth > kMostLength || a / growth < kLeastLength) {
    parameters.refuse(fmt::format("the radius changes by a factor of {:.3g}, expected {} at most; take fewer turns",
                                  growth, kMostContrast));
  }
  return {LogSpiral(a, b, angle)};
}

Curves exponential(const Parameters& parameters) {
  const Interval range{parameters.number("from"), parameters.number("to")};
  if (!(range.lo < range.hi)) parameters.refuse("from must be below to");
  return {Exponential{parameters.number("scale"), range}};
}

}  // namespace rollfix::shapes
