#include "log/wrapping.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "rollfix/error.hpp"

// Notation:
//   a_k             angles of a column, or places on a finger that goes round, of period 2 pi or of its whole length
//   step            a_k - a_k-1; `turns_in`: the whole periods that it takes back if the column is wrapped
//   far             a step over more than half a period: another one where the column is not wrapped
//   rounding        of each a_k, half a unit of its last digit
// Follows docs/rolling.md, "Logs".
// Idea: a column that leaves a full period was never wrapped. In one that stays within it far steps are taken back, and
// said to be unclear where they are not as short, or as much alike, as the steps around them.
namespace rollfix {
namespace {

// A wrapped column can seem this much wider than its period: the rounding of its own 2 pi, in periods.
constexpr double kWrapSlack = 2e-10;

/// Whether a column with this range, of so many angles, may be wrapped: it stays within a period. One angle tells
/// nothing, and without a period nothing wraps. Two angles fill a range too easily: they count as wrapped only if they
/// lie in [-period / 2, period / 2] or in [0, period].
bool may_be_wrapped(const Interval& range, std::size_t count, double rounding, double period) {
  if (count < 2 || !std::isfinite(period)) return false;
  // Both ends of the range are rounded.
  const double slack = 2 * rounding + kWrapSlack * period;
  if (!(range.width() <= period + slack)) return false;
  if (count > 2) return true;
  const bool is_symmetric = range.lo >= -period / 2 - slack && range.hi <= period / 2 + slack;
  const bool is_positive = range.lo >= -slack && range.hi <= period + slack;
  return is_symmetric || is_positive;
}

// Rows this near together, as a share of a turn, show by their steps where a column is wrapped ...
constexpr double kNearRows = 1.0 / 6;
// ... and these show it where it is wrapped twice, which no angle within a turn would look like.
constexpr double kFarRows = 0.4;
// A step that is shorter than this share of the longest of the others belongs to them: one that only seems to be taken
// back, on the way through less than a turn, is longer than all of them.
constexpr double kShortStep = 0.8;
// One no longer than this many times as long belongs to them where it goes on as its neighbours do.
constexpr double kLikeStep = 2;
// Noise turns neighbours around. Among so many rows this near together the other reading is a single step of more than
// 25 times any other.
constexpr double kNearestRows = 1.0 / 50;
constexpr std::size_t kManySteps = 20;

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
    // An angle without whole turns keeps its bits.
    if (turns != 0) result[k] = angles[k] + turns * period;
  }
  return result;
}

std::vector<double> unwrapped_as_said(const std::vector<double>& angles, double rounding, double period,
                                      const std::optional<bool>& is_wrapped) {
  if (!is_wrapped) return unwrapped(angles, rounding, period);
  std::vector<double> result = angles;
  if (!*is_wrapped || !std::isfinite(period)) return result;
  double turns = 0;
  for (std::size_t k = 1; k < angles.size(); ++k) {
    turns -= turns_in(angles[k] - angles[k - 1], period);
    result[k] = angles[k] + turns * period;
  }
  return result;
}

std::optional<std::size_t> unclear_step(const std::vector<double>& angles, double rounding, double period,
                                        const std::optional<bool>& is_wrapped) {
  if (is_wrapped || angles.empty()) return std::nullopt;
  const auto [least, most] = std::minmax_element(angles.begin(), angles.end());
  // Left a full period: the column was never wrapped, and no step is unclear.
  if (!may_be_wrapped({*least, *most}, angles.size(), rounding, period)) return std::nullopt;
  std::vector<double> steps;                            // as they are if the column is wrapped
  std::vector<std::size_t> far;                         // of those that are others if it is not
  double longest = 2 * rounding + kWrapSlack * period;  // of those that are the same
  double turns = 0;
  for (std::size_t k = 1; k < angles.size(); ++k) {
    const double step = angles[k] - angles[k - 1];
    const double whole = turns_in(step, period);
    steps.push_back(step - whole * period);
    turns += whole;
    if (whole != 0) far.push_back(k - 1);
    if (whole == 0) longest = std::max(longest, std::abs(step));
  }
  // Several wraps whose other steps are short: no course within one turn looks like that.
  const bool is_wrapped_often = far.size() > 2 || std::abs(turns) > 1;
  if (far.empty() || (is_wrapped_often && longest <= kFarRows * period)) return std::nullopt;
  // A far step, taken back, is clear where it is like the steps around it, and those are short. Else the column may as
  // well go through less than a turn in one step.
  const bool is_dense = steps.size() >= kManySteps && longest <= kNearestRows * period;
  for (const std::size_t k : far) {
    const double size = std::abs(steps[k]);
    // A neighbouring step goes the same way.
    const bool goes_on =
        is_dense || (k > 0 && steps[k - 1] * steps[k] > 0) || (k + 1 < steps.size() && steps[k + 1] * steps[k] > 0);
    const bool belongs = size <= kShortStep * longest || (goes_on && size <= kLikeStep * longest);
    if (!belongs || longest > kNearRows * period) return k + 1;
  }
  return std::nullopt;
}

/// As the rows so far show it, unless it was said. Later rows can change the answer.
bool GrowingAngle::is_wrapped(double rounding) const {
  return said_ ? *said_ && std::isfinite(period_) : may_be_wrapped(range_, count_, rounding, period_);
}

double GrowingAngle::add(double angle, double rounding) {
  const double last = last_;
  const double turns = turns_;
  range_ = count_ == 0 ? Interval{angle, angle} : Interval{std::min(range_.lo, angle), std::max(range_.hi, angle)};
  // Wraps are counted whether the column is wrapped or not: it may turn out later.
  if (count_ > 0) {
    const double whole = turns_in(angle - last, period_);
    turns_ -= whole;
    was_far_ = was_far_ || (whole != 0 && std::abs(angle - last - whole * period_) > kNearRows * period_);
  }
  last_ = angle;
  ++count_;
  // Without whole turns the angle is as written, to the bit.
  const bool wraps = (turns != 0 || turns_ != 0) && is_wrapped(rounding);
  before_ = wraps ? last + turns * period_ : last;
  return wraps && turns_ != 0 ? angle + turns_ * period_ : angle;
}

namespace {

/// The first row in which two columns differ; if none does, how many rows there are.
std::size_t first_change(const std::vector<double>& one, const std::vector<double>& other) {
  return static_cast<std::size_t>(std::mismatch(one.begin(), one.end(), other.begin()).first - one.begin());
}

}  // namespace

void require_readable(const FingerRows& rows, const std::string& log) {
  const auto is_finite = [](double value) { return std::isfinite(value); };
  if (!std::all_of(rows.u.begin(), rows.u.end(), is_finite) ||
      !std::all_of(rows.psi.begin(), rows.psi.end(), is_finite)) {
    throw InputError(
        fmt::format("{}: its rows would hold numbers beyond any double: check the units, and the noise", log));
  }
  // A reader unwraps what he reads. If that changes any row, the log would not come back as it is.
  const std::size_t row = std::min(first_change(rows.u, unwrapped(rows.u, rows.place_rounding, rows.u_period)),
                                   first_change(rows.psi, unwrapped(rows.psi, rows.angle_rounding)));
  if (row == rows.u.size()) return;
  throw InputError(fmt::format(
      "{}: its {} rows are more than half a turn apart, rows {} and {}, so that a reader would take the angles as "
      "wrapped: take more rows, unless they are many and the motion jumps there",
      log, rows.u.size(), row, row + 1));
}

}  // namespace rollfix
