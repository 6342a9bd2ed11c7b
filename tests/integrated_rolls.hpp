#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/math/tools/roots.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <boost/numeric/odeint/stepper/controlled_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_cash_karp54.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "roll/motion.hpp"
#include "rollfix/error.hpp"
#include "work/pulse.hpp"

/// The witness of rolls: eqs. (1) and (2), with kappa by arc length, integrated by Runge-Kutta 5(4) with step control,
/// started afresh wherever kappa jumps.
namespace integrated_rolls {

using namespace rollfix;

namespace odeint = boost::numeric::odeint;

// Of one step, for angles in radians and for s in perimeters: so that a roll of many steps keeps 1e-10.
constexpr double kStepTolerance = 1e-13;
// What is left of a roll when it arrives at the end of its way, in radians: less than this is an error of integration.
constexpr double kLeftOver = 1e-10;

inline const boost::math::tools::eps_tolerance<double> kFully(std::numeric_limits<double>::digits);

/// What eqs. (1) and (2) are integrated over; s in perimeters, so that one tolerance suits all.
using State = std::array<double, 3>;
constexpr std::size_t kU = 0;
constexpr std::size_t kS = 1;
constexpr std::size_t kPsi = 2;
// Not Fehlberg 7(8): its estimate of the error is 0 wherever a rate depends on time alone, as psi's does.
using Stepper = odeint::runge_kutta_cash_karp54<State>;
inline const Stepper kStepper{};  // static, so that the scratch space in it is zeroed before it is copied
using ControlledStepper = odeint::result_of::make_controlled<Stepper>::type;

class Integration {
 public:
  Integration(const Track& track, const Motion& motion)
      : track_(track),
        motion_(motion),
        perimeter_(track.part().perimeter()),
        unit_of_u_(track.finger().is_disk() ? track.finger().length_per_u() : perimeter_),
        controlled_(odeint::make_controlled(kStepTolerance, 0.0, kStepper)),
        state_{motion.first.u * track.finger().length_per_u() / unit_of_u_, motion.start.s / perimeter_,
               motion.first.psi},
        step_(motion.duration) {
    enter(motion.start.index, 1);
  }

  void advance_to(double time) {
    while (time_ < time) {
      const double limit = std::min(time, next_turning_point(time));
      step(limit);
    }
  }

  RollState state() const {
    const Contact contact{state_[kU] * unit_of_u_ / track_.finger().length_per_u(), state_[kPsi]};
    const double turn = reading_between(track_.finger(), motion_.first, contact).turn;
    return {contact, state_[kS] * perimeter_, motion_.start_angle + turn};
  }

 private:
  /// Eqs. (1) and (2), the latter by arc length; in a pivot the contact rests.
  void rates(const State& state, State& rate, double time) const {
    const double omega = motion_.omega_at(time);
    rate[kPsi] = omega;
    if (stretch_.is_pivot) {
      rate[kU] = rate[kS] = 0;
      return;
    }
    const double s = state[kS] * perimeter_;
    const double velocity = omega / (track_.finger_curvature(stretch_, s) + track_.turning(stretch_, s).curvature);
    rate[kU] = -velocity / unit_of_u_;  // eq. (1): what is rolled off the finger
    rate[kS] = velocity / perimeter_;   // eq. (2)
  }

  auto system() const {
    return [this](const State& state, State& rate, double time) { rates(state, rate, time); };
  }

  void step(double limit) {
    beat();
    const bool is_cut = step_ >= limit - time_;
    const double size = is_cut ? limit - time_ : step_;
    State next;
    double next_time = time_;
    double suggestion = size;
    if (controlled_.try_step(system(), state_, next_time, next, suggestion) == odeint::fail) {
      step_ = suggestion;
      require_progress();
      return;
    }
    const int direction = motion_.omega_at(time_ + size / 2) < 0 ? -1 : 1;
    const double beyond = direction > 0 ? position(next) - ends_.hi : ends_.lo - position(next);
    if (beyond > 0) {
      leave(direction, size);
      return;
    }
    state_ = next;
    time_ = is_cut ? limit : next_time;
    step_ = is_cut ? std::max(step_, suggestion) : suggestion;
  }

