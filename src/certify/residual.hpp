#pragma once

#include <vector>

#include "rollfix/certify/certify.hpp"

namespace rollfix {

/// f of one reading along the boundary, s unwrapped: what a certificate is drawn up by.
class Residual {
 public:
  Residual(const Part& part, const Reading& reading)
      : part_(part), turning_(part.turning()), length_(reading.length[0]), turn_(reading.turn) {}

  double length() const { return length_; }
  double at(double s) const { return turning_.angle(s + length_) - turning_.angle(s) - turn_; }
  double size(double s) const;

  /// The least step between places: what a roll's end is known to, many times over.
  double step() const;

  /// Moved ahead (or back, `way` -1) until the start and the end of the roll are clear of where curves meet.
  double clear(double s, int way) const;

  /// Between these f has one sign of slope, and no jump.
  bool is_monotone(double lo, double hi) const;

  /// The place where |f| is least.
  double nearest(double lo, double hi) const;

  /// The stretches between these on which f is 0 to rounding.
  std::vector<Interval> flat(double lo, double hi) const;

  /// Where that is by the outline's formulas.
  CurvePlace place(double s) const;

 private:
  /// Where the start or the end of the roll passes from one spiral to the next.
  struct Cut {
    double s = 0;
    bool jumps = false;  // the tangent turns there
  };

  std::vector<Cut> cuts(double lo, double hi) const;
  double slope(double s) const { return turning_.curvature(s + length_) - turning_.curvature(s); }
  int slope_sign(double lo, double hi, int depth) const;
  bool is_flat(double lo, double hi) const;
  double refined(double lo, double hi) const;

  const Part& part_;
  const TurningFunction& turning_;
  double length_;
  double turn_;
};

}  // namespace rollfix
