#pragma once

#include <cmath>
#include <cstddef>

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

}  // namespace rollfix::march
