#pragma once

#include <cstddef>

#include "outline/fitted_spline.hpp"
#include "teach/turning_course.hpp"

namespace rollfix::teaching {

/// How near to the rows.
struct TurningFit {
  double tolerance = 0;        // radians; nodes are added until the rows are within it
  bool rows_are_exact = true;  // where that takes about as many nodes as rows: take the rows themselves
};

/// Theta over the run. Where rows only grow (or only fall), so does Theta; where they stay, Theta does.
TurningNodes fit(const TurningRun& run, const TurningFit& how);

/// The same of a run that goes round and on, its end joining its start: over [lo, hi] Theta grows by `turn`, and the
/// curvature at both ends is the same.
TurningNodes fit_round(const TurningRun& run, double turn, const TurningFit& how);

/// Of a spline whose points' first coordinates are values: its value and slope at s, also beyond its ends.
Vec2 value_and_slope(const FittedSpline& spline, double s);

/// The same function, with a node at each break. Of a closed spline the last is the first.
TurningNodes nodes_at_breaks(const FittedSpline& spline);

/// Where nodes only grow or only fall, or stay, the cubics between them do as well; their slopes change. `round`: the
/// last node is the first.
void make_monotone(TurningNodes& nodes, bool round);

/// How rows are off: each by its own normal error, or by the sum of its own and all before it.
struct RowErrors {
  double sd = 0;         // radians, above 0
  bool gathers = false;  // increments
};

/// What a least-squares fit took and left, over one run or several.
struct FitSums {
  std::size_t rows = 0;     // rows of the runs; where errors gather, the steps between them
  double coefficients = 0;  // of the splines: as many parameters were free
  double squares = 0;       // radians^2: of what the rows are off; of rows that gather, of what each adds
  // What is left of the ramp when it is fitted like the rows: how well the rows tell the drift from the shape.
  double ramps = 0;  // its square
  double both = 0;   // times what is left of the rows
};

/// Theta over the run, which has noise: a cubic spline of least squares with as few knots as the noise allows. A span
/// is halved while blocks of its rows are off, on average, by more than chance makes of the noise (chi-square).
TurningNodes smooth(const TurningRun& run, const RowErrors& errors, FitSums& sums);

/// The same of a run that goes round and on, see fit_round. Several passes may lie over one another.
TurningNodes smooth_round(const TurningRun& whole, double turn, const RowErrors& errors, FitSums& sums);

}  // namespace rollfix::teaching
