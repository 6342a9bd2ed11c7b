#pragma once

#include <algorithm>
#include <cstddef>
#include <numbers>
#include <vector>

#include "rollfix/curve.hpp"
#include "rollfix/part.hpp"
#include "rollfix/turning_function.hpp"

namespace rollfix::belief {

/// Where three points stand for a normal distribution, as many standard deviations from the mean: with the weights 1/6,
/// 2/3, 1/6.
inline constexpr double kSigmaPoint = std::numbers::sqrt3;

// A contact that is this much of a radian off where the boundary is looked at is looked at there as well as anywhere.
inline constexpr double kSameLine = 0.02;

/// The line of least squares through three such points, `reach` from the middle one: its value and slope there, and
/// the variance of what it misses.
struct SigmaLine {
  double mean = 0;
  double slope = 0;
  double variance = 0;

  static SigmaLine through(double below, double middle, double above, double reach) {
    const double half = 0.5 * (above - below);
    const double bend = below - 2 * middle + above;
    // Of the three about their mean, less what the straight line explains.
    return {(below + 4 * middle + above) / 6, reach > 0 ? half / reach : 0, bend * bend / 18};
  }
};

/// Hermite's: from 0 at x = 0, with the slope a there.
struct HermiteCubic {
  double a = 0;  // slope at x = 0
  double b = 0;  // half the second derivative there
  double c = 0;  // a sixth of the third

  /// Through a rise over a step, with these slopes at its ends.
  static HermiteCubic through(double step, double rise, double slope_lo, double slope_hi) {
    const double mean = rise / step;
    return {slope_lo, (3 * mean - 2 * slope_lo - slope_hi) / step, (slope_lo + slope_hi - 2 * mean) / (step * step)};
  }
  double at(double x) const { return x * (a + x * (b + x * c)); }
  double slope(double x) const { return a + x * (2 * b + x * 3 * c); }
};

/// Finds the last of many growing numbers that is at or below another: nearly, at once, by equal steps.
class Buckets {
 public:
  Buckets() = default;
  /// `end`: beyond the last of them.
  Buckets(const std::vector<double>& starts, double end);

  /// No later than it, and few before it.
  std::size_t before(double x) const {
    const auto step = static_cast<std::size_t>(std::max(0.0, (x - lo_) * per_length_));
    return first_[std::min(step, first_.size() - 1)];
  }

 private:
  double lo_ = 0;
  double per_length_ = 0;
  std::vector<std::size_t> first_;
};

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
  /// How far w is beyond an end of its arc, in standard deviations, less what noise explains; and its derivative by w.
  /// An open end and a concave corner are no corners to pivot at: what is beyond contradicts the place.
  double beyond = 0;
  double beyond_by_w = 0;
};

/// A stretch of the boundary that a finger can roll along: all of a closed one, or what lies between its ends and
/// concave corners. s as a function of w, piecewise cubic.
class TiltedArc {
 public:
  /// s and ds/dw at w. On a closed boundary any w; else s stays at the arc's ends beyond them, with slope 0.
  TiltedPlace at(double w) const;

  /// A w at which the contact is at s, unwrapped; of a corner the last one. Beyond the arc's ends: theirs.
  double w_at(double s) const;

  /// s about w, which is known to this variance, on average over rows that are spread with that one.
  SpreadPlace about(double w, double variance, double spread) const;

  double lo() const { return cells_.front().w; }
  double hi() const { return hi_; }
  bool loop() const { return loop_; }
  /// Where the slope jumps, within [lo(), hi()]: at corners, joints of the curvature and an arc's ends. A spline
  /// through points has none, however many points there are.
  const std::vector<double>& kinks() const { return kinks_; }
  std::size_t cells() const { return cells_.size(); }

 private:
  friend class TiltedBoundary;

  /// s = s0 + the cubic of w - this w.
  struct Cell {
    double w = 0;
    double s = 0;
    HermiteCubic cubic;
    double kink_below = 0;  // the nearest places where the slope jumps, from the cell's start: at most 0, and ...
    double kink_above = 0;  // ... above it
    double end = 0;         // where the next one starts; beyond all w of the last
  };

  /// A value of w within the arc's own range, its cell, and the s of the windings that were taken off.
  struct Found {
    const Cell* cell;
    double x;
    double shift;
  };
  Found find(double w) const {
    double base = w;
    double shift = 0;
    if (loop_) {
      const Wrapped wrapped = wrap(w - lo(), hi_ - lo());
      base = lo() + wrapped.base;
      shift = wrapped.winding * perimeter_;
    }
    const Cell* cell = &cells_[buckets_.before(base)];
    cell += cell->end <= base ? 1 : 0;  // most often, and without a branch to foresee
    while (cell->end <= base) ++cell;
    return {cell, base - cell->w, shift};
  }
  static TiltedPlace on(const Found& found) {
    const Cell& cell = *found.cell;
    return {cell.s + cell.cubic.at(found.x) + found.shift, cell.cubic.slope(found.x)};
  }

  /// Lets the cells from `begin` on, which go back in w, take over from the ones before at w.
  void join(std::size_t begin, double w);
  void mark_kinks();

  bool loop_ = false;        // a closed boundary without concave corners
  double perimeter_ = 0;     // of the boundary, s of a lap
  double hi_ = 0;            // w where it ends
  double end_ = 0;           // s at hi
  std::vector<Cell> cells_;  // in order of w
  std::vector<double> kinks_;
  Buckets buckets_;
};

/// How far one of the places that look alike is from another, and on which arc it is then.
struct Shift {
  std::size_t arcs = 0;  // further on, of a boundary of several
  double w = 0;
  double s = 0;
};

/// A part's boundary by its tilted turning.
class TiltedBoundary {
 public:
  /// The tilt is `least` or, where that would not make w grow everywhere, more. `accuracy`: of s, length.
  TiltedBoundary(const Part& part, double least, double accuracy);

  double tilt() const { return tilt_; }
  const std::vector<TiltedArc>& arcs() const { return arcs_; }
  /// So many times the boundary looks the same, wherever a finger is put: 1 for no symmetry.
  std::size_t folds() const { return folds_; }
  /// From a place to the one that looks like it, so many folds further on.
  Shift shift(std::size_t folds) const;

 private:
  std::size_t count_folds() const;
  bool repeats_after(const Shift& shift) const;
  void add_spiral(const TurningFunction& turning, const Spiral& spiral, double winding, double accuracy,
                  TiltedArc& arc) const;

  double tilt_ = 0;
  double perimeter_ = 0;
  double all_w_ = 0;  // once around
  std::size_t folds_ = 1;
  std::vector<TiltedArc> arcs_;  // in order along the boundary
};

/// The tilt to ask for: a disk's curvature; else `even`, what makes lengths and angles, as uncertain as they are, count
/// alike.
double tilt_of(double finger_curvature, double even, const Part& part);

/// How well s as a function of w is to be known, where a contact is known to this standard deviation; length.
double accuracy_of(double contact_sd, const Part& part);

/// What a radian of pivoting counts as, length. A finger's centre goes along the boundary and, about a corner, along an
/// arc of the finger's radius: what comes to touch by chance touches there in proportion. A flat finger, or none that
/// is known, stands for one as large as the part.
double corner_length(double finger_curvature, const Part& part);

}  // namespace rollfix::belief
