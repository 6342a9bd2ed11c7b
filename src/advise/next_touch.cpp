#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "outline/turn.hpp"
#include "rollfix/advise.hpp"
#include "rollfix/error.hpp"
#include "rollfix/turning_function.hpp"
#include "touch/nearest.hpp"
#include "touch/steps.hpp"
#include "work/pulse.hpp"

namespace rollfix::advising {

using touch::LikelyPose;
using touch::NearestOfPart;
using touch::PartDistance;

/// A part as it may lie, by an answer that has to outlive it: its likely poses, and a circle around it in all of them.
class PartInPoses {
 public:
  PartInPoses(const TouchAnswer& answer, std::vector<LikelyPose> poses);

  const TouchAnswer& answer() const { return answer_; }
  const std::vector<LikelyPose>& poses() const { return poses_; }
  /// Distances to the part, in its own frame.
  PartDistance& part() { return part_; }
  /// The circle around the part in all poses, in the world: its middle and its radius.
  const Vec2& middle() const { return middle_; }
  double reach() const { return reach_; }
  /// Of the part from its frame's origin.
  double farthest() const { return farthest_; }

  /// A place of the world in the part's frame, and back; the frame is mirrored where the part lies face down.
  Vec2 in_part(const LikelyPose& one, const Vec2& at) const;
  Vec2 in_world(const LikelyPose& one, const Vec2& point) const { return one.pose.world(mirrored(point)); }
  /// A direction in the part's frame as the world sees it.
  Vec2 turned(const LikelyPose& one, const Vec2& along) const { return one.pose.turned(mirrored(along)); }

 private:
  Vec2 mirrored(const Vec2& point) const { return {answer_.mirrored ? -point.x() : point.x(), point.y()}; }

  const TouchAnswer& answer_;
  std::vector<LikelyPose> poses_;
  PartDistance part_;
  Vec2 middle_ = Vec2::Zero();
  double reach_ = 0;
  double farthest_ = 0;
};

/// Approaches where none are given. From outside, in all directions; of a hole from within.
std::vector<Approach> approaches_around(PartInPoses& lying);

/// A touch as it would be measured in a pose, and how well it is known beforehand.
struct Forecast {
  ExpectedTouch touch;
  double variance = 0;   // of the part's side across itself, from the pose's
  double incidence = 1;  // cosine of the way's angle with the normal
  /// of the normal, radians^2
  double turn_variance = 0;
};

/// What a touch would be in each pose of a part, and what it would tell of them.
class TouchGains {
 public:
  explicit TouchGains(PartInPoses& lying);

  std::vector<Forecast> forecasts(const Approach& approach);

  /// By how far the finger goes in each pose: quick, and right where no other side of the part is near.
  TouchGain rough(const Approach& approach);

  /// By how well the touch that one pose leads to fits the other one, on whatever side of it.
  TouchGain close(const Approach& approach);

  /// Until one pose is left.
  double bits_wanted() const;

 private:
  template <class Apart>
  TouchGain gain(const Approach& approach, const Apart& apart);
  NearestOfPart nearest_in(const LikelyPose& one, const Vec2& at);
  /// An upper bound of a side's variance across itself.
  double most_variance_of(const LikelyPose& one) const;
  double turn_variance_of(const LikelyPose& one, const NearestOfPart& nearest) const;
  /// d^2 of a touch from any side of another pose; of two touches: square_apart.
  double square_off(const Forecast& made, const LikelyPose& one);
  double square_of(double place, double variance, double turn, double turn_variance) const;
  /// d^2 of the touches that one way makes in two poses.
  double square_apart(const Forecast& a, const Forecast& b) const;
  /// Traces the way in one pose.
  Forecast forecast(const Approach& approach, const LikelyPose& one);
  void touches(const LikelyPose& one, const Vec2& along, const NearestOfPart& nearest, Forecast& result) const;

