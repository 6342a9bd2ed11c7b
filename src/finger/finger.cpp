#include "rollfix/finger.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "outline/turn.hpp"
#include "rollfix/error.hpp"

// Notation:
//   u, psi          contact on the finger, the finger's orientation: Contact
//   N(u)            direction of the finger's outward normal in its own frame: `normal`; at a corner all of `normals`
//   kappa_f         dN / d(arc length): `curvature`
//   L, theta        length rolled on the part, turn of its tangent: Reading; `pivot`: theta is known to +- that
// Follows eqs. (3) and (7)-(9) of the paper (Jia, IROS 2001); docs/rolling.md, "Fingers of any convex shape" and
// "Fingers with corners".
// Idea: a disk, a jaw and an outline differ only in N(u), kappa_f and the place of u. Rolling without slip covers the
// same length on both bodies, and their normals stay opposite: so two contacts give a reading without an integral.
namespace rollfix {

namespace {

constexpr double kQuarterTurn = std::numbers::pi / 2;
// Of a full turn over the perimeter: a curvature this far below 0 is rounding.
constexpr double kFlat = 1e-9;
// Of the length of its outline: a contact so near to a corner may be on it by rounding.
constexpr double kAtCorner = 1e-9;

/// Throws InputError with what was found and where: u and the point there.
[[noreturn]] void refuse_finger(const Part& part, double u, const std::string& found) {
  const Vec2 point = part.point(u);
  throw InputError(
      fmt::format("{}: expected the outline of a finger, convex all around, found {} at {:.6g} of "
                  "its length, ({:.6g}, {:.6g}); give its convex hull",
                  part.name(), found, u, point.x(), point.y()));
}

/// Throws InputError: a concave corner, or a spiral with a curvature below 0 by more than rounding. kappa is monotone
/// on a spiral, so that its ends are enough.
void require_convex(const Part& part) {
  for (const Corner& corner : part.corners()) {
    if (corner.turn < -kJointTurn) {
      refuse_finger(part, corner.s, fmt::format("a concave corner of {:.6g} deg", corner.turn / kDegree));
    }
  }
  const double least = -kFlat * 2 * std::numbers::pi / part.perimeter();
  for (const Spiral& spiral : part.turning().spirals()) {
    const bool at_start = spiral.start.curvature < spiral.end.curvature;
    const double curvature = at_start ? spiral.start.curvature : spiral.end.curvature;
    if (curvature < least) {
      refuse_finger(part, at_start ? spiral.lo : spiral.hi,
                    fmt::format("a concave place with a curvature of {:.6g}", curvature));
    }
  }
}

/// The finger pivots there: not a smooth joint of a drawing whose digits were rounded.
bool pivots(const Corner& corner) { return corner.turn > kJointTurn; }

Vec2 unit_vector(double angle) { return {std::cos(angle), std::sin(angle)}; }

}  // namespace

/// A finger that is the x axis of its frame.
Finger jaw() { return {Finger::Kind::jaw, "jaw"}; }

/// Copies the outline, which is shared by all copies of the finger.
Finger Finger::outlined(const Part& outline) {
  Finger finger(Kind::outline, outline.name());
  finger.outline_ = std::make_shared<const Part>(outline);
  require_convex(*finger.outline_);
  const std::vector<Corner>& corners = finger.outline_->corners();
  finger.has_corners_ = std::any_of(corners.begin(), corners.end(), pivots);
  return finger;
}

std::optional<DiskFinger> Finger::disk() const {
  return is_disk() ? std::optional<DiskFinger>(DiskFinger{radius_}) : std::nullopt;
}

/// An outline has its body on the left, so that the outward normal is a quarter turn behind the tangent.
double Finger::normal(double u) const {
  if (is_disk()) return u;
  return is_jaw() ? -kQuarterTurn : outline_->turning().angle(u) - kQuarterTurn;
}

/// A place within `within` of several corners has the normals of all of them. Linear in the number of corners.
Interval Finger::normals(double u, double within) const {
  Interval all{normal(u), normal(u)};
  if (!has_corners()) return all;
  const TurningFunction& turning = outline_->turning();
  const double P = outline_->perimeter();
  for (const Corner& corner : outline_->corners()) {
    if (!pivots(corner)) continue;
    // The corner's lap that is nearest to u: u of a closed outline is unwrapped.
    const double laps = outline_->closed() ? std::round((u - corner.s) / P) : 0;
    if (std::abs(u - corner.s - laps * P) > within + kAtCorner * P) continue;
    // N grows by a whole turn each lap.
    const double lap_turn = laps * turning.period_turn() - kQuarterTurn;
    all.lo = std::min(all.lo, turning.angle(corner.s, Side::before) + lap_turn);
    all.hi = std::max(all.hi, turning.angle(corner.s, Side::after) + lap_turn);
  }
  return all;
}

bool Finger::is_on_corner(double u, double within) const { return normals(u, within).width() > 0; }

/// kappa_f; radians per length.
double Finger::curvature(double u) const {
  if (is_disk()) return 1 / radius_;
  return is_jaw() ? 0 : outline_->turning().curvature(u);
}

/// Of a disk r (cos u, sin u), of a jaw (u, 0).
Vec2 Finger::point(double u) const {
  if (is_disk()) return radius_ * unit_vector(u);
  return is_jaw() ? Vec2(u, 0) : outline_->point(u);
}

/// Per radian of u of a disk, per length of all others.
double Finger::turn_per_u() const {
  if (is_disk()) return 1;
  return is_jaw() ? 0 : outline_->turning().most_curvature();
}

double Finger::period() const {
  if (is_disk()) return 2 * std::numbers::pi;
  return outline_ && outline_->closed() ? outline_->perimeter() : std::numeric_limits<double>::infinity();
}

Interval Finger::ends() const {
  if (outline_ && !outline_->closed()) return {0, outline_->perimeter()};
  return {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
}

void require_valid(const Finger& finger) {
  const double radius = finger.is_disk() ? finger.length_per_u() : 1;
  if (radius > 0 && std::isfinite(radius)) return;
  throw InputError(fmt::format(
      "expected a finger whose radius is a finite number above 0, found {}: give it in the outline's unit", radius));
}

const Finger* finger_of(const std::vector<Finger>& fingers, std::size_t which) {
  return fingers.empty() ? nullptr : &fingers[std::min(which, fingers.size() - 1)];
}

void require_fingers(const std::vector<Finger>& fingers, std::size_t rolled, bool must_be_known,
                     const std::string& log) {
  if (fingers.empty() && must_be_known) {
    throw InputError(
        fmt::format("{}: u says where on the finger the contact is, expected the finger's shape as well: `finger` "
                    "disk,r=RADIUS, with the radius in the outline's unit",
                    log));
  }
  if (fingers.size() > rolled) {
    throw InputError(fmt::format("{}: is of {}, found the shapes of {}; leave {} out", log,
                                 rolled == 1 ? "one finger" : "two fingers", fingers.size(), fingers.size() - rolled));
  }
  for (const Finger& finger : fingers) require_valid(finger);
}

void require_no_corners(const std::vector<Finger>& fingers, const std::string& what) {
  for (const Finger& finger : fingers) {
    if (!finger.has_corners()) continue;
    throw InputError(fmt::format(
        "{}: expected a finger without corners, found {}: on a corner u does not tell how the finger's normal is "
        "turned; round its corners, or ask `locate` or `watch` about one finger with skin or two",
        what, finger.name()));
  }
}

double normal_direction(const Finger& finger, const Contact& contact) { return finger.normal(contact.u) + contact.psi; }

/// Eq. (3). On corners N is an interval at both ends: theta is its middle, `pivot` half of both widths together.
Reading reading_between(const Finger& finger, const Contact& first, const Contact& last, double within) {
  if (finger.has_corners()) {
    const Interval from = finger.normals(first.u, within);
    const Interval to = finger.normals(last.u, within);
    Reading reading{first.u - last.u, (to.middle() - from.middle()) + (last.psi - first.psi)};
    reading.pivot = 0.5 * (from.width() + to.width());
    return reading;
  }
  const double rolled = last.u - first.u;
  // Of a disk N = u, whatever the radius.
  const double turned = finger.is_disk() ? rolled : finger.normal(last.u) - finger.normal(first.u);
  return {-finger.length_per_u() * rolled, turned + (last.psi - first.psi)};  // eq. (3)
}

/// Solves eq. (3) for the last contact: u from L, then psi from theta.
Contact contact_after(const Finger& finger, const Contact& first, const Reading& reading) {
  const double rolled = reading.length[0] / finger.length_per_u();
  const double u = first.u - rolled;
  const double turned = finger.is_disk() ? rolled : finger.normal(first.u) - finger.normal(u);
  return {u, first.psi + (reading.turn + turned)};
}

/// u = Theta + pi / 2 - psi.
Contact contact_on(double tangent, double psi) { return {nearest_angle(tangent + kQuarterTurn - psi), psi}; }

/// psi = Theta + pi / 2 - N(u).
Contact contact_at(const Finger& finger, double tangent, double u) {
  return {u, tangent + kQuarterTurn - finger.normal(u)};
}

/// The point less R(psi) times the place on the finger.
Vec2 centre_of(const Finger& finger, const Vec2& point, const Contact& contact) {
  if (finger.is_disk()) return point - finger.length_per_u() * unit_vector(contact.normal_direction());
  const Vec2 x = unit_vector(contact.psi);
  const Vec2 on_finger = finger.point(contact.u);
  return point - (on_finger.x() * x + on_finger.y() * Vec2(-x.y(), x.x()));
}

/// The normal and the direction across it are the frame in which `at` is given; both turn by kappa_f along the finger.
Arm arm_of(const Finger& finger, double u) {
  if (finger.is_disk()) return {Vec2(finger.length_per_u(), 0), Vec2::Zero()};
  const Vec2 normal = unit_vector(finger.normal(u));
  const Vec2 point = finger.point(u);
  Arm arm;
  arm.at = {normal.dot(point), normal.x() * point.y() - normal.y() * point.x()};
  // The contact goes across the normal, and the normal turns.
  arm.per_length = Vec2(0, 1) - finger.curvature(u) * Vec2(-arm.at.y(), arm.at.x());
  return arm;
}

/// Two fingers on a part that moves: its own rotation is in both turns and cancels in their difference. What both
/// corners leave open adds up.
Reading together(const PerFinger<Reading>& each) {
  if (each.size() == 1) return each[0];
  Reading both{each[0].length[0], each[1].length[0], each[0].turn - each[1].turn};  // eqs. (7)-(9)
  both.pivot = each[0].pivot + each[1].pivot;
  return both;
}

/// Only L changes: the tangent of the reversed outline turns by the same angle along the same way.
Reading in_stored_direction(const Reading& as_given, const Part& part) {
  Reading result = as_given;
  if (!part.reversed()) return result;
  for (double& length : result.length) length = -length;
  return result;
}

}  // namespace rollfix
