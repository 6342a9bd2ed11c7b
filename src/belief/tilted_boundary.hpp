#pragma once

#include <cstddef>
#include <vector>

#include "rollfix/outline/curve.hpp"
#include "rollfix/part/part.hpp"

namespace rollfix::belief {

/// A place on the boundary by its tilted turning w = Theta + c s. With c above every -kappa, w grows along the
/// boundary, also through a convex corner, where s stays: it tells all that a contact can be apart. For a disk, c = 1/r
/// and w is how far the finger has turned in the world.
struct TiltedPlace {
  double s = 0;      // arc length, unwrapped
  double slope = 0;  // ds/dw = 1 / (kappa + c); 0 in a corner
};

/// The same where w is known no better than to a standard deviation: the mean of s, the slope that serves best over
/// that range, and the variance that a straight line leaves.
struct SpreadPlace {
  double s = 0;
  double slope = 0;
  double variance = 0;
};

/// A stretch of the boundary that a finger can roll along: all of a closed one, or what lies between its ends and
/// concave corners. s as a function of w, piecewise cubic.
class TiltedArc {
 public:
  /// s and ds/dw at w. On a closed boundary any w; else s stays at the arc's ends beyond them, with slope 0.
  TiltedPlace at(double w) const;

  /// s about w, which is known to this variance, on average over rows that are spread with that one.
  SpreadPlace about(double w, double variance, double spread) const;

  double lo() const { return cells_.front().w; }
  double hi() const { return hi_; }
  bool loop() const { return loop_; }
  /// The ends of the pieces on which s is smooth in w, lo() and hi() included.
  const std::vector<double>& breaks() const { return breaks_; }

 private:
  friend class TiltedBoundary;

  /// s = s0 + x (a + x (b + x c)), x = w - this w.
  struct Cell {
    double w = 0;
    double s = 0;
    double a = 0;
    double b = 0;
    double c = 0;
    double kink_below = 0;  // the nearest places where the slope jumps, from the cell's start: at most 0, and ...
    double kink_above = 0;  // ... above it
  };

  /// A value of w within the arc's own range, its cell, and the s of the windings that were taken off.
  struct Found {
    const Cell* cell;
    double x;
    double shift;
  };
  Found find(double w) const;
  static TiltedPlace on(const Found& found) {
    const Cell& cell = *found.cell;
    const double x = found.x;
    return {cell.s + x * (cell.a + x * (cell.b + x * cell.c)) + found.shift,
            cell.a + x * (2 * cell.b + x * 3 * cell.c)};
  }

  /// Lets the cells from `begin` on, which go back in w, take over from the ones before at w.
  void join(std::size_t begin, double w);
  void index();
  void mark_kinks();

  bool loop_ = false;
  double perimeter_ = 0;
  double hi_ = 0;
  double end_ = 0;  // s at hi
  std::vector<Cell> cells_;
  std::vector<double> breaks_;
  std::vector<std::size_t> bucket_;  // the cell that holds the start of each of many equal steps of w
  double buckets_per_w_ = 0;
};

/// A part's boundary by its tilted turning.
class TiltedBoundary {
 public:
  /// The tilt is `least` or, where that would not make w grow everywhere, more. `accuracy`: of s, length.
  TiltedBoundary(const Part& part, double least, double accuracy);

  double tilt() const { return tilt_; }
  const std::vector<TiltedArc>& arcs() const { return arcs_; }

 private:
  void add_spiral(const TurningFunction& turning, const Spiral& spiral, double winding, double accuracy,
                  TiltedArc& arc) const;

  double tilt_ = 0;
  std::vector<TiltedArc> arcs_;
};

}  // namespace rollfix::belief
