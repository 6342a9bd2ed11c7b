#pragma once

#include <algorithm>
#include <boost/container/small_vector.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "rollfix/locate.hpp"
#include "rollfix/turning_function.hpp"

namespace rollfix::locating {

/// f and its slope at one first contact s: f(s) = Theta(s + L) - Theta(s) - theta, radians; f' = kappa(s + L) -
/// kappa(s), radians per length. Both curvatures are kept, because each one alone is monotone on its spiral and f' is
/// not.
struct ResidualSample {
  double s = 0;
  double value = 0;            // f(s), radians
  double start_curvature = 0;  // kappa(s)
  double end_curvature = 0;    // kappa(s + L)

  /// f'(s)
  double slope() const { return end_curvature - start_curvature; }
};

/// The first contacts for which the roll starts on one spiral and ends on another: there f' has rigorous bounds.
struct SpiralPair {
  const TurningFunction& turning;  // of the part
  const Spiral& start;             // that s is on
  const Spiral& end;               // that s + L is on
  double offset = 0;               // from the start's s to the end's, whole periods taken off
  double turn = 0;                 // theta, the same periods' turn taken off

  /// f at s, from Theta and kappa at s on `start` and at s + offset on `end`.
  ResidualSample sample(double s, const Turning& at_start, const Turning& at_end) const {
    return {s, at_end.angle - at_start.angle - turn, at_start.curvature, at_end.curvature};  // eqs. (4), (5)
  }
};

/// An interval of first contacts on which |f| is within the tolerance. Neighbours that touch are joined later
/// (sets_of_one.cpp).
struct StartPiece {
  double lo = 0;
  double hi = 0;
  bool exact = false;   // f = 0 on all of it
  bool corner = false;  // a single point, where a corner's pivot makes up the difference
};

/// A place in a piece that may be its answer: a zero of f, a corner whose pivot makes up for f, or an extremum of f
/// that misses 0 by less than the tolerance.
struct Root {
  double s = 0;
  bool exact = true;        // f = 0 there; false: a near miss
  bool corner = false;      // thanks to a corner's pivot
  bool crossing = false;    // strictly inside an interval on which f is monotone and changes sign
  std::uint32_t panel = 0;  // that the roll starts on at a crossing, or one next to it
  ResidualSample sample{};  // of f at a crossing
};

// Answers are few: that many need no allocation.
inline constexpr std::size_t kFewAnswers = 12;

using Pieces = boost::container::small_vector<StartPiece, kFewAnswers>;
using FoundRoots = boost::container::small_vector<Root, kFewAnswers>;

/// What one reading leaves of a stretch of boundary.
struct Findings {
  Pieces pieces;  // in rising order
  FoundRoots roots;
  std::vector<Interval> unresolved;
  SearchCounts counts;
  std::size_t budget = 0;  // intervals that may still be looked at, beyond the part's own
};

/// An interval of s that is still to be decided, with f sampled at both ends.
struct SampledRange {
  ResidualSample lo;  // at the lower end
  ResidualSample hi;  // at the upper end
  int bend = 0;       // the sign of f'' where it is known
  int depth = 0;      // halvings and secant steps that led to it
};

struct QuinticRoot;

/// Branch and prune for one reading on one pair of spirals: every s with |f(s)| <= tolerance, proved complete.
class RootSearch {
 public:
  /// The tolerance, radians, is at least kTurnAccuracy. `budget`: intervals that halving may add before the search
  /// gives up. `perimeter`: P; all length thresholds are shares of it.
  RootSearch(double tolerance, std::size_t budget, double perimeter);

  Findings findings;  // of all runs together

  /// For the runs that follow. `pivot`: of the reading, by which |f| may be off beyond the tolerance.
  void allow(double tolerance, double pivot) {
    tolerance_ = tolerance + pivot;
    takes_ends_as_straight_ = pivot == 0;
  }

  /// The ends are samples of this pair. The interval between them comes with the part, however many points that has: it
  /// costs nothing of the budget.
  void run(const SpiralPair& pair, const ResidualSample& lo, const ResidualSample& hi) {
    if (is_far(lo, hi)) {  // most intervals
      ++findings.counts.intervals;
    } else {
      look_at(pair, lo, hi);
    }
  }

