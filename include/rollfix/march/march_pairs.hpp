#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "rollfix/contact/reading.hpp"
#include "rollfix/march/march.hpp"
#include "rollfix/outline/outline.hpp"

namespace rollfix::march {

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
