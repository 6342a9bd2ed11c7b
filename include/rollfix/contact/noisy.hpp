#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "rollfix/contact/finger.hpp"
#include "rollfix/contact/free_part.hpp"
#include "rollfix/contact/noise.hpp"
#include "rollfix/contact/pair_log.hpp"
#include "rollfix/contact/rolling.hpp"

namespace rollfix {

/// What was drawn once for a whole roll of one finger.
struct RollError {
  double slip = 0;    // e: the contact travelled (1 + e) times as far on the part as the finger was rolled off
  double radius = 0;  // the disk's true radius less the one that the log's reader takes
};

/// A roll whose sensors are noisy, and how it really was. Everything follows from the seed, the same on all platforms
/// up to the rounding of their logarithm:
///  * slip: one normal e per roll with this standard deviation;
///  * radius: a disk's true radius is r + N(0, radius), one per roll, and the log's reader takes r;
///  * contact: in each row u is off by N(0, contact) along the finger, of a disk by that over r;
///  * angle: in each row psi is off by N(0, angle).
/// The finger's centre in the world is without error.
struct NoisyRoll {
  Log log;
  Roll truth;
  RollError error;
};

/// Throws InputError as roll_in_closed_form does, and: a standard deviation that is not a number of at least 0, that of
/// the radius of a finger that has none, or one so large that the radius came out below 0 or the slip below -1.
NoisyRoll noisy_roll(const Part& part, const Finger& finger, const RollPlan& plan, const Noise& noise,
                     std::uint64_t seed);

/// The same of two fingers, each with errors of its own.
struct NoisyFreeRoll {
  PairLog log;
  FreeRoll truth;
  std::array<RollError, 2> error;
};
NoisyFreeRoll noisy_roll_free(const Part& part, const FreePlan& plan, const Noise& noise, std::uint64_t seed);

/// A log of increments, as a wheel encoder and a gyroscope give them, and how it really was.
struct NoisyIncrements {
  Log log;                // summed up, as read_log does
  std::vector<double> s;  // where the contact really is, of each row; the first contact is before them
  RollError error;
};

/// From s = start over this length along the stored outline, in so many equal steps of the true length. Each distance
/// is off by N(0, contact), each dturn by N(0, angle); slip as above. Throws InputError likewise, and: no row, a length
/// that is not finite, a way off the ends of an open part.
NoisyIncrements noisy_increments(const Part& part, double start, double length, std::size_t rows, const Noise& noise,
                                 std::uint64_t seed);

}  // namespace rollfix
