#pragma once

#include "rollfix/cpp20.hpp"  // IWYU pragma: keep

namespace rollfix {

/// How far an outline that was measured may be off the part, as standard deviations: what `teach` says of its outline.
/// All 0: exact. Of the angle between the tangents at two places `length` apart the variance is 2 turn^2, less where
/// they are nearer together than `alike`, and walk^2 length more.
struct Accuracy {
  double length = 0;  // of a length along the outline, per length: all lengths are off by one factor
  double turn = 0;    // of a tangent's direction, radians
  double alike = 0;   // length: tangents nearer together than this are off alike
  double walk = 0;    // of what tangents' errors gather along the outline, radians per square root of length

  bool is_exact() const { return length == 0 && turn == 0 && walk == 0; }
};

}  // namespace rollfix
