#include "rollfix/advise.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <optional>
#include <vector>

#include "advise/touch_gains.hpp"
#include "rollfix/error.hpp"
#include "rollfix/pulse.hpp"
#include "rollfix/turning_function.hpp"
#include "touch/likely_poses.hpp"
#include "touch/nearest.hpp"

// Notation:
//   bits      of a touch, or of the roll instead: -sum over k of w_k log2(sum over j of w_j exp(-d_kj^2 / 2)), what it
//             takes away of the entropy of the poses' weights w; d: how far apart it is in two poses, standard
//             deviations
//   s_k       where the last touch is on the part, in pose k
//   Theta     the part's tangent, unwrapped along the boundary; a roll over L turns it by Theta(s_k + L) - Theta(s_k)
//   sigma     of a measured direction, radians; a turn is the difference of two
// Follows docs/touch.md, "The next touch".
// Idea: all approaches are judged roughly, the most promising ones again closely, until none that is left can be
// better.
namespace rollfix::advising {
namespace {

// Rolls that are looked at, in shares of the perimeter: steps, and the longest.
constexpr double kRollStep = 0.02;
constexpr int kMostRollSteps = 12;
// The shortest roll that gains this share of what the best one gains is told.
constexpr double kNearlyAsMany = 0.9;
// A roll that gains less than kNearlyAsMany of so many bits is none.
constexpr double kLeastRollBits = 0.05;

/// Of measured directions, radians; 0: none is measured.
double direction_sd(const TouchAnswer& answer) {
  if (answer.noise) return answer.noise->angle;
  double most = 0;
  for (const TouchTolerance& tolerance : answer.tolerance) most = std::max(most, tolerance.angle);
  return most;
}

/// Where a roll starts in a pose, and how far off along the part that may be.
struct RollStart {
  double weight = 0;
  /// along the outline, on the first lap
  double s = 0;
  double sd = 0;
};

/// s_k: what of the part is nearest to the last touch in this pose. Its sd along the part has the pose's covariance and
/// the touch's own error.
RollStart start_in(const LikelyPose& one, const TouchAnswer& answer, PartDistance& part) {
  // In the part's frame, mirrored where the part lies face down.
  const double side = answer.mirrored ? -1 : 1;
  const Vec2& at = answer.touches.back().at;
  const Vec2 point = Pose{0, 0, -one.pose.heading}.turned(at - Vec2(one.pose.x, one.pose.y));
  const NearestOfPart nearest = part.nearest({side * point.x(), point.y()});
  const Vec2 away = one.pose.turned({side * nearest.away.x(), nearest.away.y()});
  const Vec2 arm = one.pose.turned({side * nearest.contact.x(), nearest.contact.y()});
  // The tangent: by_pose is how far the contact goes along it when the pose moves by (dx, dy, dphi).
  const Vec2 along(-away.y(), away.x());
  const Eigen::Vector3d by_pose(along.x(), along.y(), along.y() * arm.x() - along.x() * arm.y());
  const double share = answer.noise ? kTouchSigmas : 1;
  // With noise a tolerance is kTouchSigmas standard deviations; without noise it is taken as one.
  const double place_sd = answer.tolerance.back().length / share;
  return {one.weight, nearest.s, std::sqrt(by_pose.dot(one.covariance * by_pose) + place_sd * place_sd)};
}

/// What a roll would turn by in a pose.
struct Turned {
  double turn = 0;
  double variance = 0;
};

/// Theta(s + L) - Theta(s), and its variance from the start's: the difference over two standard deviations.
Turned turn_along(const Part& part, const RollStart& start, double length) {
  const auto turn_from = [&](double s) { return part.turning().angle(s + length) - part.turning().angle(s); };
  // At least a little, so that a corner at the start counts as not known.
  const double spread = std::max(start.sd, 1e-9 * part.perimeter());
  const double change = turn_from(start.s + spread) - turn_from(start.s - spread);
  return {turn_from(start.s), 0.25 * change * change};
}

/// The roll stays on an open part.
bool ends_in_time(const Part& part, const RollStart& start, double length) {
  return part.closed() || (start.s + length >= 0 && start.s + length <= part.perimeter());
}

/// As of touches: poses whose turns lie d standard deviations apart keep exp(-d^2 / 2) of their weight beside each
/// other.
double bits_of(const Part& part, const std::vector<RollStart>& starts, double length, double sd) {
  std::vector<Turned> turned;
  for (const RollStart& start : starts) turned.push_back(turn_along(part, start, length));
  double bits = 0;
  for (std::size_t i = 0; i < starts.size(); ++i) {
    double weight = 0;
    for (std::size_t j = 0; j < starts.size(); ++j) {
      // d^2 = off^2 / variance
      const double off = turned[i].turn - turned[j].turn;
      // a measured turn is the difference of two directions: 2 sd^2; both forecasts add their own
      const double variance = i == j ? 1 : 2 * sd * sd + turned[i].variance + turned[j].variance;
      weight += starts[j].weight * std::exp(-0.5 * off * off / variance);
    }
    bits -= starts[i].weight * std::log2(weight);
  }
  return std::max(0.0, bits);
}

/// The roll from the last touch that tells most of these poses apart, by how much the tangent turns along it. None: the
/// finger is a point, no angle is measured, or no roll gains anything.
std::optional<RollGain> roll_instead(const TouchAnswer& answer, const std::vector<LikelyPose>& poses,
                                     PartDistance& part) {
  const double sd = direction_sd(answer);
  if (!(answer.radius > 0) || !(sd > 0)) return std::nullopt;
  std::vector<RollStart> starts;
  for (const LikelyPose& one : poses) starts.push_back(start_in(one, answer, part));
  std::vector<RollGain> rolls;
  for (int k = 1; k <= kMostRollSteps; ++k) {
    for (const double way : {1.0, -1.0}) {
      // From short to long: the first roll that is as good is the shortest.
      const double length = way * k * kRollStep * answer.part.perimeter();
      const bool all_end = std::all_of(starts.begin(), starts.end(), [&](const RollStart& start) {
        return ends_in_time(answer.part, start, length);
      });
      if (all_end) rolls.push_back({length, bits_of(answer.part, starts, length, sd)});
    }
  }
  // Where all rolls gain less than kNearlyAsMany of this there is none.
  double most = kLeastRollBits;
  for (const RollGain& roll : rolls) most = std::max(most, roll.bits);
  const auto first =
      std::find_if(rolls.begin(), rolls.end(), [&](const RollGain& roll) { return roll.bits >= kNearlyAsMany * most; });
  return first == rolls.end() ? std::nullopt : std::optional(*first);
}

}  // namespace

}  // namespace rollfix::advising