 private:
  /// True: |f| > tolerance on all of [lo, hi]. A function whose slope is monotone and changes by d over a width w is on
  /// one side of its chord, by |d| w / 4 at most: below it where the slope rises. Theta(s + L) and Theta(s) are such
  /// functions, since kappa is monotone on each spiral. f is their difference: its chord, plus what the one can leave
  /// its chord by, less what the other can.
  bool is_far(const ResidualSample& lo, const ResidualSample& hi) const {
    const double quarter = 0.25 * (hi.s - lo.s);
    const double end = quarter * (hi.end_curvature - lo.end_curvature);
    const double start = quarter * (hi.start_curvature - lo.start_curvature);
    const double least = std::min(lo.value, hi.value) - std::max(end, 0.0) + std::min(start, 0.0);
    const double most = std::max(lo.value, hi.value) - std::min(end, 0.0) + std::max(start, 0.0);
    return std::max(least, -most) > tolerance_;  // one branch: on which side of 0 f is can't be foreseen
  }
  /// Decides [lo, hi], which the strip does not exclude: a continuum of zeros first, then everything else.
  void look_at(const SpiralPair& pair, const ResidualSample& lo, const ResidualSample& hi);
  /// Is f zero on all of [lo, hi]? (search.md, "Once per reading", step 5)
  bool is_stretch(const SpiralPair& pair, const ResidualSample& lo, const ResidualSample& hi);
  /// Decides a half of an interval; takes one from the budget, or lists the half as unresolved where none is left.
  void decide(const SpiralPair& pair, const SampledRange& range);
  /// Decides an interval that the strip does not exclude: by the cone, by monotony, by the sign of f'', else by
  /// halving.
  void decide_near(const SpiralPair& pair, const SampledRange& range);
  /// REQUIRES range.bend != 0.
  void decide_bent(const SpiralPair& pair, const SampledRange& range);
  /// f is monotone on [lo, hi]: lists its root, if there is one, and the piece where |f| <= tolerance.
  void take_monotone(const SpiralPair& pair, const ResidualSample& lo, const ResidualSample& hi);
  void split_at_extremum(const SpiralPair& pair, const SampledRange& range);
  void decide_by_polynomial(const SpiralPair& pair, const SampledRange& range, const Panel& start, const Panel& end);
  void take_flat(const ResidualSample& lo, const ResidualSample& hi, bool exact);
  void halve(const SpiralPair& pair, const SampledRange& range, double place);
  /// `reach`: how far from the root a straight f comes to the tolerance, length.
  bool is_straight(const SpiralPair& pair, const ResidualSample& root, double reach, const ResidualSample& lo,
                   const ResidualSample& hi);
  ResidualSample solve(const SpiralPair& pair, double level, ResidualSample lo, ResidualSample hi);
  bool is_settled(const QuinticRoot& root, const ResidualSample& at) const;
  /// f at any s of the pair, by two evaluations of Theta.
  ResidualSample sample(const SpiralPair& pair, double s) {
    findings.counts.evaluations += 2;
    return pair.sample(s, on(pair.turning, pair.start, s, start_panel_),
                       on(pair.turning, pair.end, s + pair.offset, end_panel_));
  }
  /// Theta on a spiral, of which the panel of the sample before is known: mostly it is this one's.
  static Turning on(const TurningFunction& turning, const Spiral& spiral, double base, const Panel*& panel) {
    if (panel == nullptr || !(base >= panel->lo && base < panel->hi)) panel = &turning.panel_on(spiral, base);
    return turning.on_panel(*panel, base);
  }
  void add_piece(double lo, double hi, bool exact = false);

