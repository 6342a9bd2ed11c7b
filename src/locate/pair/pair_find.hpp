#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "rollfix/locate.hpp"
#include "rollfix/turning_function.hpp"

namespace rollfix::locating {

/// Two first contacts: s of finger a and t of finger b.
using PairPoint = std::array<double, 2>;

/// A box of them.
using PairBox = std::array<Interval, 2>;

/// Whole perimeters that are added to s and to t.
using Shift = std::array<double, 2>;

/// The same pair, or box, by another name on a closed outline.
inline PairPoint moved(const PairPoint& point, const Shift& shift) {
  return {point[0] + shift[0], point[1] + shift[1]};
}

inline PairBox moved(const PairBox& box, const Shift& shift) {
  return {Interval{box[0].lo + shift[0], box[0].hi + shift[0]}, Interval{box[1].lo + shift[1], box[1].hi + shift[1]}};
}

/// The least box around points; around none an empty one.
template <class Points>
PairBox box_about(const Points& points) {
  PairBox box{Boundary::empty_arc(), Boundary::empty_arc()};
  for (const PairPoint& at : points) {
    for (const std::size_t k : {0U, 1U}) box[k] = {std::min(box[k].lo, at[k]), std::max(box[k].hi, at[k])};
  }
  return box;
}

/// In the plane of s and t, not across s = 0 or t = 0.
inline double distance(const PairPoint& one, const PairPoint& two) {
  const double s = one[0] - two[0];
  const double t = one[1] - two[1];
  return std::sqrt(s * s + t * t);  // no hypot: nothing here is near to under- or overflow, and it is called often
}

/// A pair of first contacts at which every f_k is 0, or, of more equations than two, those that cross best there.
struct PairRoot {
  PairPoint at{};
  int sign = 0;         // of det J; 0 where J is singular
  bool corner = false;  // thanks to a corner's pivot
  bool exact = true;    // every f_k is 0
};

/// A connected set of pairs on which every |f_k| is within the tolerance.
struct PairPiece {
  PairBox box;                  // around it
  std::vector<PairPoint> hull;  // a convex polygon around it; empty: the box
  std::vector<PairPoint> line;  // through it, where f = 0 along a line
  double error = 0;             // how far the hull or the line may be off
  bool exact = false;           // f = 0 on all of it
  bool corner = false;          // where corners' pivots make up the difference
};

/// What a search leaves of the boxes that it looked at.
struct PairFindings {
  // In the order in which they were found, as are the roots.
  std::vector<PairPiece> pieces;
  std::vector<PairRoot> roots;
  // Boxes that were neither excluded nor listed, for the budget was used up.
  std::vector<PairBox> unresolved;
  SearchCounts counts;
};

/// What all steps of one search need to know.
struct PairLimits {
  double tolerance = 0;   // of every component: of rolls radians
  double perimeter = 0;   // P
  double same_place = 0;  // lengths below this are rounding errors
  bool facing = false;    // the last row is modulo 2 pi
  bool covered = false;   // inside a set that is within the tolerance and already listed: only its roots are missing

  /// For a box inside a listed set: its roots alone are looked for, to rounding.
  PairLimits inside() const {
    PairLimits limits = *this;
    limits.tolerance = kTurnAccuracy;
    limits.covered = true;
    return limits;
  }
};

}  // namespace rollfix::locating
