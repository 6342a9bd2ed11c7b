#include "rollfix/locate/march/correspondence.hpp"

#include <algorithm>
#include <cmath>

namespace rollfix::march {

void Correspondence::follow_with_s(StartsOfBoth& at) const {
  at.a.move_to_value(0, at.b.phi(0) + at.problem->theta[0], 1, y());
}

void Correspondence::follow_with_t(StartsOfBoth& at) const {
  at.b.move_to_value(0, at.a.phi(0) - at.problem->theta[0], 1, z());
}

void Correspondence::move_s_to(StartsOfBoth& at, double s) const {
  at.a.move_to(s);
  follow_with_t(at);
}

void Correspondence::move_t_to(StartsOfBoth& at, double t) const {
  at.b.move_to(t);
  follow_with_s(at);
}

Correspondence::Rates Correspondence::rates(const StartsOfBoth& at) const {
  const double one = std::fabs(at.a.slope(0));
  const double three = std::fabs(at.b.slope(0));
  Rates rates;
  rates.ds = one <= three ? 1 : three / one;
  rates.dt = one > three ? 1 : (three > 0 ? one / three : 1);
  rates.phi_2 = std::fabs(at.a.slope(1)) * rates.ds;
  rates.phi_4 = std::fabs(at.b.slope(1)) * rates.dt;
  return rates;
}

double Correspondence::slope(const StartsOfBoth& at) const {
  const Rates along = rates(at);
  return trend_2 * along.phi_2 - trend_4 * along.phi_4;
}

/// Whatever the trends, phi_1 grows from the bottom of the interval of s to its top, and phi_3 likewise. Below, the
/// correspondence begins at the higher of both bottoms, and the other start goes up to it; above, it ends at the lower
/// of both tops, and the other start comes down to it: two cases at each end, and two trends of each phi, are sixteen.
std::optional<Correspondence> correspond(const MonotoneInterval& i, const MonotoneInterval& j,
                                         const PairProblem& problem, Tally& tally) {
  const double theta = problem.theta[0];
  const double lowest_1 = i.bottom().phi(0);
  const double highest_1 = i.top().phi(0);
  const double lowest_3 = j.bottom().phi(0) + theta;
  const double highest_3 = j.top().phi(0) + theta;
  if (std::max(lowest_1, lowest_3) > std::min(highest_1, highest_3) + problem.rounding) return std::nullopt;

  const StartsOfBoth bottoms = StartsOfBoth{i.bottom(), j.bottom(), &problem}.counted_by(tally);
  const StartsOfBoth tops = StartsOfBoth{i.top(), j.top(), &problem}.counted_by(tally);
  Correspondence found{bottoms, tops, i.second_along_first(), j.second_along_first()};
  if (lowest_1 > lowest_3) {
    found.begin.b.move_to_value(0, lowest_1 - theta, 1, tops.b.s());  // Figure 5: x is an end, t goes up to w
  } else {
    found.begin.a.move_to_value(0, lowest_3, 1, tops.a.s());
  }
  if (highest_1 > highest_3) {
    found.end.a.move_to_value(0, highest_3, -1, bottoms.a.s());  // Figure 5: z is an end, s comes down to y
  } else {
    found.end.b.move_to_value(0, highest_1 - theta, -1, bottoms.b.s());
  }
  return found;
}

}  // namespace rollfix::march
