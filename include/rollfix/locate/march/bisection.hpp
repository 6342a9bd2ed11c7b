#pragma once

#include <cstddef>
#include <optional>

#include "rollfix/locate/march/mode.hpp"
#include "rollfix/locate/march/pair.hpp"

namespace rollfix::march {

/// A root of phi(s) = C between two places of a pair.
struct Bisected {
  Pair at;
  std::size_t iterations = 0;
};

/// Halves [s of start, high] until it is shorter than `tolerance`. REQUIRES that phi - C changes its sign once between.
/// Integrates forward from the lower end only, so that all halvings together cost about one more slide.
/// Its steps are counted by `tally`.
Bisected bisect(const Pair& start, double high, double tolerance, Tally& tally);

}  // namespace rollfix::march
