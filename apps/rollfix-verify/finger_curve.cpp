#include "finger_curve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "budget.hpp"

namespace rollfix_verify {
namespace {

// An end whose contacts can't be told from a joint is moved outwards by this share of the perimeter, so many times.
constexpr double kNudge = 4e-13;
constexpr int kMostNudges = 6;
// Stretches over more joints than this are halved before anything is said of their curvatures.
constexpr std::size_t kMostSegments = 8;
// Stretches that are kept for the next who asks, before all are dropped.
constexpr std::size_t kMostKept = 30000;
// To look whether a joint is in a range, in expansions.
constexpr double kJointWork = 0.01;

Ball weighted(const std::vector<Ball>& weights, const std::vector<Ball>& values) {
  Ball result = 0.0;
  for (std::size_t c = 0; c < weights.size(); ++c) result = result + weights[c] * values[c];
  return result;
}

double spread(const Ball& ball) { return ball.upper() - ball.lower(); }

Ball hull_of(const std::vector<Ball>& balls) {
  Ball result = balls.front();
  for (const Ball& ball : balls) result = hull(result, ball);
  return result;
}

Ball around_zero(const Ball& reach) { return hull(-reach, reach); }

/// By the curvature at the start of each segment and how fast it changes, where that tells more.
Ball curvatures_by_slope(const Boundary& boundary, const std::vector<Segment>& all) {
  Ball result;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const long curve = all[k].from.curve;
    const Boundary::Bend wide = boundary.bend(curve, hull(all[k].from.u, all[k].to.u));
    const Ball first = boundary.bend(curve, all[k].from.u).curvature;
    Ball here = first + up_to(all[k].to.s - all[k].from.s) * wide.change;
    if (!here.is_finite() || here.upper() - here.lower() > wide.curvature.upper() - wide.curvature.lower()) {
      here = wide.curvature;
    }
    result = k == 0 ? here : hull(result, here);
  }
  return result;
}

/// Whether a contact between two places may pivot: at a corner that is not concave, or where a curve is at rest.
bool pivots_between(const Boundary& boundary, const Place& from, const Place& to) {
  for (long curve = from.curve; curve < to.curve; ++curve) {
    if (boundary.is_at_rest(curve)) return true;
    if (!abs(boundary.jump(curve)).is_below(kSmooth) && !boundary.jump(curve).is_below(-kConcave)) return true;
  }
  return false;
}

/// Half of an interval.
Ball half_of(const Ball& range, bool upper) {
  const double middle = range.middle();
  return upper ? hull(middle, Ball(range.upper())) : hull(Ball(range.lower()), middle);
}

}  // namespace

/// By their ranges; or on one side of the chord or the other by a quarter of the slope's change times the width at the
/// most, where that is less.
Ball Stretch::sum(const std::vector<Ball>& weights) const {
  if (pivot) return weighted(weights, from);
  Ball apart = weighted(weights, range);
  const Ball slope = weighted(weights, rate);
  if (!slope.is_finite()) return apart;
  const Ball sag = 0.25 * (Ball(hi) - lo) * (Ball(slope.upper()) - slope.lower());
  Ball jumps = 0.0;
  for (std::size_t c = 0; c < weights.size(); ++c) jumps = jumps + abs(weights[c]) * abs(jump[c]);
  Ball together = hull(weighted(weights, from), weighted(weights, to)) + around_zero(sag) + around_zero(jumps);
  return apart.is_finite() && spread(apart) < spread(together) ? apart : together;
}

Ball Stretch::angle(std::size_t contact) const {
  std::vector<Ball> weights(from.size(), Ball(0.0));
  weights[contact] = 1.0;
  return sum(weights);
}

std::size_t Stretch::widest() const {
  const auto width = [&](std::size_t c) { return spread(from[c]); };
  std::size_t result = 0;
  for (std::size_t c = 1; c < from.size(); ++c) result = width(c) > width(result) ? c : result;
  return result;
}

