#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "centre_path.hpp"
#include "outline/turn.hpp"
#include "pose_fit.hpp"
#include "roll_belief.hpp"
#include "roll_contacts.hpp"
#include "rollfix/touch.hpp"
#include "steps.hpp"

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

// ---- in words of the answer
// Notation:
//   (X, phi)        a pose; a contact's residuals in it are the distance of its centre from the path's c(u), and what
//                   its tangent is off by: TouchContact
//   (a, h)          a cell: the first contact's stretch, a disc (c, rho), and headings phi +- h
//   extent          X = q_1 - R(phi) c, off by rho + delta_1 + 2 |c| sin(h / 2) at most: `extent_of`
//   I, lambda       information of a pose and its least eigenvalue, headings taken times half the part's diagonal: the
//                   pose is a continuum where lambda <= 1 / (kContinuum delta)^2
//   w_k, m_k, C_k   weight, mean and covariance of a node of the posterior; of a mode the moments are those of the
//                   mixture, C = sum w_k (C_k + m_k m_k^T) / sum w_k - m m^T: `add_posterior`
// Follows docs/touch.md, "What the answer promises" and "How it works".
namespace rollfix::touch {
namespace {

// Poses are a continuum where the touches hold the part, in some direction, to no less than this many tolerances.
constexpr double kContinuum = 12;
// Headings of extents are rounded, radians.
constexpr double kHeadingRounding = 1e-12;

/// The residual of the normal has its sign, that of the place is a distance. A roll with noise has those of the means
/// of its node.
TouchContact contact_of(const PoseFit& fit, const Pose& pose, std::size_t touch, const PathPlace& place) {
  const CentrePoint point = fit.path(touch).at(place);
  const InPart at = fit.in_part(pose, touch);
  TouchContact contact;
  contact.s = fit.path(touch).part().boundary().canonical(point.s);
  contact.point = fit.path(touch).contact(place);
  contact.tangent = nearest_angle(point.angle);
  if (const RollBelief* roll = fit.touches()[touch].roll) {
    const Eigen::Vector3d off = roll->residual(pose, roll->at(place));
    if (at.has_place) contact.distance = off.head<2>().norm();
    contact.turn = off.z();
    return contact;
  }
  if (at.has_place) contact.distance = (at.at - point.centre).norm();
  if (at.tangent) contact.turn = nearest_angle(*at.tangent - point.angle);
  return contact;
}

/// Whether the cells' headings leave none out. Their arcs are swept in order from -pi to pi: a gap means that some
/// heading is missing.
bool cover_all(const std::vector<Cell>& cells) {
  std::vector<Interval> arcs;
  for (const Cell& cell : cells) {
    if (cell.heading.is_all()) return true;
    const double middle = nearest_angle(cell.heading.middle);
    // An arc may cross -pi or pi: its copies a turn away are looked at as well.
    for (const double lap : {-kFullTurn, 0.0, kFullTurn}) {
      const Interval arc{middle - cell.heading.half + lap, middle + cell.heading.half + lap};
      if (arc.hi >= -std::numbers::pi && arc.lo <= std::numbers::pi) arcs.push_back(arc);
    }
  }
  std::sort(arcs.begin(), arcs.end(), [](const Interval& a, const Interval& b) { return a.lo < b.lo; });
  double reached = -std::numbers::pi;
  for (const Interval& arc : arcs) {
    // A gap between `reached` and this arc.
    if (arc.lo > reached) break;
    reached = std::max(reached, arc.hi);
  }
  return reached >= std::numbers::pi;
}

void extend(Interval& interval, double lo, double hi) {
  interval.lo = std::min(interval.lo, lo);
  interval.hi = std::max(interval.hi, hi);
}

/// Whether the touches leave the part free to move: in some direction they would hardly hold it, if its sides were as
/// long as they are straight there.
/// By the least eigenvalue of the information, with headings scaled to lengths; a matrix that is not regular counts as
/// a continuum.
bool is_continuum(const PoseFit& fit, const FittedPose& fitted) {
  double least = std::numeric_limits<double>::infinity();
  for (const Measured& touch : fit.touches()) {
    if (touch.has_place) least = std::min(least, touch.place_most);
  }
  // A turn moves the part's rim by half its diagonal: so headings count as lengths.
  const Eigen::Vector3d scale(1, 1, 2 / fit.path(0).diagonal());
  const Eigen::Matrix3d information = scale.asDiagonal() * fitted.information * scale.asDiagonal();
  const double weakest = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(information).eigenvalues()(0);
  // 1 / sqrt(weakest) is how far the part can move, in lengths, at one standard deviation or tolerance.
  return !(weakest > 1 / (kContinuum * kContinuum * least * least));
}

/// Whether a set is a continuum. Of rolls without noise its extent says that: they are confined to arcs. Of a reference
/// with noise the posterior says how well the heading is known.
bool is_free(const PoseFit& fit, const FittedPose& fitted, const TouchPair& pair,
             const std::array<Interval, 3>& extent) {
  const std::vector<Measured>& contacts = fit.touches();
  const Measured& first = contacts[pair.first];
  // x and y follow from the reference: there is nothing to slide.
  if (is_reference(first)) return false;
  const bool any_rolls =
      std::any_of(contacts.begin(), contacts.end(), [](const Measured& contact) { return contact.is_roll; });
  const bool has_noise =
      std::any_of(contacts.begin(), contacts.end(), [](const Measured& contact) { return contact.roll != nullptr; });
  // Touches, and rolls with noise, by the information at the best pose.
  if (!any_rolls || has_noise) return is_continuum(fit, fitted);
  // Of rolls without noise: more room than the tolerances make.
  const double place = kFreePlace * fit.path(0).part().perimeter() + kFreeTolerances * first.place_most;
  const double heading = kFreeHeading + kFreeTolerances * (first.tangent ? first.angle_most : 0);
  return std::max(extent[0].width(), extent[1].width()) > place || extent[2].width() > heading;
}

}  // namespace

/// Of no cells: lo above hi.
std::array<Interval, 3> extent_of(const PoseFit& fit, const std::vector<Cell>& cells, const TouchPair& pair,
                                  const Pose& about) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  std::array<Interval, 3> extent;
  extent.fill({kFar, -kFar});
  const Measured& first = fit.touches()[pair.first];
  for (const Cell& cell : cells) {
    const PathTree::Node& node = fit.tree(pair.first).node(cell.first);
    const Pose turn{0, 0, cell.heading.middle};
    // X = q_1 - R(phi) c, at the middle of disc and headings.
    const Vec2 place = first.at - turn.turned(node.middle);
    const double swing = cell.heading.is_all() ? 2 : 2 * std::sin(0.5 * cell.heading.half);
    // A reference has no tolerance: the pose is counted from it.
    const double slack = node.radius + (is_reference(first) ? 0 : first.place_most) + swing * node.middle.norm();
    extend(extent[0], place.x() - slack, place.x() + slack);
    extend(extent[1], place.y() - slack, place.y() + slack);
    // Unwrapped about the given heading; a set that goes all around is told by `any_heading`.
    const double off = about.heading + nearest_angle(cell.heading.middle - about.heading);
    extend(extent[2], off - cell.heading.half, off + cell.heading.half);
  }
  return extent;
}

