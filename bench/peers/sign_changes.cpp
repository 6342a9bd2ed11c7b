#include "sign_changes.hpp"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cstdint>

namespace bench {

using namespace rollfix;

std::vector<double> locate_by_sign_changes(const Part& part, const Reading& reading, std::size_t samples) {
  const TurningFunction& turning = part.turning();
  const double length = reading.length[0];
  const auto f = [&](double s) { return turning.angle(s + length) - turning.angle(s) - reading.turn; };
  const double lo = part.closed() ? 0 : std::max(0.0, -length);
  const double hi = part.perimeter() - (part.closed() ? 0 : std::max(0.0, length));
  std::vector<double> found;
  double left = lo;
  double at_left = f(left);
  for (std::size_t k = 1; k <= samples; ++k) {
    const double right = lo + (hi - lo) * static_cast<double>(k) / static_cast<double>(samples);
    const double at_right = f(right);
    if (at_left == 0) {
      found.push_back(left);
    } else if ((at_left < 0) != (at_right < 0) && at_right != 0) {
      std::uintmax_t steps = 100;
      const auto [one, other] = boost::math::tools::toms748_solve(f, left, right, at_left, at_right,
                                                                  boost::math::tools::eps_tolerance<double>(50), steps);
      found.push_back(0.5 * (one + other));
    }
    left = right;
    at_left = at_right;
  }
  if (!part.closed() && at_left == 0) found.push_back(left);
  return found;
}

}  // namespace bench
