#pragma once

#include <cmath>
#include <cstddef>
#include <string>
#include <type_traits>

#include "rollfix/outline.hpp"
#include "rollfix/rolling.hpp"

/// Small words for tests about two fingers on a part that is free to move.
namespace free_rolls {

using rollfix::FingerRows;
using rollfix::FreePlan;
using rollfix::Part;
using rollfix::Roll;
using rollfix::Vec2;

inline Part part_of(const std::string& shape) { return Part(rollfix::gallery(shape)); }

/// Finger a of radius ra rolls from s over La, b of radius rb from t over Lb, while the part turns.
inline FreePlan by_distances(double ra, double s, double La, double rb, double t, double Lb, double part_rotation = 0) {
  FreePlan plan;
  plan.fingers[0] = {{ra}, s, 0.3, La, {}};
  plan.fingers[1] = {{rb}, t, -1.1, Lb, {}};
  plan.pose = {0.4, -0.7, 2.1};
  plan.part_rotation = part_rotation;
  plan.rows = 201;
  return plan;
}

/// All three turn by their own profiles; finger b changes its direction.
inline FreePlan by_profiles(double ra, double s, double rb, double t, double duration = 1, std::size_t rows = 201) {
  FreePlan plan;
  plan.fingers[0] = {{ra}, s, 0.3, {}, [](double time) { return 4 + 2 * std::cos(3 * time); }};
  plan.fingers[1] = {{rb}, t, -1.1, {}, [](double time) { return 5 * std::cos(4 * time); }};
  plan.omega_part = [](double time) { return 0.8 - time; };
  plan.duration = duration;
  plan.pose = {0.4, -0.7, 2.1};
  plan.rows = rows;
  return plan;
}

inline Vec2 centre_at(const FingerRows& rows, std::size_t row) { return {rows.x[row], rows.y[row]}; }
inline Vec2 direction(double angle) { return {std::cos(angle), std::sin(angle)}; }

/// Where the finger's sensors say that the contact is in the world.
inline Vec2 felt_contact(const FingerRows& rows, double radius, std::size_t row) {
  return centre_at(rows, row) + radius * direction(rows.u[row] + rows.psi[row]);
}

/// Where the part's boundary is in the world.
inline Vec2 boundary_point(const Part& part, const Roll& roll, double s, std::size_t row) {
  return roll.pose[row].world(part.point(s));
}

/// The derivative of a sequence with this step, accurate to step^4 where it is smooth.
template <class Sequence>
auto rate(const Sequence& at, std::size_t row, double step) {
  using Value = std::decay_t<decltype(at(row))>;
  return Value(((at(row - 2) - at(row + 2)) + 8 * (at(row + 1) - at(row - 1))) / (12 * step));
}

}  // namespace free_rolls