/// kPossibleSigmas of each node's own standard deviations.
PoseExtent extent_of(const PoseMode& mode, const std::vector<PosteriorNode>& nodes, const Pose& about) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  PoseExtent extent;
  extent.fill({kFar, -kFar});
  for (const std::size_t k : mode.nodes) {
    const Pose& pose = nodes[k].pose;
    const std::array<double, 3> at{pose.x, pose.y, about.heading + nearest_angle(pose.heading - about.heading)};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto axis = static_cast<Eigen::Index>(i);
      const double slack = kPossibleSigmas * std::sqrt(nodes[k].covariance(axis, axis));
      extend(extent[i], at[i] - slack, at[i] + slack);
    }
  }
  return extent;
}

/// The heading by its distance from the middle of the extent, which may be wider than a turn.
bool holds(const PoseExtent& extent, const Pose& pose, double place, double turn) {
  const auto is_in = [](const Interval& one, double value, double slack) {
    return value >= one.lo - slack && value <= one.hi + slack;
  };
  if (!is_in(extent[0], pose.x, place) || !is_in(extent[1], pose.y, place)) return false;
  const double off = std::abs(nearest_angle(pose.heading - extent[2].middle()));
  return off <= 0.5 * extent[2].width() + turn + kHeadingRounding;
}

TouchContact nearest_contact(const PoseFit& fit, const Pose& pose, std::size_t touch) {
  return contact_of(fit, pose, touch, nearest_place(fit.tree(touch), fit.in_part(pose, touch)).place);
}

/// Over all places and normals; of a roll with noise its miss, as a share of the standard deviations that it may have.
double worst_of(const PoseFit& fit, const FittedPose& fitted) {
  double worst = 0;
  for (std::size_t k = 0; k < fitted.places.size(); ++k) {
    const Measured& touch = fit.touches()[k];
    if (touch.roll != nullptr) {
      worst = std::max(worst, touch.roll->worst(fitted.pose, touch.roll->at(fitted.places[k])));
      continue;
    }
    const CentrePoint point = fit.path(k).at(fitted.places[k]);
    const InPart at = fit.in_part(fitted.pose, k);
    if (at.has_place) worst = std::max(worst, (at.at - point.centre).norm() / touch.place_most);
    if (at.tangent) worst = std::max(worst, std::abs(nearest_angle(*at.tangent - point.angle)) / touch.angle_most);
  }
  return worst;
}

