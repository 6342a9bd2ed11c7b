#pragma once

#include <vector>

#include "rollfix/locate/locate.hpp"

namespace rollfix {

/// At a convex corner Theta takes every value between its one-sided limits: the limit of a rounding of radius 0. So it
/// does at the tiny concave joint (kJointTurn) of a drawing whose digits were rounded. Elsewhere (a concave corner
/// included) the interval is the limits' hull or a single value.
struct AngleSet {
  Interval angles;
  bool pivot = false;    // a convex corner or a tiny joint: every value in between is taken
  bool concave = false;  // a concave corner: only the two ends are
};

/// Theta at s as a set. Places within kLengthAccuracy * P of a corner are at it.
AngleSet angle_set(const Part& part, double s);

/// What to try of a set, one at a time: a pivot's interval, or the one or two values at a smooth point or a concave
/// corner.
std::vector<Interval> choices(const AngleSet& set);

/// How far 0 is from f(s) = Theta(s + L) - Theta(s) - theta, corners taken as sets; all readings share the start's
/// tangent. This is the residual of s: the largest |f_k| for the best choice within the pivots.
double residual_at(const Part& part, const std::vector<Reading>& readings, double s);

/// The tangents at the first and the last contact that a start at s leaves possible.
Pivot pivot_at(const Part& part, const std::vector<Reading>& readings, double s);

}  // namespace rollfix
