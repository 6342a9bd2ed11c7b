#include "pair_bounds.hpp"

#include <algorithm>
#include <cmath>

#include "part/cursor.hpp"
#include "places.hpp"

// Notation:
//   s, L_c          first contact, and how far from it contact c is (L_0 = 0): `lengths_`
//   Theta_c(s)      Theta(s + L_c), from end to end of a stretch `from`, `to`, between them `angle`
//   kappa_c         its rate: `rate`, bounds on all of the stretch
//   w               weights of the contacts; w . Theta leaves its chord by no more than width |w . kappa| / 4, |.|
//                   being the width of the bounds: `chord`, `sum`
//   pivot           a stretch at one place: each contact at a convex corner takes any angle of its range, on its own
// Follows docs/certificates.md, "Two fingers", "How it is checked"; rollfix-verify's finger_curve.cpp does the same in
// balls.
// Idea: cut the first contacts where any contact comes to a corner; between cuts one chord and one bound serve each
// sum.
namespace rollfix::certifying {
namespace {

// A curvature that jumps by this many radians over the perimeter ends a stretch that is nearly an arc.
constexpr double kBend = 1e-6;

}  // namespace

/// Of several contacts that pivot at once the one with the widest range is taken as the unknown.
std::size_t ContactStretch::widest() const {
  const auto found = std::max_element(angle.begin(), angle.end(),
                                      [](const Range& one, const Range& two) { return one.spread() < two.spread(); });
  return static_cast<std::size_t>(found - angle.begin());
}

/// Radians, with sign; of a pivot 0 for all contacts but the widest.
double ContactStretch::turn(std::size_t contact) const {
  if (!pivot) return to[contact] - from[contact];
  return contact == widest() ? angle[contact].spread() : 0;
}

/// Of a stretch the chord's ends and what the sum may leave it by; of a pivot plain interval arithmetic, for contacts
/// pivot independently.
Range ContactStretch::sum(const std::vector<double>& weights) const {
  if (!pivot) {
    const Chord way = chord(weights);
    return {std::min(way.from, way.to) - way.off, std::max(way.from, way.to) + way.off};
  }
  Range all{0, 0};
  for (std::size_t c = 0; c < weights.size(); ++c) all = all + weights[c] * angle[c];
  return all;
}

/// Each angle is on one side of its chord, or changes sides, by a quarter of what its slope changes by times the width.
/// Of a pivot the contact that turns most goes from its least angle to its largest, the others leave theirs open.
ContactStretch::Chord ContactStretch::chord(const std::vector<double>& weights) const {
  Chord way;
  Range slope{0, 0};
  const std::size_t turning = pivot ? widest() : 0;
  for (std::size_t c = 0; c < weights.size(); ++c) {
    if (!pivot) {
      way.from += weights[c] * from[c];
      way.to += weights[c] * to[c];
      // Bounds on the sum's slope: contacts with opposite weights cancel, which bounds on each angle alone would lose.
      slope = slope + weights[c] * rate[c];
    } else if (c == turning) {
      way.from += weights[c] * angle[c].least;
      way.to += weights[c] * angle[c].most;
    } else {
      way.from += weights[c] * angle[c].middle();
      way.to += weights[c] * angle[c].middle();
      // An open angle is its middle and, to be safe, its whole spread.
      way.off += std::abs(weights[c]) * angle[c].spread();
    }
  }
  if (!pivot) way.off = 0.25 * width() * slope.spread();
  return way;
}

/// Lists the joints at which the curvature jumps, once.
ContactCurve::ContactCurve(const Part& part, std::vector<double> lengths) : part_(part), lengths_(std::move(lengths)) {
  const TurningFunction& turning = part_.turning();
  Cursor cursor(turning, 0);
  // The cursor passes each joint; on a closed outline also the one at s = 0.
  const std::size_t joints = turning.spirals().size() - (part_.closed() ? 0 : 1);
  for (std::size_t k = 0; k < joints; ++k) {
    const double s = cursor.hi();
    const double before = cursor.spiral().end.curvature;
    cursor.advance();
    // Radians per length on both sides of the joint; compared over the whole perimeter, without a unit.
    const double jump = std::abs(cursor.spiral().start.curvature - before);
    if (jump * part_.perimeter() > kBend) bends_.push_back(s);
  }
}

std::vector<double> ContactCurve::angles(double s, Side side) const {
  std::vector<double> result;
  for (const double length : lengths_) result.push_back(part_.turning().angle(s + length, side));
  return result;
}

/// All first contacts between lo and hi, both excluded, at which some contact is at a corner (with `bends`, also at a
/// jump of curvature), by rising s. One corner may come several times, for each contact and each lap.
std::vector<ContactCurve::Event> ContactCurve::events(double lo, double hi, Cuts cuts) const {
  std::vector<Event> result;
  const auto add = [&](std::size_t contact, double place, const Event& event) {
    double s = place - lengths_[contact];
    // The event's first lap from lo on.
    if (part_.closed()) s = lo + wrap(s - lo, part_.perimeter()).base;
    for (; s < hi; s += part_.perimeter()) {
      if (s > lo) result.push_back({s, contact, event.turn, event.concave, event.is_corner});
      if (!part_.closed()) break;
    }
  };
  for (std::size_t c = 0; c < lengths_.size(); ++c) {
    for (const Corner& corner : part_.corners()) add(c, corner.s, {0, 0, corner.turn, corner.is_concave(), true});
    if (cuts == Cuts::corners) continue;
    for (const double s : bends_) add(c, s, {});
  }
  std::sort(result.begin(), result.end(), [](const Event& one, const Event& two) { return one.s < two.s; });
  return result;
}

/// Bounds on kappa between two places: on a spiral it is monotone, so that the values at the spirals' ends bound it.
Range ContactCurve::curvatures(double lo, double hi) const {
  const TurningFunction& turning = part_.turning();
  Range all{turning.curvature(lo), turning.curvature(lo)};
  const auto add = [&](double curvature) { all = hull(std::min(all.least, curvature), std::max(all.most, curvature)); };
  // The value before hi, if a joint lies there.
  add(turning.curvature(hi, Side::before));
  Cursor cursor(turning, lo);
  while (!cursor.is_last() && cursor.hi() < hi) {
    add(cursor.spiral().end.curvature);
    cursor.advance();
    add(cursor.spiral().start.curvature);
  }
  return all;
}

/// A stretch on which no contact is at a corner. The ends are taken from inside: after lo, before hi.
ContactStretch ContactCurve::smooth(double lo, double hi) const {
  ContactStretch result;
  result.lo = lo;
  result.hi = hi;
  result.from = angles(lo, Side::after);
  result.to = angles(hi, Side::before);
  for (std::size_t c = 0; c < lengths_.size(); ++c) {
    result.angle.push_back(hull(result.from[c], result.to[c]));
    result.rate.push_back(curvatures(lo + lengths_[c], hi + lengths_[c]));
  }
  return result;
}

/// The stretches at a cluster of corners that are too near each other to be told apart. A convex corner gives a contact
/// all angles in between; a concave one the angle before or after. So a contact has one range more than it passes
/// concave corners, and each choice of ranges for all contacts is a stretch.
std::vector<ContactStretch> ContactCurve::at_corner(double lo, double hi, const std::vector<Event>& events) const {
  // One place, `lo` to `hi` some steps apart; angles are added contact by contact.
  ContactStretch empty;
  empty.lo = lo;
  empty.hi = hi;
  empty.pivot = true;
  std::vector<ContactStretch> result = {empty};
  const std::vector<double> first = angles(lo, Side::after);
  const std::vector<double> last = angles(hi, Side::after);
  for (std::size_t c = 0; c < lengths_.size(); ++c) {
    // `before` to `after`: the range so far. A concave corner ends it, and the next one begins beyond its jump.
    double before = first[c];
    double after = first[c];
    std::vector<Range> sets;
    for (const Event& event : events) {
      if (event.contact != c) continue;
      after += event.turn;
      if (!event.concave) continue;
      sets.push_back(hull(before, after - event.turn));
      before = after;
    }
    sets.push_back(hull(before, last[c]));
    // Each stretch so far times each range of this contact.
    std::vector<ContactStretch> longer;
    for (const Range& set : sets) {
      for (ContactStretch one : result) {
        one.angle.push_back(set);
        longer.push_back(std::move(one));
      }
    }
    result = std::move(longer);
  }
  return result;
}

/// Alternates smooth stretches and corners from lo to hi. The result is kept: boxes of a cover share their sides.
const std::vector<ContactStretch>& ContactCurve::over(double lo, double hi, Cuts cuts) {
  const auto found = known_.find({lo, hi, cuts});
  if (found != known_.end()) return found->second;
  std::vector<ContactStretch> result;
  // Each cut takes a step to either side: places nearer to a corner are at it.
  const double beside = least_step(part_);
  double here = lo;
  const std::vector<Event> all = events(lo - beside, hi + beside, cuts);
  for (std::size_t k = 0; k < all.size();) {
    std::vector<Event> near = {all[k++]};
    // Events within some steps of each other are one cluster: rounding must not decide their order.
    while (k < all.size() && all[k].s - near.back().s <= 4 * beside) near.push_back(all[k++]);
    const double before = near.front().s - beside;
    const double after = near.back().s + beside;
    // From the last cluster to this one.
    if (before > here) result.push_back(smooth(here, before));
    // A cluster of bends alone is smooth, but ends the stretches beside it.
    if (std::any_of(near.begin(), near.end(), [](const Event& event) { return event.is_corner; })) {
      for (ContactStretch& one : at_corner(before, after, near)) result.push_back(std::move(one));
    } else {
      result.push_back(smooth(before, after));
    }
    here = after;
  }
  if (hi > here) result.push_back(smooth(here, hi));
  return known_[{lo, hi, cuts}] = std::move(result);
}

}  // namespace rollfix::certifying