double Stretch::turn(std::size_t contact) const {
  if (!pivot) return (to[contact] - from[contact]).middle();
  return contact == widest() ? from[contact].upper() - from[contact].lower() : 0.0;
}

double Stretch::change() const {
  double most = 0;
  for (std::size_t c = 0; c < from.size(); ++c) {
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

/// First contacts that bring a contact to a corner, rising.
std::vector<double> FingerCurve::corners_between(double lo, double hi) const {
  std::vector<double> result;
  for (const Ball& length : lengths_) {
    const auto lap = [&](double s) {
      return boundary_.closed() ? static_cast<long>(std::floor((s + length.middle()) / period_)) : 0;
    };
    const long joints = boundary_.closed() ? boundary_.curves() : boundary_.curves() - 1;
    for (long laps = lap(lo) - 1; laps <= lap(hi); ++laps) {
      Budget::spend(kJointWork * static_cast<double>(joints));
      for (long k = 0; k < joints; ++k) {
        if (abs(boundary_.jump(k)).is_below(kSmooth)) continue;
        const long curve = k + laps * boundary_.curves();
        const double s = (boundary_.back(curve).s - length).middle();
        if (s > lo && s < hi) result.push_back(s);
      }
    }
  }
  std::sort(result.begin(), result.end());
  return result;
}

/// Of the angle: by its ends where it only rises or falls. Where a curve is at rest the curvature has no bounds.
Ball FingerCurve::range_of(const std::vector<Segment>& all, const Ball& curvature) const {
  if (!curvature.is_finite()) return hull_of(angles(boundary_, all));
  if (sign_of(curvature) == 0) return unknown();
  return hull(all.front().from.angle, all.back().to.angle) + around_zero(abs(jumps(boundary_, all)));
}

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
  std::vector<Stretch> result = {empty};
  for (std::size_t c = 0; c < first.size(); ++c) {
    const std::size_t more = pivots_between(boundary_, first[c], last[c]) ? 1 : 0;
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

const std::vector<Stretch>& FingerCurve::over(double lo, double hi) {
  const auto found = known_.find({lo, hi});
  if (found != known_.end()) return found->second;
  if (kept_ > kMostKept) {
    known_.clear();
    kept_ = 0;
  }
  std::vector<Stretch> result;
  const double beside = kSamePlace * period_;
  double here = lo;
  const std::vector<double> corners = corners_between(lo - beside, hi + beside);
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const double before = corners[k] - beside;
    while (k + 1 < corners.size() && corners[k + 1] - corners[k] <= 4 * beside) ++k;
    const double after = corners[k] + beside;
    if (before > here) result.push_back(smooth(here, before));
    for (Stretch& one : at_corner(before, after)) result.push_back(std::move(one));
    here = after;
  }
  if (hi > here) result.push_back(smooth(here, hi));
  kept_ += result.size();
  return known_[{lo, hi}] = std::move(result);
}

const std::pair<Stretch, Stretch>& FingerCurve::halved(const Stretch& stretch) {
  if (stretch.halves) return *stretch.halves;
  kept_ += 2;
  if (!stretch.pivot) {
    const double middle = stretch.lo + 0.5 * stretch.width();
    if (!(middle > stretch.lo && middle < stretch.hi)) throw std::domain_error("a stretch is too short to be halved");
    stretch.halves =
        std::make_shared<const std::pair<Stretch, Stretch>>(smooth(stretch.lo, middle), smooth(middle, stretch.hi));
    return *stretch.halves;
  }
  const std::size_t widest = stretch.widest();
  Stretch lower = stretch;
  Stretch upper = stretch;
  lower.from[widest] = half_of(stretch.from[widest], false);
  upper.from[widest] = half_of(stretch.from[widest], true);
  stretch.halves = std::make_shared<const std::pair<Stretch, Stretch>>(lower, upper);
  return *stretch.halves;
}

}  // namespace rollfix_verify
