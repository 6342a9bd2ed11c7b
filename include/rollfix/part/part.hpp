#pragma once

#include <cstddef>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "rollfix/outline/outline.hpp"
#include "rollfix/part/turning_function.hpp"

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
/// InputError as that does and as Part does. Drawings, saved parts, and options: rollfix/files/load_part.hpp.
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

}  // namespace rollfix
