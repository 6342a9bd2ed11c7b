#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "rollfix/log.hpp"
#include "rollfix/part.hpp"
#include "rollfix/reading.hpp"

namespace bench {

/// A place that a particle filter believes in: a run of particles next to each other.
struct Cloud {
  double start = 0;   // mean of their first contacts
  double weight = 0;  // of all particles' 1
};

/// What most people have today: particles, each a first contact with a scale of lengths of its own, weighed by every
/// sample's turn, drawn again where few of them carry the weight, and shaken a little then (Liu and West 2001), so that
/// they don't all become one. The heaviest cloud first.
std::vector<Cloud> filter_particles(const rollfix::Part& part, const std::vector<rollfix::Sample>& samples,
                                    const rollfix::Noise& noise, std::size_t particles, std::uint64_t seed);

}  // namespace bench
