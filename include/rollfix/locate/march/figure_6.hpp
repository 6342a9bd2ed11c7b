#pragma once

#include <cstddef>

#include "rollfix/locate/march/alternation.hpp"
#include "rollfix/locate/march/correspondence.hpp"

namespace rollfix::march {

/// How an iteration of Figure 6 ended.
struct Figure6 {
  enum class End { limit, exit, stalled };
  End end = End::limit;
  std::size_t iterations = 0;
  double rate = 0;   // by which the distance shrank in the last round
  double error = 0;  // estimated distance to the limit, of s and of t
};

/// Section 3.2 where phi_2 and phi_4 go the same way: from the pair's place to the first pair that satisfies (9) too,
/// or to the end of the correspondence. Neither s nor t ever passes it. REQUIRES trend_2 == trend_4.
Figure6 iterate(StartsOfBoth& at, const Correspondence& way, const LimitRule& rule);

/// Which of both starts has to go forward to meet (9): s where phi_2(s) lags behind phi_4(t) + theta_2, seen in the
/// direction in which both go, else t.
inline bool s_moves_first(const StartsOfBoth& at, const Correspondence& way) { return way.trend_2 * at.excess(1) < 0; }

}  // namespace rollfix::march
