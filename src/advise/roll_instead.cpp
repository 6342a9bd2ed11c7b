#include "advise/roll_instead.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "rollfix/turning_function.hpp"

// Notation:
//   s_k       where the last touch is on the part, in pose k
//   Theta     the part's tangent, unwrapped along the boundary; a roll over L turns it by Theta(s_k + L) - Theta(s_k)
//   sigma     of a measured direction, radians; a turn is the difference of two
namespace rollfix::touch {
namespace {

// Rolls that are looked at, in shares of the perimeter: steps, and the longest.
constexpr double kRollStep = 0.02;
constexpr int kMostRollSteps = 12;
// The shortest roll that gains this share of what the best one gains is told.
constexpr double kNearlyAsMany = 0.9;
// One that gains less of a bit is none.
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
  double s = 0;
  double sd = 0;
};

RollStart start_in(const LikelyPose& one, const TouchAnswer& answer, PartDistance& part) {
  const double side = answer.mirrored ? -1 : 1;
  const Vec2& at = answer.touches.back().at;
  const Vec2 point = Pose{0, 0, -one.pose.heading}.turned(at - Vec2(one.pose.x, one.pose.y));
  const NearestOfPart nearest = part.nearest({side * point.x(), point.y()});
  const Vec2 away = one.pose.turned({side * nearest.away.x(), nearest.away.y()});
  const Vec2 arm = one.pose.turned({side * nearest.contact.x(), nearest.contact.y()});
  const Vec2 along(-away.y(), away.x());
  const Eigen::Vector3d by_pose(along.x(), along.y(), along.y() * arm.x() - along.x() * arm.y());
  const double share = answer.noise ? kTouchSigmas : 1;
  const double place_sd = answer.tolerance.back().length / share;
  return {one.weight, nearest.s, std::sqrt(by_pose.dot(one.covariance * by_pose) + place_sd * place_sd)};
}

/// What a roll would turn by in a pose.
struct Turned {
  double turn = 0;
  double variance = 0;
};

Turned turn_along(const Part& part, const RollStart& start, double length) {
  const auto turn_from = [&](double s) { return part.turning().angle(s + length) - part.turning().angle(s); };
  const double spread = std::max(start.sd, 1e-9 * part.perimeter());
  const double change = turn_from(start.s + spread) - turn_from(start.s - spread);
  return {turn_from(start.s), 0.25 * change * change};
}

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
      const double off = turned[i].turn - turned[j].turn;
      const double variance = i == j ? 1 : 2 * sd * sd + turned[i].variance + turned[j].variance;
      weight += starts[j].weight * std::exp(-0.5 * off * off / variance);
    }
    bits -= starts[i].weight * std::log2(weight);
  }
  return std::max(0.0, bits);
}

}  // namespace

std::optional<RollGain> roll_instead(const TouchAnswer& answer, const std::vector<LikelyPose>& poses,
                                     PartDistance& part) {
  const double sd = direction_sd(answer);
  if (!(answer.radius > 0) || !(sd > 0)) return std::nullopt;
  std::vector<RollStart> starts;
  for (const LikelyPose& one : poses) starts.push_back(start_in(one, answer, part));
  std::vector<RollGain> rolls;
  for (int k = 1; k <= kMostRollSteps; ++k) {
    for (const double way : {1.0, -1.0}) {
      const double length = way * k * kRollStep * answer.part.perimeter();
      const bool all_end = std::all_of(starts.begin(), starts.end(), [&](const RollStart& start) {
        return ends_in_time(answer.part, start, length);
      });
      if (all_end) rolls.push_back({length, bits_of(answer.part, starts, length, sd)});
    }
  }
  double most = kLeastRollBits;
  for (const RollGain& roll : rolls) most = std::max(most, roll.bits);
  const auto first =
      std::find_if(rolls.begin(), rolls.end(), [&](const RollGain& roll) { return roll.bits >= kNearlyAsMany * most; });
  return first == rolls.end() ? std::nullopt : std::optional(*first);
}

}  // namespace rollfix::touch
