#pragma once

// A part: its outline, with all that is computed once of it.
//
//     const Part part = load_part("gallery:ellipse,a=2,b=1");
//     std::round(1e6 * part.perimeter()) / 1e6;  // 9.68845
//     part.closed();                             // true
//     part.point(0).x();                         // 2
//
// Degenerate cases: an outline that crosses itself, has a cusp or no length is an InputError with the place.
//
// Accuracy: arc length 1e-12 P, Theta 1e-12 rad, measured against elliptic integrals and other closed forms
// (docs/search.md, "ACCURACY").

#include <cstddef>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "rollfix/curve.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/turning_function.hpp"

namespace rollfix {

/// A jump this small is a smooth joint of a drawing whose digits were rounded, radians: Theta takes every value in
/// between there, whichever way it turns. A corner that was meant turns by far more.
inline constexpr double kJointTurn = 1e-3;

/// A jump of the turning function at arc length s. `turn` > 0: convex (a finger pivots there);
/// < 0: concave (a finger can't get into it).
struct Corner {
  double s = 0;     // in [0, P)
  double turn = 0;  // radians, in (-pi, pi)

  /// A finger can't roll over it.
  bool is_concave() const { return turn <= -kJointTurn; }
};

struct PartOptions {
  bool allow_crossing = false;  // take an outline that crosses itself (a race track with a bridge)
};

/// An outline with everything that is computed once per shape: the paper's "one-time overhead for one
/// part shape". Immutable; copies share their data; safe to read from any number of threads.
///
/// A closed outline is stored with the material on its left: a clockwise one (a hole: a counter-clockwise one) is
/// reversed (same first point) and `reversed()` says so. An open one keeps its direction.
///
/// Throws InputError: outline with a gap, a cusp, or (unless allowed) a self-crossing; the message says where.
class Part {
 public:
  explicit Part(Outline outline, const PartOptions& options = {});

  const std::string& name() const;
  const Outline& outline() const;                             // as stored: counter-clockwise when closed
  const std::string& unit() const { return outline().unit; }  // of lengths: "mm", ...; empty: not known
  bool closed() const;
  bool reversed() const;     // stored against the direction in which the user gave it
  double perimeter() const;  // total arc length P, in the outline's unit; relative error 1e-12
  Boundary boundary() const { return turning().boundary(); }  // what its places s are
  double total_turn() const;                                  // of the tangent over the whole boundary, radians
  int turns() const;  // total_turn / 2 pi of a closed outline: 1 for a simple one; 0 when open

  const TurningFunction& turning() const;

  const std::vector<double>& inflections() const;  // s where the curvature changes sign
  const std::vector<double>& vertices() const;     // s where the curvature's derivative changes sign
  const std::vector<Corner>& corners() const;

  /// Position at arc length s (any s when closed; clamped to [0, P] when open).
  Vec2 point(double s) const;
  /// Direction of the tangent just after s (just before it at an open end), in (-pi, pi].
  double tangent(double s) const;

  /// How far apart two places are along the boundary, of a closed one the shorter way round, whatever laps they name.
  double distance(double s, double t) const { return boundary().distance(s, t); }

  /// A polyline through `count` + 1 points from s = lo to s = hi, corners included: for drawing.
  std::vector<Vec2> polyline(double lo, double hi, int count) const;

 private:
  friend struct PartAccess;
  struct Data;
  explicit Part(std::shared_ptr<const Data> data) : data_(std::move(data)) {}
  std::shared_ptr<const Data> data_;
};

/// The same part with a name for the unit of its lengths, which stay the numbers that they are.
Part with_unit(const Part& part, const std::string& unit);

/// The same part with another name.
Part with_name(const Part& part, const std::string& name);

/// The part of what load_outline takes: "gallery:NAME,key=value,...", or points in .csv, .dat or .txt. Throws
/// InputError as that does and as Part does. Drawings, saved parts, and options: rollfix/files.hpp.
Part load_part(const std::string& source);

/// A place on a boundary, in numbers.
struct BoundarySample {
  double s = 0;
  Vec2 point = Vec2::Zero();
  double tangent = 0;    // Theta(s), radians, unwrapped
  double curvature = 0;  // positive where convex
};

/// From one of these samples to the next the tangent turns by no more than this, radians, ...
inline constexpr double kSampleTurn = std::numbers::pi / 90;
/// ... and s grows by no more than this share of the perimeter.
inline constexpr double kSampleShare = 1.0 / 200;

/// A boundary as numbers, by growing s from 0 to P, as densely as its shape asks for (kSampleTurn, kSampleShare). All
/// ends of spirals are among them: inflections, vertices, joints and corners. Where the tangent or the curvature jumps
/// there are two samples with the same s: the limits from before and from after.
std::vector<BoundarySample> samples_of(const Part& part);

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
