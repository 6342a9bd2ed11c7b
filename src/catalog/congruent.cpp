#include "congruent.hpp"

#include <cmath>
#include <cstddef>

#include "part/turning_range.hpp"

namespace rollfix {
namespace {

// Places that are compared, besides the corners.
constexpr int kPlaces = 512;

}  // namespace

bool are_congruent(const Part& one, double from, const Part& other, double other_from, const Likeness& likeness) {
  if (one.closed() != other.closed()) return false;
  const double P = one.perimeter();
  const double scale = other.perimeter() / P;
  if (std::abs(scale - 1) * std::max(likeness.roll, P) > likeness.length * std::max(1.0, P / likeness.roll))
    return false;
  const TurningFunction& a = one.turning();
  const TurningFunction& b = other.turning();
  if (!one.closed()) from = other_from = 0;
  const double lift = b.angle(other_from) - a.angle(from);
  const auto agree_at = [&](double x) {
    const double at = other_from + x * scale;
    const Interval near =
        angles_over(b, one.closed() ? Interval{at - likeness.length, at + likeness.length}
                                    : other.boundary().arc(at - likeness.length, at + likeness.length));
    const double angle = a.angle(from + x) + lift;
    return near.lo - likeness.turn <= angle && angle <= near.hi + likeness.turn;
  };
  for (int k = 0; k < kPlaces; ++k) {
    if (!agree_at((k + 0.5) / kPlaces * P)) return false;
  }
  return one.corners().size() == other.corners().size();
}

}  // namespace rollfix
