#include "congruent.hpp"

#include <algorithm>
#include <cmath>

#include "part/turning_range.hpp"

namespace rollfix {
namespace {

// Places that are compared.
constexpr int kPlaces = 512;

/// From these places on: at every place of one the other's tangent is the same not far from there.
bool agree(const Part& one, double from, const Part& other, double other_from, const Likeness& likeness) {
  const TurningFunction& a = one.turning();
  const TurningFunction& b = other.turning();
  const double P = one.perimeter();
  const double scale = other.perimeter() / P;
  const double near = likeness.length + kSameScale * P;
  const double lift = b.angle(other_from) - a.angle(from);
  for (int k = 0; k < kPlaces; ++k) {
    const double x = (k + 0.5) / kPlaces * P;
    const double at = other_from + x * scale;
    const Interval arc{at - near, at + near};
    const Interval angles = angles_over(b, one.closed() ? arc : other.boundary().arc(arc.lo, arc.hi));
    const double angle = a.angle(from + x) + lift;
    if (angle < angles.lo - likeness.turn || angle > angles.hi + likeness.turn) return false;
  }
  return true;
}

}  // namespace

bool are_congruent(const Part& one, const std::vector<double>& from, const Part& other,
                   const std::vector<double>& other_from, const Likeness& likeness) {
  if (one.closed() != other.closed() || one.corners().size() != other.corners().size()) return false;
  const double off = std::abs(other.perimeter() / one.perimeter() - 1);  // the scale
  if (off > kSameScale && off * likeness.roll > likeness.length) return false;
  if (!one.closed()) return agree(one, 0, other, 0, likeness);
  return std::any_of(from.begin(), from.end(), [&](double place) {
    return std::any_of(other_from.begin(), other_from.end(),
                       [&](double other_place) { return agree(one, place, other, other_place, likeness); });
  });
}

}  // namespace rollfix
