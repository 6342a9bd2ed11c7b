#pragma once

#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "free_roll.hpp"
#include "rollfix/belief.hpp"
#include "rollfix/log.hpp"
#include "rollfix/turning_function.hpp"

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
  drawn.log = rollfix::roll_free(part, plan).log;
  add_noise(drawn.log.fingers[0], ra, noise, generator);
  add_noise(drawn.log.fingers[1], rb, noise, generator);
  return drawn;
}

inline Belief belief_of(const Part& part, const Case& drawn, const BeliefOptions& options) {
  rollfix::FingerGeometry contacts;
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

inline BeliefOptions options_with(double contact, double angle, double slip) {
  BeliefOptions options;
  options.noise = {contact, angle, slip, 0};
  return options;
}

/// A roll of random length from a random place, by fingers that are small against the part.
inline Case random_pair(const Part& part, std::size_t rows, const Noise& noise, std::mt19937_64& generator) {
  std::uniform_real_distribution<double> unit(0, 1);
  const double P = part.perimeter();
  const auto roll = [&] { return (0.15 + 0.5 * unit(generator)) * P * (unit(generator) < 0.5 ? -1 : 1); };
  const std::array<double, 2> start{unit(generator) * P, unit(generator) * P};
  const double La = roll();
  const double Lb = roll();
  return noisy_case(part, start, La, Lb, rows, 0.03 * P, 0.024 * P, noise, generator);
}

/// The modes whose region holds a pair.
inline std::vector<std::size_t> modes_at(const Part& part, const std::vector<Mode>& modes,
                                         const std::array<double, 2>& at) {
  std::vector<std::size_t> found;
  for (std::size_t k = 0; k < modes.size(); ++k) {
    if (holds(part, modes[k].region[0], at[0]) && holds(part, modes[k].region[1], at[1])) found.push_back(k);
  }
  return found;
}

/// How often what a posterior claims comes true.
struct Calibration {
  int cases = 0;
  int held = 0;    // intervals that hold the truth; two for each case
  int listed = 0;  // cases whose truth is in a mode
  int top = 0;     // in the first
  double claimed = 0;
  double variance = 0;  // of how often the first is right, if it claims rightly

  void add(const Part& part, const Case& drawn, Belief belief) {
    const std::vector<Mode>& modes = belief.modes();
    const std::vector<std::size_t> at = modes_at(part, modes, drawn.start);
    ++cases;
    if (modes.empty()) return;
    claimed += modes.front().probability;
    variance += modes.front().probability * (1 - modes.front().probability);
    if (at.empty()) return;
    ++listed;
    top += at.front() == 0 ? 1 : 0;
    for (const std::size_t finger : {0U, 1U}) {
      held += holds(part, modes[at.front()].interval[finger], drawn.start[finger]) ? 1 : 0;
    }
  }
};

}  // namespace noisy_pairs
