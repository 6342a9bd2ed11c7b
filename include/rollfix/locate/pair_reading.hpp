#pragma once

namespace rollfix {

/// What two fingers' sensors say of one instant, measured from their first contacts at s0 and t0. The part may have
/// moved in the meantime: only the difference between the fingers is known, eqs. (7)-(9).
struct PairReading {
  double length_a = 0;  // arc length travelled by finger a's contact, positive along the stored outline
  double length_b = 0;  // the same of finger b
  double turn = 0;      // theta = Phi(s0, s0 + La) - Phi(t0, t0 + Lb), radians, unwrapped
};

}  // namespace rollfix
