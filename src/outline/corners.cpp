#include "outline/corners.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <utility>

#include "outline/turn.hpp"
#include "rollfix/outline.hpp"

// Notation:
//   q_k             points, in order; closed ones cyclically
//   turn            of the chords at q_k, radians: ChordTurns::at; by the length that it takes: `curvature`
//   nose            a point at which a curve that is sampled sparsely turns by a corner's angle, as its neighbours do
//   arm             the line of least squares through the points within `reach` of one, before it or after it: ScanArm
// Follows docs/files.md, "Points and scans" and "Airfoils".
// Idea: of exact points a corner is where chords turn by `kCornerAngle` and the neighbours' turns don't lead up to it;
// of noisy ones where the two arms do, by more than at any other point within reach.
namespace rollfix {
namespace {

/// On a curve that is sampled sparsely the points on both sides of one that turns by a corner's angle turn as well, the
/// same way and by this share of it (on ellipses up to 8:1, wherever the points fall); the sides of a corner that is
/// meant are far straighter, one of them at least.
constexpr double kNeighbourShare = 0.12;

/// From one point to the next a nose's curvature grows by this; that of arcs is the same.
constexpr double kNoseGrowth = 1.2;

/// Points of a straight side turn by less, radians: rounded digits.
constexpr double kStraightSide = 0.01;

/// A corner of an airfoil this near to its end, as a share of the chord, is at its trailing edge.
constexpr double kTrailingEdge = 0.02;

}  // namespace

double ChordTurns::at(std::size_t k) const {
  if (is_open_end(k)) return 0;
  const Vec2 before = points_[k] - points_[previous(k)];
  const Vec2 after = points_[next(k)] - points_[k];
  return std::atan2(cross(before, after), before.dot(after));
}

/// The turn, by the length that it takes.
double ChordTurns::curvature(std::size_t k) const {
  if (is_open_end(k)) return 0;
  // Half the length of both chords belongs to the point.
  const double length = (points_[k] - points_[previous(k)]).norm() + (points_[next(k)] - points_[k]).norm();
  return 2 * at(k) / length;
}

std::optional<std::size_t> ChordTurns::straighter_beside(std::size_t k, double least, bool after) const {
  const auto step = [&](std::size_t i) { return after ? next(i) : previous(i); };
  std::size_t neighbour = step(k);
  for (std::size_t steps = 0; steps < points_.size(); ++steps, neighbour = step(neighbour)) {
    if (std::abs(at(neighbour)) < least) return neighbour;
  }
  return std::nullopt;
}

bool ChordTurns::goes_on(std::size_t k, double least) const {
  const auto bends_along = [&](bool after) {
    const std::optional<std::size_t> neighbour = straighter_beside(k, least, after);
    // It turns the same way, by at least kNeighbourShare of the turn here.
    return neighbour && at(*neighbour) * at(k) > 0 && std::abs(at(*neighbour)) >= kNeighbourShare * std::abs(at(k));
  };
  return bends_along(true) && bends_along(false);
}

bool ChordTurns::has_straight_side(std::size_t k, double least) const {
  const auto is_straight = [&](bool after) {
    const std::optional<std::size_t> neighbour = straighter_beside(k, least, after);
    return !neighbour || (!is_open_end(*neighbour) && std::abs(at(*neighbour)) < kStraightSide);
  };
  return is_straight(true) || is_straight(false);
}

bool ChordTurns::is_nose(std::size_t k, double least) const {
  if (!goes_on(k, least)) return false;
  const auto bends_more = [&](const auto& step) {
    std::size_t neighbour = step(k);
    // Ends, because goes_on() found such a point.
    while (std::abs(at(neighbour)) >= least) neighbour = step(neighbour);
    return std::abs(curvature(neighbour)) >= kNoseGrowth * std::abs(curvature(step(neighbour)));
  };
  return bends_more([this](std::size_t i) { return next(i); }) &&
         bends_more([this](std::size_t i) { return previous(i); });
}

std::vector<std::size_t> corners_of_points(const std::vector<Vec2>& points, bool closed, bool airfoil) {
  const ChordTurns turns(points, closed);
  // The extreme points by x; for an airfoil, whose chord lies along x.
  const auto [nose, tail] =
      std::minmax_element(points.begin(), points.end(), [](const Vec2& a, const Vec2& b) { return a.x() < b.x(); });
  const double trailing_edge = tail->x() - kTrailingEdge * (tail->x() - nose->x());
  std::vector<std::size_t> corners;
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (!(std::abs(turns.at(k)) >= kCornerAngle)) continue;
    const bool is_corner = airfoil ? points[k].x() >= trailing_edge : !turns.is_nose(k, kCornerAngle);
    if (is_corner) corners.push_back(k);
  }
  return corners;
}

