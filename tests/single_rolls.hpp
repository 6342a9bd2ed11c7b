#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <string>

#include "random.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/rolling.hpp"
#include "rollfix/solve.hpp"

// Noisy rolls of one disk, and whether an answer has the truth.
namespace single_rolls {

using namespace rollfix;

struct Drawn {
  Problem problem;
  double start = 0;
};

/// How a disk of 3 % of the perimeter rolls over 40 % of it.
struct Rolling {
  Noise noise{};  // lengths in perimeters
  std::size_t rows = 200;
  bool places = false;                    // with x and y
  std::function<double(double)> omega{};  // by time; none: evenly
};

inline Drawn drawn(const Part& part, const Rolling& rolling, std::uint64_t number) {
  std::mt19937_64 generator = test_generator(number);
  const double P = part.perimeter();
  RollPlan plan;
  plan.start = std::uniform_real_distribution<double>(0, P)(generator);
  plan.rows = rolling.rows;
  if (rolling.omega) {
    plan.omega = rolling.omega;
    plan.duration = 10;
  } else {
    plan.distance = 0.4 * P;
  }
  Noise noise = rolling.noise;
  for (double* length : {&noise.contact, &noise.position, &noise.correlation}) *length *= P;
  const Finger finger = disk(0.03 * P);
  NoisyRoll roll = noisy_roll(part, finger, plan, noise, generator());
  if (!rolling.places) {
    roll.log.fingers[0].x.clear();
    roll.log.fingers[0].y.clear();
  }
  return {{part, roll.log, {finger}, noise}, plan.start};
}

/// Within six standard deviations of a placement, or in its interval.
inline bool lists(const Answer& answer, double start) {
  for (const Placement& placement : answer.placements) {
    if (answer.part.boundary().contains(placement.interval[0], start)) return true;
    if (answer.part.distance(placement.mean[0], start) <= 6 * placement.sd[0]) return true;
  }
  return false;
}

}  // namespace single_rolls
