#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "rollfix/outline/curve.hpp"

namespace rollfix {

/// Arc length is accurate to this share of the perimeter: places closer together than that are one place.
inline constexpr double kLengthAccuracy = 1e-12;

/// A point of a loop: value = base + winding * period, base in [0, period).
struct Wrapped {
  double base = 0;
  double winding = 0;  // a whole number
};

/// The only place where lengths are reduced to one period. `period` > 0.
inline Wrapped wrap(double value, double period) {
  if (value >= 0 && value < period) return {value, 0};
  double winding = std::floor(value / period);
  double base = value - winding * period;
  // The quotient is rounded: the remainder can come out a whole period off, or at the period itself.
  if (base < 0) {
    base += period;
    winding -= 1;
  }
  if (base >= period) {
    base = 0;
    winding += 1;
  }
  return {base, winding};
}

/// Which of two neighbouring things is meant where they meet: what ends there or what starts there.
enum class Side { before, after };

/// What the places s of a boundary are: of a closed one a loop, on which s and s + P are one place; of an open one the
/// segment [0, P]. Knows no geometry.
///
/// An arc of it, a stretch from lo forwards to hi, is an Interval: any lo and hi >= lo on a closed boundary, where it
/// may go on across s = 0 and holds all that is a whole number of perimeters off. hi < lo: the empty arc. As wide as P:
/// the full one.
struct Boundary {
  double perimeter = 0;  // P, above 0
  bool closed = true;

  static constexpr Interval empty_arc() {
    return {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  }
  Interval full_arc() const { return {0, perimeter}; }

  static bool is_empty(const Interval& arc) { return !(arc.lo <= arc.hi); }
  bool is_full(const Interval& arc) const {
    return closed ? arc.width() >= perimeter : arc.lo <= 0 && arc.hi >= perimeter;
  }

  // ---- places ----

  /// s as a place on [0, P) and whole laps, or from before on (0, P]; of an open boundary clamped to [0, P], no laps.
  Wrapped reduced(double s, Side side = Side::after) const {
    if (!closed) return {std::min(std::max(s, 0.0), perimeter), 0};
    const Wrapped place = wrap(s, perimeter);
    return place.base == 0 && side == Side::before ? Wrapped{perimeter, place.winding - 1} : place;
  }
  double base(double s) const { return reduced(s).base; }

  /// s in [0, P) of a closed boundary; of an open one s as it is, on it or beyond an end.
  double on_first_lap(double s) const { return closed ? wrap(s, perimeter).base : s; }

  /// The same, and what lies before P by no more than rounding is 0: one name for one place.
  double canonical(double s) const {
    const double at = base(s);
    return closed && perimeter - at <= kLengthAccuracy * perimeter ? 0 : at;
  }

  /// How far it is forwards from one place to another: in [0, P) on a closed boundary; below 0 on an open one where
  /// the other lies behind.
  double ahead(double from, double to) const { return closed ? wrap(to - from, perimeter).base : to - from; }

  /// The same the shorter way, forwards or (below 0) backwards.
  double offset(double from, double to) const { return closed ? std::remainder(to - from, perimeter) : to - from; }

  /// How far apart two places are.
  double distance(double one, double other) const {
    if (!closed) return std::abs(one - other);
    const double forwards = ahead(one, other);
    return std::fmin(forwards, perimeter - forwards);
  }

  // ---- arcs ----

  /// The arc by one name: lo in [0, P), canonical where the arc is no longer than rounding; hi may exceed P. The full
  /// one is [0, P]. Of an open boundary what lies in [0, P].
  Interval arc(double lo, double hi) const {
    if (!closed) return {std::max(lo, 0.0), std::min(hi, perimeter)};
    const double width = hi - lo;
    if (width >= perimeter) return full_arc();
    if (!(width >= 0)) return empty_arc();
    const double start = width <= kLengthAccuracy * perimeter ? canonical(lo) : base(lo);
    return {start, start + width};
  }

  /// Does it hold s, or miss it by no more than the slack?
  bool contains(const Interval& arc, double s, double slack = 0) const {
    if (is_empty(arc)) return false;
    if (!closed) return s >= arc.lo - slack && s <= arc.hi + slack;
    return ahead(arc.lo - slack, s) <= arc.width() + 2 * slack;
  }

  /// How far outside an arc a place is: 0 inside; of the empty one infinity.
  double distance(const Interval& arc, double s) const {
    if (is_empty(arc)) return std::numeric_limits<double>::infinity();
    if (!closed) return std::max({0.0, arc.lo - s, s - arc.hi});
    const double forwards = ahead(arc.lo, s);
    if (forwards <= arc.width()) return 0;
    return std::min(forwards - arc.width(), perimeter - forwards);
  }

  /// Have two arcs a place in common?
  bool intersects(const Interval& one, const Interval& other) const {
    if (is_empty(one) || is_empty(other)) return false;
    if (!closed) return one.lo <= other.hi && other.lo <= one.hi;
    return ahead(one.lo, other.lo) <= one.width() || ahead(other.lo, one.lo) <= other.width();
  }

  /// Does one arc hold all of another?
  bool covers(const Interval& arc, const Interval& inner) const {
    if (is_empty(inner) || is_full(arc)) return true;
    if (is_empty(arc)) return false;
    if (!closed) return arc.lo <= inner.lo && inner.hi <= arc.hi;
    return ahead(arc.lo, inner.lo) + inner.width() <= arc.width();
  }
};

/// The distance between two points of a closed boundary, the shorter way round.
inline double periodic_distance(double a, double b, double period) { return Boundary{period, true}.distance(a, b); }

}  // namespace rollfix
