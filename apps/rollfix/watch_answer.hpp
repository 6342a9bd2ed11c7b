#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "rollfix/belief/belief.hpp"
#include "rollfix/contact/log_stream.hpp"

namespace rollfix::app {

// Verdicts that decide what is said; docs/belief.md has all of them.
inline constexpr const char* kUnique = "unique";
inline constexpr const char* kInconsistent = "inconsistent";

/// What is known of a roll after one of its samples.
struct WatchAnswer {
  std::size_t roll = 0;     // from 1
  std::size_t samples = 0;  // of this roll so far
  Sample sample;            // the last of them, after which the rest holds
  std::string verdict;
  std::vector<Mode> modes;  // the most probable first
  double rest = 0;          // probability outside of them
  double excess = 1;        // by how many times the samples are off more than the noise allows
  Diagnosis diagnosis;      // of a roll that is over and that nothing fits: why
};

/// Whether somebody who knows the one answer wants to hear the other: another verdict, or the most probable place is
/// not one that was known, or it is twice as certain, or its probability is another by a tenth. That two places which
/// are about as probable change ranks is no news.
bool is_news(const WatchAnswer& said, const WatchAnswer& now, const Part& part);

}  // namespace rollfix::app
