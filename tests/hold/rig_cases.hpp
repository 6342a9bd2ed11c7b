#pragma once

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "outline/turn.hpp"
#include "rollfix/hold.hpp"
#include "touch/touch_cases.hpp"

// A jaw and a wheel that turns freely on its pin, with a part between them. The simulation knows rigid bodies whose
// velocities are equal where they touch, and the outline's points, tangents and curvature: nothing of closed forms. It
// is integrated by Runge and Kutta's method of fourth order.
namespace rig_cases {

using rollfix::HoldAnswer;
using rollfix::HoldPlacement;
using rollfix::HoldProblem;
using rollfix::Log;
using rollfix::Part;
using rollfix::Pose;
using rollfix::Vec2;
using touch_cases::normal;
using touch_cases::uniform;

/// How jaw and pin move, as polynomials of the time from 0 to 1.
struct RigMotion {
  std::array<double, 3> jaw_turn{};  // by t, t^2, t^3
  std::array<Vec2, 3> jaw_way{{Vec2::Zero(), Vec2::Zero(), Vec2::Zero()}};
  std::array<Vec2, 3> pin_way{{Vec2::Zero(), Vec2::Zero(), Vec2::Zero()}};
};

template <class Value>
Value at_time(const std::array<Value, 3>& by, double t) {
  return by[0] * t + by[1] * (t * t) + by[2] * (t * t * t);
}
template <class Value>
Value rate_at(const std::array<Value, 3>& by, double t) {
  return by[0] + by[1] * (2 * t) + by[2] * (3 * t * t);
}

inline Vec2 across(const Vec2& v) { return {-v.y(), v.x()}; }
inline Vec2 turned(const Vec2& v, double angle) { return Pose{0, 0, angle}.turned(v); }

struct RigCase {
  HoldProblem problem;
  double start = 0;        // of the jaw's contact
  double wheel_start = 0;  // of the wheel's
  double end = 0;
  double wheel_end = 0;
  Pose first;
  Pose last;
  bool is_sound = true;  // both keep touching, neither enters the part, and the contacts kept apart from g = 0
};

struct RigSetup {
  double radius = 0.4;
  double start = 1;
  double wheel_start = 5;
  Pose first{0.3, -0.2, 0.5};
  RigMotion motion{};
  std::size_t rows = 40;
  std::size_t steps_of_row = 40;
  bool encoder = false;
};

/// The rig at one instant: what is integrated.
struct RigState {
  Vec2 part = Vec2::Zero();
  double heading = 0;
  double spin = 0;  // of the wheel
  double s = 0;
  double t = 0;

  RigState moved(const RigState& rate, double h) const {
    return {part + h * rate.part, heading + h * rate.heading, spin + h * rate.spin, s + h * rate.s, t + h * rate.t};
  }
};

class Rig {
 public:
  Rig(const Part& part, const RigSetup& setup) : part_(part), setup_(setup) {
    state_ = {{setup.first.x, setup.first.y}, setup.first.heading, 0.7, setup.start, setup.wheel_start};
    jaw_turn_ = state_.heading + part.tangent(setup.start) + std::numbers::pi;
    jaw_ = point_of(state_, state_.s) - turned({kFirstU, 0}, jaw_turn_);
    pin_ = point_of(state_, state_.t) + setup.radius * turned(outward(state_.t), state_.heading);
  }

  static constexpr double kFirstU = 0.13;

  double jaw_turn(double time) const { return jaw_turn_ + at_time(setup_.motion.jaw_turn, time); }
  Vec2 jaw(double time) const { return jaw_ + at_time(setup_.motion.jaw_way, time); }
  Vec2 pin(double time) const { return pin_ + at_time(setup_.motion.pin_way, time); }
  double u() const { return kFirstU - (state_.s - setup_.start); }
  const RigState& state() const { return state_; }

  void step(double time, double h) {
    const RigState a = rate(state_, time);
    const RigState b = rate(state_.moved(a, 0.5 * h), time + 0.5 * h);
    const RigState c = rate(state_.moved(b, 0.5 * h), time + 0.5 * h);
    const RigState d = rate(state_.moved(c, h), time + h);
    state_ = state_.moved(a, h / 6).moved(b, h / 3).moved(c, h / 3).moved(d, h / 6);
  }

  /// How far the bodies have come apart where they touch, length.
  double gap(double time) const {
    const Vec2 on_jaw = jaw(time) + turned({u(), 0}, jaw_turn(time));
    const Vec2 on_wheel = pin(time) - setup_.radius * turned(outward(state_.t), state_.heading);
    return std::max((point_of(state_, state_.s) - on_jaw).norm(), (point_of(state_, state_.t) - on_wheel).norm());
  }

