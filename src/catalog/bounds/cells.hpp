#pragma once

#include <Eigen/Core>
#include <bitset>
#include <cmath>
#include <cstddef>
#include <vector>

#include "clues.hpp"
#include "profile.hpp"
#include "rollfix/part.hpp"

namespace rollfix::catalog {

/// What one reading asks of the tangent at the start, as if its own error were none; and 1 / its variance.
template <typename Lanes>
struct Asked {
  Lanes least;  // tau is at least this, radians, ...
  Lanes most;   // ... and at most this
  typename Lanes::Scalar weight;
};

/// An interval of tangents at the start, and the standard deviation of an error that all readings share.
template <typename Lanes>
struct Start {
  Lanes least;
  Lanes most;
  typename Lanes::Scalar shared_sd;
};

/// Lower bounds on the sum of squares of all errors, in standard deviations, over all tangents at the start and all
/// shared errors; for several starts side by side. Where one is no more than `enough`, that is all that it says. As a
/// function of the two together, x, the sum is convex: its slope is bisected, and the bound is where two tangents of it
/// meet at worst.
template <typename Lanes>
Lanes least_cost(const Start<Lanes>& start, const std::vector<Asked<Lanes>>& asked, typename Lanes::Scalar enough) {
  using Scalar = typename Lanes::Scalar;
  // Of the slope's interval: more make the bound closer where it is near `enough`, and take time.
  constexpr int kHalvings = 12;
  // One parabola of x, 0 between least and most: convex, and so is the sum of all.
  const auto add = [](const Lanes& x, const Asked<Lanes>& one, Lanes& cost, Lanes& slope) {
    const Lanes miss = (x - one.most).max(Scalar(0)) - (one.least - x).max(Scalar(0));
    cost += one.weight * miss.square();
    slope += 2 * one.weight * miss;
  };
  const auto at = [&](const Lanes& x, Lanes& cost, Lanes& slope) {
    cost.setZero();
    slope.setZero();
    for (const Asked<Lanes>& one : asked) add(x, one, cost, slope);
    if (start.shared_sd > 0) {
      add(x, {start.least, start.most, 1 / (start.shared_sd * start.shared_sd)}, cost, slope);
    }
  };
  // Farther from the start's interval than this the shared error alone costs more than `enough`.
  const Scalar room = std::sqrt(enough) * start.shared_sd;
  Lanes lo = start.least - room;
  Lanes hi = start.most + room;
  Lanes cost_lo;
  Lanes cost_hi;
  Lanes slope_lo;
  Lanes slope_hi;
  at(lo, cost_lo, slope_lo);
  at(hi, cost_hi, slope_hi);
  // A convex function lies above its tangents. That at lo bounds it from below over all of [lo, hi], and so does that
  // at hi: the larger of both bounds holds.
  const auto bound = [&]() -> Lanes {
    const Lanes from_lo = cost_lo + (slope_lo < 0).select(slope_lo * (hi - lo), Lanes::Zero());
    const Lanes from_hi = cost_hi - (slope_hi > 0).select(slope_hi * (hi - lo), Lanes::Zero());
    return from_lo.max(from_hi);
  };
  // Invariant: the minimum over [lo, hi] as it was first lies in the present one: the slope is below 0 at lo and not
  // below 0 at hi, or the end is the first one.
  for (int k = 0; k < kHalvings; ++k) {
    // Goes on only while some lane could still fall to `enough`: a value at an end at most `enough` settles that it
    // does, a bound above it that it does not.
    const bool may_be_less = ((cost_lo.min(cost_hi) > enough) && (bound() <= enough)).any();
    if (!may_be_less) break;
    const Lanes middle = lo + Scalar(0.5) * (hi - lo);
    Lanes cost;
    Lanes slope;
    at(middle, cost, slope);
    const auto rises = slope >= 0;
    hi = rises.select(middle, hi);
    cost_hi = rises.select(cost, cost_hi);
    slope_hi = rises.select(slope, slope_hi);
    lo = rises.select(lo, middle);
    cost_lo = rises.select(cost_lo, cost);
    slope_lo = rises.select(slope_lo, slope);
  }
  return bound();
}

/// Some of N equal cells of the boundary.
template <std::size_t N>
using Cells = std::bitset<N>;

/// What bounds need to know of a part besides its profile.
struct Course {
  float perimeter = 0;       // in the catalog's unit
  float period_turn = 0;     // turn of a lap, radians: 2 pi of a simple closed outline
  float most_curvature = 0;  // the largest |kappa|
  bool closed = true;
};

/// The cells in which the roll can have started, of those within these larger ones. None is left out in which all the
/// readings fit within their slack, with one tangent at the start. Of two fingers: in which finger a can have.
template <std::size_t N>
Cells<N> cells_left(const Profile<N>& profile, const Course& course, const Clues& clues, const Cells<N / 4>& within);

extern template Cells<kCoarseCells> cells_left(const Profile<kCoarseCells>&, const Course&, const Clues&,
                                               const Cells<kCoarseCells / 4>&);
extern template Cells<kCells> cells_left(const Profile<kCells>&, const Course&, const Clues&,
                                         const Cells<kCoarseCells>&);
extern template Cells<kFineCells> cells_left(const Profile<kFineCells>&, const Course&, const Clues&,
                                             const Cells<kCells>&);

/// Whether one finger's roll can have started anywhere in these cells: they are halved, with bounds from the part
/// itself, until nothing is left or halves are not worth looking at any more.
bool may_start(const Part& part, const Clues& clues, const Cells<kFineCells>& cells);

}  // namespace rollfix::catalog
