#pragma once

#include <cstddef>

#include "outline/fitted_spline.hpp"
#include "teach/turning_course.hpp"

namespace rollfix {

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

}  // namespace rollfix