  /// How far the wheel's normal passes the jaw's contact: where it does not the contacts can't follow.
  double aside() const {
    return (part_.point(state_.t) - part_.point(state_.s)).dot(Vec2(-outward(state_.t).y(), outward(state_.t).x()));
  }

 private:
  Vec2 outward(double s) const { return {std::sin(part_.tangent(s)), -std::cos(part_.tangent(s))}; }
  Vec2 point_of(const RigState& at, double s) const { return at.part + turned(part_.point(s), at.heading); }

  /// Part and wheel move as the jaw and the pin make them where they touch.
  RigState rate(const RigState& at, double time) const {
    const Vec2 q = point_of(at, at.s), w = point_of(at, at.t);
    const double jaw_rate = rate_at(setup_.motion.jaw_turn, time);
    const Vec2 jaw_velocity = rate_at(setup_.motion.jaw_way, time) + jaw_rate * across(q - jaw(time));
    Eigen::Matrix2d system;
    system.col(0) = across(w - q);
    system.col(1) = -across(w - pin(time));
    const Vec2 turns = system.inverse() * (rate_at(setup_.motion.pin_way, time) - jaw_velocity);
    RigState rate;
    rate.heading = turns(0);
    rate.spin = turns(1);
    rate.part = jaw_velocity - turns(0) * across(q - at.part);
    const auto& turning = part_.turning();
    rate.s = (jaw_rate - turns(0)) / turning.curvature(at.s);
    rate.t = (turns(1) - turns(0)) / (turning.curvature(at.t) + 1 / setup_.radius);
    return rate;
  }

  const Part& part_;
  const RigSetup& setup_;
  RigState state_;
  double jaw_turn_ = 0;
  Vec2 jaw_, pin_;
};

/// Runs it, and what the sensors say of it without noise.
inline RigCase rig_of(const Part& part, const RigSetup& setup) {
  Rig rig(part, setup);
  RigCase result{HoldProblem{part, {}, {rollfix::jaw()}}, setup.start, setup.wheel_start, 0, 0, setup.first, {}};
  result.problem.may_overlap = true;  // a random wheel may be beyond the jaw's line
  Log log;
  log.name = "jaw";
  rollfix::FingerRows& jaw = log.fingers.front();
  jaw.u_wrapped = jaw.psi_wrapped = false;
  std::vector<double> x, y, psi, time;
  const double aside = rig.aside();
  for (std::size_t row = 0; row <= setup.rows; ++row) {
    const double now = static_cast<double>(row) / static_cast<double>(setup.rows);
    jaw.u.push_back(rig.u());
    jaw.psi.push_back(rig.jaw_turn(now));
    jaw.x.push_back(rig.jaw(now).x());
    jaw.y.push_back(rig.jaw(now).y());
    x.push_back(rig.pin(now).x());
    y.push_back(rig.pin(now).y());
    psi.push_back(rig.state().spin);
    time.push_back(now);
    result.is_sound = result.is_sound && std::isfinite(rig.state().s) && rig.gap(now) < 1e-9 &&
                      aside * rig.aside() > 0 && std::abs(rig.aside()) > 0.05 * part.perimeter() / 10;
    if (!result.is_sound) break;
    result.end = rig.state().s;
    result.wheel_end = rig.state().t;
    result.last = {rig.state().part.x(), rig.state().part.y(), rig.state().heading};
    const double h = 1.0 / static_cast<double>(setup.rows * setup.steps_of_row);
    for (std::size_t k = 0; row < setup.rows && k < setup.steps_of_row; ++k) {
      rig.step(now + h * static_cast<double>(k), h);
    }
  }
  if (!result.is_sound) return result;
  log.time = time;
  result.problem.logs = {log};
  rollfix::PinLog pin = rollfix::pin_log("pin", x, y, setup.encoder ? psi : std::vector<double>{}, time);
  pin.rows.fingers.front().psi_wrapped = false;
  result.problem.wheels = {{pin, setup.radius}};
  return result;
}

/// Whether a jaw can lie at s, and a wheel touch at t, without entering the part.
inline bool is_free(const Part& part, double s, double t, double radius) {
  const Vec2 n(std::sin(part.tangent(s)), -std::cos(part.tangent(s)));
  const Vec2 m(std::sin(part.tangent(t)), -std::cos(part.tangent(t)));
  const Vec2 centre = part.point(t) + radius * m;
  constexpr int kPlaces = 400;
  for (int k = 0; k < kPlaces; ++k) {
    const Vec2 point = part.point(part.perimeter() * k / kPlaces);
    if ((point - part.point(s)).dot(n) > 1e-9 * part.perimeter()) return false;
    if ((point - centre).norm() < radius * (1 - 1e-6)) return false;
  }
  return true;
}

/// A random one that goes well.
inline RigCase random_rig(const Part& part, double radius, std::mt19937_64& generator, bool encoder = false,
                          std::size_t rows = 40) {
  const double size = part.perimeter() / 10;
  const auto vector = [&] { return Vec2{uniform(generator, -size, size), uniform(generator, -size, size)}; };
  while (true) {
    RigSetup setup;
    setup.radius = radius;
    setup.rows = rows;
    setup.encoder = encoder;
    setup.start = uniform(generator, 0, part.perimeter());
    setup.wheel_start = uniform(generator, 0, part.perimeter());
    setup.first = {uniform(generator, -size, size), uniform(generator, -size, size), uniform(generator, -3, 3)};
    for (double& by : setup.motion.jaw_turn) by = uniform(generator, -0.4, 0.4);
    for (Vec2& by : setup.motion.jaw_way) by = vector();
    for (Vec2& by : setup.motion.pin_way) by = 0.3 * vector();
    // The pin goes with the jaw, about.
    for (std::size_t k = 0; k < 3; ++k) setup.motion.pin_way[k] += setup.motion.jaw_way[k];
    if (!is_free(part, setup.start, setup.wheel_start, radius)) continue;
    RigCase one = rig_of(part, setup);
    if (one.is_sound && is_free(part, one.end, one.wheel_end, radius)) return one;
  }
}

/// Where both touch at one instant, and how the part lies. `pivot`: at a corner the jaw's tangent is so far behind the
/// one before it, radians.
struct Held {
  double s = 0;
  double t = 0;
  Pose pose;
  std::optional<double> pivot{};
  std::optional<double> wheel_pivot{};
};

/// An angle from instant to instant, without turns that nothing made.
class Followed {
 public:
  double operator()(double angle) {
    last_ = last_ ? *last_ + rollfix::nearest_angle(angle - *last_) : angle;
    return *last_;
  }

