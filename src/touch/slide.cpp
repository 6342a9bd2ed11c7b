#include "rollfix/touch.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "centre_path.hpp"
#include "outline/turn.hpp"
#include "pose_fit.hpp"

// Notation, of a pose that fits and the others of its set:
//   q_i, delta_i    a touch's measured centre and how far it may be off
//   q_0             the middle of the touches; w_i = R(-phi) (q_i - q_0)
//   z = (dy, theta) another pose: by how much its point of the part at q_0 is elsewhere, and its heading
//   c_i, t_i, n_i   where the pose has the finger's centre on a side; along the side, and out of it
// Another pose has the touch at p_i + dy - theta J w_i, but for theta^2 |w_i| / 2. While it stays beside its side,
//   |n_i . (p_i - c_i + dy - theta J w_i)| <= delta_i + theta^2 |w_i| / 2,
// which is a polytope of z. Its corners say how far poses are apart, and how far along its side each touch gets.
namespace rollfix::touch {
namespace {

// Of touches so many are enough: fewer bounds leave no pose out.
// Corners are tried for all triples of bounds, which grow with the cube of this.
constexpr std::size_t kMostSides = 12;
// theta^2 shrinks with what theta can be; this often it is looked at again.
constexpr int kRounds = 3;
// Three planes have a corner where their directions have a larger determinant; and rounding, of what bounds allow.
constexpr double kParallelPlanes = 1e-13;
constexpr double kRoundingOfBounds = 1e-9;

/// |offset + by . z| <= most.
/// A slab of poses z = (dy, theta).
struct Bound {
  Eigen::Vector3d by = Eigen::Vector3d::Zero();
  double offset = 0;
  double most = 0;

  double at(const Eigen::Vector3d& z) const { return offset + by.dot(z); }
  /// The same slab with a unit normal: `most` is a distance then.
  Bound scaled() const { return {by / by.norm(), offset / by.norm(), most / by.norm()}; }
};

/// A touch beside a side of the part.
struct Side {
  Vec2 along = Vec2::UnitX();
  Vec2 out = Vec2::UnitY();
  Vec2 off = Vec2::Zero();  // p_i - c_i
  Vec2 arm = Vec2::Zero();  // w_i
  Interval rest;            // of the side, along it from c_i
  double most = 0;          // delta_i
  // Of the path: the number of the side's stretch, and c_i.
  std::int32_t stretch = -1;
  Vec2 centre = Vec2::Zero();

  /// `bend`: theta^2 / 2.
  Bound across(double bend) const { return {towards(out), out.dot(off), most + bend * arm.norm()}; }
  /// Not a bound but a value: the place of the touch along its side, from c_i.
  Bound ahead() const { return {towards(along), along.dot(off), 0}; }

 private:
  /// d/dz of direction . (dy - theta J w): J turns by 90 degrees counter-clockwise.
  Eigen::Vector3d towards(const Vec2& direction) const {
    return {direction.x(), direction.y(), -direction.dot(turned_left(arm))};
  }
};

/// Corners of what the bounds leave.
/// Vertices of the polytope: each is where three planes meet, on one side or the other of their slabs, and no bound is
/// broken. O(n^4) for n bounds. Empty: nothing is left.
std::vector<Eigen::Vector3d> corners_of(std::vector<Bound> bounds) {
  for (Bound& bound : bounds) bound = bound.scaled();
  const auto fits = [&](const Eigen::Vector3d& z) {
    return std::all_of(bounds.begin(), bounds.end(), [&](const Bound& bound) {
      return std::abs(bound.at(z)) <= bound.most * (1 + kRoundingOfBounds);
    });
  };
  std::vector<Eigen::Vector3d> corners;
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    for (std::size_t j = i + 1; j < bounds.size(); ++j) {
      for (std::size_t k = j + 1; k < bounds.size(); ++k) {
        Eigen::Matrix3d planes;
        planes << bounds[i].by.transpose(), bounds[j].by.transpose(), bounds[k].by.transpose();
        if (std::abs(planes.determinant()) <= kParallelPlanes) continue;
        const Eigen::Matrix3d inverse = planes.inverse();
        for (int signs = 0; signs < 8; ++signs) {
          // by . z at the slab's upper or lower plane.
          const auto end = [&](const Bound& bound, int bit) {
            return ((signs >> bit & 1) != 0 ? bound.most : -bound.most) - bound.offset;
          };
          const Eigen::Vector3d z = inverse * Eigen::Vector3d(end(bounds[i], 0), end(bounds[j], 1), end(bounds[k], 2));
          if (fits(z)) corners.push_back(z);
        }
      }
    }
  }
  return corners;
}

/// A linear function takes its extremes at corners. Of no corners: lo above hi.
Interval range_of(const Bound& value, const std::vector<Eigen::Vector3d>& corners) {
  Interval range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const Eigen::Vector3d& z : corners) {
    range.lo = std::min(range.lo, value.at(z));
    range.hi = std::max(range.hi, value.at(z));
  }
  return range;
}

