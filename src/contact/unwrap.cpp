#include "contact/unwrap.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "rollfix/error.hpp"

namespace rollfix {

namespace {

// A wrapped column can seem this much wider than its period: the rounding of its own 2 pi, in periods.
constexpr double kWrapSlack = 2e-10;

/// `range`: of all angles, of which there are so many.
bool may_be_wrapped(const Interval& range, std::size_t count, double rounding, double period) {
  if (count < 2 || !std::isfinite(period)) return false;
  const double slack = 2 * rounding + kWrapSlack * period;
  if (!(range.width() <= period + slack)) return false;
  if (count > 2) return true;
  const bool is_symmetric = range.lo >= -period / 2 - slack && range.hi <= period / 2 + slack;
  const bool is_positive = range.lo >= -slack && range.hi <= period + slack;
  return is_symmetric || is_positive;
}

/// The whole turns that such a step takes back.
double turns_in(double step, double period) { return std::abs(step) > period / 2 ? std::round(step / period) : 0; }

}  // namespace

std::vector<double> unwrapped(const std::vector<double>& angles, double rounding, double period) {
  std::vector<double> result = angles;
  if (angles.empty()) return result;
  const auto [least, most] = std::minmax_element(angles.begin(), angles.end());
  if (!may_be_wrapped({*least, *most}, angles.size(), rounding, period)) return result;
  double turns = 0;
  for (std::size_t k = 1; k < angles.size(); ++k) {
    turns -= turns_in(angles[k] - angles[k - 1], period);
    if (turns != 0) result[k] = angles[k] + turns * period;
  }
  return result;
}

double GrowingAngle::add(double angle, double rounding) {
  const double last = last_;
  const double turns = turns_;
  range_ = count_ == 0 ? Interval{angle, angle} : Interval{std::min(range_.lo, angle), std::max(range_.hi, angle)};
  if (count_ > 0) turns_ -= turns_in(angle - last, period_);
  last_ = angle;
  ++count_;
  const bool is_wrapped = (turns != 0 || turns_ != 0) && may_be_wrapped(range_, count_, rounding, period_);
  before_ = is_wrapped ? last + turns * period_ : last;
  return is_wrapped && turns_ != 0 ? angle + turns_ * period_ : angle;
}

void require_readable(const Log& log) {
  if (unwrapped(log.u, log.place_rounding, log.u_period) == log.u && unwrapped(log.psi, log.angle_rounding) == log.psi)
    return;
  throw InputError(fmt::format(
      "{}: its {} rows are more than half a turn apart, so that a reader would take the angles as wrapped: take more "
      "rows",
      log.name, log.rows()));
}

}  // namespace rollfix
