#pragma once

#include <limits>
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

/// How far apart two fingers are, below 0 by how much they are in one another; nothing of two jaws, which without ends
/// would always meet somewhere. `enough`: a distance of no less than this needs not be exact.
std::optional<double> gap_between(const Finger& finger_a, const ContactPlace& a, const Finger& finger_b,
                                  const ContactPlace& b, double enough = std::numeric_limits<double>::infinity());

/// How much that can change, at most, from one contact of both to others, where each rolls from the one to the other.
double gap_change(const Finger& finger_a, const ContactPlace& a, const ContactPlace& next_a, const Finger& finger_b,
                  const ContactPlace& b, const ContactPlace& next_b);

/// What a finger is about as large as: a disk's radius, an outline's perimeter over a whole turn; of a jaw 0.
double size_of(const Finger& finger);

}  // namespace rollfix
