#pragma once

#include "rollfix/part/turning_function.hpp"

namespace rollfix {

/// f and its slope at one first contact s:  f(s) = Theta(s + L) - Theta(s) - theta,  f' = kappa(s + L) - kappa(s).
struct ResidualSample {
  double s = 0;
  double value = 0;
  double start_curvature = 0;  // kappa(s)
  double end_curvature = 0;    // kappa(s + L)

  double slope() const { return end_curvature - start_curvature; }
};

/// The first contacts for which the roll starts on one spiral and ends on another: there f' has rigorous bounds.
struct SpiralPair {
  const TurningFunction& turning;
  const Spiral& start;
  const Spiral& end;
  double offset = 0;  // from the start's s to the end's, whole periods taken off
  double turn = 0;    // theta, the same periods' turn taken off

  ResidualSample sample(double s, const Turning& at_start, const Turning& at_end) const {
    return {s, at_end.angle - at_start.angle - turn, at_start.curvature, at_end.curvature};
  }
  ResidualSample sample(double s) const {
    return sample(s, turning.on_spiral(start, s), turning.on_spiral(end, s + offset));
  }
};

}  // namespace rollfix
