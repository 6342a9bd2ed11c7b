#pragma once

#include <cstddef>
#include <vector>

#include "rollfix/part/turning_function.hpp"

namespace rollfix::belief {

/// What a contact's normal, as it is measured, tells of the tangent's angle where it was felt: the place is known no
/// better than to a standard deviation, and with the place the measured normal is off.
struct Felt {
  double angle = 0;     // its mean, radians, unwrapped
  double slope = 0;     // of that by the place, radians per length
  double variance = 0;  // radians^2
};

/// Theta(s + n) + n / r with n ~ N(0, sd): mean and variance, as a table. Where Theta is smooth they are Theta and
/// ((kappa + 1/r) sd)^2. At a convex corner a finger stays while it pivots, so that a contact which is felt near it is
/// likely to be at it, pointing anywhere in between.
class FeltTurning {
 public:
  /// `sd`: of a place, length, above 0. `corner_length`: how far a finger's centre goes per radian that it pivots.
  /// `normal_turn`: 1/r, by how much a place that is off turns the measured normal; 0 where normals are not measured by
  /// places. `accuracy`: of the angle, radians.
  FeltTurning(const TurningFunction& turning, double sd, double corner_length, double normal_turn, double accuracy);

  /// Any s on a closed outline; beyond an open one's ends the tangent goes on as it is there.
  Felt at(double s) const;

 private:
  struct Knot {
    double s = 0;
    Felt felt;
  };

  /// By integration.
  Felt integrated(double s) const;
  void add_knots(double spacing, double accuracy);
  void index();

  const TurningFunction* turning_;
  double sd_;
  double corner_length_;
  double normal_turn_;
  double lo_ = 0;
  double hi_ = 0;
  std::vector<Knot> knots_;
  std::vector<std::size_t> bucket_;  // the last knot at or below the start of each of many equal steps
  double buckets_per_length_ = 0;
};

}  // namespace rollfix::belief
