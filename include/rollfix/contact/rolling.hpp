#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "rollfix/contact/finger.hpp"
#include "rollfix/contact/log.hpp"
#include "rollfix/part/part.hpp"

namespace rollfix {

/// How a robot turns a finger that touches a part. Exactly one of `distance`, `rotation` and `duration` is given.
/// A finger that starts at a convex corner has its pivot there behind it; one that stops at one has it still ahead.
struct RollPlan {
  double start = 0;                // s of the first contact, along the stored outline
  double psi = 0;                  // a disk's orientation there, radians
  std::optional<double> u;         // of any other finger: where on it the first contact is, psi follows; default 0,
                                   // of an open outline its middle
  std::optional<double> distance;  // until the contact has travelled this far: L, below 0 for backwards; or
  std::optional<double> rotation;  // until the finger has turned by this, radians, below 0 for backwards; or
  std::optional<double> duration;  // for this long, seconds, as `omega` says
  double speed = 1;                // size of the angular velocity where `omega` does not give it, rad/s
  std::function<double(double)> omega;  // angular velocity by time, rad/s; may change its sign; with `duration` only
  std::size_t rows = 101;               // of the log, at equal times, both ends included; at least 2
};

/// A roll that was carried out. The part is at rest, its frame is the world's.
struct Roll {
  Log log;                    // what the sensors say: time, u, psi, and the finger's centre
  std::vector<double> s;      // where the contact is, unwrapped: s[i] - s[0] is L
  std::vector<double> angle;  // of the tangent there, unwrapped; at a corner how far the finger has pivoted
};

/// Rolls a finger along a part: eqs. (1) and (2), with kappa by arc length, integrated by Runge-Kutta 5(4) with step
/// control, started afresh wherever kappa jumps. At a convex corner the finger pivots: psi grows, u and L stay.
/// Only the contact's own surroundings are looked at: that the finger does not hit the part elsewhere is not checked.
/// Throws InputError: an impossible plan; a concave corner or a concavity that the finger does not fit into on the
/// way (with the place, the curvature, and the radius that would do); a flat side under a jaw; running off an open
/// part's end or an open finger's; or so few rows that a reader could not tell whether the angles are wrapped.
Roll roll(const Part& part, const Finger& finger, const RollPlan& plan);

/// The same without integration, from what eqs. (1) and (2) imply: psi - psi0 = (Theta(s) - Theta(s0)) + N(u0) - N(u),
/// solved for s, and u = u0 - (s - s0) along the finger; of a disk N(u0) - N(u) = (s - s0) / r. Accurate to rounding
/// and faster.
Roll roll_in_closed_form(const Part& part, const Finger& finger, const RollPlan& plan);

}  // namespace rollfix