  PartInPoses& lying_;
  const TouchAnswer& answer_;
  const std::vector<LikelyPose>& poses_;
  PartDistance& part_;
  std::vector<double> share_of_set_;  // of each pose, in the set that it stands for
  /// the answer's touches have them, so that the next one does
  bool has_normals_ = false;
  /// of a measured place, length; turn_sd_: of a normal, radians
  double place_sd_ = 0;
  double turn_sd_ = 0;
};

// Notation:
//   i, j, w_i       a pose that is left and its weight: LikelyPose::weight
//   x_i, n_i        how far the finger goes in pose i until it touches, and the normal there: Forecast::touch
//   c               cosine of the way's angle with the normal: `incidence`; c (x_i - x_j): how far apart the sides are
//   V_i             variance of the side across itself, from the pose's covariance; of n_i: `turn_variance`
//   d_ij^2          c^2 (x_i - x_j)^2 / (sd^2 + V_i + V_j), and the like of the normals: `square_apart`; closely the
//                   squares of the touch that pose i leads to on any side of pose j: `square_off`
//   bits            -sum over i of w_i log2(sum over j of w_j exp(-d_ij^2 / 2)), the entropy that a touch takes away
// Follows docs/touch.md, "The next touch".
// Idea: a touch tells two poses apart by how far away from each other it would end in them. Each way is traced in steps
// of the part's distance (sphere tracing) and judged by the x_i, the most promising ones again by all sides.

namespace {

// Approaches where none are given: directions all around, and parallel ways in each.
constexpr int kDirections = 36;
constexpr std::size_t kParallel = 7;
// In a hole they start at places that are so far apart, a share of its diagonal, and are looked for among so many.
constexpr double kApart = 0.02;
constexpr std::size_t kMostPlaces = 40;

/// Probability of the poses in which the finger touches nothing there.
double share_free(PartInPoses& lying, const Vec2& at) {
  double share = 0;
  for (const LikelyPose& one : lying.poses()) {
    if (lying.part().nearest(lying.in_part(one, at)).distance > lying.answer().radius) share += one.weight;
  }
  return share;
}

/// Where the hole's middle is in the likeliest poses, if it is free in all of them; else where it is in most.
std::vector<Vec2> places_within(PartInPoses& lying) {
  // In the part's frame: each pose puts it somewhere else in the world.
  const Vec2 middle = lying.part().middle_of_hole();
  std::vector<std::pair<double, Vec2>> places;
  for (const LikelyPose& one : lying.poses()) {
    const Vec2 place = lying.in_world(one, middle);
    // Poses that lie nearly alike give one place.
    const bool is_known = std::any_of(places.begin(), places.end(), [&](const auto& known) {
      return (known.second - place).norm() < kApart * lying.part().diagonal();
    });
    if (!is_known && places.size() < kMostPlaces) places.emplace_back(share_free(lying, place), place);
  }
  std::stable_sort(places.begin(), places.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  // Those that are free in as much probability as the best one.
  std::vector<Vec2> result;
  for (const auto& [share, place] : places) {
    if (share >= places.front().first && result.size() < kParallel) result.push_back(place);
  }
  return result;
}

// A finger touches where it is nearer than this share of the diagonal; it creeps along a side no longer than so many
// steps.
constexpr double kTouches = 1e-6;
constexpr int kMostTraceSteps = 400;
// Near the part, in shares of its diagonal, the side is taken for straight, and what that leads to is looked at.
constexpr double kNear = 1e-2;
// A touch whose squares are at least this much says the pose is another.
constexpr double kFarOff = 100;
// A way along a side says less by where the finger stops than one straight at it; it is counted no less than this.
constexpr double kLeastIncidence = 0.1;
// A normal that may be off by so much, radians, says nothing.
constexpr double kAnyTurn = std::numbers::pi;

/// Of the part's side across itself, from the pose's.
double variance_of(const LikelyPose& one, const NearestOfPart& nearest) {
  // n; arm: from the frame's origin to the contact, in the world's directions
  const Vec2& away = nearest.away;
  const Vec2& arm = nearest.contact;
  // What a side does when the pose moves by (dx, dy, dphi): dx n_x + dy n_y + dphi (arm x n).
  const Eigen::Vector3d by_pose(away.x(), away.y(), away.y() * arm.x() - away.x() * arm.y());
  return by_pose.dot(one.covariance * by_pose);
}

}  // namespace

/// The circle holds the outline in all poses: `reach_` is half the diagonal of the box around them.
PartInPoses::PartInPoses(const TouchAnswer& answer, std::vector<LikelyPose> poses)
    : answer_(answer), poses_(std::move(poses)), part_(answer.part) {
  // The outline as points: for the circle, and for the part's farthest point from its frame's origin.
  const std::vector<Vec2> outline = answer_.part.polyline(0, answer_.part.perimeter(), 200);
  Vec2 least = Vec2::Constant(std::numeric_limits<double>::infinity()), most = -least;
  for (const LikelyPose& one : poses_) {
    for (const Vec2& point : outline) {
      const Vec2 world = in_world(one, point);
      least = least.cwiseMin(world);
      most = most.cwiseMax(world);
    }
  }
  for (const Vec2& point : outline) farthest_ = std::max(farthest_, point.norm());
  middle_ = 0.5 * (least + most);
  reach_ = 0.5 * (most - least).norm();
}

/// Turned back by the heading and mirrored again, if the part lies face down.
Vec2 PartInPoses::in_part(const LikelyPose& one, const Vec2& at) const {
  return mirrored(Pose{0, 0, -one.pose.heading}.turned(at - Vec2(one.pose.x, one.pose.y)));
}

std::vector<Approach> approaches_around(PartInPoses& lying) {
  std::vector<Approach> approaches;
  if (lying.part().is_hole()) {
    for (const Vec2& from : places_within(lying)) {
      for (int k = 0; k < kDirections; ++k) approaches.push_back({from, kFullTurn * k / kDirections});
    }
    return approaches;
  }
  for (int k = 0; k < kDirections; ++k) {
    const double direction = kFullTurn * k / kDirections;
    const Vec2 along(std::cos(direction), std::sin(direction));
    const Vec2 across(-along.y(), along.x());
    for (std::size_t i = 0; i < kParallel; ++i) {
      // Middles of equal strips across the circle.
      const double off = ((2.0 * static_cast<double>(i) + 1) / kParallel - 1) * lying.reach();
      approaches.push_back(
          {lying.middle() + off * across - (lying.reach() + lying.answer().radius) * along, direction});
    }
  }
  return approaches;
}

TouchGains::TouchGains(PartInPoses& lying)
    : lying_(lying), answer_(lying.answer()), poses_(lying.poses()), part_(lying.part()) {
  // One normal is enough: the next touch will have one as well.
  has_normals_ = std::any_of(answer_.touches.begin(), answer_.touches.end(),
                             [](const MeasuredTouch& touch) { return touch.normal.has_value(); });
  // A tolerance is kPossibleSigmas standard deviations of the noise; without noise it is taken as one.
  const double share = answer_.noise ? kPossibleSigmas : 1;
  for (const TouchTolerance& tolerance : answer_.tolerance) {
    place_sd_ = std::max(place_sd_, tolerance.length / share);
    turn_sd_ = std::max(turn_sd_, tolerance.angle / share);
  }
  // A continuum is several poses of one placement: each has a share of it.
  std::map<std::size_t, double> of_set;
  for (const LikelyPose& one : poses_) of_set[one.placement] += one.weight;
  for (const LikelyPose& one : poses_) share_of_set_.push_back(one.weight / of_set[one.placement]);
}

std::vector<Forecast> TouchGains::forecasts(const Approach& approach) {
  std::vector<Forecast> result;
  for (const LikelyPose& one : poses_) result.push_back(forecast(approach, one));
  return result;
}

/// `apart(a, b, j)`: how far the touch in pose a is from what pose j would have, b.
template <class Apart>
TouchGain TouchGains::gain(const Approach& approach, const Apart& apart) {
  const std::vector<Forecast> all = forecasts(approach);
  TouchGain result{approach};
  for (std::size_t i = 0; i < all.size(); ++i) {
    double weight = 0;  // that the poses have once the touch is made, if i is the true one
    double remain = 0;
    for (std::size_t j = 0; j < all.size(); ++j) {
      // exp(-d_ij^2 / 2): what of pose j's weight is left
      const double share = i == j ? 1 : std::exp(-0.5 * apart(all[i], all[j], j));
      weight += poses_[j].weight * share;
      remain += share * share_of_set_[j];
    }
    result.bits -= poses_[i].weight * std::log2(std::max(weight, 1e-300));
    result.poses += poses_[i].weight * std::max(1.0, remain);  // of a continuum a part of it
    result.head_on += poses_[i].weight * (all[i].touch.hits ? all[i].incidence : 0);
  }
  result.bits = std::max(0.0, result.bits);  // weights add up to 1 but for rounding
  return result;
}

/// Each pose's own touch with each other's: their number squared comparisons, without the part.
TouchGain TouchGains::rough(const Approach& approach) {
  return gain(approach,
              [&](const Forecast& one, const Forecast& other, std::size_t) { return square_apart(one, other); });
}

/// No d is larger than the rough one, so that the rough bits bound the close ones from above.
TouchGain TouchGains::close(const Approach& approach) {
  return gain(approach, [&](const Forecast& one, const Forecast& other, std::size_t j) {
    const double square = square_apart(one, other);
    return one.touch.hits && square > 0 ? std::min(square, square_off(one, poses_[j])) : square;
  });
}

/// H(w): what it takes to leave one pose.
double TouchGains::bits_wanted() const {
  double bits = 0;
  for (const LikelyPose& one : poses_) bits -= one.weight * std::log2(one.weight);
  return bits;
}

/// What is nearest to a place of the world, in a pose; directions and places as the world sees them, about the part.
NearestOfPart TouchGains::nearest_in(const LikelyPose& one, const Vec2& at) {
  NearestOfPart nearest = part_.nearest(lying_.in_part(one, at));
  nearest.away = lying_.turned(one, nearest.away);
  nearest.contact = lying_.turned(one, nearest.contact);
  return nearest;
}

/// No side's is larger.
double TouchGains::most_variance_of(const LikelyPose& one) const {
  const double by_place = std::sqrt(one.covariance.topLeftCorner<2, 2>().trace());
  const double by_turn = std::sqrt(one.covariance(2, 2)) * lying_.farthest();
  return (by_place + by_turn) * (by_place + by_turn);
}

/// Of the normal, from the pose's heading, and as a touch may as well have been a little further along the side: by
/// how much its normal turns there.
double TouchGains::turn_variance_of(const LikelyPose& one, const NearestOfPart& nearest) const {
  const bool is_corner = std::isinf(nearest.curvature);
  const double radius = answer_.radius;
  // kappa of the curve along which the finger's centre goes; about a corner it is the finger's own, 1 / r.
  const double bend = is_corner ? 1 / radius : std::abs(nearest.curvature / (1 + nearest.curvature * radius));
  return one.covariance(2, 2) + std::pow(std::min(bend * place_sd_, kAnyTurn), 2);
}

/// The squares of a touch's residuals in another pose.
double TouchGains::square_off(const Forecast& made, const LikelyPose& one) {
  // Bounds of the distance cost less than the nearest point: if even they are far off, that is enough.
  const Interval distance = part_.between(lying_.in_part(one, made.touch.at));
  // The finger's surface is off the part by at least this.
  const double least = std::max({distance.lo - answer_.radius, answer_.radius - distance.hi, 0.0});
  const double quick = least * least / (place_sd_ * place_sd_ + made.variance + most_variance_of(one));
  if (quick > kFarOff) return quick;
  const NearestOfPart nearest = nearest_in(one, made.touch.at);
  const double gap = nearest.distance - answer_.radius;
  const double turn = nearest_angle(made.touch.normal - std::atan2(nearest.away.y(), nearest.away.x()));
  return square_of(gap, made.variance + variance_of(one, nearest), turn,
                   made.turn_variance + turn_variance_of(one, nearest));
}

/// d^2 of a touch: of the place, and of the normal where normals are measured.
double TouchGains::square_of(double place, double variance, double turn, double turn_variance) const {
  double square = place * place / (place_sd_ * place_sd_ + variance);
  if (has_normals_ && turn_sd_ > 0) square += turn * turn / (turn_sd_ * turn_sd_ + turn_variance);
  return square;
}

/// Goes by how far the part is, until it touches or is past.
Forecast TouchGains::forecast(const Approach& approach, const LikelyPose& one) {
  Forecast result;
  result.touch = {one.placement, one.weight, one.pose};
  const Vec2 along(std::cos(approach.direction), std::sin(approach.direction));
  // Beyond this the circle around the part is behind the finger.
  const double farthest = (approach.from - lying_.middle()).norm() + lying_.reach() + answer_.radius;
  // At each turn the finger touches nothing up to `travel`: it goes on by no more than the part is away.
  double travel = 0;
  for (int look = 0; look < kMostTraceSteps && travel <= farthest; ++look) {
    const Vec2 at = approach.from + travel * along;
    // A lower bound of the distance, cheap: as long as it is large, the nearest point is not needed.
    const double most_near = part_.at_least(lying_.in_part(one, at)) - answer_.radius;
    if (most_near > kTouches * part_.diagonal()) {
      travel += most_near;
      continue;
    }
    NearestOfPart nearest = nearest_in(one, at);
    const double gap = nearest.distance - answer_.radius;
    double step = gap > 0 ? gap : 0;
    bool is_there = gap <= kTouches * part_.diagonal();
    const double incidence = -along.dot(nearest.away);
    // Near a side the steps get ever shorter. If it is straight, the finger touches after gap / incidence: if it does
    // there, that is the touch.
    if (!is_there && gap <= kNear * part_.diagonal() && incidence > kLeastIncidence) {
      const NearestOfPart ahead = nearest_in(one, at + gap / incidence * along);
      is_there = std::abs(ahead.distance - answer_.radius) <= kTouches * part_.diagonal();
      if (is_there) nearest = ahead;
      if (is_there) step = gap / incidence;
    }
    travel += step;
    if (!is_there) continue;
    touches(one, along, nearest, result);
    result.touch.at = approach.from + travel * along;
    result.touch.travel = travel;
    break;
  }
  return result;
}

/// What is known of a touch beforehand, from the side that is nearest there.
void TouchGains::touches(const LikelyPose& one, const Vec2& along, const NearestOfPart& nearest,
                         Forecast& result) const {
  result.touch.hits = true;
  result.touch.normal = std::atan2(nearest.away.y(), nearest.away.x());
  result.incidence = std::max(kLeastIncidence, -along.dot(nearest.away));
  result.variance = variance_of(one, nearest);
  result.turn_variance = turn_variance_of(one, nearest);
}

double TouchGains::square_apart(const Forecast& a, const Forecast& b) const {
  // A touch and a miss are told apart for sure; two misses are alike.
  if (a.touch.hits != b.touch.hits) return std::numeric_limits<double>::infinity();
  if (!a.touch.hits) return 0;
  // Across the sides: at a small incidence the travel differs by much where the sides differ by little.
  const double place = (a.touch.travel - b.touch.travel) * std::min(a.incidence, b.incidence);
  return square_of(place, a.variance + b.variance, nearest_angle(a.touch.normal - b.touch.normal),
                   a.turn_variance + b.turn_variance);
}

// ---- the touch to make
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
  const double share = answer.noise ? kPossibleSigmas : 1;
  // With noise a tolerance is kPossibleSigmas standard deviations; without noise it is taken as one.
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
        "next touch: expected a complete answer, found one that is undecided; touch once "
        "more, or raise `budget`");
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