namespace rollfix {

namespace advising {
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
  // Compared in steps of kAboutAsManyBits.
  const double more = std::round(one.bits / kAboutAsManyBits) - std::round(other.bits / kAboutAsManyBits);
  return more > 0 || (more == 0 && one.head_on > other.head_on);
}

/// Looks closely at the most promising touches, and says which of them is best. Bits are no more than roughly: if
/// only the best is asked for, what is roughly no better than it needs no closer look.
std::size_t best_of(TouchGains& touches, std::size_t poses, std::vector<TouchGain>& gains, bool only_best) {
  // The most promising first. Each close look compares all pairs of poses.
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

/// Throws InputError for a number of an approach that is not finite.
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
}  // namespace advising

NextTouch next_touch(const TouchAnswer& answer, const std::vector<Approach>& approaches) {
  advising::require_finite(approaches);
  if (!answer.rolls.empty()) {
    throw InputError("next touch: expected an answer to touches alone, found rolls: give their touches by themselves");
  }
  if (answer.status != Status::complete) {
    throw InputError(
        "next touch: expected a complete answer, found one that is undecided; touch once more, or raise "
        "`budget`");
  }
  NextTouch next;
  next.why = advising::nothing_to_tell(answer);
  if (!next.why.empty()) return next;
  const Doing doing("looking for the touch that tells most");
  // Each approach is judged by a sample of poses, weighted.
  advising::PartInPoses lying(answer, touch::likely_poses(answer));
  advising::TouchGains touches(lying);
  for (const Approach& approach : approaches.empty() ? advising::approaches_around(lying) : approaches) {
    next.gains.push_back(touches.rough(approach));
  }
  next.best = advising::best_of(touches, lying.poses().size(), next.gains, approaches.empty());
  // After a single touch the poses are a sample: there is nothing to list for each.
  if (!answer.poses.empty()) {
    for (advising::Forecast& one : touches.forecasts(next.advised().approach)) next.expected.push_back(one.touch);
  }
  next.bits_wanted = touches.bits_wanted();
  // The alternative: to roll on from where the finger touches.
  next.roll = advising::roll_instead(answer, lying.poses(), lying.part());
  next.helps = next.advised().bits >= advising::kLeastBits;
  if (next.helps) return next;
  next.why = approaches.empty() ? "no touch tells these poses apart: the part looks the same in each, within the noise"
                                : "none of these approaches tells the poses apart";
  return next;
}

}  // namespace rollfix