  /// Goes to the end of the stretch, which a step of this size crosses, and on to the next.
  void leave(int direction, double size) {
    const double end = direction > 0 ? ends_.hi : ends_.lo;
    const auto excess = [&](double part) { return direction * (position(stepped(part)) - end); };
    const double before = direction * (position(state_) - end);
    const double after = excess(size);
    double part = before < 0 ? size : 0;
    if (before < 0 && after > 0) {
      std::uintmax_t iterations = 100;
      part = boost::math::tools::toms748_solve(excess, 0.0, size, before, after, kFully, iterations).first;
    }
    state_ = stepped(part);
    if (!stretch_.is_pivot) state_[kS] = end / perimeter_;
    time_ += part;
    go_on(direction);
  }

  State stepped(double size) const {
    State end = state_;
    if (size > 0) Stepper().do_step(system(), state_, time_, end, size);
    return end;
  }

  void go_on(int direction) {
    if (const auto next = track_.next(index_, direction)) {
      state_[kPsi] += track_.fall_between(index_, *next);
      enter(*next, direction);
    } else if (std::abs(motion_.omega_at(time_)) * (motion_.duration - time_) < kLeftOver) {
      time_ = motion_.duration;
    } else {
      track_.refuse(index_, direction);
    }
  }

  void enter(std::int64_t index, int direction) {
    index_ = index;
    stretch_ = track_.stretch(index);
    if (stretch_.is_pivot) {
      const double angle = state_[kPsi];
      const double turn = stretch_.angle.width();
      ends_ = direction > 0 ? Interval{angle, angle + turn} : Interval{angle - turn, angle};
    } else {
      ends_ = stretch_.s;
    }
  }

  /// What has to stay between the stretch's ends: s, or in a pivot, where u stays, the finger's orientation.
  double position(const State& state) const { return stretch_.is_pivot ? state[kPsi] : state[kS] * perimeter_; }

  /// Where omega changes its sign before `time`: a step must not go beyond an end and come back.
  double next_turning_point(double time) const {
    if (!motion_.omega) return time;
    const double now = motion_.omega(time_);
    const double then = motion_.omega(time);
    if (!(now * then < 0)) return time;
    std::uintmax_t iterations = 100;
    return boost::math::tools::toms748_solve(motion_.omega, time_, time, now, then, kFully, iterations).second;
  }

  void require_progress() const {
    if (time_ + step_ > time_) return;
    const int direction = motion_.omega_at(time_) < 0 ? -1 : 1;
    if (!track_.next(index_, direction)) track_.refuse(index_, direction);
    throw InternalError(
        fmt::format("{}: a roll got stuck at time {}, s = {}", track_.part().name(), time_, state_[kS] * perimeter_));
  }

  const Track& track_;
  const Motion& motion_;
  double perimeter_;
  double unit_of_u_;  // a disk's u is an angle, any other's is taken in the part's perimeters
  ControlledStepper controlled_;
  State state_;
  double time_ = 0;
  double step_;
  std::int64_t index_ = 0;
  Stretch stretch_;
  Interval ends_;
};

inline std::vector<RollState> states_by_integration(const Track& track, const Motion& motion,
                                                    const std::vector<double>& times) {
  std::vector<RollState> states;
  states.reserve(times.size());
  Integration integration(track, motion);
  for (const double time : times) {
    integration.advance_to(time);
    states.push_back(integration.state());
  }
  return states;
}

inline Roll integrated_roll(const Part& part, const Finger& finger, const RollPlan& plan) {
  return roll_with(&states_by_integration, part, finger, plan);
}

inline Roll integrated_roll_free(const Part& part, const FreePlan& plan) {
  return roll_with(&states_by_integration, part, plan);
}

}  // namespace integrated_rolls
