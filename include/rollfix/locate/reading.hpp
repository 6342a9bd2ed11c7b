#pragma once

namespace rollfix {

/// What one finger's sensors say of one instant, measured from the first contact.
struct Reading {
  double length = 0;  // L, arc length travelled on the part, positive along the stored outline; may exceed P
  double turn = 0;    // theta, total curvature along it, radians, unwrapped; may exceed pi in size
};

}  // namespace rollfix
