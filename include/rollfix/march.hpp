#pragma once

// The paper's own algorithms, by numerical integration: the reference that the faster search is compared with.
//
//     const march::March march(load_outline("gallery:limacon"), march::curvature_density());
//     march.segments(1.0, 0.5).segments.size();  // 2
//
// Degenerate cases: corners, lines, arcs and continua are a Refusal with its Reason; `rollfix::locate` handles them.
//
// Accuracy: each segment's `error` is its estimated distance to the root; docs/march.md has counted steps and two holes
// of the algorithm.

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "rollfix/curve.hpp"
#include "rollfix/error.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/reading.hpp"

/// The paper's one-finger algorithms as the paper has them (section 2, eq. (6), section 5), by numerical integration
/// along the parametric curve at step h: the reference that the production search is compared with. Use rollfix::locate
/// for anything else. docs/march.md derives the algorithm and shows its counted steps and its two holes.
namespace rollfix::march {

/// A point of an outline, as its curves are parametrized.
struct Site {
  std::size_t curve = 0;  // index into Outline::curves
  double u = 0;           // that curve's own parameter
  const Jet& jet;         // position and derivatives there
};

/// What is integrated along the boundary: a function of the place, per unit of arc length. Analytic on each curve of
/// the outline; it may jump where two curves meet.
using DensityFunction = std::function<double(const Site&)>;

/// A density g together with what its zeros are called. The march knows nothing else of the problem: it looks for the
/// segments of length L over which the integral of g equals C.
///
///   problem                          g        C       sign changes of g
///   section 2, eqs. (4) and (5)      kappa    theta   inflections
///   stationary points of phi, eq. (6) kappa'  0       vertices
///   section 5                        f        C       sign changes of f
struct Density {
  enum class Kind { curvature, curvature_rate, other };

  Kind kind = Kind::other;
  std::string name;       // for messages: "the curvature"
  std::string zero_name;  // for messages: "inflection"
  DensityFunction per_length;
};

/// kappa: its integral over [s, t] is the total curvature Phi(s, t).
Density curvature_density();

/// kappa' = d kappa / ds: its integral over [s, t] is kappa(t) - kappa(s).
Density curvature_rate_density();

/// Any f of section 5. `f` is per unit of arc length: to integrate by a curve's own parameter, divide by the speed.
Density density(DensityFunction f, std::string name = "f");

/// What the paper's marching algorithms are not made for.
enum class Reason {
  corner,           // the tangent jumps where two curves meet
  line,             // the curvature is zero on a whole curve
  arc,              // the curvature is constant on a whole curve
  zero_density,     // another density is zero on a whole curve
  degenerate_zero,  // the density is zero with a zero slope: not a simple inflection, not a simple vertex
  curvature_jump,   // the curvature jumps where two curves meet, so that eq. (6) is not an integral of kappa'
  continuum,        // the integral over length L equals C on an interval of starts
  unresolved        // the automatic step can not become small enough: a near cusp
};

/// The march does not answer, and says why and where. The production search (rollfix::locate) handles all of these.
class Refusal : public InputError {
 public:
  Refusal(Reason reason, double where, const std::string& message)
      : InputError(message), reason_(reason), where_(where) {}

  Reason reason() const { return reason_; }
  double where() const { return where_; }  // arc length of the place, or of the start of the curve, in question

 private:
  Reason reason_;
  double where_;
};

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

/// An outline prepared for any number of questions about one density: the paper's one-time overhead for a part shape.
/// Immutable; copies share their data; safe to use from any number of threads.
class March {
 public:
  /// Throws Refusal for an outline that section 2 excludes, InputError for options out of range or no curves.
  March(const Outline& outline, const Density& density, const Options& options = {});

  /// Every segment of signed length L over which the density's integral equals C, from s to s + L. On a closed outline
  /// L may have any size. On an open one |L| <= P, and only segments that lie on it count.
  /// Throws Refusal where a continuum of segments fits; InputError for numbers that are not finite and lengths that do
  /// not fit on an open outline.
  Result segments(double length, double integral) const;

  /// What preprocessing found: inflections, vertices, or sign changes of f, in order.
  std::vector<Breakpoint> breakpoints() const;

