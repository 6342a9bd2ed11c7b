#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "outline/shapes/shapes.hpp"
#include "outline/turn.hpp"
#include "rollfix/curve.hpp"

namespace rollfix::shapes {

namespace {

void refuse_needle(const Parameters& parameters, double a, double b) {
  if (std::max(a, b) > kMostContrast * std::min(a, b)) {
    parameters.refuse(fmt::format("too slim, a and b may differ by a factor of {} at most", kMostContrast));
  }
}

/// The base raised to a whole power >= 0.
double whole_power(double base, int exponent) {
  double result = 1;
  for (; exponent > 0; exponent /= 2) {
    if (exponent % 2 == 1) result *= base;
    base *= base;
  }
  return result;
}

/// c^n + s^n = 1 stretched to half axes a and b, drawn by the direction u of (x/a, y/b):
///   (x/a, y/b) = radius (c, s), radius = g^(-1/n), g = c^n + s^n, c = cos u, s = sin u.
/// The derivatives below follow from (log radius)' = p s - q c with p = c^(n-1)/g, q = s^(n-1)/g, and from
/// p c + q s = 1, which takes out the differences of near-equal terms: (x/a, y/b)' = radius (-q, p).
/// Valid where c, s >= 0, and everywhere when n is even.
class SuperellipseArc {
 public:
  SuperellipseArc(double a, double b, double n) : scale_(a, b), n_(n) {
    if (n == std::floor(n)) whole_n_ = static_cast<int>(n);
  }

  Vec2 velocity(double c, double s) const {
    const double c1 = power(c, -1);
    const double s1 = power(s, -1);
    const double g = c1 * c + s1 * s;
    return radius(g) / g * scale_.cwiseProduct(Vec2(-s1, c1));
  }

  Jet jet(double c, double s) const {
    const double c3 = power(c, -3);  // c^(n-3)
    const double s3 = power(s, -3);
    const double g = c3 * c * c * c + s3 * s * s * s;
    const double p3 = c3 / g;
    const double q3 = s3 / g;
    const double p2 = p3 * c;
    const double q2 = q3 * s;
    const double p = p2 * c;
    const double q = q2 * s;

    const double m = n_ + 1;
    const double x2 = m * p - 2 * c;  // x'' = -radius q2 x2
    const double y2 = 2 * s - m * q;  // y'' =  radius p2 y2
    const double x3 = (m * p - 3 * c) * x2 + 2 * s * s + m * (s * p2 * y2 - p * (p - c));
    const double y3 = (3 * s - m * q) * y2 + 2 * c * c - m * (c * q2 * x2 - q * (s - q));

    const Vec2 axes = radius(g) * scale_;
    return {axes.cwiseProduct(Vec2(c, s)), axes.cwiseProduct(Vec2(-q, p)), axes.cwiseProduct(Vec2(-q2 * x2, p2 * y2)),
            axes.cwiseProduct(Vec2(-q3 * x3, p3 * y3))};
  }

 private:
  double radius(double g) const { return std::pow(g, -1 / n_); }
  double power(double base, int offset) const {
    return whole_n_ > 0 ? whole_power(base, whole_n_ + offset) : std::pow(base, n_ + offset);
  }

  Vec2 scale_;
  double n_;
  int whole_n_ = 0;  // 0 where n is not whole
};

/// n even: one analytic curve all the way round.
struct WholeSuperellipse {
  SuperellipseArc arc;

  Interval domain() const { return {0, kFullTurn}; }
  Vec2 velocity(double u) const {
    const Turn turn = turn_by(u);
    return arc.velocity(turn.cosine, turn.sine);
  }
  Jet jet(double u) const {
    const Turn turn = turn_by(u);
    return arc.jet(turn.cosine, turn.sine);
  }
};

/// Any n: a quarter between two axes, where |.|^n is not analytic.
struct SuperellipseQuarter {
  SuperellipseArc arc;  // drawn in the first quadrant, then turned
  int quarter_turns;

  static constexpr double kQuarter = std::numbers::pi / 2;

  Interval domain() const { return {0, kQuarter}; }
  Vec2 turned(const Vec2& v) const {
    switch (quarter_turns) {
      case 0:
        return v;
      case 1:
        return {-v.y(), v.x()};
      case 2:
        return -v;
      default:
        return {v.y(), -v.x()};
    }
  }
  // Measured from the nearer axis, so that both ends are on an axis exactly.
  static Vec2 direction(double u) {
    if (u <= kQuarter / 2) return {std::cos(u), std::sin(u)};
    return {std::sin(kQuarter - u), std::cos(kQuarter - u)};
  }
  Vec2 velocity(double u) const {
    const Vec2 d = direction(u);
    return turned(arc.velocity(d.x(), d.y()));
  }
  Jet jet(double u) const {
    const Vec2 d = direction(u);
    const Jet plain = arc.jet(d.x(), d.y());
    return {turned(plain.position), turned(plain.first), turned(plain.second), turned(plain.third)};
  }
};

Curves whole_ellipse(double a, double b) { return {EllipticArc(Vec2::Zero(), {a, 0}, {0, b}, 0, kFullTurn)}; }

}  // namespace

Curves circle(const Parameters& parameters) { return {Arc(Vec2::Zero(), parameters.number("r"), 0, kFullTurn)}; }

Curves ellipse(const Parameters& parameters) {
  const double a = parameters.number("a");
  const double b = parameters.number("b");
  refuse_needle(parameters, a, b);
  return whole_ellipse(a, b);
}

Curves superellipse(const Parameters& parameters) {
  const double a = parameters.number("a");
  const double b = parameters.number("b");
  const double n = parameters.number("n");
  refuse_needle(parameters, a, b);
  if (n == 2) return whole_ellipse(a, b);
  if (n < 3) parameters.refuse("n must be 2 or at least 3: between them the curvature has infinite slope on the axes");
  if (std::fmod(n, 2) == 0) return {WholeSuperellipse{{a, b, n}}};
  Curves curves;
  for (int quarter = 0; quarter < 4; ++quarter) {
    const bool swapped = quarter % 2 == 1;
    curves.push_back(SuperellipseQuarter{{swapped ? b : a, swapped ? a : b, n}, quarter});
  }
  return curves;
}

}  // namespace rollfix::shapes
