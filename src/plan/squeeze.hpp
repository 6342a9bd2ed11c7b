#pragma once

#include <limits>
#include <optional>

#include "plan/roll_path.hpp"

namespace rollfix::planning {

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

// Notation:
//   K             kappa(s) + the curvature of finger a: both bend away from each other
//   r, kappa      radius of the wheel, and the part's curvature where it touches
//   D, d          distance of the contacts, and Theta(t) - Theta(s)
//   w             1 / (1 + K (D + r)): `share`
// While finger a rests, part and wheel can roll together with one freedom, and the pin is lifted by half of
// K [ |cos d| + K (D + r) (1 - kappa D) / (1 + r kappa) ] (ds)^2: above 0 the balance is stable. What stands in the
// brackets, times w, is w |cos d| + (1 - w) b with b = (1 - kappa D) / (1 + r kappa), which has a limit at corners,
// where K or kappa are infinite: w = 0, b = -D / r.

/// That, of a part squeezed between finger a and a wheel. At joints and corners the worst of all sides.
double stability_of(const ContactWay& way_a, const ContactWay& way_b, const PairPlace& place);

/// A lower bound of it all the way between two instants of a path, where each contact goes one way.
double stability_between(const ContactWay& way_a, const ContactWay& way_b, const PairPlace& one, const PairPlace& two);

}  // namespace rollfix::planning
