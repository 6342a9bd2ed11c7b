#include <fmt/format.h>

#include <cmath>
#include <complex>

#include "outline/shapes/shapes.hpp"
#include "outline/turn.hpp"

// Shapes in polar form, and the two open ones.
// Notation:
//   u, r(u)         polar angle, and the radius there with its derivatives: RadiusJet; x = r cos u, y = r sin u
//   a, b            as docs/gallery.md has them for each shape
// Follows docs/gallery.md: in polar form (r e^iu)' = (r' + i r) e^iu, and so on.
namespace rollfix::shapes {

namespace {

/// A radius and its derivatives by the angle.
struct RadiusJet {
  double value;  // length
  double first;  // by u, and so on
  double second;
  double third;
};

/// r = r(u) once around, in polar form: x = r cos u, y = r sin u. `Radius` gives RadiusJet from a Turn.
template <class Radius>
struct Polar {
  Radius radius;

  Interval domain() const { return {0, kFullTurn}; }

  /// (r e^iu)' = (r' + i r) e^iu.
  Vec2 velocity(double u) const {
    const Turn turn = turn_by(u);
    const RadiusJet r = radius(turn);
    return in_frame(turn, r.first, r.value);
  }

  /// By the product rule: '' is (r'' - r) + 2 i r', ''' is (r''' - 3 r') + i (3 r'' - r), each times e^iu.
  Jet jet(double u) const {
    const Turn turn = turn_by(u);
    const RadiusJet r = radius(turn);
    return {in_frame(turn, r.value, 0), in_frame(turn, r.first, r.value),
            in_frame(turn, r.second - r.value, 2 * r.first),
            in_frame(turn, r.third - 3 * r.first, 3 * r.second - r.value)};
  }

 private:
  /// (outward + i around) e^iu: parts along the radius and perpendicular to it.
  static Vec2 in_frame(const Turn& turn, double outward, double around) {
    return {outward * turn.cosine - around * turn.sine, outward * turn.sine + around * turn.cosine};
  }
};

/// r = a + b cos u, with a > 0.
struct LimaconRadius {
  double a;
  double b;

  RadiusJet operator()(const Turn& turn) const {
    // Where b cos u is close to -|b|, the sum is taken as (a - |b|) + |b| (1 - cos^2)/(1 - ...) without cancellation.
    // r = (a - |b|) + |b| (1 + c) with c = cos u, or -cos u where b < 0. For c < 0, 1 + c is computed as
    // sin^2 u / (1 - c).
    const double cosine = b < 0 ? -turn.cosine : turn.cosine;
    const double above_least = cosine < 0 ? turn.sine * turn.sine / (1 - cosine) : 1 + cosine;
    const double size = std::abs(b);
    return {(a - size) + size * above_least, -b * turn.sine, -b * turn.cosine, b * turn.sine};
  }
};

/// r = base + lift q^2, q = (1 + cos u)/2.
struct CamRadius {
  double base;
  double lift;

  RadiusJet operator()(const Turn& turn) const {
    // The derivatives of q; those of q^2 follow by the product rule.
    const double q = 0.5 * (1 + turn.cosine);
    const double q1 = -0.5 * turn.sine;
    const double q2 = -0.5 * turn.cosine;
    const double q3 = 0.5 * turn.sine;
    return {base + lift * q * q, 2 * lift * q * q1, 2 * lift * (q1 * q1 + q * q2), 2 * lift * (3 * q1 * q2 + q * q3)};
  }
};

/// r = r0 + depth cos(teeth u).
struct GearRadius {
  double r0;
  double depth;
  double teeth;  // a whole number: the curve closes

  RadiusJet operator()(const Turn& turn) const {
    // teeth * u is rounded; what rounding took is put back to first order.
    const ExactProduct phase = exact_product(teeth, turn.angle);
    const double rounded_cosine = std::cos(phase.value);
    const double rounded_sine = std::sin(phase.value);
    const double cosine = rounded_cosine - phase.rest * rounded_sine;
    const double sine = rounded_sine + phase.rest * rounded_cosine;
    return {r0 + depth * cosine, -teeth * depth * sine, -teeth * teeth * depth * cosine,
            teeth * teeth * teeth * depth * sine};
  }
};

}  // namespace

/// Closer to |b| = a than kMostContrast allows, the turn near r = 0 would be as good as a cusp.
Curves limacon(const Parameters& parameters) {
  const double a = parameters.number("a");
  const double b = parameters.number("b");
  if (kMostContrast * std::abs(a - std::abs(b)) < a) parameters.refuse("it has a cusp where a = |b|; take them apart");
  return {Polar<LimaconRadius>{{a, b}}};
}

/// Any lift of at least 0 leaves the radius above 0.
Curves cam(const Parameters& parameters) {
  return {Polar<CamRadius>{{parameters.number("base"), parameters.number("lift")}}};
}

/// The radius must stay above 0, by more than what kMostContrast allows.
Curves gear(const Parameters& parameters) {
  const double r = parameters.number("r");
  const double depth = parameters.number("depth");
  if (kMostContrast * (r - depth) < r) parameters.refuse("depth must be below r, or the gaps reach the centre");
  return {Polar<GearRadius>{{r, depth, parameters.number("teeth")}}};
}

namespace {

/// r = a e^(b u). As a complex number the point is a e^((b + i) u), so each derivative multiplies by (b + i).
class LogSpiral {
 public:
  /// `angle`: how far it turns, radians.
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

  /// a e^((b + i) u); what rounding took from b u is put back to first order.
  Vec2 point(double u) const {
    const ExactProduct exponent = exact_product(b_, u);
    const double growth = std::exp(exponent.value);
    const double radius = a_ * (growth + growth * exponent.rest);
    return {radius * std::cos(u), radius * std::sin(u)};
  }
  /// The product of complex numbers.
  static Vec2 times(const Vec2& v, const Factor& f) {
    return {v.x() * f.real() - v.y() * f.imag(), v.x() * f.imag() + v.y() * f.real()};
  }

  double a_;      // radius at u = 0
  double b_;      // growth per radian, not 0
  double angle_;  // the domain's end
};

/// x = scale u, y = scale e^u.
struct Exponential {
  double scale;
  Interval range;  // of u

  Interval domain() const { return range; }
  Vec2 velocity(double u) const { return {scale, scale * std::exp(u)}; }
  Jet jet(double u) const {
    const double y = scale * std::exp(u);
    return {{scale * u, y}, {scale, y}, {0, y}, {0, y}};
  }
};

}  // namespace

/// With another b than 0 the curvature is monotone: one spiral from end to end.
Curves log_spiral(const Parameters& parameters) {
  const double a = parameters.number("a");
  const double b = parameters.number("b");
  const double angle = kFullTurn * parameters.number("turns");
  if (b == 0) parameters.refuse("b must not be 0; with b = 0 it is a circle, run through again and again");
  // From one end's radius to the other's.
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
