#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <cmath>
#include <functional>

#include "rollfix/part.hpp"

/// A jaw and a wheel on a pin, simulated as rigid bodies: nothing but that velocities are equal at both contacts, and
/// how fast a contact runs between two curves. It knows nothing of closures, nor of Rollfix's rolls.
namespace rigid_body {

using rollfix::Part;
using rollfix::Vec2;

inline Vec2 unit(double angle) { return {std::cos(angle), std::sin(angle)}; }
inline Vec2 left_of(const Vec2& v) { return {-v.y(), v.x()}; }
inline Vec2 outward(double angle) { return {std::sin(angle), -std::cos(angle)}; }

/// What moves: the jaw's frame, the pin, the part's frame, the wheel, and both contacts.
struct State {
  Vec2 jaw = Vec2::Zero();
  double jaw_heading = 0;
  Vec2 pin = Vec2::Zero();
  Vec2 part = Vec2::Zero();
  double part_heading = 0;
  double wheel_heading = 0;
  double s = 0;
  double t = 0;
  double u = 0;  // on the jaw, length
  double v = 0;  // on the wheel, angle

  Vec2 world(const Vec2& point) const {
    return part + point.x() * unit(part_heading) + point.y() * left_of(unit(part_heading));
  }
  State plus(double h, const State& rate) const {
    return {jaw + h * rate.jaw,
            jaw_heading + h * rate.jaw_heading,
            pin + h * rate.pin,
            part + h * rate.part,
            part_heading + h * rate.part_heading,
            wheel_heading + h * rate.wheel_heading,
            s + h * rate.s,
            t + h * rate.t,
            u + h * rate.u,
            v + h * rate.v};
  }
};

/// What the robot does, as velocities: of the pin in the jaw's frame, of the jaw in the world.
struct Command {
  std::function<Vec2(double)> pin;
  std::function<Vec2(double)> jaw;
  std::function<double(double)> turn;
};

class Rig {
 public:
  Rig(const Part& part, double radius, Command command) : part_(part), r_(radius), command_(std::move(command)) {}

  /// Touching at s and t, the part's frame in the world's, the wheel's frame unturned.
  State start(double s, double t) const {
    State state;
    state.s = s;
    state.t = t;
    const double tangent = part_.turning().angle(s);
    state.jaw = part_.point(s);
    state.jaw_heading = tangent + std::acos(-1.0);  // its surface along the tangent, its body outside
    const double there = part_.turning().angle(t);
    state.pin = part_.point(t) + r_ * outward(there);
    state.v = there + std::acos(-1.0) / 2;  // from the pin inwards
    return state;
  }

  State after(State state, double from, double duration, int steps) const {
    const double h = duration / steps;
    for (int k = 0; k < steps; ++k) {
      const double time = from + h * k;
      const State one = rate(state, time);
      const State two = rate(state.plus(h / 2, one), time + h / 2);
      const State three = rate(state.plus(h / 2, two), time + h / 2);
      const State four = rate(state.plus(h, three), time + h);
      state = state.plus(h / 6, one).plus(h / 3, two).plus(h / 3, three).plus(h / 6, four);
    }
    return state;
  }

 private:
  State rate(const State& now, double time) const {
    State rate;
    rate.jaw = command_.jaw(time);
    rate.jaw_heading = command_.turn(time);
    // The pin goes along with the jaw's frame, and moves in it.
    const Vec2 moved = command_.pin(time);
    rate.pin = rate.jaw + rate.jaw_heading * left_of(now.pin - now.jaw) + moved.x() * unit(now.jaw_heading) +
               moved.y() * left_of(unit(now.jaw_heading));
    const Vec2 a = now.world(part_.point(now.s));
    const Vec2 b = now.world(part_.point(now.t));
    // Unknown: the part's velocity (its origin's) and its angular velocity, and the wheel's.
    Eigen::Matrix4d equal = Eigen::Matrix4d::Zero();
    Eigen::Vector4d velocity;
    equal.topLeftCorner<2, 2>().setIdentity();
    equal.block<2, 1>(0, 2) = left_of(a - now.part);
    velocity.head<2>() = rate.jaw + rate.jaw_heading * left_of(a - now.jaw);
    equal.bottomLeftCorner<2, 2>().setIdentity();
    equal.block<2, 1>(2, 2) = left_of(b - now.part);
    equal.block<2, 1>(2, 3) = -left_of(b - now.pin);
    velocity.tail<2>() = rate.pin;
    const Eigen::Vector4d found = equal.fullPivLu().solve(velocity);
    rate.part = found.head<2>();
    rate.part_heading = found[2];
    rate.wheel_heading = found[3];
    rate.s = (rate.jaw_heading - rate.part_heading) / part_.turning().curvature(now.s);
    rate.t = (rate.wheel_heading - rate.part_heading) / (part_.turning().curvature(now.t) + 1 / r_);
    rate.u = -rate.s;
    rate.v = -rate.t / r_;
    return rate;
  }

  const Part& part_;
  double r_;
  Command command_;
};

}  // namespace rigid_body
