#include "rollfix/locate/reachable.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "rollfix/part/period.hpp"

namespace rollfix {
namespace {

// Lengths that come from elsewhere are rounded: this share of the perimeter.
constexpr double kGivenRounding = 1e-9;

double base_of(const Part& part, double s) {
  return part.closed() ? wrap(s, part.perimeter()).base : std::clamp(s, 0.0, part.perimeter());
}

bool same_place(const Part& part, double one, double two) {
  const double away = part.closed() ? periodic_distance(one, two, part.perimeter()) : std::abs(one - two);
  return away <= kGivenRounding * part.perimeter();
}

const PivotReach* pivot_at(const Part& part, const Reach& reach, double s) {
  for (const PivotReach& pivot : reach.pivots) {
    if (same_place(part, pivot.s, s)) return &pivot;
  }
  return nullptr;
}

bool is_concave_corner(const Part& part, double s) {
  return std::any_of(part.corners().begin(), part.corners().end(),
                     [&](const Corner& corner) { return corner.is_concave() && same_place(part, corner.s, s); });
}

/// The same tangents, turned by whole turns so that they are near those of a pivot.
Interval near(const Interval& angles, const Interval& pivot) {
  const double turn = 2 * std::numbers::pi;
  const double shift = turn * std::round((pivot.middle() - angles.middle()) / turn);
  return {angles.lo + shift, angles.hi + shift};
}

bool meets(const Interval& one, const Interval& two) {
  return one.lo <= two.hi + kGivenRounding && two.lo <= one.hi + kGivenRounding;
}

/// Can a finger that pivots at a corner between these tangents come from the boundary before it or after it, or go
/// there? Neither asked: can it be there at all?
bool can_pivot(const PivotReach& pivot, const Interval& tangents, bool before, bool after) {
  const Interval wanted = near(tangents, pivot.whole);
  return std::any_of(pivot.angles.begin(), pivot.angles.end(), [&](const Interval& angles) {
    if (before && angles.lo > pivot.whole.lo) return false;
    if (after && angles.hi < pivot.whole.hi) return false;
    return meets(angles, wanted);
  });
}

/// The pivots at both ends of a roll that starts or ends at a corner.
bool can_pivot(const Part& part, const Reach& reach, const Placement& placement, const Interval& roll, double last) {
  if (!placement.pivot) return true;
  const PivotReach* start = pivot_at(part, reach, placement.start);
  if (start != nullptr && !can_pivot(*start, placement.pivot->start, roll.lo<0, roll.hi> 0)) return false;
  const PivotReach* end = pivot_at(part, reach, placement.end);
  if (end == nullptr || last == 0) return true;
  return can_pivot(*end, placement.pivot->end, last > 0 && last >= roll.hi, last < 0 && last <= roll.lo);
}

bool is_possible(const Part& part, const Reach& reach, const Placement& placement, const Interval& roll, double last) {
  return can_roll(reach, placement.extent, roll) && can_pivot(part, reach, placement, roll, last);
}

Obstruction at_pivot(const Part& part, const Reach& reach, double s) {
  return {base_of(part, s), false, deepest_hit(part, reach.curvature, {s, s})};
}

/// Where the finger stands still too deep, between the end of an arc and the start of the next, or the roll's end.
Obstruction beyond(const Part& part, const Reach& reach, double from, double to) {
  if (is_concave_corner(part, base_of(part, from)))
    return {base_of(part, from), true, {from, from, 0, part.point(from)}};
  const PivotReach* pivot = pivot_at(part, reach, base_of(part, from));
  if (pivot != nullptr && !pivot->is_whole()) return at_pivot(part, reach, from);
  double end = to;
  for (const Interval& arc : reach.arcs) {
    for (const double edge : {arc.lo, arc.hi}) {
      const double ahead = part.closed() ? wrap(edge - from, part.perimeter()).base : edge - from;
      const double signed_ahead = to >= from || !part.closed() ? ahead : ahead - part.perimeter();
      const double least = kGivenRounding * part.perimeter();
      if (to >= from && signed_ahead > least) end = std::min(end, from + signed_ahead);
      if (to < from && signed_ahead < -least) end = std::max(end, from + signed_ahead);
    }
  }
  const Interval contacts{std::min(from, end), std::max(from, end)};
  Obstruction found{0, false, deepest_hit(part, reach.curvature, contacts)};
  found.s = base_of(part, found.hit.contact);
  return found;
}

}  // namespace

bool can_roll(const Reach& reach, const Interval& starts, const Interval& roll) {
  if (reach.whole_loop) return true;
  const double rounding = kGivenRounding * reach.perimeter;
  const auto holds = [&](const Interval& arc) {
    const Interval fitting{arc.lo - roll.lo - rounding, arc.hi - roll.hi + rounding};
    if (fitting.width() < 0) return false;
    if (!reach.closed) return fitting.lo <= starts.hi && starts.lo <= fitting.hi;
    // The first of the arc's copies that does not end before the starts.
    const double laps = std::ceil((starts.lo - fitting.hi) / reach.perimeter);
    return fitting.lo + laps * reach.perimeter <= starts.hi;
  };
  if (std::any_of(reach.arcs.begin(), reach.arcs.end(), holds)) return true;
  if (roll.width() > 2 * rounding) return false;
  // A finger that does not roll may pivot where it can't leave the corner.
  return std::any_of(reach.pivots.begin(), reach.pivots.end(), [&](const PivotReach& pivot) {
    return !pivot.angles.empty() && holds({pivot.s, pivot.s});
  });
}

std::optional<Obstruction> obstruction_of(const Part& part, const Reach& reach, double s, const Interval& roll) {
  if (can_roll(reach, {s, s}, roll)) return std::nullopt;
  const std::optional<Interval> arc = reach.arc_at(s);
  if (!arc) {
    Obstruction here = at_pivot(part, reach, s);
    if (here.hit.depth <= reach.slack) here = beyond(part, reach, s, roll.hi > 0 ? s + roll.hi : s + roll.lo);
    return here;
  }
  // The arc that goes furthest the right way: at a corner two may end.
  if (s + roll.hi > arc->hi) return beyond(part, reach, arc->hi - kGivenRounding * reach.perimeter, s + roll.hi);
  return beyond(part, reach, arc->lo + kGivenRounding * reach.perimeter, s + roll.lo);
}

std::vector<Impossible> drop_unreachable(const Part& part, const Reach& reach, const std::vector<Reading>& readings,
                                         Search& search, const std::vector<Reading>& more, double length_error) {
  Interval roll{0, 0};  // from the first contact to the furthest on both sides
  for (const std::vector<Reading>* list : {&readings, &more}) {
    for (const Reading& reading : *list) {
      roll = {std::min(roll.lo, reading.length), std::max(roll.hi, reading.length)};
    }
  }
  roll = {std::min(0.0, roll.lo + length_error), std::max(0.0, roll.hi - length_error)};
  std::vector<Impossible> dropped;
  std::vector<Placement> kept;
  for (Placement& placement : search.placements) {
    if (is_possible(part, reach, placement, roll, readings.empty() ? 0 : readings.back().length)) {
      kept.push_back(std::move(placement));
      continue;
    }
    std::optional<Obstruction> obstruction = obstruction_of(part, reach, placement.start, roll);
    if (!obstruction) {  // then it is a pivot at one of the ends
      const PivotReach* start = pivot_at(part, reach, placement.start);
      const bool at_start = start != nullptr && !start->is_whole();
      obstruction = at_pivot(part, reach, at_start ? placement.start : placement.end);
    }
    dropped.push_back({std::move(placement), *obstruction});
  }
  search.placements = std::move(kept);
  return dropped;
}

}  // namespace rollfix
