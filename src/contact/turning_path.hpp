#pragma once

#include <vector>

#include "contact/turning_nodes.hpp"
#include "outline/turning_span.hpp"

namespace rollfix {

/// Theta over a whole roll, run by run, each starting where the one before ends.
using TurningCourse = std::vector<TurningNodes>;

/// The curve that turns like this.
struct TurningPath {
  std::vector<TurningSpan> spans;
  std::vector<double> s;    // where each span starts
  std::vector<Vec2> point;  // there, and at the end

  double end() const { return s.back() + spans.back().domain().hi; }
  Vec2 gap() const { return point.front() - point.back(); }
  /// The diagonal of the box around the spans' ends.
  double size() const;
};

TurningPath path_of(const TurningCourse& course, const Vec2& start);

/// A node at this place as well; the cubics stay what they are.
void split_at(TurningNodes& nodes, double place);

/// What closed a course.
struct Closure {
  bool closed = false;
  double correction = 0;  // the largest change of Theta, radians
};

/// Changes Theta by as little as possible in the mean square so that the path ends where it starts: by
/// a sin Theta + b cos Theta, which are the gap's derivatives by Theta. Newton's method on a and b.
Closure close_gap(TurningCourse& course);

}  // namespace rollfix
