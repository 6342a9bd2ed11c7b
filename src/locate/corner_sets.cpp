#include "searches.hpp"

#include <algorithm>
#include <boost/container/small_vector.hpp>
#include <cmath>
#include <limits>
#include <utility>

#include "outline/turn.hpp"

// Notation:
//   {Theta(s)}      what the tangent can be at s: one angle, at a convex corner all in between, at a concave one either
//                   side's: AngleSet
//   w               the tangent at the start, of two fingers a's less b's
//   f_k             Theta(s + L_k) - theta_k - w, eqs. (4), (5), (8), (9); theta_k may be off by `Reading::pivot`
//   C               facing: w = C but for whole turns
// Follows eqs. (4), (5), (8) and (9) of the paper (Jia, IROS 2001); docs/search.md, "MULTIPLE SOLUTIONS".
// Idea: all readings share w, and each leaves an interval of it. On a line intervals have a point in common when each
// two of them do: the least slack with which they do is the residual (`fit`).
namespace rollfix {
namespace {

// Readings and one-sided limits are few: no allocation for them.
using Intervals = boost::container::small_vector<Interval, 4>;

/// The corner within `same_place` of base, 0 <= base <= P, or nullptr. s = 0 and s = P are one place of a closed part.
const Corner* corner_at(const Part& part, double base, double same_place) {
  const std::vector<Corner>& corners = part.corners();
  if (corners.empty()) return nullptr;
  auto next = std::lower_bound(corners.begin(), corners.end(), base - same_place,
                               [](const Corner& corner, double value) { return corner.s < value; });
  if (next == corners.end() && part.closed() && part.perimeter() - base <= same_place) {
    next = corners.begin();
    base -= part.perimeter();
  }
  return next != corners.end() && std::abs(next->s - base) <= same_place ? &*next : nullptr;
}

/// The same, and a corner to pivot at that is as near as `at_corner`.
const Corner* corner_near(const Part& part, double base, double at_corner) {
  const double same_place = kLengthAccuracy * part.perimeter();
  const Corner* corner = corner_at(part, base, same_place);
  if (corner != nullptr || !(at_corner > same_place)) return corner;
  corner = corner_at(part, base, at_corner);
  return corner != nullptr && !corner->is_concave() ? corner : nullptr;
}

/// What to try of a set, one at a time: a pivot's interval, or the one or two values at a smooth point or a concave
/// corner.
Intervals choices(const AngleSet& set) {
  if (set.concave) return {{set.angles.lo, set.angles.lo}, {set.angles.hi, set.angles.hi}};
  return {set.angles};
}

/// {Theta(s)}, of two fingers the differences {Theta(s)} - {Theta(t)}, as one interval for each choice at concave
/// corners.
Intervals tangents_at(const ContactEquations& question, const PerFinger<double>& at) {
  const auto tangents = [&](std::size_t finger) {
    return choices(angle_set(question.part, at[finger], question.at_corner));
  };
  Intervals of_a = tangents(0);
  if (at.size() == 1) return of_a;
  Intervals differences;
  for (const Interval& a : of_a) {
    for (const Interval& b : tangents(1)) differences.push_back({a.lo - b.hi, a.hi - b.lo});
  }
  return differences;
}

/// Each finger's contact at a reading: its first contact plus L, not wrapped.
PerFinger<double> ends_of(const PerFinger<double>& at, const Reading& reading) {
  PerFinger<double> ends = at;
  for (std::size_t finger = 0; finger < at.size(); ++finger) ends[finger] += reading.length[finger];
  return ends;
}

/// How far intervals are from having a tangent in common, radians.
struct CornerFit {
  double residual = std::numeric_limits<double>::infinity();
  Interval start;  // the tangents at the start that have it
};

/// The least residual r for which some w of the start's own set is within r of every wanted interval. On a line,
/// intervals meet when each two of them do. So r is the worst gap: a whole one to the start's set, which does not give
/// way, half of one between two wanted intervals, which both do.
CornerFit fit(const Interval& start, const Intervals& wanted) {
  double most_lo = -std::numeric_limits<double>::infinity();
  double least_hi = std::numeric_limits<double>::infinity();
  for (const Interval& one : wanted) {
    most_lo = std::max(most_lo, one.lo);
    least_hi = std::min(least_hi, one.hi);
  }
  CornerFit best;
  best.residual = std::max({0.0, most_lo - start.hi, start.lo - least_hi, 0.5 * (most_lo - least_hi)});
  best.start.lo = std::max(start.lo, most_lo - best.residual);
  best.start.hi = std::min(start.hi, least_hi + best.residual);
  if (best.start.lo > best.start.hi) best.start.lo = best.start.hi = best.start.middle();  // by rounding
  return best;
}

/// The least largest |f_k| over all choices of w and of one-sided ends; with w the start's tangent, f_k = Theta(s +
/// L_k) - theta_k - w, of two fingers w = Theta(s) - Theta(t).
CornerFit best_fit(const ContactEquations& question, const PerFinger<double>& at) {
  // One-sided ends at a concave corner make several combinations; each is tried.
  boost::container::small_vector<Intervals, 2> combinations(1);
  for (const Reading& reading : question.readings) {
    // f_k = 0 asks w to be in {Theta(s + L_k)} - theta_k, widened by what the reading leaves open.
    const Intervals ends = tangents_at(question, ends_of(at, reading));
    const auto add = [&](Intervals& wanted, const Interval& end) {
      wanted.push_back({end.lo - (reading.turn + reading.pivot), end.hi - (reading.turn - reading.pivot)});
    };
    if (ends.size() == 1) {
      for (Intervals& wanted : combinations) add(wanted, ends.front());
      continue;
    }
    // Every combination so far, with each of this end's choices: 2^n for n ends at concave corners.
    boost::container::small_vector<Intervals, 2> longer;
    for (const Interval& end : ends) {
      for (const Intervals& shorter : combinations) {
        longer.push_back(shorter);
        add(longer.back(), end);
      }
    }
    combinations = std::move(longer);
  }
  CornerFit best;
  const auto consider = [&](const Interval& start, const Intervals& wanted) {
    const CornerFit one = fit(start, wanted);
    if (one.residual < best.residual) best = one;
  };
  for (const Interval& start : tangents_at(question, at)) {
    for (Intervals& wanted : combinations) {
      if (!question.facing) {
        consider(start, wanted);
        continue;
      }
      // All whole turns with which the headings can agree: two pivots of nearly half a turn can at either end.
      const double first = std::floor((start.lo - *question.facing) / kFullTurn);
      const double last = std::ceil((start.hi - *question.facing) / kFullTurn);
      for (double laps = first; laps <= last; ++laps) {
        const double heading = *question.facing + laps * kFullTurn;
        wanted.push_back({heading, heading});
        consider(start, wanted);
        wanted.pop_back();
      }
    }
  }
  return best;
}

/// Can any of the contacts, first or last, be at a corner? Then residuals are those of sets. Of two fingers: on any
/// part that has corners.
bool meets_corner(const ContactEquations& question, const PerFinger<double>& at) {
  const Part& part = question.part;
  if (part.corners().empty()) return false;
  if (at.size() == 2) return true;  // on arcs the best of equal residuals is picked by their last bits: by the sets'
  const auto is_at_corner = [&](double s) {
    return corner_near(part, part.boundary().reduced(s).base, question.at_corner) != nullptr;
  };
  if (is_at_corner(at[0])) return true;
  for (const Reading& reading : question.readings) {
    if (is_at_corner(at[0] + reading.length[0])) return true;
  }
  return false;
}

/// Of one finger, where there are no corners: in the order of the sets above, so that a part with corners far away has
/// the same bits.
double smooth_residual(const ContactEquations& question, double at) {
  const Tangents tangents = tangents_of(question, 0, at);
  double largest = 0;
  for (std::size_t k = 0; k < question.readings.size(); ++k) {  // eqs. (4), (5)
    const Reading& reading = question.readings[k];
    largest = std::max(largest, std::abs(tangents[k + 1] - reading.turn - tangents[0]) - reading.pivot);
  }
  return largest;
}

}  // namespace

AngleSet angle_set(const Part& part, double s, double at_corner) {
  const TurningFunction& turning = part.turning();
  const Wrapped place = part.boundary().reduced(s);
  const Corner* corner = corner_near(part, place.base, at_corner);
  if (corner == nullptr) {
    const double angle = turning.angle(s, !part.closed() && s >= part.perimeter() ? Side::before : Side::after);
    return {{angle, angle}, false, false};
  }
  // A place just before s = P belongs to a corner at s = 0 of the next lap.
  const double winding = place.winding + (place.base - corner->s > 0.5 * part.perimeter() ? 1 : 0);
  const double before = turning.angle(corner->s, Side::before) + winding * turning.period_turn();
  const double after = turning.angle(corner->s, Side::after) + winding * turning.period_turn();
  return {{std::min(before, after), std::max(before, after)}, !corner->is_concave(), corner->is_concave()};
}

double residual_at(const ContactEquations& question, const PerFinger<double>& at) {
  if (meets_corner(question, at)) return best_fit(question, at).residual;
  if (at.size() == 1) return smooth_residual(question, at[0]);
  return residual_of(question, tangents_of(question, 0, at[0]), tangents_of(question, 1, at[1]));
}

Tangents tangents_of(const ContactEquations& question, std::size_t finger, double at) {
  const TurningFunction& turning = question.part.turning();
  Tangents tangents{turning.angle(at)};
  for (const Reading& reading : question.readings) tangents.push_back(turning.angle(at + reading.length[finger]));
  return tangents;
}

double residual_of(const ContactEquations& question, const Tangents& of_a, const Tangents& of_b) {
  // w = Theta(s) - Theta(t); the facing is known up to whole turns.
  const double start = of_a[0] - of_b[0];
  double largest = question.facing ? std::abs(std::remainder(start - *question.facing, kFullTurn)) : 0;
  for (std::size_t k = 0; k < question.readings.size(); ++k) {  // eqs. (8), (9)
    const double end = of_a[k + 1] - of_b[k + 1];
    const Reading& reading = question.readings[k];
    largest = std::max(largest, std::abs(end - start - reading.turn) - reading.pivot);
  }
  return largest;
}

PerFinger<Pivot> pivots_at(const ContactEquations& question, const PerFinger<double>& at,
                           const PerFinger<double>& end) {
  const Reading& last = question.readings.back();
  // Theta at an end is unwrapped, so the place must be of the lap that the roll has reached.
  PerFinger<double> ends = ends_of(at, last);
  PerFinger<Pivot> pivots = PerFinger<Pivot>::of(at.size());
  for (std::size_t finger = 0; finger < at.size(); ++finger) {
    ends[finger] += question.part.boundary().offset(ends[finger], end[finger]);  // `end`, of as many laps
    pivots[finger] = {angle_set(question.part, at[finger]).angles, angle_set(question.part, ends[finger]).angles};
  }
  if (at.size() == 2) return pivots;
  // One finger's start and end tell of each other.
  const Interval start = best_fit(question, at).start;
  const Interval tangents = pivots[0].end;
  // Theta at the end = w + theta, the reading's interval included, as far as the end's own set goes.
  const auto inside = [&](double angle) { return std::clamp(angle, tangents.lo, tangents.hi); };
  return Pivot{start, {inside(start.lo + (last.turn - last.pivot)), inside(start.hi + (last.turn + last.pivot))}};
}

}  // namespace rollfix
