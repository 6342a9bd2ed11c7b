#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "rollfix/curve.hpp"
#include "rollfix/log.hpp"

// Columns of angles that jump back by a turn, or by a finger's whole length, where they were wrapped.
namespace rollfix {

/// The column without jumps, as `unwrapped`, or as it was said to be.
std::vector<double> unwrapped_as_said(const std::vector<double>& angles, double rounding, double period,
                                      const std::optional<bool>& is_wrapped);

/// The first row that is so far from the one before that the column may be wrapped there or may not; nothing where the
/// rows around show which it is, or where it was said.
std::optional<std::size_t> unclear_step(const std::vector<double>& angles, double rounding, double period,
                                        const std::optional<bool>& is_wrapped);

/// Throws InputError when a reader of these rows of a log would take angles as wrapped that are not.
void require_readable(const FingerRows& rows, const std::string& log);

/// Unwraps a column as it grows: what `unwrapped` would make of the last of all angles so far, bit by bit.
class GrowingAngle {
 public:
  /// `is_wrapped`: as it was said to be.
  explicit GrowingAngle(double period, const std::optional<bool>& is_wrapped = {})
      : period_(period), said_(is_wrapped) {}

  /// `rounding`: of each angle so far.
  double add(double angle, double rounding);

  /// The angle before that one, as it is understood now: a column that leaves a full turn was never wrapped.
  double before() const { return before_; }

  /// Whether rows were so far apart that the column may be wrapped there or may not, and nobody said which.
  bool is_unclear(double rounding) const { return !said_ && was_far_ && is_wrapped(rounding); }

 private:
  bool is_wrapped(double rounding) const;

  double period_;             // 2 pi, or the finger's whole length; infinite: nothing wraps
  std::optional<bool> said_;  // whether it is wrapped, where somebody said it
  Interval range_;            // of all angles so far, as written
  std::size_t count_ = 0;     // of them
  double last_ = 0;           // as written
  bool was_far_ = false;      // there was a far step that is long (kNearRows) even if it is taken back
  double turns_ = 0;          // whole ones that were wrapped away, if the column is wrapped
  double before_ = 0;         // the last but one
};

}  // namespace rollfix
