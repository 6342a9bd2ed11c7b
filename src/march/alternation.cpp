#include "march/sweep.hpp"

// Notation (section 2.1; docs/march.md, "Convex boundary: Cases 1 and 2")
//   s_i, t_i    the march's two sequences: `pair.s`, `pair.t`, arc lengths; the segment is [s_i, t_i]
//   L, theta    the segment wanted: `problem.length`, and `problem.integral`, C for a general density
//   rho(s)      length of the segment from s on that has total curvature theta; found by `to_integral`, never stored
//   kappa       curvature, or another density: `density()`; a, b are the ends of the segment that is found
// Idea: s and t move in turn, each until one of equations (4) and (5) holds; Lemma 1 has both grow towards a and b
// without passing them, Lemma 2 says how fast, and Proposition 3 that the limit is the first segment that fits.

namespace rollfix::march {

namespace {

using End = Approach::End;

/// The mode's end is known from preprocessing, and the target lies beyond it: no need to go and see.
bool beyond(const std::optional<Position>& mark, double target, int sign) {
  return mark && sign * (target - mark->here.integral) > 0;
}

/// Case 1, rho(s_i) > L: t_i = s_i + rho(s_i); s_{i+1} = t_i - L.
End case_1(Pair& pair, const Mode& mode, const LimitRule& rule, Approach& result) {
  const double target = pair.s.integral() + pair.problem.integral;
  if (beyond(mode.t_mark, target, mode.sign_t)) return End::exit;
  if (!pair.t.to_integral(target, mode.sign_t, mode.t_end)) return End::exit;  // Phi(s_i, t_i) = theta
  const double next = pair.t.length() - pair.problem.length;                   // s_{i+1} = t_i - L
  // >= 0 by Lemma 1: phi(s_i) is short of C, so that t_i lies beyond s_i + L.
  const double advance = next - pair.s.length();
  pair.s.to_length(next);
  result.rate = pair.s.density() / pair.t.density();  // Lemma 2: kappa(a) / kappa(b)
  return judge(advance, result.rate, rule, result.error);
}

/// Case 2, rho(s_i) < L: t_i = s_i + L; Phi(s_{i+1}, t_i) = theta.
End case_2(Pair& pair, const Mode& mode, const LimitRule& rule, Approach& result) {
  const double target = pair.t.integral() - pair.problem.integral;
  const double before = pair.s.length();
  if (beyond(mode.s_mark, target, mode.sign_s)) return End::exit;
  if (!pair.s.to_integral(target, mode.sign_s, mode.s_end)) return End::exit;  // Phi(s_{i+1}, t_i) = theta
  pair.t.to_length(pair.s.length() + pair.problem.length);                     // t_{i+1} = s_{i+1} + L
  result.rate = pair.t.density() / pair.s.density();                           // Lemma 2: kappa(b) / kappa(a)
  return judge(pair.s.length() - before, result.rate, rule, result.error);
}

}  // namespace

void Mode::finish(Pair& pair) const {
  if (s_mark) {
    pair.s.jump(*s_mark);
  } else {
    pair.s.to_length(s_end);
  }
  if (t_mark) {
    pair.t.jump(*t_mark);
  } else {
    pair.t.to_length(t_end);
  }
}

Found case_of(const Pair& pair, const Mode& mode) {
  return mode.sign_s * pair.excess() < 0 ? Found::case_1 : Found::case_2;
}

/// The case holds for the whole approach: s_{i+1} never passes the root, so that phi - C keeps its sign.
Approach alternate(Pair& pair, const Mode& mode, const LimitRule& rule, std::vector<Iterate>* sequence) {
  Approach result{End::going_on};
  const bool falls_short = case_of(pair, mode) == Found::case_1;
  while (result.end == End::going_on && result.iterations < rule.iterations) {
    Iterate iterate{pair.s.length(), pair.t.length()};
    result.end = falls_short ? case_1(pair, mode, rule, result) : case_2(pair, mode, rule, result);
    if (falls_short) iterate.end = pair.t.length();
    if (sequence != nullptr) sequence->push_back(iterate);
    ++result.iterations;
  }
  if (result.end == End::going_on) result.end = End::stalled;
  return result;
}

}  // namespace rollfix::march
