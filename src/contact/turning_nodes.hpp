#pragma once

#include <vector>

#include "contact/turning_runs.hpp"
#include "outline/turning_span.hpp"

namespace rollfix {

/// Theta(s) between two corners as a cubic between each two nodes, from its values and slopes there.
struct TurningNodes {
  std::vector<double> s;
  std::vector<double> angle;
  std::vector<double> slope;  // the curvature

  /// The cubic after node k, by arc length from there.
  TurningSpan::Cubic cubic(std::size_t k) const;
  double at(double place) const;
};

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

}  // namespace rollfix
