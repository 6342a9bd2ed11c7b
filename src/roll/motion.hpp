#pragma once

#include <fmt/format.h>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "roll/track.hpp"
#include "rollfix/error.hpp"
#include "rollfix/rolling.hpp"

namespace rollfix {

/// A plan made definite for one part: where it starts, and how the finger turns over time.
struct Motion {
  /// where the contact begins, and on which stretch
  TrackPlace start;
  double start_angle = 0;               // of the tangent
  Contact first;                        // what the sensors say there
  double duration = 0;                  // seconds
  double velocity = 0;                  // rad/s, where it is constant
  std::function<double(double)> omega;  // where it is not

  /// rad/s against the part
  double omega_at(double time) const { return omega ? omega(time) : velocity; }
};

/// Throws InputError: a plan that contradicts itself or that the finger can't follow.
Motion plan_motion(const Track& track, const RollPlan& plan);

/// Equal times from 0 to the end.
std::vector<double> times_of(const Motion& motion, std::size_t rows);

/// The integral of a rate from the first of these times to each.
std::vector<double> integrals(const std::function<double(double)>& rate, const std::vector<double>& times);

/// One instant of a roll.
struct RollState {
  /// u, and psi as seen in the part's frame
  Contact contact;
  double s = 0;
  double angle = 0;  // of the tangent
};

/// The roll at these times, in closed form.
std::vector<RollState> states_of(const Track& track, const Motion& motion, const std::vector<double>& times);

/// What the sensors say of a plan whose states are found so.
using Solve = decltype(&states_of);
Roll roll_with(Solve solve, const Part& part, const Finger& finger, const RollPlan& plan);
Roll roll_with(Solve solve, const Part& part, const FreePlan& plan);

inline constexpr std::array<const char*, 2> kFingerNames = {"finger a", "finger b"};

/// Says which finger an error is about.
template <class Action>
void naming(const char* finger, const Action& action) {
  try {
    action();
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", finger, error.what()));
  }
}

/// Where a finger's contact is when the finger has turned so far.
struct Walked {
  double s = 0;
  double angle = 0;         // of the tangent, Theta
  double per_rotation = 0;  // ds per angle that the finger turns by; 0 while it pivots at a corner
};

/// Goes along a finger's track to where the finger has turned by a given amount: the inverse of Track::rotation.
class Walk {
 public:
  /// On the stretch with this index.
  Walk(const Track& track, std::int64_t index) : track_(track) { enter(index); }

  /// Throws InputError where the finger can't turn so far (Track::refuse); it can be asked for less then.
  Walked to(double rotation);

 private:
  void enter(std::int64_t index);
  void go(int direction);
  Walked solve(double rotation) const;

  const Track& track_;
  double fallen_ = 0;  // over the tiny concave joints of a drawing the finger turns back: by so much psi is behind
  /// the stretch that it is on, and its index
  std::int64_t index_ = 0;
  Stretch stretch_;
  /// psi at its ends
  Interval rotation_;
};

}  // namespace rollfix
