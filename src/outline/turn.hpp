#pragma once

#include <array>
#include <cmath>
#include <numbers>

#include "rollfix/curve.hpp"

namespace rollfix {

inline constexpr double kFullTurn = 2 * std::numbers::pi;
inline constexpr double kDegree = std::numbers::pi / 180;

/// The same angle in (-pi, pi].
inline double nearest_angle(double angle) {
  if (std::abs(angle) < std::numbers::pi) return angle;  // mostly; else without a lap, which is exact
  if (std::abs(angle) < kFullTurn && std::abs(angle) > std::numbers::pi) {
    return angle - std::copysign(kFullTurn, angle);
  }
  const double turned = std::remainder(angle, kFullTurn);
  return turned <= -std::numbers::pi ? std::numbers::pi : turned;
}

/// The same angle within half a turn of 0, in all its digits: 2 pi itself, not the double next to it, is taken off. For
/// angles of at most a billion turns.
inline double without_laps(double angle) {
  constexpr double kRest = 2.4492935982947064e-16;  // 2 pi - kFullTurn
  const double laps = std::nearbyint(angle / kFullTurn);
  return std::fma(-laps, kRest, std::fma(-laps, kFullTurn, angle));
}

/// The signed angle from one direction to another, in (-pi, pi].
inline double angle_between(const Vec2& from, const Vec2& to) { return std::atan2(cross(from, to), from.dot(to)); }

/// An angle with its cosine and sine.
struct Turn {
  double angle = 0;  // radians, in (-pi, pi]
  double cosine = 1;
  double sine = 0;
};

/// The turn by u in [0, 2 pi]. The second half is measured back from the end, so that a full turn gives
/// the bits of no turn at all: curves in polar form close exactly.
inline Turn turn_by(double u) {
  const double angle = u > std::numbers::pi ? u - kFullTurn : u;
  return {angle, std::cos(angle), std::sin(angle)};
}

/// a * b as the sum of two doubles, without error.
struct ExactProduct {
  double value;  // a * b rounded
  double rest;
};

inline ExactProduct exact_product(double a, double b) {
  const double value = a * b;
  return {value, std::fma(a, b, -value)};
}

/// A curve given by how it turns: its tangent's angle by arc length is a cubic,
///   Theta(s) = c0 + c1 s + c2 s^2 + c3 s^3,   s in [0, length],
/// and its position the integral of (cos Theta, sin Theta) from the start. The parameter is the arc length. Exact but
/// for rounding, the position too: by Gauss-Legendre quadrature.
class TurningSpan {
 public:
  using Cubic = std::array<double, 4>;

  /// Throws InputError: a number that is not finite, a length that is not above 0, or a cubic that turns by more than
  /// kMostSpanTurn: cut it into several.
  TurningSpan(const Vec2& start, const Cubic& turning, double length);

  Interval domain() const { return {0, length_}; }
  Vec2 velocity(double s) const;
  Jet jet(double s) const;
  CurveRecord record() const;

 private:
  double angle(double s) const { return turning_[0] + s * (turning_[1] + s * (turning_[2] + s * turning_[3])); }
  /// The point at s, by quadrature.
  Vec2 position(double s) const;

  Vec2 start_;     // the point at s = 0
  Cubic turning_;  // c0 ... c3
  double length_;  // the domain's end
};

/// How far a span may turn, the turns to either side added up, radians: what its quadrature is exact for.
inline constexpr double kMostSpanTurn = 1.0;

/// The turns to either side of such a cubic over [0, length] added up, at most.
double span_turn(const TurningSpan::Cubic& turning, double length);

}  // namespace rollfix
