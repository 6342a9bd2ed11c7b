#include <boost/math/special_functions/cos_pi.hpp>
#include <boost/math/special_functions/sin_pi.hpp>
#include <cstdint>
#include <numbers>
#include <random>

#include "outline/shapes/shapes.hpp"
#include "rollfix/curve.hpp"
#include "rollfix/outline.hpp"

namespace rollfix::shapes {

namespace {

constexpr double kQuarterTurn = std::numbers::pi / 2;
constexpr double kHalfTurn = std::numbers::pi;

/// Corner number i of n on the circle of radius r; number 0 on the x axis.
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

Curves stadium(const Parameters& parameters) {
  const double half = parameters.number("length") / 2;
  const double r = parameters.number("r");
  return belt({Arc({half, 0}, r, -kQuarterTurn, kHalfTurn), Arc({-half, 0}, r, kQuarterTurn, kHalfTurn)});
}

Curves rounded_rectangle(const Parameters& parameters) {
  const double r = parameters.number("r");
  const double x = parameters.number("width") / 2 - r;  // centre of the upper right corner
  const double y = parameters.number("height") / 2 - r;
  if (!(x > 0 && y > 0)) parameters.refuse("twice r must be below width and height");
  return belt({Arc({x, -y}, r, -kQuarterTurn, kQuarterTurn), Arc({x, y}, r, 0, kQuarterTurn),
               Arc({-x, y}, r, kQuarterTurn, kQuarterTurn), Arc({-x, -y}, r, kHalfTurn, kQuarterTurn)});
}

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
  const double no_corners = std::numbers::pi;
  return spline_through(points, true, no_corners);
}

}  // namespace rollfix::shapes