 private:
  struct Data;
  std::shared_ptr<const Data> data_;
};

/// Section 2: all segments with length L and total curvature theta.
Result locate(const Outline& outline, const Reading& reading, const Options& options = {});

/// Eq. (6): all stationary points of phi(s) = Phi(s, s + L), that is kappa(s + L) = kappa(s).
Result stationary_points(const Outline& outline, double length, const Options& options = {});

/// Section 5: all segments of length L over which the integral of f (per unit of arc length) equals C.
Result segments_with_integral(const Outline& outline, const DensityFunction& f, double length, double integral,
                              const Options& options = {});

/// How a pair of starts was found.
enum class PairFound {
  bisection,  // phi_2 and phi_4 go opposite ways
  iteration,  // phi_2 and phi_4 go the same way: Figure 6
  boundary    // at (x, w) or (y, z), to rounding
};

/// An answer: s_0 of finger a and t_0 of finger b satisfy (8) and (9).
struct StartPair {
  double s = 0;                // in [0, P)
  double t = 0;                // in [0, P)
  double error = 0;            // estimated distance of each of them from the true one, length
  double residual_8 = 0;       // |phi_1(s) - phi_3(t) - theta_1|, radians
  double residual_9 = 0;       // |phi_2(s) - phi_4(t) - theta_2|, radians
  double rate = 0;             // by which the distance shrank in the last round; 0 but for the iteration
  std::size_t iterations = 0;  // rounds, or halvings
  PairFound found = PairFound::iteration;
};

/// Where the algorithm can't vouch for its answer: pairs with s and t in these stretches may be missing.
struct PairDoubt {
  enum class Why {
    slow,        // no limit within the allowed rounds: the rate tends to 1 at a double pair
    jumped,      // the reset passed over an even number of pairs
    stationary,  // eq. (6): the march doubts a stationary point there, so phi may not be monotone
  };
  Why why = Why::slow;
  Interval s;                  // lo in [0, P)
  Interval t;                  // likewise
  std::size_t iterations = 0;  // rounds that were spent
  double residual = 0;         // |phi_2(s) - phi_4(t) - theta_2| at the beginning, radians
};

/// Counted work. A step is what it is for one finger: an endpoint (of the three that belong to each finger) passes
/// from one step of the curve's parameter into the next, either way.
struct PairSteps {
  std::size_t choosing = 0;       // to choose h; once per outline
  std::size_t preprocessing = 0;  // of the march for eq. (6); once per outline
  std::size_t stationary = 0;     // section 3.1: the marches for the stationary points of phi_1 ... phi_4
  std::size_t evaluation = 0;     // section 3.1: one round for each finger to evaluate phi at the a_i and b_j
  std::size_t subintervals = 0;   // section 3.2: to obtain x, y, w and z
  std::size_t iteration = 0;      // section 3.2: by s and t in the iteration of Figure 6
  std::size_t bisection = 0;      // section 3.2: by s and t in the bisections
  std::size_t landings = 0;       // not steps: a point was placed inside a step, on a length or on a phi
  std::size_t refinements = 0;    // not steps: quadratures that the landings took

  /// What the worst case of section 3.2 is about.
  std::size_t rectangles() const { return subintervals + iteration + bisection; }
  std::size_t total() const { return preprocessing + stationary + evaluation + rectangles(); }
};

struct PairResult {
  std::vector<StartPair> pairs;      // ordered by s, then t
  std::vector<PairDoubt> doubts;     // empty: every pair is listed, up to the reset amount
  std::vector<double> stationary_a;  // a_0 ... a_{n-1}: of phi_1 and phi_2, in order, s in [0, P)
  std::vector<double> stationary_b;  // b_0 ... b_{m-1}: of phi_3 and phi_4
  std::size_t merged = 0;            // stationary points of both functions of a finger that are one a_i or b_j
  std::size_t rectangles = 0;        // n m, the pairs of intervals
  std::size_t rejected = 0;          // by I_i and J_j having nothing in common
  std::size_t examined = 0;          // the others
  std::size_t bisections = 0;        // of the examined: phi_2 and phi_4 go opposite ways
  std::size_t found_again = 0;       // finds that are one pair, of neighbouring rectangles mostly
  std::size_t iterations = 0;        // all rounds and halvings
  PairSteps steps;
  double perimeter = 0;            // P
  std::size_t steps_per_loop = 0;  // T/h

  std::size_t n() const { return stationary_a.size(); }
  std::size_t m() const { return stationary_b.size(); }
  bool complete() const { return doubts.empty(); }
};

/// Which of s and t the iteration of Figure 6 moves first in a round.
enum class MoveOrder {
  towards_root,  // the one that has to go forward: docs/march.md derives it from the sign of (9)
  printed        // always t, as the paper's figure has it: loses pairs; for demonstration
};

/// Lengths are in parts of the perimeter, so that no unit is presumed.
struct PairMarchOptions {
  double step = 0;       // h, in the curves' parameter; 0: the largest that integrates each step to rounding
  double limit = 1e-11;  // the limit counts as reached when the estimated distance to it is below this part of P
  double reset = 1e-8;   // the "small amount" to pass by a pair, as a part of P; above `limit`
  std::size_t iterations = 20000;  // rounds per limit before it is given up as a double pair
  std::size_t budget = 300000;     // rounds and halvings in all, after which every limit gets 500 rounds only
  MoveOrder order = MoveOrder::towards_root;
};

/// Section 3, two rolling fingers on a part that is free to move, as the paper has it: the reference for the production
/// search. Prepared for one closed outline and any number of readings. Immutable; copies share their data; safe to use
/// from any number of threads. docs/march.md derives what the paper leaves open.
class PairMarch {
 public:
  /// Throws Refusal for an outline that eq. (6) excludes, InputError for an open one or options out of range.
  explicit PairMarch(const Outline& outline, const PairMarchOptions& options = {});

  /// Every (s_0, t_0) that satisfies (8) with the first reading and (9) with the second. Lengths have either sign and
  /// any size. Throws Refusal (continuum) where one of the four phi is constant or a curve of pairs fits, InputError
  /// for numbers that are not finite.
  PairResult pairs(const Reading& first, const Reading& second) const;

 private:
  struct Data;
  std::shared_ptr<const Data> data_;
};

/// The same for one question.
PairResult locate_pairs(const Outline& outline, const Reading& first, const Reading& second,
                        const PairMarchOptions& options = {});

}  // namespace rollfix::march
