#include <fmt/format.h>

#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "rollfix/error.hpp"
#include "rollfix/rolling.hpp"

// Notation: as in rig_closure.cpp; the places are zeros of g(s, t) in t.
namespace rollfix {
namespace {

constexpr int kSteps = 4000;

/// What a wheel at t, with the tangent just before or after it, says of a jaw at s.
class Opposite {
 public:
  Opposite(const Part& part, double radius, double s)
      : part_(part), radius_(radius), jaw_(part.turning().at(s)), point_(part.point(s)) {}

  double miss(double t) const {
    const double angle = part_.turning().angle(t);
    return (part_.point(t) - point_).dot(Vec2(std::cos(angle), std::sin(angle)));
  }

  /// On the far side, within reach of the jaw's normal, and stable.
  bool is_grip(double t) const {
    const Turning wheel = part_.turning().at(t);
    const double distance = (part_.point(t) - point_).dot(Vec2(std::sin(wheel.angle), -std::cos(wheel.angle)));
    const double cos_d = std::cos(wheel.angle - jaw_.angle);
    const double hold = -cos_d * (1 + radius_ * wheel.curvature) +
                        (1 - wheel.curvature * distance) * jaw_.curvature * (distance + radius_);
    return distance > 0 && cos_d < 0 && 1 + radius_ * wheel.curvature > 0 && jaw_.curvature > 0 && hold > 0;
  }

  double zero(double lo, double hi, double at_lo, double at_hi) const {
    std::uintmax_t iterations = 100;
    const boost::math::tools::eps_tolerance<double> full(std::numeric_limits<double>::digits);
    const auto bracket =
        boost::math::tools::toms748_solve([&](double t) { return miss(t); }, lo, hi, at_lo, at_hi, full, iterations);
    return std::abs(miss(bracket.first)) < std::abs(miss(bracket.second)) ? bracket.first : bracket.second;
  }

 private:
  const Part& part_;
  double radius_;
  Turning jaw_;
  Vec2 point_;
};

}  // namespace

std::vector<double> squeezed_places(const Part& part, double radius, double s) {
  require_valid(disk(radius));
  const double perimeter = part.perimeter();
  if (!std::isfinite(s) || (!part.closed() && !(s >= 0 && s <= perimeter))) {
    throw InputError(fmt::format("{}: expected a jaw's contact on the part, found s = {}", part.name(), s));
  }
  const Opposite opposite(part, radius, s);
  std::vector<double> places;
  double lo = 0;
  double at_lo = opposite.miss(lo);
  for (int k = 1; k <= kSteps; ++k) {
    const double hi = perimeter * k / kSteps;
    const double at_hi = opposite.miss(hi);
    if (at_lo == 0 && opposite.is_grip(lo)) places.push_back(lo);
    if (at_lo * at_hi < 0) {
      const double t = opposite.zero(lo, hi, at_lo, at_hi);
      // Across a corner g jumps, and has no zero.
      if (std::abs(opposite.miss(t)) <= 1e-9 * perimeter && opposite.is_grip(t)) places.push_back(t);
    }
    lo = hi;
    at_lo = at_hi;
  }
  return places;
}

}  // namespace rollfix
