#pragma once

#include <cstddef>
#include <vector>

#include "rollfix/locate.hpp"
#include "rollfix/part.hpp"
#include "rollfix/reading.hpp"

namespace bench {

/// One finger's readings of rolls of up to a lap from places drawn at random.
std::vector<rollfix::Reading> random_readings(const rollfix::Part& part, std::size_t count);

/// So many readings of one roll over 0.9 P, of an open part over half of it.
std::vector<rollfix::Reading> readings_of_one_roll(const rollfix::Part& part, std::size_t count);

/// Two readings of two fingers that roll, and what they face.
struct PairQuestion {
  std::vector<rollfix::Reading> readings;
  double facing = 0;
};
/// Rolls of up to a lap in either direction from two places drawn at random.
std::vector<PairQuestion> random_pair_questions(const rollfix::Part& part, std::size_t count);

rollfix::Search find(const rollfix::Part& part, const PairQuestion& question);
rollfix::Search find_with_facing(const rollfix::Part& part, const PairQuestion& question);

}  // namespace bench
