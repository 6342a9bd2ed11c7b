#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "rollfix/contact/finger.hpp"
#include "rollfix/contact/pair_log.hpp"
#include "rollfix/contact/pose.hpp"
#include "rollfix/part/part.hpp"

namespace rollfix {

/// One of two fingers on a part that is free to move. Exactly one of `distance` and `omega` is given, the same for
/// both.
struct FreeFinger {
  DiskFinger disk;
  double start = 0;                     // s of the first contact, along the stored outline
  double psi = 0;                       // the finger's orientation there, in the world, radians
  std::optional<double> distance;       // how far its contact travels: L, below 0 for backwards, 0 for staying; or
  std::function<double(double)> omega;  // its angular velocity in the world by time, rad/s; may change its sign
};

/// How a robot turns two fingers that touch a part, and how the part answers. All angular velocities are given, so that
/// the contacts and the orientations follow; `velocity_a` or `velocity_part` says how everything moves along, and
/// where neither is given finger a's centre stays where it is.
struct FreePlan {
  FreeFinger a;
  FreeFinger b;
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

/// What happened. Entry k of everything is the instant of row k.
struct FreeRoll {
  PairLog log;                  // what the sensors say: time, u, psi, and the fingers' centres in the world
  std::vector<double> s;        // where finger a's contact is, unwrapped: s[k] - s[0] is La
  std::vector<double> t;        // where finger b's is: t[k] - t[0] is Lb
  std::vector<double> angle_a;  // of the tangent at s in the part's frame, unwrapped; at a corner how far a has pivoted
  std::vector<double> angle_b;  // the same at t
  std::vector<Pose> pose;       // the part's
};

/// Rolls two fingers on a part that moves: eqs. (1) and (2) for each contact, with the finger's angular velocity
/// against the part, integrated as `roll` does. Neither that a finger hits the part elsewhere nor that the fingers hit
/// each other is checked. Throws InputError as `roll` does, and says which finger it is about.
FreeRoll roll_free(const Part& part, const FreePlan& plan);

/// The same without integration of the contacts: see docs/rolling.md. Accurate to rounding and faster.
FreeRoll roll_free_in_closed_form(const Part& part, const FreePlan& plan);

}  // namespace rollfix
