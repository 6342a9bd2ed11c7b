#pragma once

#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>

#include "rollfix/outline.hpp"
#include "rollfix/rolling.hpp"

/// Small words for tests about a jaw and a wheel.
namespace rigs {

using rollfix::Part;
using rollfix::Pose;
using rollfix::RigPlan;
using rollfix::Roll;
using rollfix::Vec2;

inline Part part_of(const std::string& shape) { return Part(rollfix::gallery(shape)); }

/// The pin moves evenly by this in the jaw's frame while the jaw stays.
inline RigPlan evenly(double radius, double s, double t, const Vec2& moved, std::size_t rows = 51) {
  RigPlan plan;
  plan.radius = radius;
  plan.start = {s, t};
  plan.pin = [moved](double time) { return Vec2(time * moved); };
  plan.rows = rows;
  return plan;
}

inline RigPlan squeezed(double radius, double s, double t, double moved, std::size_t rows = 51) {
  RigPlan plan = evenly(radius, s, t, {moved, 0}, rows);
  plan.squeezed = true;
  return plan;
}

inline Vec2 along(double angle) { return {std::cos(angle), std::sin(angle)}; }

/// Where the robot has the wheel's pin as seen from the jaw.
inline Vec2 pin_in_jaw(const Roll& roll, std::size_t row) {
  const rollfix::FingerRows& jaw = roll.log.fingers[0];
  const rollfix::FingerRows& wheel = roll.log.fingers[1];
  const Vec2 away(wheel.x[row] - jaw.x[row], wheel.y[row] - jaw.y[row]);
  return {away.dot(along(jaw.psi[row])), away.dot(along(jaw.psi[row] + std::numbers::pi / 2))};
}

/// How far a row is from two contacts as they have to be: points that should be one, and normals that should be
/// opposite (times the part's size), from what the log says and where the part is.
inline double gap_in(const Part& part, const Roll& roll, double radius, std::size_t row) {
  const rollfix::FingerRows& jaw = roll.log.fingers[0];
  const rollfix::FingerRows& wheel = roll.log.fingers[1];
  const Pose& pose = roll.pose[row];
  const Vec2 on_jaw = Vec2(jaw.x[row], jaw.y[row]) + jaw.u[row] * along(jaw.psi[row]);
  const Vec2 on_wheel = Vec2(wheel.x[row], wheel.y[row]) + radius * along(wheel.u[row] + wheel.psi[row]);
  const Vec2 tangent_a = along(roll.angle[0][row] + pose.heading);
  const Vec2 tangent_b = along(roll.angle[1][row] + pose.heading);
  return std::max({(on_jaw - pose.world(part.point(roll.s[0][row]))).norm(),
                   (on_wheel - pose.world(part.point(roll.s[1][row]))).norm(),
                   part.perimeter() * (tangent_a + along(jaw.psi[row])).norm(),
                   part.perimeter() * std::abs(tangent_b.dot(along(wheel.u[row] + wheel.psi[row])))});
}

}  // namespace rigs
