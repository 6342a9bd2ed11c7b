#include "rollfix/locate/march/bisection.hpp"

namespace rollfix::march {

Bisected bisect(const Pair& start, double high, double tolerance, Tally& tally) {
  Pair low{start.s.counted_by(tally), start.t.counted_by(tally), start.problem};
  const int side = side_of(low.excess());
  Bisected result{low, 0};
  while (high - low.s.length() > tolerance) {
    result.at = low;
    result.at.slide_to(low.s.length() + 0.5 * (high - low.s.length()));
    ++result.iterations;
    if (side_of(result.at.excess()) == side) {
      low = result.at;
    } else {
      high = result.at.s.length();
    }
  }
  return result;
}

}  // namespace rollfix::march
