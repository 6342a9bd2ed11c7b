#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "held_rows.hpp"
#include "rollfix/curve.hpp"
#include "rollfix/part.hpp"
#include "touch/centre_path.hpp"
#include "touch/heading_arc.hpp"
#include "touch/nearest.hpp"

namespace rollfix::hold {

/// What an encoder's zero can be: some intervals, modulo a period if there is one. Nothing known: all.
class SpinSet {
 public:
  /// `period`: 0: none, as of an open part. All is possible at first.
  explicit SpinSet(double period) : period_(period) {}

  /// No zero suits all instants seen so far.
  bool is_empty() const { return intervals_ && intervals_->empty(); }

  /// What this and another set of intervals have in common.
  void keep(const std::vector<Interval>& others) {
    if (!intervals_) {
      intervals_ = joined(others);
      return;
    }
    std::vector<Interval> common;
    for (const Interval& one : *intervals_) {
      for (const Interval& other : others) add_common(one, other, common);
    }
    intervals_ = joined(std::move(common));
  }

 private:
  /// Both, shifted by every number of periods at which they overlap.
  void add_common(const Interval& one, const Interval& other, std::vector<Interval>& common) const {
    const double first = period_ > 0 ? std::ceil((one.lo - other.hi) / period_) : 0;
    const double last = period_ > 0 ? std::floor((one.hi - other.lo) / period_) : 0;
    for (double lap = first; lap <= last; lap += 1) {
      const Interval both{std::max(one.lo, other.lo + lap * period_), std::min(one.hi, other.hi + lap * period_)};
      if (both.lo <= both.hi) common.push_back(both);
    }
  }

  /// In order, those that overlap as one.
  static std::vector<Interval> joined(std::vector<Interval> intervals) {
    std::sort(intervals.begin(), intervals.end(), [](const Interval& a, const Interval& b) { return a.lo < b.lo; });
    std::vector<Interval> result;
    for (const Interval& one : intervals) {
      if (!result.empty() && one.lo <= result.back().hi) {
        result.back().hi = std::max(result.back().hi, one.hi);
      } else {
        result.push_back(one);
      }
    }
    return result;
  }

  double period_ = 0;                               // radians
  std::optional<std::vector<Interval>> intervals_;  // in order, apart; none: anything
};

/// The place of a wheel's pin, touching the part, that is nearest to a point of the part's frame.
struct NearPin {
  double distance = 0;            // of the point from it, above 0 off the part
  Vec2 away = Vec2::Zero();       // direction in which that grows
  Vec2 along = Vec2::Zero();      // unit vector along the path; zero at an end of it, where the wheel hits the part
  double s = 0;                   // where the wheel touches
  double angle = 0;               // of the tangent there; at a corner as the wheel pivots. Radians, of the first lap
  double turn_per_length = 0;     // how it changes as the pin goes along the path, ...
  double contact_per_length = 0;  // ... and how s does
};

/// A stretch of the path: where the wheel touches on it, and how the tangents point.
struct PinStretch {
  Interval s;      // one place at a corner
  Interval angle;  // radians, unwrapped along the boundary
};

/// Where the pin of a wheel can be while it touches a part and enters it nowhere: the boundary's offset.
class WheelPath {
 public:
  /// `radius`: r > 0, in the part's unit. A wheel that fits nowhere has an empty path.
  WheelPath(const Part& part, double radius);
  WheelPath(const WheelPath&) = delete;
  WheelPath& operator=(const WheelPath&) = delete;

  bool is_empty() const { return path_.stretches().empty(); }
  double radius() const { return path_.radius(); }
  /// What Theta + s / r grows by around the part: an encoder sees it modulo this; 0 of an open part.
  double spin_period() const { return spin_period_; }
  /// All of the boundary.
  Interval whole() const { return path_.part().boundary().full_arc(); }

  /// Of all places: by branch and bound.
  NearPin nearest(const Vec2& point);
  /// The same for fits, which ask for it often: from `from`, where it was found last, if a foot is close to there.
  /// `from` becomes the place found.
  NearPin nearest(const Vec2& point, std::optional<touch::PathPlace>& from);
  /// All of the path within `reach` of a point, in pieces of about that length; nothing where they are too many.
  std::optional<std::vector<PinStretch>> within(const Vec2& point, double reach);

 private:
  /// A point of the part's frame as touch/nearest.hpp takes it: a place without a normal.
  touch::InPart seen(const Vec2& point) const;
  /// A place of the path, as seen from a point near it.
  NearPin described(const Vec2& point, const touch::PathPlace& place) const;

  touch::CentrePath path_;               // p + r n, with arcs about convex corners
  std::optional<touch::PathTree> tree_;  // of a path that is not empty
  double unit_ = 1;                      // length to which nearest places are settled
  double spin_period_ = 0;               // radians
};

using WheelPaths = std::vector<std::unique_ptr<WheelPath>>;  // of each wheel; nearest places need not const

/// Where a finger's contact is at an instant, in the part's frame and in the world, and how far off that can be.
struct HeldFrom {
  Vec2 point = Vec2::Zero();  // in the part's frame: the middle of the disc that holds the contact
  Vec2 at = Vec2::Zero();     // in the world, as measured
  double reach = 0;           // length: the arc's, and of what was measured
  double place = 0;           // of it what was measured
  double heading = 0;         // one of the part's, radians, unwrapped over all instants
};

/// What of a wheel suits some arc of a finger's contacts at one instant.
struct PinFound {
  std::vector<Interval> spins;       // what the encoder's zero can be
  bool any_spin = false;             // it can be anything
  std::vector<PinStretch> touching;  // where the wheel can touch
};

/// Whether wheels can touch the part where their pins were. What is tested follows from "there is a heading in this
/// arc, and a contact within reach, with every residual within its slack".
class PinSearch {
 public:
  /// `instants`: rows that are searched with.
  PinSearch(const HeldRows& rows, const std::vector<std::size_t>& instants, const WheelPaths& paths);

  std::size_t wheels() const { return wheels_.size(); }
  bool has_spin(std::size_t wheel) const { return wheels_[wheel].spin.has_value(); }
  SpinSet any_spin(std::size_t wheel) const { return SpinSet(paths_[wheel]->spin_period()); }
  Vec2 pin(std::size_t wheel, std::size_t instant) const { return pins_[instant][wheel].at; }
  /// How far off a pin can be.
  double slack(std::size_t wheel) const;
  /// Places that were compared since this was made.
  std::size_t looks() const { return looks_; }

  /// `found`: filled if given, else any place will do.
  bool may_touch(std::size_t wheel, std::size_t instant, const HeldFrom& from, const touch::HeadingArc& heading,
                 PinFound* found);

 private:
  /// One call of may_touch, with what does not change over its headings.
  struct Question;
  /// Whether the wheel can touch at headings within `half` of `middle`; halves them where that helps. `left`: looks
  /// that remain of kMostLooks.
  bool look(const Question& question, double middle, double half, std::size_t& left);
  /// Whether places of the path within reach of x suit a squeeze; into `found` those that do.
  bool keep_touching(const Question& question, double middle, double half, const Vec2& point, double reach);
  /// How far off an encoder can be at an instant, radians.
  double spin_slack(std::size_t wheel, std::size_t instant) const;

  bool has_noise_;  // errors are standard deviations; else they are tolerances
  std::vector<HeldWheel> wheels_;
  std::vector<std::vector<HeldPin>> pins_;  // of each instant, of each wheel
  const WheelPaths& paths_;
  std::size_t looks_ = 0;
};

}  // namespace rollfix::hold
