#pragma once

#include <cstddef>
#include <vector>

#include "rollfix/locate/march/mode.hpp"
#include "rollfix/locate/march/pair.hpp"
#include "rollfix/locate/march/result.hpp"

namespace rollfix::march {

/// When a limit counts as reached; lengths in the outline's unit.
struct LimitRule {
  double tolerance = 0;  // estimated distance to the limit
  double rounding = 0;   // advances below this are rounding errors
  double loosest =
      0;  // estimated distance that will do once advances are rounding errors: the reset must pass the root
  std::size_t iterations = 0;  // rounds before giving up
};

/// How an alternation ended.
struct Alternation {
  enum class End { limit, mode_end, stalled };
  End end = End::limit;
  Found found = Found::case_1;
  std::size_t iterations = 0;
  double rate = 0;   // Lemma 2's factor at the last round
  double error = 0;  // estimated distance to the limit
};

/// Section 2.1's march on a mode whose signs agree, from the pair's place to the first root of phi(s) = C or to the
/// mode's end. In concave-concave mode the mirror image: g and C with their signs changed.
/// `sequence`: where to note s_i and t_i, or null.
Alternation alternate(Pair& pair, const Mode& mode, const LimitRule& rule, std::vector<Iterate>* sequence);

}  // namespace rollfix::march
