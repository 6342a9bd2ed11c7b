#include "rollfix/locate/march/pair_bisection.hpp"

#include <cmath>

#include "rollfix/locate/march/pair.hpp"

namespace rollfix::march {

namespace {

/// What is left of a start's way: it can only shrink, so that rounding errors of the other start, which are large near
/// its stationary points, can't keep the halving going for ever.
struct Left {
  double low = 0;
  double high = 0;
  int direction = 1;

  Left(double from, double to) : low(from), high(to), direction(to < from ? -1 : 1) {}

  double width() const { return std::fmax(0.0, direction * (high - low)); }
  double middle() const { return low + 0.5 * (high - low); }
  void lower(double place) { low = place; }
  void upper(double place) {
    if (direction * (place - high) < 0) high = place;
  }
};

}  // namespace

BisectedPair bisect(const Correspondence& way, double tolerance, Tally& tally) {
  StartsOfBoth low = way.begin.counted_by(tally);
  const int side = side_of(low.excess(1));
  Left s(way.x(), way.y());
  Left t(way.w(), way.z());
  BisectedPair result{low, 0};
  while (s.width() > tolerance || t.width() > tolerance) {
    result.at = low;
    ++result.iterations;
    if (s.width() >= t.width()) {
      way.move_s_to(result.at, s.middle());
    } else {
      way.move_t_to(result.at, t.middle());
    }
    if (side_of(result.at.excess(1)) == side) {
      low = result.at;
      s.lower(low.a.s());
      t.lower(low.b.s());
    } else {
      s.upper(result.at.a.s());
      t.upper(result.at.b.s());
    }
  }
  return result;
}

}  // namespace rollfix::march
