#include "plan/stability.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rollfix {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

void include(Interval& range, double value) {
  range.lo = std::min(range.lo, value);
  range.hi = std::max(range.hi, value);
}

/// What the curvature is between two places, ends and both sides of joints included; infinite above where there is a
/// convex corner. On a spiral it is monotone, so that its values at the ends are all that is needed.
Interval curvatures_between(const Part& part, double one, double other) {
  const double rounding = kLengthAccuracy * part.perimeter();
  const double lo = std::min(one, other) - rounding;
  const double hi = std::max(one, other) + rounding;
  const double P = part.perimeter();
  const double first_lap = part.closed() ? std::floor(lo / P) : 0;
  const double last_lap = part.closed() ? std::floor(hi / P) : 0;
  Interval range{kInfinite, -kInfinite};
  for (double lap = first_lap; lap <= last_lap; ++lap) {
    for (const Spiral& spiral : part.turning().spirals()) {
      const double from = std::max(lo - lap * P, spiral.lo);
      const double to = std::min(hi - lap * P, spiral.hi);
      if (from > to) continue;
      include(range, part.turning().on_spiral(spiral, from).curvature);
      include(range, part.turning().on_spiral(spiral, to).curvature);
    }
    for (const Corner& corner : part.corners()) {
      const double at = corner.s + lap * P;
      if (corner.turn >= kJointTurn && lo <= at && at <= hi) range.hi = kInfinite;
    }
  }
  return range;
}

Interval finger_curvatures(const ContactWay& way, const ContactPlace& one, const ContactPlace& two) {
  const Part* const outline = way.finger().outline();
  if (outline != nullptr) return curvatures_between(*outline, one.contact.u, two.contact.u);
  const double curvature = way.finger_curvature(one);
  return {curvature, curvature};
}

double share_of(double bend, double distance, double radius) { return 1 / (1 + bend * (distance + radius)); }

/// The least b: it falls with kappa.
double least_bent(double kappa, const Interval& distance, double radius) {
  if (std::isinf(kappa)) return -distance.hi / radius;
  return (1 - kappa * (kappa > 0 ? distance.hi : distance.lo)) / (1 + radius * kappa);
}

}  // namespace

double stability_of(const ContactWay& way_a, const ContactWay& way_b, const PairPlace& place) {
  return stability_between(way_a, way_b, place, place);
}

double stability_between(const ContactWay& way_a, const ContactWay& way_b, const PairPlace& one, const PairPlace& two) {
  const double r = way_b.finger().disk()->radius;
  const auto distance_of = [](const PairPlace& place) { return (place.b.point - place.a.point).norm(); };
  const double moved = std::abs(two.a.s - one.a.s) + std::abs(two.b.s - one.b.s);
  const Interval distance{std::max({distance_of(one), distance_of(two)}) - moved,
                          std::min({distance_of(one), distance_of(two)}) + moved};
  if (distance.lo <= 0) return -kInfinite;
  const auto across_of = [](const PairPlace& place) { return std::abs(std::cos(place.b.angle - place.a.angle)); };
  const double across =
      std::max(across_of(one), across_of(two)) - turn_between(one.a, two.a) - turn_between(one.b, two.b);
  const Interval kappa_s = curvatures_between(way_a.part(), one.a.s, two.a.s);
  const Interval of_a = finger_curvatures(way_a, one.a, two.a);
  const double kappa_t = curvatures_between(way_b.part(), one.b.s, two.b.s).hi;
  const double bent = least_bent(kappa_t, distance, r);
  double least = kInfinite;
  for (const double share : {share_of(kappa_s.hi + of_a.hi, distance.hi, r),
                             share_of(std::max(0.0, kappa_s.lo + of_a.lo), distance.lo, r)}) {
    least = std::min(least, share * across + (1 - share) * bent);
  }
  return least;
}

}  // namespace rollfix