 private:
  std::optional<double> last_;
};

inline Vec2 normal_of(double tangent) { return {std::sin(tangent), -std::cos(tangent)}; }

/// The logs of instants that are told: what a wheel without an encoder says needs no roll in between.
inline HoldProblem held_at(const Part& part, double radius, const std::vector<Held>& instants) {
  HoldProblem problem{part, {}, {rollfix::jaw()}};
  problem.may_overlap = true;
  Log log;
  log.name = "jaw";
  rollfix::FingerRows& jaw = log.fingers.front();
  jaw.u_wrapped = jaw.psi_wrapped = false;
  std::vector<double> x, y;
  const auto tangent_at = [&](double s, const std::optional<double>& pivot) {
    return pivot ? part.tangent(s - 1e-9 * part.perimeter()) + *pivot : part.tangent(s);
  };
  Followed tangent;
  for (const Held& one : instants) {
    const double turn = one.pose.heading + tangent(tangent_at(one.s, one.pivot)) + std::numbers::pi;
    const double u = 0.1 - (one.s - instants.front().s);
    const Vec2 origin = one.pose.world(part.point(one.s)) - turned({u, 0}, turn);
    const Vec2 pin = one.pose.world(part.point(one.t) + radius * normal_of(tangent_at(one.t, one.wheel_pivot)));
    jaw.u.push_back(u);
    jaw.psi.push_back(turn);
    jaw.x.push_back(origin.x());
    jaw.y.push_back(origin.y());
    x.push_back(pin.x());
    y.push_back(pin.y());
    log.time.push_back(static_cast<double>(log.time.size()));
  }
  problem.wheels = {{rollfix::pin_log("pin", x, y, {}, log.time), radius}};
  problem.logs = {log};
  return problem;
}

/// What the sensors are off by.
struct RigNoise {
  double contact = 0;
  double angle = 0;
  double position = 0;
  double radius = 0;
};

/// The same as noisy sensors have it, with the noise stated.
inline RigCase noisy(RigCase one, const RigNoise& errors, std::mt19937_64& generator) {
  rollfix::FingerRows& jaw = one.problem.logs.front().fingers.front();
  rollfix::FingerRows& pin = one.problem.wheels.front().log.rows.fingers.front();
  for (double& u : jaw.u) u += normal(generator, errors.contact);
  for (auto* angles : {&jaw.psi, &pin.psi}) {
    for (double& psi : *angles) psi += normal(generator, errors.angle);
  }
  for (auto* places : {&jaw.x, &jaw.y, &pin.x, &pin.y}) {
    for (double& place : *places) place += normal(generator, errors.position);
  }
  one.problem.wheels.front().radius += normal(generator, errors.radius);
  rollfix::Noise noise;
  noise.contact = errors.contact;
  noise.angle = errors.angle;
  noise.position = errors.position;
  noise.radius = errors.radius;
  one.problem.noise = noise;
  return one;
}

}  // namespace rig_cases
