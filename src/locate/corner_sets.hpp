#pragma once

#include <algorithm>
#include <boost/container/small_vector.hpp>
#include <cstddef>
#include <optional>
#include <span>

#include "rollfix/locate.hpp"
#include "rollfix/part.hpp"

namespace rollfix {

/// What a simple root is accurate to: this share of the perimeter, or kRootTurn over the slope of f (of two fingers,
/// through the inverse of J).
inline constexpr double kRootLength = 1e-9;
/// |f| at a root, radians.
inline constexpr double kRootTurn = kLeastTolerance;
/// A slope of f, or a singular value of J, below this share of the curvatures that it is made of is rounding noise.
inline constexpr double kNoSlope = 1e-10;
/// The search takes places no further apart than kLengthAccuracy P for one; what bounds it has so many times that to
/// spare.
inline constexpr double kSamePlaces = 4;
/// An angle is rounded to this share of itself.
inline constexpr double kAngleRounding = 1e-15;

/// At a convex corner Theta takes every value between its one-sided limits: the limit of a rounding of radius 0. So it
/// does at the tiny concave joint (kJointTurn) of a drawing whose digits were rounded. Elsewhere (a concave corner
/// included) the interval is the limits' hull or a single value.
struct AngleSet {
  Interval angles;
  bool pivot = false;    // a convex corner or a tiny joint: every value in between is taken
  bool concave = false;  // a concave corner: only the two ends are
};

/// Theta at s as a set. Places within kLengthAccuracy * P of a corner are at it, of a convex one as near as
/// `at_corner`.
AngleSet angle_set(const Part& part, double s, double at_corner = 0);

/// What is asked of first contacts: f_k = 0 for each reading, and of two fingers the facing equation where it is known.
struct ContactEquations {
  const Part& part;
  std::span<const Reading> readings;  // one or more, all of one finger or all of two
  // C in Theta(s) - Theta(t) = C mod 2 pi, radians; empty: not known, or one finger.
  std::optional<double> facing{};
  double at_corner = 0;  // contacts that are no further from a convex corner may be at it: lengths are known no better

  std::size_t fingers() const { return readings.front().fingers(); }
  /// How many equations: one for each reading, and the facing.
  std::size_t rows() const { return readings.size() + (facing ? 1 : 0); }
  /// More equations than unknown first contacts: roots are where all of them are 0 at once, if at all.
  bool is_overdetermined() const { return rows() > fingers(); }
  /// No reading says more than an interval: every contact was on a corner of the finger.
  bool is_open() const {
    return std::none_of(readings.begin(), readings.end(), [](const Reading& reading) { return reading.is_exact(); });
  }
};

/// The largest |f_k| at these first contacts, the facing equation's included, corners taken as sets: for the best
/// choice within the pivots, those of the first contacts being the same for all readings.
double residual_at(const ContactEquations& question, const PerFinger<double>& at);

/// Theta at a first contact of one finger ([0]) and where reading k's roll ends from there ([k + 1]), unwrapped,
/// radians; for a part without corners.
using Tangents = boost::container::small_vector<double, 4>;
Tangents tangents_of(const ContactEquations& question, std::size_t finger, double at);

/// Of two fingers the same as residual_at their first contacts. REQUIRES a part without corners.
double residual_of(const ContactEquations& question, const Tangents& of_a, const Tangents& of_b);

/// The tangents at the first and the last contacts, `at` and `end`, that are left possible. With noise the last ones
/// need not be where the last lengths end.
PerFinger<Pivot> pivots_at(const ContactEquations& question, const PerFinger<double>& at, const PerFinger<double>& end);

}  // namespace rollfix
