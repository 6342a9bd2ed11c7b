#pragma once

// Every first contact of one finger, by looking everywhere: f(s) = Theta(s + L) - Theta(s) - theta may be near 0 only
// on what its values and the bounds on its slope, kappa(s + L) - kappa(s), do not exclude. What they do not exclude is
// halved, down to a floor.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "oracle/boundary.hpp"

namespace oracle {

struct Question {
  Real length = 0;
  Real turn = 0;
  Real tolerance = 0;  // radians: |f| up to here fits
  Real doubt = 0;      // radians: by how much the library may have f wrong
};

/// Starts that may fit and hang together; nothing outside of all of them does.
struct Cluster {
  Interval starts;
  bool fits = false;            // something in it does, beyond doubt
  std::vector<Interval> roots;  // in each of them f changes sign, beyond doubt
};

class OneFinger {
 public:
  /// Of the perimeter: what can't be excluded is not halved further.
  static constexpr Real kFloor = 2.5e-10L;

  OneFinger(const Boundary& boundary, const Question& question) : boundary_(boundary), question_(question) {
    place_events();
    for (std::size_t k = 0; k < events_.size(); ++k) {
      examine_event(events_[k]);
      if (k + 1 < events_.size() && events_[k + 1] > events_[k]) {
        examine({at(events_[k], Side::after, kSamePlace), at(events_[k + 1], Side::before, kSamePlace)});
      }
    }
    join_ends();
  }

  const std::vector<Cluster>& clusters() const { return clusters_; }
  std::size_t evaluations() const { return evaluations_; }

  /// f at a place; at a corner before or after it.
  Real f(Real s, Side side = Side::after) const { return at(s, side).f; }

  /// Bounds on f's slope from one place to another, without a corner in between.
  Interval slope(Real from, Real to) const { return slope({at(from), at(to, Side::before)}); }

  /// Where either end of the roll passes a corner or an end of an open outline, in order.
  const std::vector<Real>& events() const { return events_; }

  /// Whether f takes, at an event, every value between its limits.
  bool has_jump(Real event) const { return !std::empty(corners_at(event)) && !is_filled(event); }

 private:
  struct Roll {
    Contact start, end;
    Real f = 0;
  };
  struct Stretch {
    Roll from, to;
  };

  /// `near`: of the perimeter, closer to where curves meet is there.
  Roll at(Real s, Side side = Side::after, Real near = Boundary::kNear) const {
    ++evaluations_;
    const Contact start = boundary_.contact(s, side, near), end = boundary_.contact(s + question_.length, side, near);
    return {start, end, end.angle - start.angle - question_.turn};
  }

  // ---- events ----

  void place_events() {
    const Real P = boundary_.perimeter(), L = question_.length;
    if (!boundary_.closed()) {
      events_ = {std::max<Real>(0, -L), std::min(P, P - L)};
      if (events_[1] < events_[0]) events_[1] = events_[0];  // a roll over all of it, rounded
    }
    for (const Corner& corner : boundary_.corners()) {
      for (const Real s : {corner.s, corner.s - L}) {
        if (boundary_.closed()) events_.push_back(s - std::floor(s / P) * P);
        if (!boundary_.closed() && s > events_[0] && s < events_[1]) events_.push_back(s);
      }
    }
    if (boundary_.closed()) {
      if (events_.empty()) events_.push_back(kAnywhere * P);
      events_.push_back(*std::min_element(events_.begin(), events_.end()) + P);
    }
    std::sort(events_.begin(), events_.end());
    const auto same = [&](Real one, Real other) { return other - one < kSamePlace * P; };
    const bool is_lap = boundary_.closed();
    const Real last = events_.back();
    events_.erase(std::unique(events_.begin(), events_.end(), same), events_.end());
    if (is_lap && events_.back() < last) events_.back() = last;
  }

  struct Turned {
    bool at_start;
    Real turn;
  };
  std::vector<Turned> corners_at(Real event) const {
    std::vector<Turned> turned;
    const auto is_at = [&](Real s, Real corner) {
      const Real off = boundary_.closed() ? std::remainder(s - corner, boundary_.perimeter()) : s - corner;
      return std::abs(off) < 2 * kSamePlace * boundary_.perimeter();
    };
    for (const Corner& corner : boundary_.corners()) {
      if (is_at(event, corner.s)) turned.push_back({true, corner.turn});
      if (is_at(event + question_.length, corner.s)) turned.push_back({false, corner.turn});
    }
    return turned;
  }

  /// A finger pivots at a convex corner; at a joint that rounding has bent by less than this it may be any way.
  static constexpr Real kJoint = 1e-3L;

  bool is_filled(Real event) const {
    const auto turned = corners_at(event);
    return std::all_of(turned.begin(), turned.end(), [](const Turned& at) { return at.turn > -kJoint; });
  }

