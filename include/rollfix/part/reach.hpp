#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "rollfix/outline/curve.hpp"
#include "rollfix/part/part.hpp"

namespace rollfix {

/// Fingers and parts are never exact: a finger that would enter the part by no more than this share of the part's size
/// (of its box's diagonal) counts as touching it.
inline constexpr double kReachSlack = 1e-6;
/// But never by more than this share of a disk's radius.
inline constexpr double kReachSlackOfRadius = 1e-3;

/// The directions in which the tangent can point while a finger pivots at a convex corner.
struct PivotReach {
  double s = 0;    // of the corner, in [0, P)
  Interval whole;  // Theta's limits there, radians, unwrapped: where the boundary in front of it ends, ...
  std::vector<Interval> angles;  // ... and the one after it starts; in between those that the finger can take

  bool is_whole() const;
};

/// Where a finger can touch a part at all: without entering it anywhere, be it right there (1 + r kappa < 0) or
/// elsewhere. An open part is a wall of no thickness, touched from the right; its ends can be hit as well.
struct Reach {
  double curvature = 0;  // of the finger: 1 / r of a disk, 0 of a flat jaw
  double slack = 0;      // how far it may enter, length
  double perimeter = 0;
  bool closed = true;
  /// The arcs of the boundary along which the finger can roll, in order: lo in [0, P), hi may exceed P; the whole loop
  /// is [0, P]. They go on past a corner at which every pivot is possible, and end at any other and at a concave one.
  std::vector<Interval> arcs;
  bool whole_loop = false;         // the one arc has no ends: it goes on across s = 0
  std::vector<PivotReach> pivots;  // one for each convex corner, in order
  bool decided = true;             // false: the budget ran out, and what was not decided counts as within reach
  std::size_t tests = 0;           // pairs of stretches that were compared

  Boundary boundary() const { return {perimeter, closed}; }

  /// Where the finger can't touch, in order; lo in [0, P), hi may exceed P.
  std::vector<Interval> gaps() const;

  bool is_whole() const;  // every place, every pivot
  double share() const;   // of the boundary's length that is within reach

  /// Can the finger touch here, at a corner with some pivot at least?
  bool contains(double s) const;

  /// The arc that holds s, moved by whole perimeters so that it does, and widened by rounding; nothing off them all.
  std::optional<Interval> arc_at(double s) const;
};

struct ReachOptions {
  std::optional<double> slack{};  // length; by default what the constants above say, and no less than twice the
                                  // outline's own gap
  std::size_t budget = 20000000;  // pairs of stretches to compare before giving up
};

/// Where a disk can touch. The circle with radius r about p + r n, n being the outward normal, must have no point of
/// the boundary deeper in it than the slack. Branch and bound over pairs of stretches: nothing is sampled; see
/// docs/reach.md. Throws InputError: a radius that is not a finite number above 0.
Reach reach_of_disk(const Part& part, double radius, const ReachOptions& options = {});

/// Where a flat jaw can touch: where the tangent supports all of the part. The same with r to infinity: the places on
/// the convex hull.
Reach reach_of_jaw(const Part& part, const ReachOptions& options = {});

/// What a finger would hit.
struct Hit {
  double contact = 0;         // s of the place where it touches
  double s = 0;               // of the point of the boundary that is deepest inside it
  double depth = 0;           // how deep, length: above the slack where the finger can't be
  Vec2 point = Vec2::Zero();  // of the boundary
};

/// The point of the boundary that is deepest inside the finger while that touches at s with the tangent at this angle
/// (of a corner any between its limits). `curvature`: the finger's. A finger that is free to be there has depth 0.
Hit deepest_hit(const Part& part, double curvature, double s, double angle);

/// The deepest of the hits of a few contacts from lo to hi: for messages. Of a corner, where lo = hi, of its pivots.
Hit deepest_hit(const Part& part, double curvature, const Interval& contacts);

}  // namespace rollfix
