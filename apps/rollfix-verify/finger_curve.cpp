#include "finger_curve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "check.hpp"

// Notation:
//   [lo, hi]        a stretch of first contacts: Stretch
//   Theta           the angles of all contacts; w: a weight for each of them
//   K, |K|          a ball that holds w . kappa on the stretch; its width
// Follows docs/certificates.md, "Two fingers".
// Idea: a sum of angles w . Theta is bounded on a stretch
//  * by its ranges: the sum of what each angle takes there, and
//  * by its chord: it leaves the straight way from end to end by no more than (hi - lo) |K| / 4, and by what joints in
//    between turn.
namespace rollfix_verify {
namespace {

// An end whose contacts can't be told from a joint is moved outwards by this share of the perimeter, so many times.
constexpr double kNudge = 4e-13;
constexpr int kMostNudges = 6;
// Stretches over more joints than this are halved before anything is said of their curvatures.
constexpr std::size_t kMostSegments = 8;
// A curvature that jumps by this many radians over the perimeter ends a stretch that is nearly an arc.
constexpr double kBend = 1e-6;
// Stretches that are kept for the next who asks, before all are dropped.
constexpr std::size_t kMostKept = 30000;
// To look whether a joint is in a range, in expansions.
constexpr double kJointWork = 0.01;

/// The least ball around all of them.
Ball hull_of(const std::vector<Ball>& balls) {
  return std::accumulate(balls.begin(), balls.end(), balls.front(),
                         [](const Ball& a, const Ball& b) { return hull(a, b); });
}

/// By the curvature at the start of each segment and how fast it changes, where that tells more.
Ball curvatures_by_slope(const Boundary& boundary, const std::vector<Segment>& all) {
  Ball result;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const long curve = all[k].from.curve;
    const Boundary::Bend wide = boundary.bend(curve, hull(all[k].from.u, all[k].to.u));
    const Ball first = boundary.bend(curve, all[k].from.u).curvature;
    Ball here = first + up_to(all[k].to.s - all[k].from.s) * wide.change;
    // Of a long or sharply bent segment the plain bound is the better one.
    if (!here.is_finite() || spread(here) > spread(wide.curvature)) here = wide.curvature;
    result = k == 0 ? here : hull(result, here);
  }
  return result;
}

/// Whether a contact between two places may pivot.
bool pivots_between(const Boundary& boundary, const Place& from, const Place& to) {
  for (long curve = from.curve; curve < to.curve; ++curve) {
    if (boundary.pivots(curve)) return true;
  }
  return false;
}

/// Whether the curvature jumps at a joint.
bool bends_at(const Boundary& boundary, long curve) {
  const Place before = boundary.back(curve);
  const Place after = boundary.front(curve + 1);
  const Ball jump = boundary.bend(after.curve, after.u).curvature - boundary.bend(before.curve, before.u).curvature;
  return !(abs(jump) * boundary.perimeter()).is_below(kBend);
}

/// Half of an interval.
Ball half_of(const Ball& range, bool upper) {
  const double middle = range.middle();
  return upper ? hull(middle, Ball(range.upper())) : hull(Ball(range.lower()), middle);
}

}  // namespace

/// By their ranges, or by the chord, which may tell more.
Ball Stretch::sum(const std::vector<Ball>& weights) const {
  // Contacts pivot independently: interval arithmetic is exact here.
  if (pivot) return weighted(weights, from);
  Ball apart = weighted(weights, range);
  const Chord chord = this->chord(weights);
  // At rest the curvature has no bound, but the angle has.
  if (!chord.off.is_finite()) return apart;
  const Ball together = hull(chord.from, chord.to) + around_zero(chord.off);
  return apart.is_finite() && spread(apart) < spread(together) ? apart : together;
}

/// On one side of the chord or the other by a quarter of the slope's change times the width at the most, and by what
/// joints turn. Of a pivot the contact that turns most goes from its least angle to its largest.
Stretch::Chord Stretch::chord(const std::vector<Ball>& weights) const {
  if (pivot) {
    const std::size_t turning = widest();
    // The other contacts stay open: their ranges are in both ends of the chord.
    std::vector<Ball> angles = from;
    angles[turning] = from[turning].lower();
    Chord chord{weighted(weights, angles), {}, 0.0};
    angles[turning] = from[turning].upper();
    chord.to = weighted(weights, angles);
    return chord;
  }
  const Ball slope = weighted(weights, rate);
  // |K| / 4 times the width, K the ball of w . kappa.
  Ball off = slope.is_finite() ? 0.25 * (Ball(hi) - lo) * (Ball(slope.upper()) - slope.lower()) : unknown();
  for (std::size_t c = 0; c < weights.size(); ++c) off = off + abs(weights[c]) * abs(jump[c]);
  return {weighted(weights, from), weighted(weights, to), off};
}