  /// All values that f can take there: between its limits, and with a corner at both ends those of either pivot alone.
  void examine_event(Real event) {
    const auto turned = corners_at(event);
    if (turned.empty()) return;
    const Real before = at(event, Side::before, kSamePlace).f, after = at(event, Side::after, kSamePlace).f;
    Interval values = hull(before, after);
    for (const Turned& corner : turned) {
      values = hull(values, before + (corner.at_start ? -corner.turn : corner.turn));
    }
    const Real reach = question_.tolerance + question_.doubt;
    if (values.lo > reach || values.hi < -reach) return;
    Cluster& cluster = cluster_at(event, event);
    if (!is_filled(event)) {
      last_sign_ = 0;  // f jumps
      return;
    }
    const Real sure = question_.tolerance - question_.doubt;
    cluster.fits = cluster.fits || (values.lo <= sure && values.hi >= -sure);
    note(event, before);
    note(event, after);
  }

  // ---- stretches ----

  Interval slope(const Stretch& stretch) const {
    return gain_of_curvature(boundary_, question_.length, {stretch.from.start, stretch.to.start},
                             {stretch.from.end, stretch.to.end});
  }

  void examine(Stretch stretch) {
    const Real tolerance = question_.tolerance + question_.doubt;
    while (true) {
      const Real from = stretch.from.start.s, to = stretch.to.start.s, width = to - from;
      const Interval slope = this->slope(stretch);
      // No closer to 0 than this near either end.
      const auto reached = [&](Real f, Real down, Real up) -> Real {
        if (f > tolerance) return down > 0 ? (f - tolerance) / down : width + 1;
        if (f < -tolerance) return up > 0 ? (-tolerance - f) / up : width + 1;
        return 0;
      };
      const Real left = reached(stretch.from.f, -slope.lo, slope.hi),
                 right = reached(stretch.to.f, slope.hi, -slope.lo);
      if (left + right > width * (1 + 4 * kRounding)) return;
      const Interval values = between(stretch.from.f, stretch.to.f, slope, width);
      if (values.size() <= tolerance + question_.doubt || width <= kFloor * boundary_.perimeter()) return keep(stretch);
      if (left + right < width / 2) {
        const Roll amid = at(from + width / 2);
        examine({stretch.from, amid});
        stretch.from = amid;
        continue;
      }
      if (left > 0) stretch.from = at(from + left);
      if (right > 0) stretch.to = at(std::max(stretch.from.start.s, to - right), Side::before);
    }
  }

  // ---- clusters ----

  Cluster& cluster_at(Real from, Real to) {
    const Real gap = 4 * kSamePlace * boundary_.perimeter();
    if (clusters_.empty() || from - clusters_.back().starts.hi > gap) {
      clusters_.push_back({{from, to}, false, {}});
      last_sign_ = 0;
    }
    clusters_.back().starts.hi = std::max(clusters_.back().starts.hi, to);
    return clusters_.back();
  }

  void keep(const Stretch& stretch) {
    const Real from = stretch.from.start.s, to = stretch.to.start.s;
    cluster_at(from, to);
    note(from, stretch.from.f);
    if (to - from > kFloor * boundary_.perimeter()) {
      for (int k = 1; k < 4; ++k) note(from + (to - from) * k / 4, f(from + (to - from) * k / 4));
    }
    note(to, stretch.to.f);
  }

  /// One value of f, in order: whether it fits, and whether f has changed its sign.
  void note(Real s, Real f) {
    Cluster& cluster = clusters_.back();
    cluster.fits = cluster.fits || std::abs(f) <= question_.tolerance - question_.doubt;
    if (std::abs(f) <= question_.doubt) return;
    const int sign = f > 0 ? 1 : -1;
    if (last_sign_ * sign < 0) {
      cluster.roots.push_back({last_signed_, s});
      cluster.fits = true;
    }
    last_sign_ = sign;
    last_signed_ = s;
  }

  /// Of a closed outline: the last cluster goes on at the first.
  void join_ends() {
    const Real P = boundary_.perimeter(), gap = 4 * kSamePlace * P;
    if (!boundary_.closed() || clusters_.size() < 2) return;
    Cluster& first = clusters_.front();
    Cluster& last = clusters_.back();
    if (first.starts.lo - events_.front() > gap || events_.back() - last.starts.hi > gap) return;
    last.starts.hi = first.starts.hi + P;
    last.fits = last.fits || first.fits;
    for (const Interval& root : first.roots) last.roots.push_back({root.lo + P, root.hi + P});
    clusters_.erase(clusters_.begin());
  }

  static constexpr Real kAnywhere =
      0.0314159L;                             // of the perimeter: where a loop is cut, a place that nothing singles out
  static constexpr Real kSamePlace = 1e-12L;  // of the perimeter: what the library's arc lengths are accurate to

  const Boundary& boundary_;
  Question question_;
  std::vector<Real> events_;
  std::vector<Cluster> clusters_;
  mutable std::size_t evaluations_ = 0;
  int last_sign_ = 0;
  Real last_signed_ = 0;
};

}  // namespace oracle
