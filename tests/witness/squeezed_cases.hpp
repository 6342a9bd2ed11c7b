#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include "hold/rig_cases.hpp"

/// Rigs that squeeze a part: where the finger touches, how the part lies and by how much the wheel's normal misses the
/// finger's contact is told, and where the wheel touches is solved for.
namespace squeezed_cases {

using namespace rig_cases;

struct SqueezeErrors {
  double each_row = 0;  // of the wheel's normal, radians: each row on its own, ...
  double alike = 0;     // ... and all rows alike
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

/// The wheel follows the finger.
inline std::optional<std::vector<Held>> roll_on(const Part& part, double s, double t, double length, double radius,
                                                const SqueezeErrors& errors, std::size_t rows,
                                                std::mt19937_64& generator) {
  const double P = part.perimeter();
  const double alike = normal(generator, errors.alike);
  const double way = uniform(generator, -0.3, 0.3);
  std::vector<Held> instants;
  for (std::size_t k = 0; k <= rows; ++k) {
    const double share = static_cast<double>(k) / static_cast<double>(rows);
    Held one;
    one.s = s + share * length;
    const auto exact = root(part, one.s, radius, 0, t - 0.05 * P, t + 0.05 * P);
    if (!exact) return std::nullopt;
    t = *exact;
    const double off = alike + normal(generator, errors.each_row);
    const auto missed = root(part, one.s, radius, off, t - 0.1 * P, t + 0.1 * P);
    if (!missed) return std::nullopt;
    one.t = *missed;
    one.pose = {0.3 + share * way * P, -0.2 + share * share * 0.1 * P, 0.5 + 2 * way * share};
    instants.push_back(one);
  }
  return instants;
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

/// `squeezed`: as it is stated.
inline RigCase random_squeezed(const Part& part, double radius, bool is_disk, const SqueezeErrors& errors,
                               double squeezed, std::mt19937_64& generator) {
  const double P = part.perimeter();
  while (true) {
    const double s = uniform(generator, 0, P);
    const auto t = wheel_place(part, s, radius, generator);
    if (!t) continue;
    const auto instants = roll_on(part, s, *t, uniform(generator, 0.05, 0.15) * P, radius, errors, 40, generator);
    if (!instants || !is_free(part, instants->back().s, instants->back().t, radius)) continue;
    RigCase one{held_at(part, radius, *instants),
                s,
                instants->front().t,
                instants->back().s,
                instants->back().t,
                instants->front().pose,
                instants->back().pose};
    if (is_disk) let_disk_roll(part, 0.04 * P, *instants, one.problem);
    one.problem.squeezed = squeezed;
    return one;
  }
}

}  // namespace squeezed_cases
