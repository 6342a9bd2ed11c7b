#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include "hold/rig_cases.hpp"

/// Rigs that squeeze a part: where the finger touches, how the part lies and by how much the wheel's normal misses the
/// finger's contact is told, and where the wheel touches is solved for. At each instant finger and wheel fit.
namespace squeezed_cases {

using namespace rig_cases;

struct SqueezeErrors {
  double each_row = 0;  // of the wheel's normal, radians: each row on its own, ...
  double alike = 0;     // ... all rows alike, ...
  double turning = 0;   // ... and as much to one side in the first half of the rows, to the other one in the second
};

struct Squeeze {
  double radius = 0;  // of the wheel
  SqueezeErrors errors{};
  double stated = 0;      // of them, radians
  std::size_t rows = 40;  // behind the first one
  bool encoder = false;
  double disk_radius = 0;  // of the finger; 0: a jaw
};

/// How far the way from the finger's contact to the pin is turned from the wheel's normal, as the part sees it.
inline double miss(const Part& part, double s, double t, double radius) {
  const Vec2 normal = normal_of(part.tangent(t));
  const Vec2 way = part.point(t) + radius * normal - part.point(s);
  return rollfix::nearest_angle(std::atan2(way.y(), way.x()) - std::atan2(normal.y(), normal.x()));
}

/// The root of miss = off between these places, by halving.
inline std::optional<double> root(const Part& part, double s, double radius, double off, double lo, double hi) {
  const auto value = [&](double t) { return miss(part, s, t, radius) - off; };
  double at_lo = value(lo);
  if (at_lo * value(hi) > 0 || std::abs(at_lo) > 1 || std::abs(value(hi)) > 1) return std::nullopt;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (lo + hi);
    const double here = value(middle);
    if (here * at_lo > 0) at_lo = here;
    (here * at_lo > 0 ? lo : hi) = middle;
  }
  return 0.5 * (lo + hi);
}

/// Of all places opposite one at random.
inline std::optional<double> wheel_place(const Part& part, double s, double radius, std::mt19937_64& generator) {
  constexpr int kPlaces = 400;
  std::vector<double> found;
  for (int k = 0; k < kPlaces; ++k) {
    const double P = part.perimeter();
    const auto t = root(part, s, radius, 0, P * k / kPlaces, P * (k + 1) / kPlaces);
    if (t && part.distance(s, *t) > 0.1 * P && is_free(part, s, *t, radius)) found.push_back(*t);
  }
  if (found.empty()) return std::nullopt;
  return found[std::uniform_int_distribution<std::size_t>(0, found.size() - 1)(generator)];
}

/// The wheel follows the finger. Between rows as well both fit.
inline std::optional<std::vector<Held>> roll_on(const Part& part, double s, double t, double length,
                                                const Squeeze& squeeze, std::mt19937_64& generator) {
  const double P = part.perimeter();
  const double alike = normal(generator, squeeze.errors.alike);
  const double turning = normal(generator, squeeze.errors.turning);
  const double way = uniform(generator, -0.3, 0.3);
  std::vector<Held> instants;
  constexpr std::size_t kSteps = 40;  // at least
  const std::size_t steps_of_row = (kSteps + squeeze.rows - 1) / squeeze.rows;
  for (std::size_t k = 0; k <= squeeze.rows * steps_of_row; ++k) {
    const double share = static_cast<double>(k) / static_cast<double>(squeeze.rows * steps_of_row);
    Held one;
    one.s = s + share * length;
    const auto exact = root(part, one.s, squeeze.radius, 0, t - 0.05 * P, t + 0.05 * P);
    if (!exact) return std::nullopt;
    t = *exact;
    const double off = alike + (share < 0.5 ? turning : -turning) + normal(generator, squeeze.errors.each_row);
    const auto missed = root(part, one.s, squeeze.radius, off, t - 0.1 * P, t + 0.1 * P);
    if (!missed || !is_free(part, one.s, *missed, squeeze.radius)) return std::nullopt;
    one.t = *missed;
    one.pose = {0.3 + share * way * P, -0.2 + share * share * 0.1 * P, 0.5 + 2 * way * share};
    if (k % steps_of_row == 0) instants.push_back(one);
  }
  return instants;
}

/// How a wheel is turned that rolls: by the part's heading, by the tangent where it touches, and by the way there.
inline void turn_wheel(const Part& part, const std::vector<Held>& instants, rollfix::PassiveWheel& wheel) {
  std::vector<double>& psi = wheel.log.rows.fingers.front().psi;
  Followed tangent;
  for (const Held& one : instants) {
    psi.push_back(one.pose.heading + tangent(part.tangent(one.t)) + one.t / wheel.radius);
  }
  wheel.log.rows.fingers.front().psi_wrapped = false;
}

/// The finger's log where a disk takes the jaw's place.
inline void let_disk_roll(const Part& part, double radius, const std::vector<Held>& instants, HoldProblem& problem) {
  problem.fingers = {rollfix::disk(radius)};
  rollfix::FingerRows& rows = problem.logs.front().fingers.front();
  rows.u_period = 2 * std::numbers::pi;
  for (std::size_t k = 0; k < instants.size(); ++k) {
    const Held& one = instants[k];
    const double tangent = one.pose.heading + part.tangent(one.s);
    rows.u[k] = 0.4 - (one.s - instants.front().s) / radius;
    rows.psi[k] = tangent + std::numbers::pi / 2 - rows.u[k];
    const Vec2 centre = one.pose.world(part.point(one.s)) + radius * normal_of(tangent);
    rows.x[k] = centre.x();
    rows.y[k] = centre.y();
  }
}

inline RigCase random_squeezed(const Part& part, const Squeeze& squeeze, std::mt19937_64& generator) {
  const double P = part.perimeter();
  while (true) {
    const double s = uniform(generator, 0, P);
    const auto t = wheel_place(part, s, squeeze.radius, generator);
    if (!t) continue;
    const auto instants = roll_on(part, s, *t, uniform(generator, 0.05, 0.15) * P, squeeze, generator);
    if (!instants) continue;
    RigCase one{held_at(part, squeeze.radius, *instants),
                s,
                instants->front().t,
                instants->back().s,
                instants->back().t,
                instants->front().pose,
                instants->back().pose};
    if (squeeze.disk_radius > 0) let_disk_roll(part, squeeze.disk_radius, *instants, one.problem);
    if (squeeze.encoder) turn_wheel(part, *instants, one.problem.wheels.front());
    one.problem.squeezed = squeeze.stated;
    return one;
  }
}

}  // namespace squeezed_cases
