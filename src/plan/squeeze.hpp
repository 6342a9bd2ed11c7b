#pragma once

#include <optional>

#include "plan/contact_way.hpp"

namespace rollfix {

// Notation:
//   p, q          the contacts of fingers a and b in the part's frame: places s and t
//   D             |q - p|
//   A             angle from the inward normal at p to the way to q; B from that at q to the way to p: `at_a`, `at_b`.
//                 Where the fingers press apart, to the opposite ways
// Two forces alone are in balance only on the line through both contacts, equal and opposite: finger a must be able to
// press under A, finger b under B, and |tan| of each be at most the friction there. A wheel's force goes through its
// pin: B = 0.

/// How two fingers press on the part at one instant.
struct Squeeze {
  double at_a = 0;      // A, radians, in (-pi, pi]
  double at_b = 0;      // B
  double distance = 0;  // D
};

/// `expanding`: they press apart.
Squeeze squeeze_of(const ContactPlace& a, const ContactPlace& b, bool expanding);

/// How far apart two fingers are; nothing where that is not known: of disks, and of a disk and a jaw, it is.
std::optional<double> gap_between(const Finger& finger_a, const ContactPlace& a, const Finger& finger_b,
                                  const ContactPlace& b);

}  // namespace rollfix
