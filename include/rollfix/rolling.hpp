#pragma once

// What fingers do that roll on a part, and what their sensors would write: docs/rolling.md.
//
//     const Part part = load_part("gallery:ellipse,a=2,b=1");
//     RollPlan plan;
//     plan.start = 0.5;
//     plan.distance = 1.0;
//     const Roll rolled = roll(part, disk(0.3), plan);
//     const Answer answer = solve({part, rolled.log, {disk(0.3)}});
//     answer.placements[0].contains(part.boundary(), {0.5});  // true
//
// Degenerate cases: at a convex corner the finger pivots, at a concave one it stops with an error; a roll of length 0
// is one row, repeated.
//
// Accuracy: closed forms of eqs. (1) and (2), to rounding; an integrator of the same equations agrees to 1e-9 in
// tests/rolling_test.cpp.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "rollfix/curve.hpp"
#include "rollfix/finger.hpp"
#include "rollfix/log.hpp"
#include "rollfix/part.hpp"
#include "rollfix/reading.hpp"

namespace rollfix {

/// How a robot turns a finger that touches a part at rest. Exactly one of `distance`, `rotation` and `duration` is
/// given. A finger that starts at a convex corner has its pivot there behind it; one that stops at one has it still
/// ahead.
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

/// One of two fingers on a part that is free to move. Exactly one of `distance` and `omega` is given, the same for
/// both.
struct FreeFinger {
  Finger finger = DiskFinger{};
  double start = 0;                       // s of the first contact, along the stored outline
  double psi = 0;                         // a disk's orientation there, in the world, radians
  std::optional<double> distance{};       // how far its contact travels: L, below 0 for backwards, 0 for staying; or
  std::function<double(double)> omega{};  // its angular velocity in the world by time, rad/s; may change its sign
  std::optional<double> u{};              // of any other finger than a disk: as of a roll on a part at rest
};

/// How a robot turns two fingers that touch a part, and how the part answers. All angular velocities are given, so that
/// the contacts and the orientations follow; `velocity_a` or `velocity_part` says how everything moves along, and
/// where neither is given finger a's centre stays where it is.
struct FreePlan {
  PerFinger<FreeFinger> fingers{FreeFinger{}, FreeFinger{}};
  Pose pose;                       // the part's, at the start
  std::optional<double> duration;  // seconds; with `omega` it must be given
  // With distances: all turn evenly.
  double part_rotation = 0;  // by how much the part turns meanwhile, radians
  double speed = 1;          // without a duration: of the finger that turns the faster against the part, rad/s
  // With `omega`:
  std::function<double(double)> omega_part;  // the part's angular velocity by time, rad/s; none: it does not turn
  // At most one of them, by time, per second:
  std::function<Vec2(double)> velocity_a;     // of finger a's centre
  std::function<Vec2(double)> velocity_part;  // of the origin of the part's frame
  std::size_t rows = 101;                     // of the log, at equal times, both ends included; at least 2
};

/// A roll that was carried out, by one finger or by two. Entry k of everything is the instant of row k.
struct Roll {
  Log log;                               // what the sensors say: time, u, psi, and the fingers' centres in the world
  PerFinger<std::vector<double>> s;      // where each contact is, unwrapped: s[k] - s[0] is L
  PerFinger<std::vector<double>> angle;  // of the tangent there in the part's frame, unwrapped; at a corner how far the
                                         // finger has pivoted
  std::vector<Pose> pose;                // of a part that is free to move; at rest its frame is the world's: empty
};

/// Rolls a finger along a part, by what eqs. (1) and (2) imply: psi - psi0 = (Theta(s) - Theta(s0)) + N(u0) - N(u),
/// solved for s, and u = u0 - (s - s0) along the finger; of a disk N(u0) - N(u) = (s - s0) / r. Accurate to rounding.
/// At a convex corner, the part's or the finger's own, the finger pivots: psi grows, u and L stay; theta grows at the
/// part's alone. Only the contact's own surroundings are looked at:
/// that the finger does not hit the part elsewhere is not checked. Throws InputError: an impossible plan; a concave
/// corner or a concavity that the finger does not fit into on the way (with the place, the curvature, and the radius
/// that would do); a flat side under a jaw or under a flat side of the finger; running off an open part's end or an
/// open finger's; or so few rows that a reader could not tell whether the angles are wrapped.
Roll roll(const Part& part, const Finger& finger, const RollPlan& plan);

/// Rolls two fingers on a part that moves, each contact as `roll` does with the finger's angular velocity against the
/// part: docs/rolling.md. That a finger hits the part elsewhere is not checked; whether the fingers hit each other
/// overlap_of tells. Throws InputError as `roll` does, and says which finger it is about.
Roll roll_free(const Part& part, const FreePlan& plan);

/// The row in which two fingers are deepest in one another.
struct Overlap {
  std::size_t row = 0;
  double depth = 0;  // length: how far one has to be moved, at least, until they are apart
};

/// Nothing where they are apart in every row. Exact for disks, outlines (of an open one its convex hull) and a jaw,
/// which has no ends; two jaws are not compared, because without ends they would always meet somewhere. `roll`: of two
/// fingers.
std::optional<Overlap> overlap_of(const Roll& roll, const Finger& a, const Finger& b);

/// What was drawn once for a whole roll of one finger.
struct RollError {
  double slip = 0;    // e: the contact travelled (1 + e) times as far on the part as the finger was rolled off
  double radius = 0;  // the disk's true radius less the one that the log's reader takes
};

/// A roll whose sensors are noisy, and how it really was. Everything follows from the seed, the same on all platforms
/// up to the rounding of their logarithm, for each finger on its own:
///  * slip: one normal e per roll with this standard deviation;
///  * radius: a disk's true radius is r + N(0, radius), one per roll, and the log's reader takes r;
///  * contact: in each row u is off by N(0, contact) along the finger, of a disk by that over r;
///  * angle: in each row psi is off by N(0, angle);
///  * position: in each row x and y of its centre are off by N(0, position) each;
///  * correlation: these errors of two rows that are x of roll apart have the correlation exp(-x / correlation);
///  * gyro, drift, walk: psi as a gyroscope has it that is off by these.
struct NoisyRoll {
  Log log;
  Roll truth;
  PerFinger<RollError> error;
};

/// Throws InputError as roll does, and: a standard deviation that is not a number of at least 0, that of
/// the radius of a finger that has none, or one so large that the radius came out below 0 or the slip below -1.
NoisyRoll noisy_roll(const Part& part, const Finger& finger, const RollPlan& plan, const Noise& noise,
                     std::uint64_t seed);
NoisyRoll noisy_roll_free(const Part& part, const FreePlan& plan, const Noise& noise, std::uint64_t seed);

/// A log of increments, as a wheel encoder and a gyroscope give them, and how it really was.
struct NoisyIncrements {
  Log log;                // summed up, as read_log does
  std::vector<double> s;  // where the contact really is, of each row; the first contact is before them
  RollError error;
  double turn_scale = 1;  // turns are this many times what the gyroscope measures, but for ...
  double turn_bias = 0;   // ... this much by which its rate is too high, radians per second
};

/// From s = start over this length along the stored outline, in so many equal steps of the true length. Each distance
/// is off by N(0, contact), each dturn by N(0, angle); slip and a gyroscope as above, and no other noise is taken.
/// `seconds`: that it takes, at an even speed; 0: the log has no times. Throws InputError likewise, and: no row, a
/// length that is not finite, a way off the ends of an open part.
NoisyIncrements noisy_increments(const Part& part, double start, double length, std::size_t rows, const Noise& noise,
                                 std::uint64_t seed, double seconds = 0);

/// Where a row of a roll is when all before it are added up.
struct ReckonedRow {
  double s = 0;      // length travelled since the row that comes first along the outline
  double angle = 0;  // direction of the tangent, radians, unwrapped
  Vec2 point = Vec2::Zero();
};

/// One finger's rows by growing length, as `teach` takes them: from row to row along an arc of a circle, nothing closed
/// and nothing averaged. In the world's frame as far as the log has psi, x and y, else from (0, 0) along x.
/// Throws InputError: two fingers, u and psi without a disk.
std::vector<ReckonedRow> dead_reckoned(const Log& log, const std::optional<Finger>& finger);

/// The part's poses at some rows of a log, and how badly what was measured there fits the part's shape: without noise
/// the residuals vanish for the true first contacts, and hardly ever for others. One entry per row.
struct Poses {
  std::vector<Pose> pose;             // headings are unwrapped; the one at the first contact is in (-pi, pi]
  std::vector<double> residual;       // length: how far the contacts in the world are from where the part has them
  std::vector<double> turn_residual;  // radians: how far the headings are apart that the contacts' normals ask for
};

/// The part's poses when the first contacts are at `start`, in the direction in which the part is stored.
///  * Under one finger the part is at rest, and each pose is what that row says alone; `residual` compares its chord
///  from
///    the first contact with the part's, `turn_residual` its heading with the first.
///  * Under two it is free to move, and the poses are means of what both say. `residual` compares the vector from
///  contact
///    a to contact b with the part's, which is also how far apart the fingers would have the part; `turn_residual` is
///    the facing equation's.
/// Nothing where the log does not have each finger's orientation and its centre x, y, or no finger is known. `noise`:
/// by which a contact may be on a corner of its finger, where the heading is between bounds. On one of the part it may
/// be by the digits of the log, and by `start_error`, length, by which the starts may be off.
std::optional<Poses> poses(const Part& part, const std::vector<Finger>& fingers, const Log& log,
                           const PerFinger<double>& start, const std::vector<std::size_t>& rows,
                           const Noise& noise = {}, double start_error = 0);

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

/// With noise as in noisy_roll_free, but that `position` is of the pin alone. The pin
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