/// The sum with a single weight of 1.
Ball Stretch::angle(std::size_t contact) const {
  std::vector<Ball> weights(from.size(), Ball(0.0));
  weights[contact] = 1.0;
  return sum(weights);
}

std::size_t Stretch::widest() const {
  const auto is_narrower = [](const Ball& a, const Ball& b) { return spread(a) < spread(b); };
  return static_cast<std::size_t>(std::max_element(from.begin(), from.end(), is_narrower) - from.begin());
}

double Stretch::turn(std::size_t contact) const {
  if (!pivot) return (to[contact] - from[contact]).middle();
  return contact == widest() ? spread(from[contact]) : 0.0;
}

/// The largest change of any contact, radians; infinite where nothing bounds it. It decides which stretch is halved.
double Stretch::change() const {
  double most = 0;
  for (std::size_t c = 0; c < from.size(); ++c) {
    // By the rate, by the range, whichever is less.
    double here = pivot ? spread(from[c]) : std::numeric_limits<double>::infinity();
    if (!pivot && rate[c].is_finite()) here = width() * abs(rate[c]).upper();
    if (!pivot && range[c].is_finite()) here = std::min(here, spread(range[c]));
    most = std::max(most, here);
  }
  return most;
}

/// Where the contacts are; s moves a little that way where one of them can't be told from a joint.
std::vector<Place> FingerCurve::places(double& s, int way) const {
  for (int k = 0; k < kMostNudges; ++k, s += way * kNudge * period_) {
    std::vector<Place> result;
    for (const Ball& length : lengths_) {
      const std::optional<Place> place = boundary_.after(Ball(s) + length);
      if (place) result.push_back(*place);
    }
    if (result.size() == lengths_.size()) return result;
  }
  throw std::domain_error("contacts can't be told from joints near " + std::to_string(s));
}

/// Rising.
std::vector<FingerCurve::Cut> FingerCurve::cuts_between(double lo, double hi, Cuts cuts) const {
  std::vector<Cut> result;
  for (const Ball& length : lengths_) {
    // Of the contact, not of the first contact.
    const auto lap = [&](double s) {
      return boundary_.closed() ? static_cast<long>(std::floor((s + length.middle()) / period_)) : 0;
    };
    // A closed outline's last curve ends at a joint as well.
    const long joints = boundary_.closed() ? boundary_.curves() : boundary_.curves() - 1;
    for (long laps = lap(lo) - 1; laps <= lap(hi); ++laps) {
      Budget::spend(kJointWork * static_cast<double>(joints));
      for (long k = 0; k < joints; ++k) {
        const bool is_corner = boundary_.turns(k);
        // Places at rest without a turn are no corners here: beside them angles are bounded by their ranges.
        if (!is_corner && (cuts == Cuts::corners || !bends_at(boundary_, k))) continue;
        const double s = (boundary_.back(k + laps * boundary_.curves()).s - length).middle();
        // The first contact that brings this contact to the joint.
        if (s > lo && s < hi) result.push_back({s, is_corner});
      }
    }
  }
  std::sort(result.begin(), result.end(), [](const Cut& one, const Cut& two) { return one.s < two.s; });
  return result;
}

/// Of the angle: by its ends where it only rises or falls. Where a curve is at rest the curvature has no bounds.
Ball FingerCurve::range_of(const std::vector<Segment>& all, const Ball& curvature) const {
  if (!curvature.is_finite()) return hull_of(angles(boundary_, all));
  if (sign_of(curvature) == 0) return unknown();
  return hull(all.front().from.angle, all.back().to.angle) + around_zero(abs(jumps(boundary_, all)));
}

