#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "random.hpp"
#include "rollfix/belief.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/rolling.hpp"
#include "rollfix/turning_function.hpp"

/// Noisy rolls of a disk, and what they make believe.
namespace belief_cases {

using rollfix::Belief;
using rollfix::BeliefOptions;
using rollfix::DiskFinger;
using rollfix::Mode;
using rollfix::Noise;
using rollfix::NoisyRoll;
using rollfix::Part;
using rollfix::RollPlan;

inline Part part_of(const std::string& shape) { return Part(rollfix::load_outline("gallery:" + shape)); }

/// Noise by the part's size.
inline Noise noise_on(const Part& part, double contact_share, double angle, double slip) {
  return {contact_share * part.perimeter(), angle, slip, 0};
}

inline NoisyRoll roll_on(const Part& part, double radius, double start, double length, std::size_t rows,
                         const Noise& noise, std::uint64_t seed) {
  RollPlan plan;
  plan.start = start;
  plan.distance = length;
  plan.rows = rows;
  return rollfix::noisy_roll(part, DiskFinger{radius}, plan, noise, seed);
}

/// Lets a finger slip here and there as well, as docs/belief.md takes it: five times the share, on its own over each
/// hundredth of the perimeter. What slips leaves the normal where it is.
inline void slip_here_and_there(NoisyRoll& roll, const Part& part, double radius, double slip,
                                std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  double slipped = 0;
  for (std::size_t row = 1; row < roll.log.rows(); ++row) {
    const double length = std::abs(roll.truth.s[0][row] - roll.truth.s[0][row - 1]);
    slipped += 5 * slip * std::sqrt(0.01 * part.perimeter() * length) * normal(random);
    roll.log.fingers[0].u[row] += slipped / radius;
    roll.log.fingers[0].psi[row] -= slipped / radius;
  }
}

/// Gives all rows of a log to a belief.
inline void tell(Belief& belief, const rollfix::Log& log, double radius) {
  for (const rollfix::Reading& reading : rollfix::readings_as_given(log, {DiskFinger{radius}})) {
    rollfix::Sample sample;
    sample.reading = reading;
    sample.finger_curvature = 1 / radius;
    belief.add(sample);
  }
}

inline Belief belief_in(const Part& part, const rollfix::Log& log, double radius, const BeliefOptions& options) {
  Belief belief(part, rollfix::LogKind::contact, options);
  tell(belief, log, radius);
  return belief;
}

inline bool holds(const rollfix::Interval& interval, double s, const Part& part) {
  return part.boundary().contains(interval, s);
}

inline double distance(const Part& part, double a, double b) { return part.boundary().distance(a, b); }

/// The mode whose region holds the place; nullptr where none does.
inline const Mode* mode_at(const std::vector<Mode>& modes, double s, const Part& part) {
  for (const Mode& mode : modes) {
    if (holds(mode.region[0], s, part)) return &mode;
  }
  return nullptr;
}

/// A robot that rolls to and fro, without losing contact: one log with errors of its own.
class Robot {
 public:
  Robot(const Part& part, double radius, double start, const Noise& noise, std::uint64_t seed)
      : part_(part), radius_(radius), start_(start), noise_(noise), random_(seed), scale_(1 + noise.slip * normal()) {}

  /// Rolls on by this length and tells the belief.
  void roll(double length, Belief& belief) {
    RollPlan plan;
    plan.start = part_.boundary().on_first_lap(start_ + length_);
    plan.distance = length;
    plan.rows = 120;
    const rollfix::Roll roll = rollfix::roll(part_, DiskFinger{radius_}, plan);
    for (std::size_t row = 0; row < roll.s[0].size(); ++row) {
      tell_row(length_ + roll.s[0][row] - roll.s[0][0], turn_ + roll.angle[0][row] - roll.angle[0][0], belief);
    }
    length_ += roll.s[0].back() - roll.s[0].front();
    turn_ += roll.angle[0].back() - roll.angle[0].front();
  }

 private:
  double normal() { return std::normal_distribution<double>()(random_); }

  void tell_row(double length, double turn, Belief& belief) {
    const double u_true = -length / scale_ / radius_;
    const rollfix::Contact now{u_true + noise_.contact * normal() / radius_, turn - u_true + noise_.angle * normal()};
    if (!first_) first_ = now;
    rollfix::Sample sample;
    sample.reading = rollfix::reading_between(DiskFinger{radius_}, *first_, now);
    sample.finger_curvature = 1 / radius_;
    belief.add(sample);
  }

  const Part& part_;
  double radius_;
  double start_;
  Noise noise_;
  std::mt19937_64 random_;
  double scale_;
  double length_ = 0;
  double turn_ = 0;
  std::optional<rollfix::Contact> first_;
};

/// What many cases add up to.
struct Tally {
  int cases = 0;
  int listed = 0;      // the true place is in a mode's region
  int inside = 0;      // ... and in its 95 % interval
  int first = 0;       // ... and that mode is the most probable
  double claimed = 0;  // sum of the most probable modes' probabilities
  double claimed_variance = 0;

  void add(const std::vector<Mode>& modes, double truth, const Part& part) {
    ++cases;
    const Mode* mode = mode_at(modes, truth, part);
    if (!modes.empty()) {
      claimed += modes.front().probability;
      claimed_variance += modes.front().probability * (1 - modes.front().probability);
    }
    if (mode == nullptr) return;
    ++listed;
    inside += holds(mode->interval[0], truth, part) ? 1 : 0;
    first += mode == &modes.front() ? 1 : 0;
  }
  double share_inside() const { return static_cast<double>(inside) / cases; }
};

/// Random rolls on a part, forward and back, each with its own errors.
inline Tally tally(const Part& part, double radius, double length_share, const Noise& noise, int count,
                   std::uint64_t stream) {
  std::mt19937_64 random = test_generator(stream);
  std::uniform_real_distribution<double> unit;
  Tally result;
  BeliefOptions options;
  options.noise = noise;
  for (int k = 0; k < count; ++k) {
    const double start = unit(random) * part.perimeter();
    const double length = (unit(random) < 0.5 ? -1 : 1) * length_share * part.perimeter() * (0.5 + unit(random));
    NoisyRoll roll = roll_on(part, radius, start, length, 100, noise, random());
    slip_here_and_there(roll, part, radius, noise.slip, random);
    Belief belief = belief_in(part, roll.log, radius, options);
    result.add(belief.modes(), start, part);
  }
  return result;
}

inline BeliefOptions with(const Noise& noise) {
  BeliefOptions options;
  options.noise = noise;
  return options;
}

inline rollfix::Sample sample_of(const rollfix::Reading& reading, double finger_curvature = 0) {
  rollfix::Sample sample;
  sample.reading = reading;
  sample.finger_curvature = finger_curvature;
  return sample;
}

}  // namespace belief_cases
