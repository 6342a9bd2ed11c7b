#include <boost/math/special_functions/cos_pi.hpp>
#include <boost/math/special_functions/sin_pi.hpp>
#include <cstdint>
#include <numbers>
#include <random>

#include "outline/shapes/shapes.hpp"
#include "rollfix/outline/points.hpp"

namespace rollfix::shapes {

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
