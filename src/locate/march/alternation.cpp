#include "rollfix/locate/march/alternation.hpp"

#include <cmath>

namespace rollfix::march {

namespace {

using End = Alternation::End;

/// What one round of a case came to.
enum class Round { going_on, limit, mode_end, stalled };

/// Lemma 2: the distance to the limit shrinks by `rate` per round, so that before an advance by `advance` it was about
/// advance / (1 - rate). Advances that are lost in rounding leave as much, on whichever side; a rate too near to 1 then
/// leaves more than the reset can pass.
Round judge(double advance, double rate, const LimitRule& rule, double& error) {
  error = advance / (1 - rate);
  if (rate < 1 && error <= rule.tolerance) return Round::limit;
  if (advance > rule.rounding) return Round::going_on;
  error = rule.rounding / std::fabs(1 - rate);
  return error <= rule.loosest ? Round::limit : Round::stalled;
}

/// The mode's end is known from preprocessing, and the target lies beyond it: no need to go and see.
bool beyond(const std::optional<Position>& mark, double target, int sign) {
  return mark && sign * (target - mark->here.integral) > 0;
}

/// Case 1, rho(s_i) > L: t_i = s_i + rho(s_i); s_{i+1} = t_i - L.
Round case_1(Pair& pair, const Mode& mode, const LimitRule& rule, Alternation& result) {
  const double target = pair.s.integral() + pair.problem.integral;
  if (beyond(mode.t_mark, target, mode.sign_t)) return Round::mode_end;
  if (!pair.t.to_integral(target, mode.sign_t, mode.t_end)) return Round::mode_end;  // Phi(s_i, t_i) = theta
  const double next = pair.t.length() - pair.problem.length;
  const double advance = next - pair.s.length();
  pair.s.to_length(next);
  result.rate = pair.s.density() / pair.t.density();
  return judge(advance, result.rate, rule, result.error);
}

/// Case 2, rho(s_i) < L: t_i = s_i + L; Phi(s_{i+1}, t_i) = theta.
Round case_2(Pair& pair, const Mode& mode, const LimitRule& rule, Alternation& result) {
  const double target = pair.t.integral() - pair.problem.integral;
  const double before = pair.s.length();
  if (beyond(mode.s_mark, target, mode.sign_s)) return Round::mode_end;
  if (!pair.s.to_integral(target, mode.sign_s, mode.s_end)) return Round::mode_end;  // Phi(s_{i+1}, t_i) = theta
  pair.t.to_length(pair.s.length() + pair.problem.length);
  result.rate = pair.t.density() / pair.s.density();
  return judge(pair.s.length() - before, result.rate, rule, result.error);
}

End end_of(Round round) {
  switch (round) {
    case Round::limit:
      return End::limit;
    case Round::mode_end:
      return End::mode_end;
    default:
      return End::stalled;
  }
}

}  // namespace

Alternation alternate(Pair& pair, const Mode& mode, const LimitRule& rule, std::vector<Iterate>* sequence) {
  Alternation result;
  const bool falls_short = mode.sign_s * pair.excess() < 0;  // rho(s_0) > L
  result.found = falls_short ? Found::case_1 : Found::case_2;
  Round round = Round::going_on;
  while (round == Round::going_on && result.iterations < rule.iterations) {
    Iterate iterate{pair.s.length(), pair.t.length()};
    round = falls_short ? case_1(pair, mode, rule, result) : case_2(pair, mode, rule, result);
    if (falls_short) iterate.end = pair.t.length();
    if (sequence != nullptr) sequence->push_back(iterate);
    ++result.iterations;
  }
  result.end = end_of(round);
  return result;
}

}  // namespace rollfix::march