/// The stretch of the path that a contact is on, if it is no corner.
/// At a corner's s it is a side next to it; `stays` then finds that the side has no room.
std::optional<std::size_t> stretch_at(const CentrePath& path, double s) {
  for (std::size_t k = 0; k < path.stretches().size(); ++k) {
    const CentreStretch& stretch = path.stretches()[k];
    if (!stretch.corner && stretch.u.contains(s)) return k;
  }
  return std::nullopt;
}

/// Whether any centre on another stretch is this near to a segment.
/// Branch and bound over the tree; a node that is too short to be halved counts as near. `near`: length.
bool is_near_another(PathTree& tree, std::int32_t own, const Vec2& from, const Vec2& to, double near) {
  const auto distance = [&](const Vec2& point) {
    const Vec2 along = to - from;
    const double share = along.squaredNorm() > 0 ? (point - from).dot(along) / along.squaredNorm() : 0;
    return (point - from - std::clamp(share, 0.0, 1.0) * along).norm();
  };
  std::vector<std::int32_t> waiting{tree.root()};
  while (!waiting.empty()) {
    const std::int32_t index = waiting.back();
    waiting.pop_back();
    const PathTree::Node& node = tree.node(index);
    if (node.stretch == own || distance(node.middle) > near + node.radius) continue;
    if (node.is_single() && node.radius <= near) return true;
    const auto [left, right] = tree.halves(index);
    if (left == right) return true;
    waiting.push_back(left);
    waiting.push_back(right);
  }
  return false;
}

/// The touches beside the sides that a pose has them at; nothing if one is at a corner.
/// `middle`: q_0. Touches without a place hold nothing and are left out.
std::optional<std::vector<Side>> sides_of(const TouchAnswer& answer, const TouchPose& pose, const CentrePath& path,
                                          const Vec2& middle) {
  const Pose back{0, 0, -pose.pose.heading};
  std::vector<Side> sides;
  for (std::size_t k = 0; k < answer.touches.size() && sides.size() < kMostSides; ++k) {
    const MeasuredTouch& touch = answer.touches[k];
    if (!touch.has_place()) continue;
    const TouchContact& contact = pose.contacts[k];
    const std::optional<std::size_t> stretch = stretch_at(path, contact.s);
    if (!stretch) return std::nullopt;
    const Interval& u = path.stretches()[*stretch].u;
    Side side;
    side.along = {std::cos(contact.tangent), std::sin(contact.tangent)};
    side.out = -turned_left(side.along);
    side.centre = contact.point + answer.radius * side.out;
    side.arm = back.turned(touch.at - middle);
    side.off = back.turned(touch.at - Vec2(pose.pose.x, pose.pose.y)) - side.centre;
    side.rest = {u.lo - contact.s, u.hi - contact.s};
    side.most = answer.tolerance[k].length;
    side.stretch = static_cast<std::int32_t>(*stretch);
    sides.push_back(side);
  }
  return sides;
}

/// REQUIRES a touch with a place.
Vec2 middle_of(const std::vector<MeasuredTouch>& touches) {
  Vec2 sum = Vec2::Zero();
  double count = 0;
  for (const MeasuredTouch& touch : touches) {
    if (!touch.has_place()) continue;
    sum += touch.at;
    count += 1;
  }
  return sum / count;
}

/// What the sides leave, and no more than `turn` of a heading, which becomes what they leave of that; `far`: of the
/// rest.
/// Round by round a smaller turn makes theta^2 / 2 smaller, and with it what each side leaves.
std::vector<Eigen::Vector3d> left_by(const std::vector<Side>& sides, double far, double& turn) {
  std::vector<Eigen::Vector3d> corners;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<Bound> bounds{
        {Eigen::Vector3d::UnitX(), 0, far}, {Eigen::Vector3d::UnitY(), 0, far}, {Eigen::Vector3d::UnitZ(), 0, turn}};
    for (const Side& side : sides) bounds.push_back(side.across(0.5 * turn * turn));
    corners = corners_of(std::move(bounds));
    const Interval turns = range_of({Eigen::Vector3d::UnitZ(), 0, 0}, corners);
    turn = std::min(turn, std::max(std::abs(turns.lo), std::abs(turns.hi)));
  }
  return corners;
}

