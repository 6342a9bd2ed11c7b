#pragma once

#include <cstddef>
#include <vector>

#include "rollfix/part/part.hpp"

namespace rollfix::hold {

/// The boundary at a place that is known to some length only: a corner nearby is blurred by it.
struct BlurredPlace {
  Vec2 point = Vec2::Zero();
  Vec2 tangent = Vec2::Zero();  // a unit vector: how the point goes
  double angle = 0;             // mean of Theta, radians
  double bend = 0;              // its derivative by s, corners included
  double curvature = 0;         // without corners
  double variance = 0;          // of Theta, by corners
  double half_turn = 0;         // without blur: Theta is within this of `angle`
};

/// Theta on average over a normal distribution about s.
BlurredPlace blurred(const Part& part, double s, double sd);

/// Theta's range within `reach` of s: for measurements that are exact but for their digits.
BlurredPlace ranged(const Part& part, double s, double reach);

}  // namespace rollfix::hold
