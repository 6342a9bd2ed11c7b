#include "contact/unwrap.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "rollfix/error.hpp"

namespace rollfix {

namespace {

constexpr double kFullTurn = 2 * std::numbers::pi;
// A wrapped column can seem this much wider than a full turn: the rounding of its own 2 pi, in radians.
constexpr double kWrapSlack = 1e-9;

bool may_be_wrapped(const std::vector<double>& angles, double rounding) {
  if (angles.size() < 2) return false;
  const auto [least, most] = std::minmax_element(angles.begin(), angles.end());
  const double slack = 2 * rounding + kWrapSlack;
  if (!(*most - *least <= kFullTurn + slack)) return false;
  if (angles.size() > 2) return true;
  const bool is_symmetric = *least >= -std::numbers::pi - slack && *most <= std::numbers::pi + slack;
  const bool is_positive = *least >= -slack && *most <= kFullTurn + slack;
  return is_symmetric || is_positive;
}

}  // namespace

std::vector<double> unwrapped(const std::vector<double>& angles, double rounding) {
  std::vector<double> result = angles;
  if (!may_be_wrapped(angles, rounding)) return result;
  double turns = 0;
  for (std::size_t k = 1; k < angles.size(); ++k) {
    const double step = angles[k] - angles[k - 1];
    if (std::abs(step) > std::numbers::pi) turns -= std::round(step / kFullTurn);
    if (turns != 0) result[k] = angles[k] + turns * kFullTurn;
  }
  return result;
}

void require_readable(const Log& log) {
  if (unwrapped(log.u, log.place_rounding) == log.u && unwrapped(log.psi, log.angle_rounding) == log.psi) return;
  throw InputError(fmt::format(
      "{}: its {} rows are more than half a turn apart, so that a reader would take the angles as wrapped: take more "
      "rows",
      log.name, log.rows()));
}

}  // namespace rollfix
