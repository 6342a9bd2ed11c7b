#include "roots.hpp"

#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>

namespace rollfix {
namespace {

using chebyshev::Series;

// Two sign changes closer together than this share of a panel are a double root: no change at all.
constexpr double kNarrow = 1e-8;

double value(const Series& powers, double x) {
  double sum = 0;
  for (Eigen::Index k = powers.size() - 1; k >= 0; --k) sum = sum * x + powers[k];
  return sum;
}

/// The same polynomial around x = centre (Horner's scheme, repeated).
Series shifted(Series powers, double centre) {
  const Eigen::Index count = powers.size();
  for (Eigen::Index first = 0; first + 1 < count; ++first) {
    for (Eigen::Index k = count - 2; k >= first; --k) powers[k] += centre * powers[k + 1];
  }
  return powers;
}

void search(const Series& powers, double lo, double hi, std::vector<double>& found) {
  const double half = 0.5 * (hi - lo);
  const Series local = shifted(powers, lo + half);
  double reach = 0;        // how far the polynomial gets from its middle value
  double slope_reach = 0;  // and its slope
  double power = half;
  for (Eigen::Index k = 1; k < local.size(); ++k, power *= half) {
    reach += std::abs(local[k]) * power;
    if (k > 1) slope_reach += static_cast<double>(k) * std::abs(local[k]) * power / half;
  }
  if (std::abs(local[0]) > reach) return;
  const bool monotone = local.size() > 1 && std::abs(local[1]) > slope_reach;
  if (!monotone && half > kNarrow) {
    search(powers, lo, lo + half, found);
    search(powers, lo + half, hi, found);
    return;
  }
  const double before = value(powers, lo);
  const double after = value(powers, hi);
  if ((before < 0) == (after < 0) || before == 0) return;  // a zero at lo was the end of the interval before
  if (after == 0) {
    if (hi < 1) found.push_back(hi);
    return;
  }
  std::uintmax_t rounds = 100;
  const auto bracket = boost::math::tools::toms748_solve([&](double x) { return value(powers, x); }, lo, hi, before,
                                                         after, boost::math::tools::eps_tolerance<double>(52), rounds);
  found.push_back(0.5 * (bracket.first + bracket.second));
}

}  // namespace

std::vector<double> sign_changes(const Series& powers) {
  std::vector<double> found;
  if (powers.size() > 1) search(powers, -1, 1, found);
  return found;
}

}  // namespace rollfix
