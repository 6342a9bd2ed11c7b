#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "rollfix/log.hpp"
#include "rollfix/part.hpp"
#include "rollfix/reading.hpp"

namespace bench {

inline constexpr double kLogContactShare = 1e-3;  // the noise of a contact's place, as a share of the perimeter
inline constexpr double kLogAngle = 5e-3;         // of an orientation, radians
inline constexpr double kLogSlip = 5e-3;
inline constexpr std::size_t kLogRows = 200;

/// The noise of the logs.
rollfix::Noise log_noise(const rollfix::Part& part);

/// A disk that fits into the part's concavities.
double log_radius(const rollfix::Part& part);

/// A log of `kLogRows` rows over 0.1 to 0.4 perimeters from a place drawn at random, and where it really started.
struct NoisyLog {
  std::vector<rollfix::Sample> samples;
  double start = 0;
  std::uint64_t seed = 0;  // for whoever draws more of it
};
std::vector<NoisyLog> noisy_logs(const rollfix::Part& part, std::size_t count);

}  // namespace bench
