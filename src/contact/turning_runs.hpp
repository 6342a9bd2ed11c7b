#pragma once

#include <cstddef>
#include <vector>

#include "rollfix/contact/reading.hpp"

namespace rollfix {

/// Rows of a roll between two corners (or ends): the tangent's angle by arc length.
struct TurningRun {
  double lo = 0;  // where the corners or ends are
  double hi = 0;
  std::vector<double> s;  // rising, within [lo, hi]
  std::vector<double> angle;
};

/// A roll cut at its corners. Each run ends where the next begins.
struct TurningRuns {
  std::vector<TurningRun> runs;
  bool starts_at_corner = false;  // the roll starts while the finger pivots
  bool ends_at_corner = false;

  double length() const { return runs.back().hi - runs.front().lo; }
};

/// What tells a corner from a bend.
struct PivotLimits {
  double length = 0;        // rows closer together than this are at one place
  double corner_angle = 0;  // radians: a turn of this size between neighbouring rows is a corner
};

/// Cuts readings, in the direction of growing length, at the corners. Rows at one place are averaged, or, where they
/// turn, are a corner. Throws InputError when a length falls by more than the limit.
TurningRuns turning_runs(const std::vector<Reading>& readings, const PivotLimits& limits);

/// The part of it up to a length.
TurningRuns cut_at(const TurningRuns& runs, double length);

}  // namespace rollfix
