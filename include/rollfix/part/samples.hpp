#pragma once

#include <numbers>
#include <vector>

#include "rollfix/part/part.hpp"

namespace rollfix {

/// A place on a boundary, in numbers.
struct BoundarySample {
  double s = 0;
  Vec2 point = Vec2::Zero();
  double tangent = 0;    // Theta(s), radians, unwrapped
  double curvature = 0;  // positive where convex
};

/// From one of these samples to the next the tangent turns by no more than this, radians, ...
inline constexpr double kSampleTurn = std::numbers::pi / 90;
/// ... and s grows by no more than this share of the perimeter.
inline constexpr double kSampleShare = 1.0 / 200;

/// A boundary as numbers, by growing s from 0 to P, as densely as its shape asks for (kSampleTurn, kSampleShare). All
/// ends of spirals are among them: inflections, vertices, joints and corners. Where the tangent or the curvature jumps
/// there are two samples with the same s: the limits from before and from after.
std::vector<BoundarySample> samples_of(const Part& part);

}  // namespace rollfix