/// In order, those that meet joined; a corner is a point. Nodes that are not single are followed down to stretches.
std::vector<Interval> places_of(const PathTree& tree, const std::vector<Cell>& cells) {
  std::vector<Interval> arcs;
  for (const Cell& cell : cells) {
    std::vector<std::int32_t> waiting{cell.first};
    while (!waiting.empty()) {
      const PathTree::Node& node = tree.node(waiting.back());
      waiting.pop_back();
      if (!node.is_single()) {
        waiting.push_back(node.left);
        waiting.push_back(node.right);
        continue;
      }
      const CentreStretch& stretch = tree.path().stretches()[static_cast<std::size_t>(node.stretch)];
      arcs.push_back(stretch.corner ? Interval{stretch.s, stretch.s} : node.u);
    }
  }
  std::sort(arcs.begin(), arcs.end(), [](const Interval& a, const Interval& b) { return a.lo < b.lo; });
  std::vector<Interval> merged;
  for (const Interval& arc : arcs) {
    if (!merged.empty() && arc.lo <= merged.back().hi) {
      merged.back().hi = std::max(merged.back().hi, arc.hi);
    } else {
      merged.push_back(arc);
    }
  }
  return merged;
}

/// `probability`, `spread`, `interval` and `density` stay unset: `add_posterior` has them.
TouchPose described(const PoseFit& fit, const FittedPose& fitted, const std::vector<Cell>& cells,
                    const TouchPair& pair) {
  TouchPose result;
  result.pose = fitted.pose;
  result.chi_square = fitted.square;
  for (std::size_t k = 0; k < fitted.places.size(); ++k) {
    result.contacts.push_back(contact_of(fit, fitted.pose, k, fitted.places[k]));
    result.residual.length = std::max(result.residual.length, result.contacts.back().distance);
    result.residual.turn = std::max(result.residual.turn, std::abs(result.contacts.back().turn.value_or(0)));
  }
  result.worst = worst_of(fit, fitted);
  result.any_heading = !fit.knows_heading() && cover_all(cells);
  result.extent = extent_of(fit, cells, pair, fitted.pose);
  // Then the heading's extent is one turn about the fitted pose.
  if (result.any_heading) {
    result.extent[2] = {fitted.pose.heading - std::numbers::pi, fitted.pose.heading + std::numbers::pi};
  }
  result.continuum = result.any_heading || is_free(fit, fitted, pair, result.extent);
  return result;
}

/// Moments of the mixture of the mode's nodes, about the fitted pose so that little is lost to rounding. Intervals of
/// 95 % are quantiles of the mixture, not of a normal distribution.
void add_posterior(TouchPose& pose, const PoseMode& mode, const std::vector<PosteriorNode>& nodes) {
  double most = -std::numeric_limits<double>::infinity();
  for (const std::size_t k : mode.nodes) most = std::max(most, nodes[k].log_weight);
  std::array<std::vector<MixtureTerm>, 3> terms;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  double total = 0;
  const Eigen::Vector3d origin(pose.pose.x, pose.pose.y, pose.pose.heading);
  for (const std::size_t k : mode.nodes) {
    const PosteriorNode& node = nodes[k];
    const double weight = std::exp(node.log_weight - most);
    // Less than rounding of the sum.
    if (!(weight > 1e-16)) continue;
    const Eigen::Vector3d off(node.pose.x - origin(0), node.pose.y - origin(1),
                              nearest_angle(node.pose.heading - origin(2)));
    for (int i = 0; i < 3; ++i) {
      // Each coordinate by itself: one term of its mixture for each node.
      terms[static_cast<std::size_t>(i)].push_back({weight, origin(i) + off(i), std::sqrt(node.covariance(i, i))});
    }
    total += weight;
    mean += weight * off;
    second += weight * (node.covariance + off * off.transpose());
  }
  mean /= total;
  pose.probability = mode.probability;
  pose.spread.covariance = second / total - mean * mean.transpose();
  pose.spread.mean = {origin(0) + mean(0), origin(1) + mean(1), origin(2) + mean(2)};
  for (std::size_t i = 0; i < 3; ++i) {
    pose.interval[i] = middle_share(terms[i], 0.95);
    for (MixtureTerm& term : terms[i]) term.weight /= total;
  }
  pose.density = std::move(terms);
}

}  // namespace rollfix::touch
