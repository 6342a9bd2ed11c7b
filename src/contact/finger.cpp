#include "rollfix/contact/finger.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "part/angle.hpp"
#include "rollfix/error.hpp"

namespace rollfix {

void require_valid(const DiskFinger& finger) {
  if (finger.radius > 0 && std::isfinite(finger.radius)) return;
  throw InputError(
      fmt::format("expected a finger whose radius is a finite number above 0, found {}: give it in the outline's unit",
                  finger.radius));
}

Reading reading_between(const DiskFinger& finger, const Contact& first, const Contact& last) {
  const double rolled = last.u - first.u;
  return {-finger.radius * rolled, rolled + (last.psi - first.psi)};  // eq. (3)
}

Contact contact_after(const DiskFinger& finger, const Contact& first, const Reading& reading) {
  const double rolled = reading.length / finger.radius;
  return {first.u - rolled, first.psi + (reading.turn + rolled)};
}

Contact contact_on(double tangent, double psi) { return {nearest_angle(tangent + std::numbers::pi / 2 - psi), psi}; }

Vec2 centre_of(const DiskFinger& finger, const Vec2& point, const Contact& contact) {
  return point - finger.radius * Vec2(std::cos(contact.facing()), std::sin(contact.facing()));
}

Reading in_stored_direction(const Reading& as_given, const Part& part) {
  return {part.reversed() ? -as_given.length : as_given.length, as_given.turn};
}

}  // namespace rollfix
