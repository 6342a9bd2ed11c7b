#pragma once

#include <cstddef>

#include "teach/turning_course.hpp"

namespace rollfix {

/// How rows are off: each by its own normal error, or by the sum of its own and all before it.
struct RowErrors {
  double sd = 0;         // radians, above 0
  bool gathers = false;  // increments
};

/// What a least-squares fit took and left, over one run or several.
struct FitSums {
  std::size_t rows = 0;
  double coefficients = 0;
  double squares = 0;  // of what the rows are off; of rows that gather, of what each adds
  // What is left of the ramp when it is fitted like the rows: how well the rows tell the drift from the shape.
  double ramps = 0;  // its square
  double both = 0;   // times what is left of the rows
};

/// Theta over the run, which has noise: a cubic spline of least squares with as few knots as the noise allows. A span
/// is halved while blocks of its rows are off, on average, by more than chance makes of the noise (chi-square).
TurningNodes smooth(const TurningRun& run, const RowErrors& errors, FitSums& sums);

/// The same of a run that goes round and on, see fit_round. Several passes may lie over one another.
TurningNodes smooth_round(const TurningRun& whole, double turn, const RowErrors& errors, FitSums& sums);

}  // namespace rollfix
