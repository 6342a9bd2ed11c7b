#pragma once

#include <cmath>

namespace rollfix {

/// A point of a closed boundary: value = base + winding * period, base in [0, period).
struct Wrapped {
  double base = 0;
  double winding = 0;  // a whole number
};

/// The only place where arc lengths are reduced to one period. `period` > 0.
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

/// The distance between two points of a closed boundary, the shorter way round.
inline double periodic_distance(double a, double b, double period) {
  const double ahead = wrap(b - a, period).base;
  return std::fmin(ahead, period - ahead);
}

}  // namespace rollfix
