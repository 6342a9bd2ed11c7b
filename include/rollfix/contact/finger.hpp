#pragma once

#include "rollfix/locate/reading.hpp"
#include "rollfix/outline/geometry.hpp"
#include "rollfix/part/part.hpp"

namespace rollfix {

/// A round finger. Contacts lie on its rim, r (cos u, sin u) in its own frame.
struct DiskFinger {
  double radius = 0;  // r > 0, in the outline's unit
};

/// What the sensors say of one instant.
struct Contact {
  double u = 0;    // where on the finger, in its own frame, radians, counter-clockwise
  double psi = 0;  // the finger's orientation in the world, radians, counter-clockwise

  /// Direction in the world from the finger's centre to the contact: the part's inward normal there.
  double facing() const { return u + psi; }
};

/// Throws InputError unless the radius is a finite number above 0.
void require_valid(const DiskFinger& finger);

/// Eqs. (1)-(3) integrated: L = -r (u1 - u0), theta = (u1 - u0) + (psi1 - psi0). Angles unwrapped.
Reading reading_between(const DiskFinger& finger, const Contact& first, const Contact& last);

/// The inverse: the contact after a roll with this reading.
Contact contact_after(const DiskFinger& finger, const Contact& first, const Reading& reading);

/// The contact of a finger that is oriented psi and touches where the part's tangent points in this direction (both in
/// the world's frame). The finger lies on the right of the tangent, the material on its left: u + psi = tangent + pi/2.
/// u comes out in (-pi, pi].
Contact contact_on(double tangent, double psi);

/// Where the finger's centre is in the world when it touches at this point.
Vec2 centre_of(const DiskFinger& finger, const Vec2& point, const Contact& contact);

/// A reading whose length is positive along the outline as the user gave it, in the direction in which it is stored.
/// Against the user's direction, L changes its sign and theta does not: see docs/rolling.md.
Reading in_stored_direction(const Reading& as_given, const Part& part);

}  // namespace rollfix
