#pragma once

#include <optional>
#include <vector>

#include "march/limit.hpp"
#include "march/path.hpp"
#include "march/preprocessing.hpp"
#include "rollfix/march.hpp"

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
