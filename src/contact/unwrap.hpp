#pragma once

#include <cstddef>

#include "rollfix/contact/log.hpp"
#include "rollfix/outline/curve.hpp"

namespace rollfix {

/// Throws InputError when a reader of these rows would take angles as wrapped that are not.
void require_readable(const Log& log);

/// Unwraps a column as it grows: what `unwrapped` would make of the last of all angles so far, bit by bit.
class GrowingAngle {
 public:
  explicit GrowingAngle(double period) : period_(period) {}

  /// `rounding`: of each angle so far.
  double add(double angle, double rounding);

  /// The angle before that one, as it is understood now: a column that leaves a full turn was never wrapped.
  double before() const { return before_; }

 private:
  double period_;
  Interval range_;
  std::size_t count_ = 0;
  double last_ = 0;    // as written
  double turns_ = 0;   // whole ones that were wrapped away, if the column is wrapped
  double before_ = 0;  // the last but one
};

}  // namespace rollfix
