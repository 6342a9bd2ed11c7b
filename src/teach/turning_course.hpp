#pragma once

#include <cstddef>
#include <vector>

#include "outline/turn.hpp"
#include "rollfix/reading.hpp"

namespace rollfix::teaching {

/// Rows of a roll between two corners (or ends): the tangent's angle by arc length.
struct TurningRun {
  double lo = 0;  // arc lengths of the corners or ends, in the log's unit
  double hi = 0;
  std::vector<double> s;      // rising, within [lo, hi]
  std::vector<double> angle;  // Theta of each row, radians, unwrapped
  double lo_between = 0;      // the corner at lo lies between two rows so far apart; 0: rows pivot there
  // Of noisy rows, where several passes of a roll lie over one another:
  std::vector<int> pass{};     // which pass each row is of, from 0
  std::vector<double> ramp{};  // how much of the drift of a lap it has: 0 at the roll's start, 1 a lap later
};

/// A roll cut at its corners. Each run ends where the next begins.
struct TurningRuns {
  std::vector<TurningRun> runs;
  bool starts_at_corner = false;  // the roll starts while the finger pivots
  bool ends_at_corner = false;    // the same of its end

  double length() const { return runs.back().hi - runs.front().lo; }
};

/// What tells a corner from a bend.
struct PivotLimits {
  double length = 0;        // rows closer together than this are at one place; ...
  double turn = 0;          // ... where they turn by this, radians, that is a corner
  double corner_angle = 0;  // radians: a turn of this size between neighbouring rows is a corner
};

/// Cuts readings, in the direction of growing length, at the corners. Rows at one place are averaged, or, where they
/// turn, are a corner. Throws InputError when a length falls by more than the limit.
TurningRuns turning_runs(const std::vector<Reading>& readings, const PivotLimits& limits);

/// The part of it up to a length.
TurningRuns cut_at(const TurningRuns& runs, double length);

/// Theta(s) between two corners as a cubic between each two nodes, from its values and slopes there.
struct TurningNodes {
  std::vector<double> s;      // of the nodes, rising
  std::vector<double> angle;  // Theta there, radians
  std::vector<double> slope;  // its derivative, the curvature

  /// The cubic after node k, by arc length from there.
  TurningSpan::Cubic cubic(std::size_t k) const;
  /// The one at this place; beyond the ends the first or the last.
  std::size_t cubic_at(double place) const;
  /// Theta, radians, and its slope; beyond the ends the outer cubics go on.
  double at(double place) const;
  double slope_at(double place) const;

  /// A node behind the last one; the vector holds Theta and its slope.
  void add(double place, const Vec2& value_and_slope);
};

/// Theta over a whole roll, run by run, each starting where the one before ends.
using TurningCourse = std::vector<TurningNodes>;

/// The curve that turns like this.
struct TurningPath {
  std::vector<TurningSpan> spans;
  std::vector<double> s;    // where each span starts
  std::vector<Vec2> point;  // there, and at the end

  /// Arc length at the path's end.
  double end() const { return s.back() + spans.back().domain().hi; }
  /// From the path's end to its start, in the log's unit; 0 where it is closed.
  Vec2 gap() const { return point.front() - point.back(); }
  /// The diagonal of the box around the spans' ends.
  double size() const;
};

/// The path of this course from a point on, without any closing.
TurningPath path_of(const TurningCourse& course, const Vec2& start);

/// A node at this place as well; the cubics stay what they are.
void split_at(TurningNodes& nodes, double place);

/// What closed a course.
struct Closure {
  bool closed = false;    // the gap is below rounding
  double correction = 0;  // no change of Theta is larger, radians
};

/// Changes Theta by as little as possible in the mean square so that the path ends where it starts: by
/// a sin Theta + b cos Theta, which are the gap's derivatives by Theta. Newton's method on a and b.
Closure close_gap(TurningCourse& course);

}  // namespace rollfix::teaching
