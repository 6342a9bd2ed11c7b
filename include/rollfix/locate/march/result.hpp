#pragma once

#include <cstddef>
#include <vector>

#include "rollfix/outline/curve.hpp"

namespace rollfix::march {

/// How a segment was found.
enum class Found {
  case_1,     // s and t alternate, the integral over [s, s + L] being short of C
  case_2,     // ... being beyond C
  bisection,  // in a mode in which the integral is monotone
  boundary    // at the end of a mode, or at an end of an open curve
};

/// One round of Case 1 or Case 2: the paper's s_i and t_i, as arc lengths. On a closed outline t_i may exceed P.
struct Iterate {
  double start = 0;
  double end = 0;
};

/// One of the paper's z_i: where the density changes its sign.
struct Breakpoint {
  double s = 0;         // arc length
  double integral = 0;  // of the density over [0, s]
  int sign_after = 1;   // of the density
};

/// An answer: the boundary from `start` to `end` has the length L and the integral C.
struct Segment {
  double start = 0;            // s, in [0, P) when closed, in [0, P] when open
  double end = 0;              // s + L, likewise
  double integral_error = 0;   // |integral over the segment - C|; radians for readings
  double error = 0;            // estimated distance of `start` from the true root, length
  double rate = 0;             // Lemma 2's factor at the last round: kappa(s)/kappa(t) or its inverse; 0 by bisection
  std::size_t iterations = 0;  // rounds, or halvings, since the last mode change or reset
  Found found = Found::case_1;
  std::vector<Iterate> sequence;  // s_0, t_0, s_1, t_1, ... when Options::record is set. For negative L on an open
                                  // outline: of the equivalent problem with -L and -C that starts at the other end
};

/// A stretch of starts on which the march can't vouch for its answer: one of the two holes of the paper's algorithm.
struct Doubt {
  enum class Why {
    slow,   // the limit was not reached within Options::iterations: the rate tends to 1 at a double root
    jumped  // the reset passed over an even number of roots
  };
  Why why = Why::slow;
  Interval where;              // of s
  std::size_t iterations = 0;  // rounds that were spent
  double residual = 0;         // |integral over the segment - C| at where.lo
};

/// Counted work. A step is one numerical increment: an endpoint passes from one step of the curve's parameter into the
/// next, and both integrals are extended by quadrature over it. T/h of them make one loop.
struct Steps {
  std::size_t choosing = 0;       // to choose h and to estimate its error; once per outline and density
  std::size_t preprocessing = 0;  // one walk round the outline; once per outline and density
  std::size_t start = 0;          // the paper's m: to obtain t_0
  std::size_t marching = 0;       // by s and t, in all modes
  std::size_t bisection = 0;      // in the mixed modes, after both ends have been evaluated
  std::size_t landings = 0;       // not steps: an endpoint was placed inside a step, on a length or on an integral
  std::size_t refinements = 0;    // not steps: quadratures over a part of a step that the landings took

  /// What Theorem 5 bounds.
  std::size_t total() const { return preprocessing + start + marching + bisection; }
};

struct Result {
  std::vector<Segment> segments;  // ordered as they were met: by start, but for a negative L on an open outline
  std::vector<Doubt> doubts;      // empty: every segment is listed, up to the reset amount
  std::size_t found_again = 0;    // times that a reset fell short and the same root was converged to once more
  std::size_t iterations = 0;     // all rounds and halvings
  Steps steps;
  double perimeter = 0;            // P
  double total_integral = 0;       // over the whole outline
  double parameter_range = 0;      // the paper's T
  double length_error = 0;         // of the quadrature, estimated, over one loop
  double integral_error = 0;       // likewise, of the density's integral
  double step = 0;                 // the paper's h (the mean over the outline)
  std::size_t steps_per_loop = 0;  // T/h

  bool complete() const { return doubts.empty(); }
};

/// Each default is in parts of the perimeter where it is a length, so that no unit is presumed.
struct Options {
  double step = 0;       // h, in the curves' parameter; 0: the largest that integrates each step to rounding
  double limit = 1e-11;  // the limit counts as reached when the estimated distance to it is below this part of P
  double reset = 1e-8;  // the "very small positive amount" after a find, as a part of P; above `limit`, or finds repeat
  std::size_t iterations = 100000;  // rounds per limit before it is given up as a double root
  bool record = false;              // keep the sequences s_i, t_i
};

}  // namespace rollfix::march
