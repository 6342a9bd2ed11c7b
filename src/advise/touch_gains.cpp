#include "advise/touch_gains.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include "outline/turn.hpp"

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
namespace rollfix::advising {
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
  // A tolerance is kTouchSigmas standard deviations of the noise; without noise it is taken as one.
  const double share = answer_.noise ? kTouchSigmas : 1;
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

}  // namespace rollfix::advising
