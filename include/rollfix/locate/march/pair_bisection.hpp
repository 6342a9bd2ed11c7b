#pragma once

#include <cstddef>

#include "rollfix/locate/march/correspondence.hpp"

namespace rollfix::march {

/// The pair that satisfies (9) too, between two places of a correspondence.
struct BisectedPair {
  StartsOfBoth at;
  std::size_t iterations = 0;
};

/// Section 3.2 where phi_2 and phi_4 go opposite ways, so that phi_2(s) - phi_4(t) is monotone: halves whichever of
/// [s, y] and [t, z] is longer, until both are shorter than `tolerance`. REQUIRES that (9)'s excess has different signs
/// at both ends. Each middle is reached from the lower end of what is left. Its steps are counted by `tally`.
BisectedPair bisect(const Correspondence& way, double tolerance, Tally& tally);

}  // namespace rollfix::march
