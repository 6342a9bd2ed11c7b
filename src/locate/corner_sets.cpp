#include "corner_sets.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rollfix {
namespace {

/// The corner at base, 0 <= base <= P, or none.
const Corner* corner_at(const Part& part, double base) {
  const std::vector<Corner>& corners = part.corners();
  if (corners.empty()) return nullptr;
  const double same_place = kLengthAccuracy * part.perimeter();
  auto next = std::lower_bound(corners.begin(), corners.end(), base - same_place,
                               [](const Corner& corner, double value) { return corner.s < value; });
  if (next == corners.end() && part.closed() && part.perimeter() - base <= same_place) {
    next = corners.begin();
    base -= part.perimeter();
  }
  return next != corners.end() && std::abs(next->s - base) <= same_place ? &*next : nullptr;
}

/// The tangents at the start for which a reading fits to within `slack`.
Interval starts(const AngleSet& end, double turn, double slack) {
  return {end.angles.lo - turn - slack, end.angles.hi - turn + slack};
}

struct Fit {
  double residual = std::numeric_limits<double>::infinity();
  Interval start;  // the tangents at the start that have it
};

/// The least slack for which all the readings and the start's own set have a tangent in common: on a line, sets meet
/// when each two of them do.
Fit fit(const Interval& start, const std::vector<Interval>& wanted) {
  Fit best;
  best.residual = 0;
  for (const Interval& one : wanted) {
    best.residual = std::max({best.residual, one.lo - start.hi, start.lo - one.hi});
    for (const Interval& other : wanted) best.residual = std::max(best.residual, 0.5 * (one.lo - other.hi));
  }
  best.start = start;
  for (const Interval& one : wanted) {
    best.start.lo = std::max(best.start.lo, one.lo - best.residual);
    best.start.hi = std::min(best.start.hi, one.hi + best.residual);
  }
  if (best.start.lo > best.start.hi) best.start.lo = best.start.hi = best.start.middle();  // by rounding
  return best;
}

Fit best_fit(const Part& part, const std::vector<Reading>& readings, double s) {
  const AngleSet start = angle_set(part, s);
  // One-sided ends at a concave corner make several combinations; each is tried.
  std::vector<std::vector<Interval>> combinations(1);
  for (const Reading& reading : readings) {
    const AngleSet end = angle_set(part, s + reading.length);
    const std::vector<Interval> ends = choices(end);
    std::vector<std::vector<Interval>> longer;
    for (const std::vector<Interval>& shorter : combinations) {
      for (const Interval& one : ends) {
        longer.push_back(shorter);
        longer.back().push_back(starts({one, false, false}, reading.turn, 0));
      }
    }
    combinations = std::move(longer);
  }
  Fit best;
  for (const Interval& tangents : choices(start)) {
    for (const std::vector<Interval>& wanted : combinations) {
      const Fit one = fit(tangents, wanted);
      if (one.residual < best.residual) best = one;
    }
  }
  return best;
}

}  // namespace

std::vector<Interval> choices(const AngleSet& set) {
  if (set.concave) return {{set.angles.lo, set.angles.lo}, {set.angles.hi, set.angles.hi}};
  return {set.angles};
}

AngleSet angle_set(const Part& part, double s) {
  const TurningFunction& turning = part.turning();
  const Wrapped place = part.closed() ? wrap(s, part.perimeter()) : Wrapped{s, 0};
  const Corner* corner = corner_at(part, place.base);
  if (corner == nullptr) {
    const double angle = turning.angle(s, !part.closed() && s >= part.perimeter() ? Side::before : Side::after);
    return {{angle, angle}, false, false};
  }
  const double winding = place.winding + (place.base - corner->s > 0.5 * part.perimeter() ? 1 : 0);
  const double before = turning.angle(corner->s, Side::before) + winding * turning.period_turn();
  const double after = turning.angle(corner->s, Side::after) + winding * turning.period_turn();
  return {{std::min(before, after), std::max(before, after)}, !corner->is_concave(), corner->is_concave()};
}

double residual_at(const Part& part, const std::vector<Reading>& readings, double s) {
  return best_fit(part, readings, s).residual;
}

Pivot pivot_at(const Part& part, const std::vector<Reading>& readings, double s) {
  const Interval start = best_fit(part, readings, s).start;
  const Reading& last = readings.back();
  const AngleSet end = angle_set(part, s + last.length);
  const auto inside = [&](double angle) { return std::clamp(angle, end.angles.lo, end.angles.hi); };
  return {start, {inside(start.lo + last.turn), inside(start.hi + last.turn)}};
}

}  // namespace rollfix
