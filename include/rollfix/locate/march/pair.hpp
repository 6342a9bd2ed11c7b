#pragma once

#include "rollfix/locate/march/walker.hpp"

namespace rollfix::march {

/// The problem after its reduction: 0 < length < P on a closed outline, 0 < length <= P on an open one.
struct Problem {
  double length = 0;    // L
  double integral = 0;  // C
};

/// The hypothesized segment's two endpoints. t = s + L whenever none of the two is being advanced.
struct Pair {
  Walker s;
  Walker t;
  Problem problem;

  /// phi(s) - C, where phi(s) is the integral over [s, s + L].
  double excess() const { return t.integral() - s.integral() - problem.integral; }
  /// phi'(s) = g(t) - g(s).
  double slope() const { return t.density() - s.density(); }

  void slide_to(double start) {
    s.to_length(start);
    t.to_length(start + problem.length);
  }
};

/// The sign that the march carries along: +1 or -1.
inline int side_of(double excess) { return excess < 0 ? -1 : 1; }

}  // namespace rollfix::march
