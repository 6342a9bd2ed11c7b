#pragma once

// What touches the part: a disk, a flat jaw, or any convex outline. Of a disk u is an angle, of all others an arc
// length along their own boundary.
//
//     const Finger finger = disk(0.2);
//     const Contact first{0.1, 0.0}, last{-4.9, 1.2};  // u, psi: radians
//     const Reading reading = reading_between(finger, first, last);
//     reading.length[0];  // 1
//     reading.turn;       // -3.8
//
// Degenerate cases: on a corner of a finger the normal is not known by u; Reading::pivot says by how much. A jaw has no
// ends; an open outline has.

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rollfix/curve.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/part.hpp"
#include "rollfix/reading.hpp"

namespace rollfix {

/// A round finger. Contacts lie on its rim, r (cos u, sin u) in its own frame.
struct DiskFinger {
  double radius = 0;  // r > 0, in the outline's unit
};

/// What the sensors say of one instant.
struct Contact {
  double u = 0;    // where on the finger, counter-clockwise: of a disk the angle in its frame, else arc length
  double psi = 0;  // the finger's orientation in the world, radians, counter-clockwise

  /// Of a disk: direction in the world from its centre to the contact, the part's inward normal there.
  double normal_direction() const { return u + psi; }
};

/// A finger of any convex shape: a disk, a flat jaw, or an outline. Its body lies on the left of its own boundary.
class Finger {
 public:
  Finger(const DiskFinger& disk) : radius_(disk.radius) {}  // NOLINT(google-explicit-constructor): it is one
  Finger(double disk_radius) : radius_(disk_radius) {}      // NOLINT(google-explicit-constructor): {0.2}

  /// A convex outline, closed or open, in its frame; u is arc length from its first point, of a closed one
  /// counter-clockwise whichever way it was given. It may have corners: there the finger pivots on the part, and u
  /// alone does not tell how the normal is turned. Throws InputError: it is concave somewhere, or is no outline.
  static Finger outlined(const Outline& outline) { return outlined(Part(outline)); }
  static Finger outlined(const Part& outline);

  const std::string& name() const { return name_; }  // "disk", "jaw", or the outline's
  std::optional<DiskFinger> disk() const;
  bool is_disk() const { return kind_ == Kind::disk; }
  bool is_jaw() const { return kind_ == Kind::jaw; }
  /// The outline, as a part; nullptr of a disk and a jaw.
  const Part* outline() const { return outline_.get(); }

  /// N: direction of the outward normal in the finger's frame, radians, unwrapped; it grows with u. At a corner, where
  /// it jumps: just after it.
  double normal(double u) const;
  /// Whether its outline has corners.
  bool has_corners() const { return outline_ && has_corners_; }
  /// Between which N is at a place that may be off by `within`, length: of one that is on a corner then all that N
  /// jumps over, else N(u) alone.
  Interval normals(double u, double within = 0) const;
  /// Whether that place may be on a corner.
  bool is_on_corner(double u, double within = 0) const;
  /// dN per arc length: 1 / r of a disk, 0 of a jaw.
  double curvature(double u) const;
  /// The place in the finger's frame.
  Vec2 point(double u) const;
  /// What u has to be multiplied by for arc length: r of a disk, else 1.
  double length_per_u() const { return is_disk() ? radius_ : 1; }
  /// The largest change of N per u, off corners: 1 of a disk, 0 of a jaw.
  double turn_per_u() const;
  /// What once around adds to u: 2 pi of a disk; of a jaw and an open outline there is no around, it is infinite.
  double period() const;
  /// The range of u: that of an open outline ends.
  Interval ends() const;

 private:
  friend Finger jaw();
  enum class Kind { disk, jaw, outline };
  Finger(Kind kind, std::string name) : kind_(kind), name_(std::move(name)) {}

  Kind kind_ = Kind::disk;
  double radius_ = std::numeric_limits<double>::infinity();
  std::string name_ = "disk";
  std::shared_ptr<const Part> outline_;
  bool has_corners_ = false;
};

/// A disk with this radius, r > 0, in the outline's unit; what it is used for looks at the radius (require_valid), not
/// this. u is an angle.
inline Finger disk(double radius) { return DiskFinger{radius}; }

/// A flat jaw without ends: the x axis of its frame, its body above; u = x.
Finger jaw();

/// Throws InputError unless a disk's radius is a finite number above 0.
void require_valid(const Finger& finger);

/// The finger of this number, 0 for a and 1 for b: nullptr where none are known; a single one serves both.
const Finger* finger_of(const std::vector<Finger>& fingers, std::size_t which);

/// Throws InputError: a finger that is not valid, more of them than there rolled, and none where they `must_be_known`.
/// `log`: for messages.
void require_fingers(const std::vector<Finger>& fingers, std::size_t rolled, bool must_be_known,
                     const std::string& log);

/// Throws InputError: one of them has corners, which `what` does not take.
void require_no_corners(const std::vector<Finger>& fingers, const std::string& what);

/// N(u) + psi: the direction of the contact's normal in the world, out of the finger and into the part.
double normal_direction(const Finger& finger, const Contact& contact);

/// Eqs. (1)-(3) integrated: L = -(arc length on the finger), theta = (N(u1) - N(u0)) + (psi1 - psi0). Angles unwrapped,
/// and so is u of a closed outline. Of a disk N = u, of a jaw N stays. `within`: how far u may be off, length. A
/// contact that may be on a corner of the finger leaves theta open: Reading::pivot.
Reading reading_between(const Finger& finger, const Contact& first, const Contact& last, double within = 0);

/// The inverse: the contact after a roll with this reading; on a corner of the finger with N just after it.
Contact contact_after(const Finger& finger, const Contact& first, const Reading& reading);

/// The contact of a disk that is oriented psi and touches where the part's tangent points in this direction (both in
/// the world's frame). The finger lies on the right of the tangent, the material on its left: u + psi = tangent + pi/2.
/// u comes out in (-pi, pi].
Contact contact_on(double tangent, double psi);

/// The contact of any finger that touches with its place u where the tangent points in this direction: psi follows.
Contact contact_at(const Finger& finger, double tangent, double u);

/// Where the origin of the finger's frame is in the world, a disk's centre, when it touches at this point.
Vec2 centre_of(const Finger& finger, const Vec2& point, const Contact& contact);

/// Where a finger's contact is as seen from the origin of its frame, a disk's centre, along the contact's normal (out
/// of the finger, into the part) and across it, counter-clockwise: of a disk (r, 0), of a jaw (0, u).
struct Arm {
  Vec2 at = Vec2::Zero();
  Vec2 per_length = Vec2::Zero();  // how it changes along the finger, counter-clockwise
};
Arm arm_of(const Finger& finger, double u);

/// What the fingers say together, each of which has a reading of its own: of one its own, of two eqs. (7)-(9). The
/// turns of two may hold that of the part, which cancels.
Reading together(const PerFinger<Reading>& each);

/// A reading whose length is positive along the outline as the user gave it, in the direction in which it is stored.
/// Against the user's direction, L changes its sign and theta does not: see docs/rolling.md.
Reading in_stored_direction(const Reading& as_given, const Part& part);

}  // namespace rollfix
