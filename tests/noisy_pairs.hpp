#pragma once

#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "free_roll.hpp"
#include "rollfix/belief/belief.hpp"
#include "rollfix/contact/log.hpp"
#include "rollfix/part/boundary.hpp"

/// Small words for tests about two fingers' noisy logs.
namespace noisy_pairs {

using rollfix::Belief;
using rollfix::BeliefOptions;
using rollfix::Finger;
using rollfix::Mode;
using rollfix::Noise;
using rollfix::Part;
using rollfix::Reading;

/// A roll of two fingers as it was, and what noisy sensors said of it.
struct Case {
  std::array<double, 2> start{};
  std::array<rollfix::DiskFinger, 2> fingers;
  rollfix::Log log;

  std::vector<rollfix::Finger> pair() const { return {fingers[0], fingers[1]}; }
};

/// Adds to a log what its sensors are off by: each row's own contact and angle, the finger's radius, and slip.
inline void add_noise(rollfix::FingerRows& rows, double radius, const Noise& noise, std::mt19937_64& generator) {
  std::normal_distribution<double> normal(0, 1);
  // Measured is what a finger of the nominal radius would have to have rolled.
  const double scale = 1 + noise.slip * normal(generator) + noise.radius / radius * normal(generator);
  const double first = rows.u.front();
  for (std::size_t k = 0; k < rows.u.size(); ++k) {
    const double true_u = rows.u[k];
    const double measured = first + (true_u - first) * scale;
    // The normal is where it is: what the finger has slipped, its orientation shows.
    rows.psi[k] += true_u - measured;
    rows.u[k] = measured + noise.contact / radius * normal(generator);
    rows.psi[k] += noise.angle * normal(generator);
  }
}

inline Case noisy_case(const Part& part, const std::array<double, 2>& start, double La, double Lb, std::size_t rows,
                       double ra, double rb, const Noise& noise, std::mt19937_64& generator) {
  rollfix::FreePlan plan = free_rolls::by_distances(ra, start[0], La, rb, start[1], Lb, 0.4);
  plan.rows = rows;
  Case drawn{start, {{{ra}, {rb}}}, {}};
  drawn.log = rollfix::roll_free_in_closed_form(part, plan).log;
  add_noise(drawn.log.fingers[0], ra, noise, generator);
  add_noise(drawn.log.fingers[1], rb, noise, generator);
  return drawn;
}

inline Belief belief_of(const Part& part, const Case& drawn, const BeliefOptions& options) {
  rollfix::Contacts contacts;
  contacts.finger_curvature = {1 / drawn.fingers[0].radius, 1 / drawn.fingers[1].radius};
  contacts.facing = rollfix::facing(drawn.log, drawn.pair());
  Belief belief(part, rollfix::LogKind::contact, options, contacts);
  for (const Reading& row : rollfix::readings_as_given(drawn.log, drawn.pair())) belief.add(row);
  return belief;
}

/// Is s within an interval of places, around the loop?
inline bool holds(const Part& part, const rollfix::Interval& interval, double s) {
  return part.boundary().contains(interval, s);
}

}  // namespace noisy_pairs
