#pragma once

#include "teach/felt_roll.hpp"

namespace rollfix {

/// Theta over a lap whose turn is closed, the curvature continuous across the seam.
struct RoundCourse {
  TurningCourse course;
  TurningRuns rows;  // without the drift
  double drift = 0;  // of the turn, that was spread, radians
};

/// `turns`: whole ones that the lap is closed to; `turn_gap`: as much its turn is off them. Noisy rows tell the drift
/// from the shape as well as they can, by least squares, given how large it can be. `sums` are of this alone.
RoundCourse round_course(const FeltRoll& roll, const TurningRuns& lap, int turns, double turn_gap, FitSums& sums);

}  // namespace rollfix