namespace {

/// Of an arm with twice as many points only every second one is taken, with three times as many every third, and so on:
/// the direction is good enough then.
constexpr std::size_t kArmPoints = 48;

/// The points on one side of a point.
struct ScanArm {
  Vec2 direction = Vec2::Zero();  // away from the point
  std::size_t count = 0;          // how many points it reaches over
};

/// Finds the corners of a noisy scan. Each point costs its arms: fewer than about 2 kArmPoints points on either side.
class ScanCorners {
 public:
  ScanCorners(const std::vector<Vec2>& points, bool closed, double reach)
      : points_(points), closed_(closed), reach_(reach) {}

  /// The points that turn by corner_angle or more, and by more than any other within reach.
  std::vector<std::size_t> find(double corner_angle) {
    const std::size_t count = points_.size();
    turns_.assign(count, 0);
    reaches_.assign(count, {0, 0});
    std::pair<std::size_t, std::size_t> last = {1, 1};  // neighbours' arms are about as long
    // First the turn at every point, between the lines fitted to its two arms; then the largest of each neighbourhood.
    for (std::size_t i = 0; i < count; ++i) {
      const ScanArm before = arm(i, false, last.first);
      const ScanArm after = arm(i, true, last.second);
      last = {before.count, after.count};
      reaches_[i] = last;
      const bool has_both = before.count > 0 && after.count > 0;
      // The arm before, seen forwards, against the arm after. Ends of an open scan have one arm and no turn.
      if (has_both) turns_[i] = std::abs(angle_between(-before.direction, after.direction));
    }
    std::vector<std::size_t> corners;
    for (std::size_t i = 0; i < count; ++i) {
      if (turns_[i] >= corner_angle && is_most(i)) corners.push_back(i);
    }
    return corners;
  }

 private:
  /// The point `steps` after or before i; false when an open curve ends before.
  bool step(std::size_t i, bool forward, std::size_t steps, std::size_t& result) const {
    const std::size_t count = points_.size();
    if (closed_) {
      result = forward ? (i + steps) % count : (i + count - steps % count) % count;
      return steps < count;
    }
    if (forward ? i + steps >= count : steps > i) return false;
    result = forward ? i + steps : i - steps;
    return true;
  }

  /// The arm of point i on one side: the points up to `reach_` away along the scan, and at least the neighbour.
  /// `expected`: how many points it has, probably; of many only every stride-th is taken.
  ScanArm arm(std::size_t i, bool forward, std::size_t expected) const {
    const std::size_t stride = std::max<std::size_t>(1, expected / kArmPoints);
    // Sums of the points as seen from point i, and of their products: enough for the line of least squares.
    Vec2 sum = Vec2::Zero();
    Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
    double taken = 1;  // the point itself
    ScanArm result;
    for (std::size_t steps = stride;; steps += stride) {
      std::size_t j = 0;
      if (!step(i, forward, steps, j)) break;
      const Vec2 from = points_[j] - points_[i];
      const bool is_beyond = from.squaredNorm() > reach_ * reach_;
      // Beyond the reach, and there are points within it: the arm ends. With none within it the neighbour alone is the
      // arm.
      if (is_beyond && result.count > 0) break;
      if (is_beyond && stride > 1) return arm(i, forward, 1);  // sparser points than at the neighbour
      sum += from;
      squares += from * from.transpose();
      ++taken;
      result.count = steps;
      if (is_beyond) break;
    }
    if (result.count > 0) result.direction = line_direction(sum, squares, taken);
    return result;
  }

  /// Of the line that is nearest to the points in the least-squares sense, pointing to where they are.
  static Vec2 line_direction(const Vec2& sum, const Eigen::Matrix2d& squares, double count) {
    // The covariance times the count. Its larger principal axis has the angle 1/2 atan2(2 s_xy, s_xx - s_yy).
    const Eigen::Matrix2d spread = squares - sum * sum.transpose() / count;
    const double angle = 0.5 * std::atan2(2 * spread(0, 1), spread(0, 0) - spread(1, 1));
    const Vec2 direction(std::cos(angle), std::sin(angle));
    return direction.dot(sum) < 0 ? Vec2(-direction) : direction;
  }

  /// Whether no point within reach on either side turns by more; of equals the first one is taken.
  bool is_most(std::size_t i) const {
    for (const bool forward : {false, true}) {
      const std::size_t reach = forward ? reaches_[i].second : reaches_[i].first;
      for (std::size_t steps = 1; steps <= reach; ++steps) {
        std::size_t j = 0;
        if (!step(i, forward, steps, j)) break;
        const bool is_within = (points_[j] - points_[i]).squaredNorm() <= reach_ * reach_;
        if (!is_within) continue;
        if (turns_[j] > turns_[i] || (turns_[j] == turns_[i] && j < i)) return false;
      }
    }
    return true;
  }

  const std::vector<Vec2>& points_;
  bool closed_;
  double reach_;                                              // length
  std::vector<double> turns_;                                 // at each point, radians, in [0, pi]
  std::vector<std::pair<std::size_t, std::size_t>> reaches_;  // points of each arm, before and after
};

}  // namespace

std::vector<std::size_t> scan_corners(const std::vector<Vec2>& points, bool closed, double reach, double corner_angle) {
  return ScanCorners(points, closed, reach).find(corner_angle);
}

}  // namespace rollfix
