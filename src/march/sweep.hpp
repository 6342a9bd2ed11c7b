#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "march/path.hpp"
#include "rollfix/march.hpp"

namespace rollfix::march {

// When a search ends, for one finger and for two: Cases 1 and 2 of section 2.1 and Figure 6 converge alike.

/// The smallest limit that rounding errors of s leave room for.
inline constexpr double kLeastLimit = 1e-14;
/// Rounding errors of an advance of s or t, as a part of P: some sums of lengths of up to two loops.
inline constexpr double kLengthRounding = 4e-15;
/// Equations that hold to rounding over more than this part of P: a continuum.
inline constexpr double kContinuum = 1e-3;
/// A limit is good enough, where rounding prevents better, when the reset surely passes what was found.
inline constexpr double kPartOfReset = 0.25;
/// Two finds of one root differ by the estimated distances to it: by no more than this many limit tolerances.
inline constexpr double kSameRoot = 4;

/// When a limit counts as reached; lengths in the outline's unit.
struct LimitRule {
  double tolerance = 0;        // estimated distance to the limit
  double rounding = 0;         // advances below this are rounding errors
  double loosest = 0;          // estimated distance that will do once advances are rounding errors
  std::size_t iterations = 0;  // rounds before giving up
};

/// `limit` and `reset` are parts of the perimeter, as in the options.
inline LimitRule limit_rule(double limit, double reset, std::size_t iterations, double perimeter) {
  const double tolerance = limit * perimeter;
  const double loosest = std::fmax(tolerance, kPartOfReset * reset * perimeter);
  return {tolerance, kLengthRounding * perimeter, loosest, iterations};
}

/// How rounds towards a limit ended.
struct Approach {
  enum class End { going_on, limit, exit, stalled };  // exit: the interval, or the mode, ends before the limit
  End end = End::limit;
  std::size_t iterations = 0;
  double rate = 0;   // by which the distance shrank in the last round
  double error = 0;  // estimated distance to the limit
};

/// Lemma 2: the distance to the limit shrinks by `rate` per round, so that before an advance by `advance` it was about
/// advance / (1 - rate). Advances that are lost in rounding leave as much, on whichever side; a rate too near to 1 then
/// leaves more than the reset can pass.
inline Approach::End judge(double advance, double rate, const LimitRule& rule, double& error) {
  error = advance / (1 - rate);
  if (rate < 1 && error <= rule.tolerance) return Approach::End::limit;
  if (advance > rule.rounding) return Approach::End::going_on;
  error = rule.rounding / std::fabs(1 - rate);
  return error <= rule.loosest ? Approach::End::limit : Approach::End::stalled;
}

/// The sign that a search carries along: +1 or -1.
inline int side_of(double excess) { return excess < 0 ? -1 : 1; }

/// A simple zero of the density, the paper's z_i, or a joint at which its sign jumps.
struct SignChange {
  /// with length and integral from s = 0
  Position at;
  /// of the density just beyond it
  int sign_after = 1;
};

/// What section 2.2 computes once per shape, in one walk of T/h steps: the z_i, with the length l(z_1, z_i) and the
/// integral Phi(z_1, z_i) of each as differences of their sums from s = 0.
struct Preprocessed {
  Position front;                    // s = 0
  Position back;                     // s = P, at the end of the last step
  Span loop;                         // over the whole outline: P and the total integral
  double variation = 0;              // integral of |g|, to a few digits: what rounding errors are measured against
  int first_sign = 1;                // of g just after s = 0
  std::vector<SignChange> changes;   // in order, s in [0, P)
  std::vector<double> curve_starts;  // arc length at which each curve of the outline starts
};

/// Throws Refusal for what the paper excludes: see Reason.
Preprocessed preprocess(const Path& path);

/// The density's value at a point of a curve.
struct Sample {
  double u = 0;
  double density = 0;
};

/// The density along each curve, at a few points per step, both ends of the curve included.
struct Samples {
  std::vector<std::vector<Sample>> curves;
  double scale = 0;  // largest |g| over the outline
};

Samples sample(const Path& path);

/// A zero of the density, or a joint at which its sign jumps.
struct Zero {
  std::size_t curve = 0;
  double u = 0;
  int sign_after = 1;
  bool simple = true;  // false: the slope vanishes too, with or without a sign change
};

struct Zeros {
  std::vector<Zero> list;  // in order; one at the seam of a closed outline comes first
  int first_sign = 1;      // of the density just after s = 0
};

/// Every zero of the density that is wider than the samples' spacing, or whose dip shows in them. REQUIRES that the
/// density is not zero on a whole curve.
Zeros find_zeros(const Path& path, const Samples& samples);

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

  /// Both endpoints forward to the pair that starts at arc length `start`.
  void slide_to(double start) {
    s.to_length(start);
    t.to_length(start + problem.length);
  }
};

/// A stretch of starts on which g(s) and g(s + L) keep their signs: convex-convex (+, +), concave-concave (-, -),
/// convex-concave (+, -) or concave-convex (-, +). It ends with s at min(z_k, sigma^-1(z_{l+1})).
struct Mode {
  /// of g(s) on the whole mode, +1 or -1
  int sign_s = 1;
  /// of g(s + L)
  int sign_t = 1;
  /// arc length at which the mode ends for s
  double s_end = 0;
  double t_end = 0;                // sigma(s_end) = s_end + L
  std::optional<Position> s_mark;  // s_end, where it is known from preprocessing: a z_k
  std::optional<Position> t_mark;  // t_end, likewise

  /// Convex-concave or concave-convex: phi is monotone.
  bool mixed() const { return sign_s != sign_t; }

  /// Both endpoints to the mode's end. What is known from preprocessing costs no steps.
  void finish(Pair& pair) const;
};

/// Which case it is: Case 1 where rho(s_0) > L, else Case 2.
Found case_of(const Pair& pair, const Mode& mode);

/// Section 2.1's march on a mode whose signs agree, from the pair's place to the first root of phi(s) = C or to the
/// mode's end. In concave-concave mode the mirror image: g and C with their signs changed.
/// `sequence`: where to note s_i and t_i, or null.
Approach alternate(Pair& pair, const Mode& mode, const LimitRule& rule, std::vector<Iterate>* sequence);

/// Section 2.2: slides a segment of length L once along the boundary, mode by mode, and notes each place where its
/// integral equals C. A convex boundary is one mode, and the sweep is then section 2.1.
/// Adds segments, doubts and counts to `result`; starts as arc lengths in [0, P], ends not reduced to one loop.
void sweep(const Path& path, const Preprocessed& preprocessed, const Problem& problem, const Options& options,
           Result& result);

}  // namespace rollfix::march
