#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>

#include "rollfix/outline/curve.hpp"
#include "rollfix/per_finger.hpp"

namespace rollfix {

/// What the sensors say of one instant, measured from the first contact: of one finger on a part that does not move
/// (L, theta), of two on a part that may have moved in the meantime (La, Lb, theta), eqs. (7)-(9).
struct Reading {
  Reading() = default;
  Reading(double travelled, double turned) : length(travelled), turn(turned) {}
  Reading(double length_a, double length_b, double turned) : length(length_a, length_b), turn(turned) {}

  PerFinger<double> length;  // arc length travelled on the part, positive along the stored outline; may exceed P
  double turn = 0;           // theta: total curvature along it, Phi(s0, s0 + L), of two fingers
                             // Phi(s0, s0 + La) - Phi(t0, t0 + Lb); radians, unwrapped, may exceed pi in size
  double pivot = 0;          // of a contact on a corner of the finger: theta is anywhere in turn -+ pivot, radians

  std::size_t fingers() const { return length.size(); }
  bool is_exact() const { return pivot == 0; }  // but for noise and digits
};

/// How far the rounding of written numbers can have moved something.
struct Rounding {
  double length = 0;  // in the outline's unit; of two fingers both lengths' together
  double turn = 0;    // radians
};

/// Where a part is in the world: the place of its frame's origin there, and how its frame is turned.
struct Pose {
  double x = 0;
  double y = 0;
  double heading = 0;  // radians, counter-clockwise

  /// A vector of the part's frame as the world sees it.
  Vec2 turned(const Vec2& vector) const {
    const double c = std::cos(heading);
    const double s = std::sin(heading);
    return {c * vector.x() - s * vector.y(), s * vector.x() + c * vector.y()};
  }
  /// A point of the part's frame as the world sees it.
  Vec2 world(const Vec2& point) const { return Vec2(x, y) + turned(point); }
};

/// A pose with noise, and how sure it is: of x, y and heading.
struct PoseSpread {
  Pose mean;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // length^2, length times radians, radians^2
};

}  // namespace rollfix
