#pragma once

#include <cmath>
#include <vector>

#include "places.hpp"
#include "rollfix/part.hpp"
#include "rollfix/reading.hpp"

namespace rollfix {

/// f of one reading along the boundary, s unwrapped, or the difference of two readings' f, on which the tangent at s
/// has no bearing: what a certificate is drawn up by.
class Residual {
 public:
  Residual(const Part& part, const Reading& reading) : Residual(part, 0, reading.length[0], reading.turn) {}
  static Residual difference(const Part& part, const Reading& one, const Reading& other) {
    return {part, other.length[0], one.length[0], one.turn - other.turn};
  }

  double at(double s) const { return turning_.angle(s + to_) - turning_.angle(s + from_) - turn_; }
  double size(double s) const { return std::abs(at(s)); }

  /// Between these f has one sign of slope, and no jump.
  bool is_monotone(double lo, double hi) const;

  /// Whether f has a jump between these.
  bool jumps(double lo, double hi) const;

  /// The place where |f| is least.
  double nearest(double lo, double hi) const;

  /// Whether |f| is no more than that, or can't be told from it, where contacts pass from curve to curve between these,
  /// or pivot at a corner.
  bool is_near_at_joints(double bound, double lo, double hi) const;
  /// The largest |f| beside such places.
  double largest_at_joints(double lo, double hi) const;

  /// By how much a value near a joint has to be clear of a bound for rows, which keep away from joints, to show it.
  double blur(double s) const;

  /// The stretches between these on which f is 0 to rounding.
  std::vector<Interval> flat(double lo, double hi) const;

 private:
  Residual(const Part& part, double from, double to, double turn)
      : turning_(part.turning()), step_(least_step(part)), from_(from), to_(to), turn_(turn) {}

  /// Where the start or the end of the roll passes from one spiral to the next.
  struct Cut {
    double s = 0;
    double jump = 0;      // of f there
    bool pivots = false;  // by every angle in between

    bool jumps() const { return std::abs(jump) > 0.5 * kTurnAccuracy; }
  };

  std::vector<Cut> cuts(double lo, double hi) const;
  double steepest(double s) const;
  int slope_sign(double lo, double hi, int depth) const;
  bool is_flat(double lo, double hi) const;
  double refined(double lo, double hi) const;
  double root(double lo, double hi) const;

  const TurningFunction& turning_;
  double step_;  // the least between places
  double from_;
  double to_;
  double turn_;
};

}  // namespace rollfix