  double tolerance_;                    // of |f| in the runs that follow, the reading's pivot included; radians
  bool takes_ends_as_straight_ = true;  // where extents are as wide as a tolerance; else their ends are what is asked
  double perimeter_;                    // P
  double same_place_;                   // lengths below this are rounding errors
  // The panels of the last sample, at the start and the end of the roll: the next sample is mostly on the same ones.
  const Panel* start_panel_ = nullptr;
  const Panel* end_panel_ = nullptr;
};

// Polynomials through samples of f, with their slopes.

/// Where the cubic with the values and slopes of two samples (Hermite) has the value `level`: Newton's method from
/// where their chord has it. REQUIRES different values; the result may lie outside the two, or be no number.
inline double cubic_root(const ResidualSample& one, const ResidualSample& other, double level) {
  // So many steps leave less of the cubic's root than the cubic is off by.
  constexpr int kSteps = 2;
  const double width = other.s - one.s;
  const double rise = other.value - one.value;
  const double linear = one.slope() * width;
  const double square = 3 * rise - 2 * linear - other.slope() * width;
  const double cube = rise - linear - square;
  // x in [0, 1] is the place between the two; the cubic is one.value + x (linear + x (square + x cube)).
  double x = (level - one.value) / rise;
  for (int step = 0; step < kSteps; ++step) {
    x -= (one.value - level + x * (linear + x * (square + x * cube))) / (linear + x * (2 * square + x * 3 * cube));
  }
  return one.s + x * width;
}

/// Where the quintic through three samples (values and slopes) has a value.
struct QuinticRoot {
  double step = 0;  // from the first sample
  double rest = 0;  // what f is there at the most, about: as if by the cubic through the first two
};

/// The quintic with the values and slopes of three samples, by divided differences of nodes taken twice (Hermite). What
/// does not need f at the first sample is computed by the constructor, while that evaluation is under way.
class Quintic {
 public:
  /// `at` is the place of the first, where f is still to be evaluated.
  Quintic(double at, const ResidualSample& last, const ResidualSample& third)
      : last_(last), to_last_(last.s - at), to_third_(third.s - at) {
    per_last_ = 1 / to_last_;
    per_third_ = 1 / to_third_;
    const double per_both = 1 / (third.s - last.s);
    const double secant = (third.value - last.value) * per_both;
    last_last_third_ = (secant - last.slope()) * per_both;
    const double last_third_third = (third.slope() - secant) * per_both;
    both_twice_ = (last_third_third - last_last_third_) * per_both;
  }

  /// Where it has the value `level`: one step of Halley's method on the quadratic at the first sample, one of Newton's
  /// on the quintic. `rest` adds up the terms beyond the cubic through the first two samples and what Newton's step
  /// leaves.
  QuinticRoot root(const ResidualSample& at, double level) const {
    const double value = at.value - level;
    const double slope = at.slope();
    const double secant = (last_.value - at.value) * per_last_;
    const double c2 = (secant - slope) * per_last_;  // of steps twice from the first, ...
    const double first_last_last = (last_.slope() - secant) * per_last_;
    const double c3 = (first_last_last - c2) * per_last_;  // ... then twice from the last, ...
    const double first_last_last_third = (last_last_third_ - first_last_last) * per_third_;
    const double c4 = (first_last_last_third - c3) * per_third_;
    const double c5 =
        ((both_twice_ - first_last_last_third) * per_third_ - c4) * per_third_;  // ... then from the third
    const double near = -value * slope / (slope * slope - value * c2);
    const double bend = c2 + (near - to_last_) * (c3 + (near - to_last_) * (c4 + (near - to_third_) * c5));
    const double step = near - (value + near * (slope + near * bend)) / (slope + 2 * near * bend);
    const double product = step * (step - to_last_);
    const double of_cubic = product * product * (std::abs(c4) + std::abs((step - to_third_) * c5));
    const double of_newton = std::abs(bend) * (step - near) * (step - near);
    return {step, of_cubic + of_newton};
  }

 private:
  ResidualSample last_;
  // Steps from the first sample's place, and their inverses.
  double to_last_;
  double to_third_;
  double per_last_ = 0;
  double per_third_ = 0;
  // Divided differences: f[last, last, third], and f[last, last, third, third].
  double last_last_third_ = 0;
  double both_twice_ = 0;
};

/// A sample at s, close to `at`, without an evaluation: curvatures interpolated between `at` and `third` (those of `at`
/// where both are one), the value by the trapezoidal rule of the slopes.
inline ResidualSample beside(const ResidualSample& at, const ResidualSample& third, double s) {
  const double share = third.s == at.s ? 0 : (s - at.s) / (third.s - at.s);
  ResidualSample sample{s, at.value, at.start_curvature + share * (third.start_curvature - at.start_curvature),
                        at.end_curvature + share * (third.end_curvature - at.end_curvature)};
  sample.value += 0.5 * (at.slope() + sample.slope()) * (s - at.s);
  return sample;
}

}  // namespace rollfix::locating
