#include "finger/convex_body.hpp"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <queue>

// Notation:
//   e(x)     the unit vector in direction x
//   a, b     points of the two bodies: the first's that is farthest along e(x), the other's that is farthest against it
//   g(x)     (a - b) . e(x): how far the bodies are in one another as seen along e(x); apart where it is below 0
// Idea: what has to be moved is the least g. For every point a of the one and b of the other g(x) >= (a - b) . e(x),
// all around. So two directions that were looked at bound g between them from below, and directions are halved where
// that bound is least, until it is no less than the least g that was seen (branch and bound): no minimum is missed.
namespace rollfix {
namespace {

constexpr double kBodyTurn = 2 * std::numbers::pi;
// Of the least g: a bound this near to it is as good.
constexpr double kDepthAccuracy = 1e-13;
// Directions closer together than this, radians, differ by less than rounding.
constexpr double kLeastWidth = 1e-9;
constexpr int kFirstDirections = 8;
// Of a direction, radians: as it is found, a distance is off by rounding alone.
constexpr double kLeastTurn = 1e-12;

/// e(x).
Vec2 towards(double direction) { return {std::cos(direction), std::sin(direction)}; }

/// The place on a convex outline whose tangent has this angle, which is one of its own.
double place_with_tangent(const TurningFunction& turning, double angle) {
  const std::vector<Spiral>& spirals = turning.spirals();
  // The last spiral that starts with no larger angle; Theta grows all along a convex outline.
  const auto behind = std::upper_bound(spirals.begin(), spirals.end(), angle,
                                       [](double wanted, const Spiral& one) { return wanted < one.start.angle; });
  const Spiral& spiral = behind == spirals.begin() ? *behind : *(behind - 1);
  // Before the first spiral's angles, or just at the start of the spiral.
  if (angle <= spiral.start.angle) return spiral.lo;
  if (angle >= spiral.end.angle) return spiral.hi;  // in a joint, or on a straight side
  // Theta is continuous and grows on the spiral: one root.
  const auto excess = [&](double u) { return turning.on_spiral(spiral, u).angle - angle; };
  const double at_lo = spiral.start.angle - angle;
  const double at_hi = spiral.end.angle - angle;
  std::uintmax_t iterations = 60;
  const boost::math::tools::eps_tolerance<double> full(std::numeric_limits<double>::digits - 4);
  return boost::math::tools::toms748_solve(excess, spiral.lo, spiral.hi, at_lo, at_hi, full, iterations).first;
}

/// One direction, as it was looked at.
struct Looked {
  double direction = 0;
  Vec2 difference = Vec2::Zero();  // a - b
  double depth = 0;                // g
};

/// a - b in one direction. The other body's point is the one farthest against it.
Looked look(const ConvexBody& one, const ConvexBody& other, double direction) {
  const Vec2 difference = one.farthest(direction) - other.farthest(direction + std::numbers::pi);
  return {direction, difference, difference.dot(towards(direction))};
}

/// All directions between two.
struct Between {
  Looked lo;
  Looked hi;
  double bound = 0;                                                           // of g from below
  bool operator<(const Between& other) const { return bound > other.bound; }  // the least one first
};

/// A lower bound on g for all directions between two. By the support points of both ends g(x) >= d_lo . e(x) and
/// g(x) >= d_hi . e(x), d = a - b. Where these bounds are above 0 they are concave in x, so that the larger of both is
/// least at an end, or where both are equal.
Between bounded(const Looked& lo, const Looked& hi) {
  Between result{lo, hi, std::min(lo.depth, hi.depth)};
  const Vec2 apart = lo.difference - hi.difference;
  // Both bounds are the same one: it is least at an end.
  if (apart.norm() == 0) return result;
  // Where d_lo . e = d_hi . e: across d_lo - d_hi, on the side of these directions.
  Vec2 meet(-apart.y(), apart.x());
  meet.normalize();
  if (meet.dot(towards(lo.direction + 0.5 * (hi.direction - lo.direction))) < 0) meet = -meet;
  result.bound = std::min(result.bound, lo.difference.dot(meet));
  return result;
}

}  // namespace

Vec2 ConvexBody::farthest(double direction) const { return pose_.world(farthest_in_frame(direction - pose_.heading)); }

/// Of a disk the point at u = direction; of a closed outline the place whose tangent is a quarter turn ahead of the
/// direction; of an open one that place, or one of its two ends.
Vec2 ConvexBody::farthest_in_frame(double direction) const {
  if (finger_.is_disk()) return finger_.point(direction);
  const TurningFunction& turning = finger_.outline()->turning();
  const double first = turning.spirals().front().start.angle;
  const double last = turning.spirals().back().end.angle;
  const double tangent = direction + kBodyTurn / 4;
  // The tangent's angle on the first lap of Theta.
  double angle = first + (tangent - first) - kBodyTurn * std::floor((tangent - first) / kBodyTurn);
  if (turning.closed()) return finger_.point(place_with_tangent(turning, angle));
  const Vec2 ahead = towards(direction);
  Vec2 best = finger_.point(0);
  const auto consider = [&](double u) {
    if (finger_.point(u).dot(ahead) > best.dot(ahead)) best = finger_.point(u);
  };
  consider(turning.perimeter());
  // An open outline may turn by more than a lap: each place with this tangent is tried.
  for (; angle <= last; angle += kBodyTurn) consider(place_with_tangent(turning, angle));
  return best;
}

namespace {

/// The direction in which the bodies are least in one another; where that is no more than `enough` any that shows it.
Looked least_of_all(const ConvexBody& one, const ConvexBody& other, double enough) {
  std::priority_queue<Between> open;
  const Looked first = look(one, other, 0);
  Looked least = first;
  const auto keep = [&](const Looked& looked) {
    if (looked.depth < least.depth) least = looked;
  };
  Looked before = first;
  // A ring of directions with bounds between neighbours; it closes at the first one again.
  for (int k = 1; k <= kFirstDirections && least.depth > enough; ++k) {
    Looked next = k < kFirstDirections ? look(one, other, kBodyTurn * k / kFirstDirections) : first;
    next.direction = kBodyTurn * k / kFirstDirections;
    keep(next);
    open.push(bounded(before, next));
    before = next;
  }
  // Invariant: the least g of all directions is `least.depth`, or lies in one of the open stretches.
  while (least.depth > enough && !open.empty() && open.top().bound < least.depth * (1 - kDepthAccuracy)) {
    const Between widest = open.top();
    open.pop();
    const double width = widest.hi.direction - widest.lo.direction;
    // Too narrow to be told apart: g at its ends is as good as in between.
    if (width < kLeastWidth) continue;
    const Looked middle = look(one, other, widest.lo.direction + 0.5 * width);
    keep(middle);
    open.push(bounded(widest.lo, middle));
    open.push(bounded(middle, widest.hi));
  }
  return least;
}

/// In which direction from here g falls: +1 or -1.
int downhill(const Looked& looked) {
  return looked.difference.dot(towards(looked.direction + kBodyTurn / 4)) > 0 ? -1 : 1;
}

}  // namespace

/// The least translation that separates two convex bodies is the least g, in its direction.
double depth_of_overlap(const ConvexBody& one, const ConvexBody& other, double enough) {
  return least_of_all(one, other, enough).depth;
}

// Where g is below 0 it has one minimum: -g is a concave function of a vector, over that vector's length. The
// directions in which it is are less than half a turn, so that the minimum is less than that from any of them.
double distance_between(const ConvexBody& one, const ConvexBody& other, double enough) {
  // Some direction that separates them, if there is one.
  Looked least = least_of_all(one, other, 0);
  if (least.depth >= 0) return -least.depth;
  const double start = least.direction;
  const int way = downhill(least);
  // Bisection between near and far, in the direction in which g falls: the minimum lies between both.
  double near = 0;
  double far = kBodyTurn / 2;
  while (-least.depth < enough && far - near > kLeastTurn) {
    const double middle = 0.5 * (near + far);
    const Looked looked = look(one, other, start + way * middle);
    const bool is_beyond = looked.depth >= 0 || downhill(looked) != way;
    (is_beyond ? far : near) = middle;
    if (looked.depth < least.depth) least = looked;
  }
  return -least.depth;
}

double depth_along(const ConvexBody& one, const ConvexBody& other, double direction) {
  return look(one, other, direction).depth;
}

/// The jaw's line is the x axis of its frame, with its body above: the other body is in it as far as it reaches above
/// that line.
double depth_of_overlap(const Pose& jaw, const ConvexBody& other) {
  const double up = jaw.heading + kBodyTurn / 4;
  return (other.farthest(up) - Vec2(jaw.x, jaw.y)).dot(towards(up));
}

/// Above 0 if they overlap, below 0 if they are apart. Two jaws have no ends and always meet somewhere: they
/// are not compared. `enough`: a depth below this need not be exact.
double depth_of_overlap(const Finger& one, const Pose& pose_of_one, const Finger& other, const Pose& pose_of_other,
                        double enough) {
  if (one.is_jaw() && other.is_jaw()) return -std::numeric_limits<double>::infinity();
  if (one.is_jaw()) return depth_of_overlap(pose_of_one, ConvexBody(other, pose_of_other));
  if (other.is_jaw()) return depth_of_overlap(pose_of_other, ConvexBody(one, pose_of_one));
  // Two disks: the sum of their radii less the distance of their centres.
  if (one.is_disk() && other.is_disk()) {
    const double distance = std::hypot(pose_of_one.x - pose_of_other.x, pose_of_one.y - pose_of_other.y);
    return one.length_per_u() + other.length_per_u() - distance;
  }
  return depth_of_overlap(ConvexBody(one, pose_of_one), ConvexBody(other, pose_of_other), enough);
}

}  // namespace rollfix
