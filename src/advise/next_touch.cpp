#include "rollfix/advise.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "advise/part_in_poses.hpp"
#include "advise/roll_instead.hpp"
#include "advise/touch_gains.hpp"
#include "rollfix/error.hpp"
#include "rollfix/pulse.hpp"

namespace rollfix {
namespace touch {
namespace {

// An approach helps where it gains so much of a bit.
constexpr double kLeastBits = 0.05;
// Approaches gain about as much where it differs by less.
constexpr double kAboutAsManyBits = 0.02;
// The most promising approaches are looked at again: whether a touch of one pose also fits another side of another.
// So many pairs of poses in all.
constexpr std::size_t kMostClosePairs = 120000;

/// Whether one gains more, or about as much and goes at the part head on: along a side a little may make it miss.
bool is_better(const TouchGain& one, const TouchGain& other) {
  const double more = std::round(one.bits / kAboutAsManyBits) - std::round(other.bits / kAboutAsManyBits);
  return more > 0 || (more == 0 && one.head_on > other.head_on);
}

/// Looks closely at the most promising touches, and says which of them is best. Bits are no more than roughly: if
/// only the best is asked for, what is roughly no better than it needs no closer look.
std::size_t best_of(TouchGains& touches, std::size_t poses, std::vector<TouchGain>& gains, bool only_best) {
  std::vector<std::size_t> order(gains.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return is_better(gains[a], gains[b]); });
  order.resize(std::min(order.size(), std::max<std::size_t>(1, kMostClosePairs / (poses * poses))));
  std::size_t best = gains.size();
  for (const std::size_t k : order) {
    const bool is_first = best == gains.size();
    if (!is_first && only_best && !is_better(gains[k], gains[best])) break;
    gains[k] = touches.close(gains[k].approach);
    if (is_first || is_better(gains[k], gains[best])) best = k;
  }
  return best;
}

void require_finite(const std::vector<Approach>& approaches) {
  for (std::size_t k = 0; k < approaches.size(); ++k) {
    const Approach& one = approaches[k];
    if (one.from.allFinite() && std::isfinite(one.direction)) continue;
    throw InputError(fmt::format("approach {}: expected finite numbers, found ({}, {}), direction {}", k + 1,
                                 one.from.x(), one.from.y(), one.direction));
  }
}

/// One touch with a normal fits all along the boundary, in one heading each; its answer lists no pose.
bool is_after_one(const TouchAnswer& answer) {
  return answer.touches.size() == 1 && answer.touches.front().normal && answer.verdict.name == Verdict::unobservable;
}

/// Why there is nothing to look at; empty: there is.
std::string nothing_to_tell(const TouchAnswer& answer) {
  if (answer.poses.empty()) {
    if (is_after_one(answer)) return "";
    return answer.verdict.name == Verdict::unobservable
               ? "one place leaves every pose that touches it: touch the part elsewhere first"
               : "no pose fits the touches";
  }
  if (answer.poses.size() > 1) return "";
  if (!answer.poses.front().continuum) return "one pose is left";
  if (answer.poses.front().any_heading) return "only the heading is not known, and it can't be felt";
  return answer.noise ? "" : "the poses hang together: with noise stated it is known how they lie";
}

}  // namespace
}  // namespace touch

NextTouch next_touch(const TouchAnswer& answer, const std::vector<Approach>& approaches) {
  touch::require_finite(approaches);
  if (!answer.rolls.empty()) {
    throw InputError("next touch: expected an answer to touches alone, found rolls: give their touches by themselves");
  }
  if (answer.status != Status::complete) {
    throw InputError(
        "next touch: expected a complete answer, found one that is undecided; touch once more, or raise "
        "`budget`");
  }
  NextTouch next;
  next.why = touch::nothing_to_tell(answer);
  if (!next.why.empty()) return next;
  const Doing doing("looking for the touch that tells most");
  touch::PartInPoses lying(answer, touch::likely_poses(answer));
  touch::TouchGains touches(lying);
  for (const Approach& approach : approaches.empty() ? touch::approaches_around(lying) : approaches) {
    next.gains.push_back(touches.rough(approach));
  }
  next.best = touch::best_of(touches, lying.poses().size(), next.gains, approaches.empty());
  if (!answer.poses.empty()) {
    for (touch::Forecast& one : touches.forecasts(next.advised().approach)) next.expected.push_back(one.touch);
  }
  next.bits_wanted = touches.bits_wanted();
  next.roll = touch::roll_instead(answer, lying.poses(), lying.part());
  next.helps = next.advised().bits >= touch::kLeastBits;
  if (next.helps) return next;
  next.why = approaches.empty() ? "no touch tells these poses apart: the part looks the same in each, within the noise"
                                : "none of these approaches tells the poses apart";
  return next;
}

}  // namespace rollfix
