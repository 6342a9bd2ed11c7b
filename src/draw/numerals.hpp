#pragma once

#include <string>
#include <vector>

#include "rollfix/outline/curve.hpp"

namespace rollfix::draw {

/// A number for the eye: so many significant digits, a true minus sign.
std::string pretty(double value, int digits = 4);

/// An angle in radians shown in degrees.
std::string pretty_degrees(double radians, int digits = 4);

/// Values for the marks of an axis.
struct Ticks {
  std::vector<double> at;
  int decimals = 0;  // that tell them apart
};

/// About `count` round values in the range: steps of 1, 2 or 5 times a power of ten.
Ticks round_ticks(const Interval& range, int count);

/// The same for degrees: steps such as 15, 45, 90, 360.
Ticks degree_ticks(const Interval& range, int count);

/// A tick's value with its axis's decimals and a true minus sign.
std::string tick_text(double value, int decimals);

/// The largest round number (1, 2 or 5 times a power of ten) that is at most `value` > 0.
double round_below(double value);

}  // namespace rollfix::draw
