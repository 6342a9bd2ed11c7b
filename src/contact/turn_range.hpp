#pragma once

#include <vector>

#include "rollfix/part/part.hpp"

namespace rollfix {

/// How far the tangent of a part can turn over a stretch of some length: bounds, from a few hundred cells.
class TurnRange {
 public:
  explicit TurnRange(const Part& part);

  /// Holds every Theta(s + l) - Theta(s) with l among these lengths (at least 0), corners at both ends included.
  Interval of(const Interval& lengths) const;

  /// The turns over one lap without their signs, added up.
  double variation() const { return variation_; }

 private:
  struct Cell {
    Interval s;
    Interval angle;
  };

  Interval angles(double from, double to) const;

  bool closed_;
  double perimeter_;
  double period_turn_;
  double variation_ = 0;
  std::vector<Cell> cells_;
};

}  // namespace rollfix
