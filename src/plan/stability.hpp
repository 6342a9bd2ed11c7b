#pragma once

#include "plan/roll_path.hpp"

namespace rollfix {

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

}  // namespace rollfix
