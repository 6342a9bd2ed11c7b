#pragma once

#include <functional>
#include <optional>

#include "teach/turning_course.hpp"

namespace rollfix::teaching {

/// A roll around a part, and how far it may have drifted on the way.
struct RoundRoll {
  const TurningRuns& runs;      // rows
  const TurningCourse& course;  // Theta made of them, nothing closed
  double row_sd = 0;            // of a row's turn, radians, above 0
  double turn_sd = 0;           // of the turn's drift over a lap, radians
  double turn_allowed = 0;      // as much the turn may be off after a lap, radians
  double gap_allowed = 0;       // as far the roll may be from its start after a lap
  double gap_sd = 0;            // what noise and drift move the end by; 0: rows are exact
  double corner_sd = 0;         // of the place where rows pivot, above 0
};

/// One time round.
struct Lap {
  double length = 0;     // in the log's unit
  double length_sd = 0;  // 0: rows are exact
  int turns = 0;         // whole ones that the tangent makes; below 0: clockwise
  double turn_gap = 0;   // of the turn, less `turns` times 2 pi, radians
  bool goes_on = false;  // the roll does after it: then both are from all rows of the overlap
};

/// Where the roll first comes back to its start: a place near it and a direction like it. Where it goes on, both passes
/// of the overlap are laid over one another: the length is that at which they turn alike. A roll that ends where it
/// began, as far as its rows can say, is one lap.
std::optional<Lap> find_lap(const RoundRoll& roll);

/// The rows of one lap. What the roll goes on is laid over its beginning, each row with its pass and its ramp, given
/// the share of a lap's drift at a length rolled. `exact`: rows of later passes are left out, there is nothing to
/// average.
TurningRuns lay_over(const TurningRuns& runs, const Lap& lap, bool exact,
                     const std::function<double(double)>& drift_share, double near_corner);

}  // namespace rollfix::teaching