/// A stretch without corners. Its ends are moved outwards off joints, so that stretches rather overlap than leave a
/// gap.
Stretch FingerCurve::smooth(double lo, double hi) const {
  Stretch result;
  result.lo = lo;
  result.hi = hi;
  const std::vector<Place> first = places(result.lo, -1);
  const std::vector<Place> last = places(result.hi, 1);
  for (std::size_t c = 0; c < first.size(); ++c) {
    const std::vector<Segment> all = segments(boundary_, first[c], last[c]);
    result.from.push_back(first[c].angle);
    result.to.push_back(last[c].angle);
    // Over many joints nothing is known, so that the stretch is halved.
    const bool is_short = all.size() <= kMostSegments;
    result.rate.push_back(is_short ? curvatures_by_slope(boundary_, all) : unknown());
    result.jump.push_back(jumps(boundary_, all));
    result.range.push_back(is_short ? range_of(all, result.rate[c]) : unknown());
  }
  return result;
}

/// At a concave corner an angle is what it is before or after; at all others anything in between, so that what is
/// before and after a corner is one set.
std::vector<Stretch> FingerCurve::at_corner(double lo, double hi) const {
  Stretch empty;
  empty.lo = lo;
  empty.hi = hi;
  empty.pivot = true;
  const std::vector<Place> first = places(empty.lo, -1);
  const std::vector<Place> last = places(empty.hi, 1);
  // Grows by one contact at a time.
  std::vector<Stretch> result = {empty};
  for (std::size_t c = 0; c < first.size(); ++c) {
    const std::size_t more = pivots_between(boundary_, first[c], last[c]) ? 1 : 0;
    // Each stretch so far with each set of this contact: concave corners multiply their number, which is paid for.
    std::vector<Stretch> longer;
    for (const Ball& set : angles(boundary_, segments(boundary_, first[c], last[c]))) {
      for (Stretch one : result) {
        one.from.push_back(set);
        one.pivots += more;
        longer.push_back(one);
      }
    }
    result = longer;
    Budget::spend(static_cast<double>(result.size()));
  }
  return result;
}

/// Alternates smooth stretches with cuts, each of them kSamePlace wide to either side. Neighbouring cuts are one.
const std::vector<Stretch>& FingerCurve::over(double lo, double hi, Cuts cuts) {
  const auto found = known_.find({lo, hi, cuts});
  if (found != known_.end()) return found->second;
  // Bounds memory; halves that others still hold live on.
  if (kept_ > kMostKept) {
    known_.clear();
    kept_ = 0;
  }
  std::vector<Stretch> result;
  const double beside = kSamePlace * period_;
  double here = lo;
  const std::vector<Cut> all = cuts_between(lo - beside, hi + beside, cuts);
  for (std::size_t k = 0; k < all.size(); ++k) {
    const double before = all[k].s - beside;
    // Cuts that are nearer than can be told are one place, at which all of their contacts pivot.
    bool is_corner = all[k].is_corner;
    for (; k + 1 < all.size() && all[k + 1].s - all[k].s <= 4 * beside; ++k) is_corner |= all[k + 1].is_corner;
    const double after = all[k].s + beside;
    // What lies before the cut.
    if (before > here) result.push_back(smooth(here, before));
    if (is_corner) {
      for (Stretch& one : at_corner(before, after)) result.push_back(std::move(one));
    } else {
      result.push_back(smooth(before, after));
    }
    here = after;
  }
  if (hi > here) result.push_back(smooth(here, hi));
  kept_ += result.size();
  return known_[{lo, hi, cuts}] = std::move(result);
}

std::optional<Stretch> FingerCurve::plain(double lo, double hi) const {
  const double beside = kSamePlace * period_;
  if (!cuts_between(lo - beside, hi + beside, Cuts::corners).empty()) return std::nullopt;
  return smooth(lo, hi);
}

/// Of a pivot the widest contact's range is halved, of all others the arc length.
const std::pair<Stretch, Stretch>& FingerCurve::halved(const Stretch& stretch) {
  if (stretch.halves) return *stretch.halves;
  std::pair<Stretch, Stretch> both;
  if (stretch.pivot) {
    both = {stretch, stretch};
    const std::size_t widest = stretch.widest();
    // The other contacts stay open in both halves.
    both.first.from[widest] = half_of(stretch.from[widest], false);
    both.second.from[widest] = half_of(stretch.from[widest], true);
  } else {
    const double middle = stretch.lo + 0.5 * stretch.width();
    if (!(middle > stretch.lo && middle < stretch.hi)) throw std::domain_error("a stretch is too short to be halved");
    both = {smooth(stretch.lo, middle), smooth(middle, stretch.hi)};
  }
  kept_ += 2;
  stretch.halves = std::make_shared<const std::pair<Stretch, Stretch>>(std::move(both));
  return *stretch.halves;
}

}  // namespace rollfix_verify
