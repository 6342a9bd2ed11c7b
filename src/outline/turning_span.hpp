#pragma once

#include <array>

#include "rollfix/curve.hpp"

namespace rollfix {

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
  Vec2 position(double s) const;

  Vec2 start_;
  Cubic turning_;
  double length_;
};

/// How far a span may turn, the turns to either side added up, radians: what its quadrature is exact for.
inline constexpr double kMostSpanTurn = 1.0;

/// The turns to either side of such a cubic over [0, length] added up, at most.
double span_turn(const TurningSpan::Cubic& turning, double length);

}  // namespace rollfix
