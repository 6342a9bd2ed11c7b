#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "places.hpp"
#include "rollfix/part.hpp"
#include "rollfix/reading.hpp"

namespace rollfix::certifying {

/// f of one reading along the boundary, s unwrapped, or the difference of two readings' f, on which the tangent at s
/// has no bearing: what a certificate is drawn up by.
class Residual {
 public:
  /// f of one reading of one finger: from = 0, to = L, turn = theta.
  Residual(const Part& part, const Reading& reading) : Residual(part, 0, reading.length[0], reading.turn) {}
  /// f_one - f_other = Theta(s + L_one) - Theta(s + L_other) - (theta_one - theta_other).
  static Residual difference(const Part& part, const Reading& one, const Reading& other) {
    return {part, other.length[0], one.length[0], one.turn - other.turn};
  }

  /// Radians. At a corner the value just after it.
  double at(double s) const { return turning_.angle(s + to_) - turning_.angle(s + from_) - turn_; }
  double size(double s) const { return std::abs(at(s)); }

  /// Between these f has one sign of slope, and no jump.
  /// False also where halving does not decide it: no claim is made then.
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

  /// By rising s, with lo first and hi last; between two neighbours each contact stays on one spiral.
  std::vector<Cut> cuts(double lo, double hi) const;
  /// A bound on |f'| at s, from the size of both curvatures: the sum, so that it is never 0 by cancellation.
  double steepest(double s) const;
  int slope_sign(double lo, double hi, int depth) const;
  /// Whether |f| is 0 to rounding at samples of the stretch, which must contain no cut.
  bool is_flat(double lo, double hi) const;
  /// A local minimum of |f|, by golden section.
  double refined(double lo, double hi) const;
  double root(double lo, double hi) const;

  const TurningFunction& turning_;
  double step_;  // the least between places
  double from_;  // of the first contact of the difference, measured from s
  double to_;    // of the second one
  double turn_;  // what Theta is to grow by in between, radians
};

/// Readings of which one at least is outside the tolerance all the way, and a row where they come nearest to it.
struct Exclusion {
  std::vector<std::size_t> by;  // one reading, or two whose difference excludes; numbered from 0
  std::optional<double> row;
};

/// f of all readings along the boundary, s unwrapped.
class Residuals {
 public:
  Residuals(const Part& part, const std::vector<Reading>& readings, double tolerance);

  std::size_t count() const { return f_.size(); }
  const Residual& operator[](std::size_t reading) const { return f_[reading]; }
  const std::vector<double>& lengths() const { return lengths_; }

  /// The largest |f|: outside the tolerance where some reading's is.
  double size(double s) const;
  /// Whether the f of some reading has a jump between these.
  bool jumps(double lo, double hi) const;

  /// What a row beside a placement has to be off by.
  double edge() const;

  /// Moved ahead (or back, `way` -1) until the start and all ends of the rolls are clear of where curves meet.
  double clear(double s, int way) const { return clear_of_joints(part_, lengths_, s, way); }

  /// Nothing where no reading, nor two of them, exclude all between these.
  std::optional<Exclusion> exclusion(double lo, double hi) const;

  /// Where to halve what none excludes: beside a corner that a roll may start at.
  double split(double lo, double hi) const;

  /// The stretches between these on which every f is 0 to rounding.
  std::vector<Interval> flat(double lo, double hi) const;

 private:
  /// What is off by more is excluded: with some to spare where another reading may do it as well.
  double excluded() const;
  std::optional<Exclusion> exclusion(const Residual& f, double bound, double lo, double hi) const;
  std::optional<Exclusion> exclusion_by_one(double lo, double hi) const;
  std::optional<Exclusion> exclusion_by_two(double lo, double hi) const;

  const Part& part_;
  const std::vector<Reading>& readings_;
  double tolerance_;
  double step_;  // the least between places
  std::vector<Residual> f_;
  std::vector<double> lengths_;
};

}  // namespace rollfix::certifying
