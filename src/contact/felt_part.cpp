#include "contact/felt_part.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "rollfix/part/period.hpp"

namespace rollfix {

namespace {

// A contact so near to a corner, in perimeters, may be on it: a placement is known to 1e-9.
constexpr double kOnCorner = 1e-8;

}  // namespace

FeltPart::FeltPart(const Part& part, const Finger& finger, const Log& log, double start)
    : part_(part),
      finger_(finger),
      log_(log),
      start_(start),
      u_(unwrapped(log.u, log.place_rounding, finger.period())),
      psi_(unwrapped(log.psi, log.angle_rounding)) {
  require_valid(finger);
}

/// The directions that the tangent may have at s, in the part's frame.
Interval FeltPart::tangents(double s) const {
  const TurningFunction& turning = part_.turning();
  const double P = part_.perimeter();
  for (const Corner& corner : part_.corners()) {
    const double ahead = part_.closed() ? std::remainder(s - corner.s, P) : s - corner.s;
    if (std::abs(ahead) > kOnCorner * P) continue;
    const double laps = part_.closed() ? std::round((s - corner.s) / P) : 0;
    const double lap_turn = laps * turning.period_turn();
    const double before = turning.angle(corner.s, Side::before) + lap_turn;
    const double after = turning.angle(corner.s, Side::after) + lap_turn;
    return {std::min(before, after), std::max(before, after)};
  }
  const double angle = turning.angle(s);
  return {angle, angle};
}

Interval FeltPart::heading(std::size_t row) const {
  const Interval tangent = tangents(place(row));
  const double normal = facing(finger_, contact(row)) - std::numbers::pi / 2;
  return {normal - tangent.hi, normal - tangent.lo};
}

Vec2 FeltPart::in_world(std::size_t row) const {
  // Where the frame's origin would be if the contact were at 0 says how far the contact is from it.
  return Vec2(log_.x[row], log_.y[row]) - centre_of(finger_, Vec2::Zero(), contact(row));
}

}  // namespace rollfix
