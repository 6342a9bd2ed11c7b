#pragma once

#include <cstddef>
#include <vector>

#include "rollfix/part.hpp"

namespace rollfix::hold {

/// The boundary at a place that is known to some length only: a corner nearby is blurred by it.
struct BlurredPlace {
  double side = 0;          // Theta at the place itself, radians: how the point goes
  double angle = 0;         // mean of Theta, radians
  double bend = 0;          // its derivative by s, corners included
  double curvature = 0;     // without corners
  double variance = 0;      // of Theta, by corners
  double pivoting = 0;      // how probable it is that the finger pivots at a corner there, times how far the ...
                            // ... finger's own tangent is then off the side's: of a square, per coordinate
  bool has_corner = false;  // near enough to be seen
  double half_turn = 0;     // without blur: Theta is within this of `angle`
};

/// Beyond an open boundary's end it goes straight on, so that a fit finds back.
Vec2 point_about(const Part& part, double s);

/// Theta on average over a normal distribution about s. `pivot`: the length that a radian of pivoting counts as, of a
/// disk its radius: its centre goes as far about a corner.
BlurredPlace blurred(const Part& part, double s, double sd, double pivot);

/// Theta at s + m less Theta at s; beyond an open boundary's end it stays.
double turn_from(const Part& part, double s, double m);
double curvature_at(const Part& part, double s);

/// Theta's range within `reach` of s: for measurements that are exact but for their digits.
BlurredPlace ranged(const Part& part, double s, double reach);

}  // namespace rollfix::hold
