#include "pivots.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace rollfix {
namespace {

// Lengths that come from elsewhere are rounded: this share of the perimeter.
constexpr double kGivenRounding = 1e-9;

bool same_place(const Part& part, double one, double two) {
  return part.boundary().distance(one, two) <= kGivenRounding * part.perimeter();
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

bool meets(const Interval& one, const Interval& two, double slack) {
  return one.lo <= two.hi + slack && two.lo <= one.hi + slack;
}

/// A contact that is at a corner but for rounding has the tangent of a place beside it.
double slack_of_tangents(const Part& part) {
  return kGivenRounding * (1 + part.turning().most_curvature() * part.perimeter());
}

/// Can a finger that pivots at a corner between these tangents come from the boundary before it or after it, or go
/// there? Neither asked: can it be there at all?
bool can_pivot(const PivotReach& pivot, const Interval& tangents, bool before, bool after, double slack) {
  const Interval wanted = near(tangents, pivot.whole);
  return std::any_of(pivot.angles.begin(), pivot.angles.end(), [&](const Interval& angles) {
    if (before && angles.lo > pivot.whole.lo) return false;
    if (after && angles.hi < pivot.whole.hi) return false;
    return meets(angles, wanted, slack);
  });
}

Obstruction at_pivot(const Part& part, const Reach& reach, double s) {
  return {part.boundary().base(s), false, deepest_hit(part, reach.curvature, {s, s})};
}

/// Where the finger stands still too deep, between the end of an arc and the start of the next, or the roll's end.
Obstruction beyond(const Part& part, const Reach& reach, double from, double to) {
  if (is_concave_corner(part, part.boundary().base(from)))
    return {part.boundary().base(from), true, {from, from, 0, part.point(from)}};
  const PivotReach* pivot = pivot_at(part, reach, part.boundary().base(from));
  if (pivot != nullptr && !pivot->is_whole()) return at_pivot(part, reach, from);
  double end = to;
  for (const Interval& arc : reach.arcs) {
    for (const double edge : {arc.lo, arc.hi}) {
      const double ahead = part.boundary().ahead(from, edge);
      const double signed_ahead = to >= from || !part.closed() ? ahead : ahead - part.perimeter();
      const double least = kGivenRounding * part.perimeter();
      if (to >= from && signed_ahead > least) end = std::min(end, from + signed_ahead);
      if (to < from && signed_ahead < -least) end = std::max(end, from + signed_ahead);
    }
  }
  const Interval contacts{std::min(from, end), std::max(from, end)};
  Obstruction found{0, false, deepest_hit(part, reach.curvature, contacts)};
  found.s = part.boundary().base(found.hit.contact);
  return found;
}

}  // namespace

bool can_pivot(const Part& part, const Reach& reach, const Placement& placement, std::size_t finger,
               const Interval& roll, double last) {
  if (!placement.pivot) return true;
  const Pivot& tangents = (*placement.pivot)[finger];
  const double slack = slack_of_tangents(part);
  const PivotReach* start = pivot_at(part, reach, placement.start[finger]);
  if (start != nullptr && !can_pivot(*start, tangents.start, roll.lo<0, roll.hi> 0, slack)) return false;
  const PivotReach* end = pivot_at(part, reach, placement.end[finger]);
  if (end == nullptr) return true;
  return can_pivot(*end, tangents.end, last > 0 && last >= roll.hi, last < 0 && last <= roll.lo, slack);
}

bool can_roll(const Reach& reach, const Interval& starts, const Interval& roll) {
  if (reach.whole_loop) return true;
  const double rounding = kGivenRounding * reach.perimeter;
  const auto holds = [&](const Interval& arc) {
    return reach.boundary().intersects({arc.lo - roll.lo - rounding, arc.hi - roll.hi + rounding}, starts);
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

Obstruction pivot_obstruction(const Part& part, const Reach& reach, const Placement& placement, std::size_t finger) {
  const PivotReach* start = pivot_at(part, reach, placement.start[finger]);
  const bool at_start = start != nullptr && !start->is_whole();
  return at_pivot(part, reach, at_start ? placement.start[finger] : placement.end[finger]);
}

}  // namespace rollfix
