#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "rollfix/contact/log.hpp"
#include "rollfix/contact/noise.hpp"
#include "rollfix/contact/pose.hpp"
#include "rollfix/contact/rolling.hpp"
#include "rollfix/part/part.hpp"
#include "rollfix/per_finger.hpp"

namespace rollfix {

/// A rig of two fingers: a flat jaw (finger a) and a wheel (finger b), a disk that turns freely on a pin. The robot
/// moves the jaw and the pin; the part, which is free, and the wheel turn as the rolling requires: docs/rolling.md.
/// Everything by time is seconds from the start, and 0 at the start.
struct RigPlan {
  double radius = 0;                  // of the wheel, r > 0, in the outline's unit
  PerFinger<double> start{0, 0};      // s of the jaw's first contact and of the wheel's, along the stored outline
  double u = 0;                       // where on the jaw its first contact is, length
  double psi = 0;                     // the wheel's orientation there, in the world, radians
  Pose pose;                          // the part's, at the start
  double duration = 1;                // seconds
  std::function<Vec2(double)> pin{};  // how far the pin has moved in the jaw's frame, along its surface and away from
                                      // it (to the jaw's body)
  std::function<Pose(double)> jaw{};  // how far the jaw's frame has moved and turned in the world; none: it stays
  /// The pin is pressed on the part by a spring, along y of the jaw's frame, so that the wheel's force passes through
  /// the jaw's contact at every instant. Then of `pin` only x is taken, and y follows.
  bool squeezed = false;
  std::size_t rows = 101;  // of the log, at equal times, both ends included; at least 2
};

/// What such a rig does: solves the closure of both contacts in every row, so that they stay together to rounding.
/// `log`: the jaw's rows and the wheel's, whose x, y is the pin. Throws InputError: an impossible plan; for each finger
/// what `roll` throws; and, with the row and how much of the motion is possible, where the pin's motion no longer says
/// how the part rolls: the wheel's normal passes through the jaw's contact, or of a squeezed rig the grip is not
/// stable. That a finger hits the part elsewhere, or the other finger, is not checked (see overlap_of).
Roll roll_rig(const Part& part, const RigPlan& plan);

/// With noise as in noisy_roll_free; and `position`: in each row x and y of the pin are off by N(0, position). The pin
/// goes the planned way against a jaw that does not slip.
NoisyRoll noisy_roll_rig(const Part& part, const RigPlan& plan, const Noise& noise, std::uint64_t seed);

/// Where on the part a wheel can be squeezed against a jaw that touches at s, in a stable grip: places t, in order,
/// whose normal passes through the jaw's contact. Corners, on which a wheel may rest as well, are left out. Looked for
/// at equal steps of a 4,000th of the boundary: two places nearer together than that can be missed. Throws InputError:
/// a radius that is not above 0, or an s off an open part.
std::vector<double> squeezed_places(const Part& part, double radius, double s);

/// What of a wheel is measured.
enum class WheelSensors {
  skin,     // where on it the contact is, how it is turned, and where the pin is: u, psi, x, y
  encoder,  // how it is turned, and where the pin is: psi, x, y
  pin       // where the pin is: x, y
};

/// A rig's log with what these measure of the wheel; other columns of finger b are empty.
Log sensed_by(WheelSensors sensors, Log log);

}  // namespace rollfix
