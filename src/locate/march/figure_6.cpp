#include "rollfix/locate/march/figure_6.hpp"

#include <algorithm>
#include <cmath>

namespace rollfix::march {

namespace {

/// s moves to where phi_2(x_{i+1}) = phi_4(w_i) + theta_2, and t follows by (8). False: y comes first.
bool round_with_s_first(StartsOfBoth& at, const Correspondence& way) {
  const double target = at.b.phi(1) + at.problem->theta[1];
  if (way.trend_2 * (target - way.end.a.phi(1)) > 0) return false;  // no need to go and see
  if (!at.a.move_to_value(1, target, way.trend_2, way.y())) return false;
  way.follow_with_t(at);
  return true;
}

/// Figure 6 as printed: t moves to where phi_4(w_{i+1}) + theta_2 = phi_2(x_i), and s follows by (8).
bool round_with_t_first(StartsOfBoth& at, const Correspondence& way) {
  const double target = at.a.phi(1) - at.problem->theta[1];
  if (way.trend_4 * (target - way.end.b.phi(1)) > 0) return false;
  if (!at.b.move_to_value(1, target, way.trend_4, way.z())) return false;
  way.follow_with_s(at);
  return true;
}

/// With s first, the distance to the limit shrinks by the factor d phi_4 / d phi_2 along the correspondence; with t
/// first by its inverse. What an advance leaves is as in Lemma 2.
double shrinking(const StartsOfBoth& at, const Correspondence& way, bool s_first) {
  const Correspondence::Rates rates = way.rates(at);
  return s_first ? rates.phi_4 / rates.phi_2 : rates.phi_2 / rates.phi_4;
}

/// Whether the limit is reached after an advance, or out of reach.
bool judge(double advance, const LimitRule& rule, Figure6& result) {
  result.error = advance / (1 - result.rate);
  if (result.rate < 1 && result.error <= rule.tolerance) return true;
  if (advance > rule.rounding) return false;
  result.error = rule.rounding / std::fabs(1 - result.rate);
  if (!(result.error <= rule.loosest)) result.end = Figure6::End::stalled;
  return true;
}

}  // namespace

Figure6 iterate(StartsOfBoth& at, const Correspondence& way, const LimitRule& rule) {
  Figure6 result;
  const bool s_first = s_moves_first(at, way);
  while (result.iterations < rule.iterations) {
    const double s = at.a.s();
    const double t = at.b.s();
    ++result.iterations;
    if (!(s_first ? round_with_s_first(at, way) : round_with_t_first(at, way))) {
      result.end = Figure6::End::exit;
      return result;
    }
    result.rate = shrinking(at, way, s_first);
    if (judge(std::max(std::fabs(at.a.s() - s), std::fabs(at.b.s() - t)), rule, result)) return result;
  }
  result.end = Figure6::End::stalled;
  return result;
}

}  // namespace rollfix::march