/// Whether a touch stays beside its side, where no other is near, in all that is left.
/// Then its bound holds in all poses of the polytope, so that no pose of the set is outside of it.
bool stays(const Side& side, PathTree& tree, const std::vector<Eigen::Vector3d>& corners, double turn) {
  const Interval ahead = range_of(side.ahead(), corners);
  const double slack = 0.5 * turn * turn * side.arm.norm() + side.most;
  const Interval on{ahead.lo - slack, ahead.hi + slack};
  return side.rest.contains(on.lo) && side.rest.contains(on.hi) &&
         !is_near_another(tree, side.stretch, side.centre + on.lo * side.along, side.centre + on.hi * side.along,
                          2 * side.most);
}

/// How far apart poses of a set can be along a direction, where the touches are on straight sides whose directions
/// differ a little: these hold the part before any touch comes to the end of its side. Nothing where one may come
/// there, with noise, of a part face down or with rolls.
/// Length, an upper bound.
std::optional<double> slide_between_sides(const TouchAnswer& answer, const TouchPose& pose, double direction) {
  if (answer.noise || answer.mirrored || !answer.rolls.empty() || answer.touches.empty()) return std::nullopt;
  const CentrePath path(answer.part, answer.radius);
  const Vec2 middle = middle_of(answer.touches);
  const std::optional<std::vector<Side>> sides = sides_of(answer, pose, path, middle);
  if (!sides) return std::nullopt;
  const Pose back{0, 0, -pose.pose.heading};
  const Vec2 toward = back.turned({std::cos(direction), std::sin(direction)});
  const Vec2 arm = back.turned(middle - Vec2(pose.pose.x, pose.pose.y));  // from the drawing's origin
  double turn = std::max(pose.extent[2].hi - pose.pose.heading, pose.pose.heading - pose.extent[2].lo);
  // A box of dy and theta that holds all poses of the extent, so that the polytope is bounded.
  const double far = std::hypot(pose.extent[0].width(), pose.extent[1].width()) + turn * arm.norm();
  const std::vector<Eigen::Vector3d> corners = left_by(*sides, far, turn);
  PathTree tree(path);
  const auto is_held = [&](const Side& side) { return stays(side, tree, corners, turn); };
  if (corners.empty() || !std::all_of(sides->begin(), sides->end(), is_held)) return std::nullopt;
  // By how far a pose moves q_0 at most: terms of second order in the turn are added to the width.
  double moved = 0;
  for (const Eigen::Vector3d& z : corners) moved = std::max(moved, z.head<2>().norm());
  // By how much the drawing's origin moves along the direction.
  const Bound origin{{toward.x(), toward.y(), toward.dot(turned_left(arm))}, 0, 0};
  return range_of(origin, corners).width() + 2 * turn * moved + turn * turn * arm.norm();
}

}  // namespace

}  // namespace rollfix::touch

namespace rollfix {
namespace {

// Sides are parallel where they differ by no more than this, radians: so well the direction is known.
constexpr double kParallel = 0.01;
// A side is straight where it turns by no more than this over the part's perimeter, radians.
constexpr double kStraight = 1e-6;

/// An angle of a line: in (-pi/2, pi/2].
double of_line(double angle) {
  const double half = std::remainder(angle, std::numbers::pi);
  return half <= -0.5 * std::numbers::pi ? half + std::numbers::pi : half;
}

/// Without outliers.
std::vector<TouchContact> counted_contacts(const TouchAnswer& answer, const TouchPose& pose) {
  std::vector<TouchContact> contacts = pose.contacts;
  for (auto k = pose.outliers.rbegin(); k != pose.outliers.rend(); ++k) {
    contacts.erase(contacts.begin() + static_cast<std::ptrdiff_t>(answer.rolls.size() + *k));
  }
  return contacts;
}

}  // namespace

std::optional<Slide> slide_of(const TouchAnswer& answer, const TouchPose& pose) {
  if (!pose.continuum || pose.any_heading || pose.contacts.empty()) return std::nullopt;
  const Part& part = answer.part;
  const std::vector<TouchContact> contacts = counted_contacts(answer, pose);
  const double along = contacts.front().tangent;
  const bool are_parallel = std::all_of(contacts.begin(), contacts.end(), [&](const TouchContact& contact) {
    return std::abs(part.turning().at(contact.s).curvature) * part.perimeter() <= kStraight &&
           std::abs(of_line(contact.tangent - along)) <= kParallel;
  });
  if (!are_parallel) return std::nullopt;
  const std::array<Interval, 3>& range = answer.noise ? pose.interval : pose.extent;
  const double direction = of_line(pose.pose.heading + along);
  const double by_x = range[0].width() / std::abs(std::cos(direction));
  const double by_y = range[1].width() / std::abs(std::sin(direction));
  const double by_extent = std::min(by_x, by_y);
  if (!pose.outliers.empty()) return Slide{direction, by_extent};  // the other sides may let it go further
  return Slide{direction, std::min(by_extent, touch::slide_between_sides(answer, pose, direction).value_or(by_extent))};
}

}  // namespace rollfix
