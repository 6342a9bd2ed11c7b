#include <fmt/format.h>

#include <algorithm>
#include <boost/math/special_functions/cos_pi.hpp>
#include <boost/math/special_functions/sin_pi.hpp>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

#include "outline/shapes/shapes.hpp"
#include "outline/turn.hpp"
#include "rollfix/curve.hpp"
#include "rollfix/outline.hpp"

// Ellipses, and shapes drawn of lines and arcs or through random points.
// Notation:
//   a, b            half axes; r a radius; n the superellipse's exponent, or a number of corners
//   u               direction in which a superellipse is drawn: c = cos u, s = sin u, g = c^n + s^n
// Follows docs/gallery.md; how each is drawn stands beside it.
namespace rollfix::shapes {
namespace {

constexpr double kQuarterTurn = std::numbers::pi / 2;
constexpr double kHalfTurn = std::numbers::pi;

/// Corner number i of n on the circle of radius r; number 0 on the x axis. By half turns, so that corners on an axis
/// are on it exactly.
Vec2 corner(double r, int i, int n) {
  const double half_turns = 2.0 * i / n;
  return r * Vec2(boost::math::cos_pi(half_turns), boost::math::sin_pi(half_turns));
}

/// The arcs in order, each joined to the one before by a line that ends exactly on both. Starts with a line.
Curves belt(const std::vector<Curve>& arcs) {
  Curves curves;
  const Curve* before = &arcs.back();
  for (const Curve& arc : arcs) {
    curves.push_back(Line(before->back(), arc.front()));
    curves.push_back(arc);
    before = &arc;
  }
  return curves;
}

}  // namespace

/// Three arcs of radius `width`, each about the corner opposite to it. Corners are at the distance width / sqrt(3) from
/// the middle.
Curves reuleaux(const Parameters& parameters) {
  const double width = parameters.number("width");
  const double r = width / std::numbers::sqrt3;
  Curves curves;
  for (int i = 0; i < 3; ++i) {
    // From corner i to the next, around the third one.
    const double from = (1 + 4 * i) * std::numbers::pi / 6;
    curves.push_back(Arc(corner(r, (i + 2) % 3, 3), width, from, std::numbers::pi / 3));
  }
  return curves;
}

/// Counter-clockwise from the lower line on: belt() puts a line in front of each half circle.
Curves stadium(const Parameters& parameters) {
  const double half = parameters.number("length") / 2;
  const double r = parameters.number("r");
  return belt({Arc({half, 0}, r, -kQuarterTurn, kHalfTurn), Arc({-half, 0}, r, kQuarterTurn, kHalfTurn)});
}

/// Four quarter circles, the lower right one first, with lines in between.
Curves rounded_rectangle(const Parameters& parameters) {
  const double r = parameters.number("r");
  const double x = parameters.number("width") / 2 - r;  // centre of the upper right corner
  const double y = parameters.number("height") / 2 - r;
  if (!(x > 0 && y > 0)) parameters.refuse("twice r must be below width and height");
  return belt({Arc({x, -y}, r, -kQuarterTurn, kQuarterTurn), Arc({x, y}, r, 0, kQuarterTurn),
               Arc({-x, y}, r, kQuarterTurn, kQuarterTurn), Arc({-x, -y}, r, kHalfTurn, kQuarterTurn)});
}

/// Neighbouring sides share a corner computed by the same formula, so they meet to the bit.
Curves polygon(const Parameters& parameters) {
  const double r = parameters.number("r");
  const int n = parameters.whole("n");
  Curves curves;
  for (int i = 0; i < n; ++i) curves.push_back(Line(corner(r, i, n), corner(r, (i + 1) % n, n)));
  return curves;
}

namespace {

/// A number in [-1, 1) from the generator's top 53 bits. The standard prescribes the generator's bits, but not
/// what its distributions make of them.
double uniform(std::mt19937_64& generator) { return 2 * (static_cast<double>(generator() >> 11) * 0x1p-53) - 1; }

}  // namespace

/// Random radii at equal angles, drawn in order from one generator: the seed alone decides, on every machine.
Curves spline(const Parameters& parameters) {
  const int n = parameters.whole("n");
  const double wobble = parameters.number("wobble");
  std::mt19937_64 generator(static_cast<std::uint64_t>(parameters.number("seed")));
  std::vector<Vec2> points;
  for (int i = 0; i < n; ++i) {
    const double half_turns = 2.0 * i / n;
    const double radius = 1 + wobble * uniform(generator);
    points.push_back(radius * Vec2(boost::math::cos_pi(half_turns), boost::math::sin_pi(half_turns)));
  }
  // Chords turn by less than pi, so none is a corner and the spline is periodic.
  const double no_corners = std::numbers::pi;
  return spline_through(points, true, no_corners);
}

namespace {

/// Throws InputError where the half axes differ by more than kMostContrast.
void refuse_needle(const Parameters& parameters, double a, double b) {
  if (std::max(a, b) > kMostContrast * std::min(a, b)) {
    parameters.refuse(fmt::format("too slim, a and b may differ by a factor of {} at most", kMostContrast));
  }
}

/// The base raised to a whole power >= 0.
double whole_power(double base, int exponent) {
  double result = 1;
  // By repeated squaring: result times base^exponent stays the same from turn to turn.
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
  /// Half axes a and b above 0; n at least 3.
  SuperellipseArc(double a, double b, double n) : scale_(a, b), n_(n) {
    if (n == std::floor(n)) whole_n_ = static_cast<int>(n);
  }

  /// d(x, y)/du at the direction (c, s) = (cos u, sin u).
  Vec2 velocity(double c, double s) const {
    // c^(n-1) and s^(n-1).
    const double c1 = power(c, -1);
    const double s1 = power(s, -1);
    const double g = c1 * c + s1 * s;
    return radius(g) / g * scale_.cwiseProduct(Vec2(-s1, c1));
  }

  /// The same with all derivatives; powers down to n - 3 are needed, hence n of at least 3.
  Jet jet(double c, double s) const {
    const double c3 = power(c, -3);  // c^(n-3)
    const double s3 = power(s, -3);
    const double g = c3 * c * c * c + s3 * s * s * s;
    // p3 = c^(n-3)/g and q3 = s^(n-3)/g, then times c or s, up to p = c^(n-1)/g and q.
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
  /// g^(-1/n): how far the point in direction u is from the middle, half axes taken as 1.
  double radius(double g) const { return std::pow(g, -1 / n_); }
  /// base^(n + offset); a whole power also of a base below 0, and faster.
  double power(double base, int offset) const {
    return whole_n_ > 0 ? whole_power(base, whole_n_ + offset) : std::pow(base, n_ + offset);
  }

  Vec2 scale_;  // half axes
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
  int quarter_turns;    // counter-clockwise, 0 to 3

  static constexpr double kQuarter = std::numbers::pi / 2;

  Interval domain() const { return {0, kQuarter}; }
  /// The vector turned by them, exactly.
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

/// One curve all around; also the superellipse with n = 2.
Curves whole_ellipse(double a, double b) { return {EllipticArc(Vec2::Zero(), {a, 0}, {0, b}, 0, kFullTurn)}; }

}  // namespace

Curves circle(const Parameters& parameters) { return {Arc(Vec2::Zero(), parameters.number("r"), 0, kFullTurn)}; }

Curves ellipse(const Parameters& parameters) {
  const double a = parameters.number("a");
  const double b = parameters.number("b");
  refuse_needle(parameters, a, b);
  return whole_ellipse(a, b);
}

/// In this order: an ellipse, refused, one analytic curve, or four quarters.
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
    // A quarter turned by an odd number of right angles has its half axes exchanged.
    const bool swapped = quarter % 2 == 1;
    curves.push_back(SuperellipseQuarter{{swapped ? b : a, swapped ? a : b, n}, quarter});
  }
  return curves;
}

}  // namespace rollfix::shapes
