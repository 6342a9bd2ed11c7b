#include "answer_poses.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "outline/turn.hpp"
#include "roll_belief.hpp"
#include "roll_contacts.hpp"

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

/// kTouchSigmas of each node's own standard deviations.
PoseExtent extent_of(const PoseMode& mode, const std::vector<PosteriorNode>& nodes, const Pose& about) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  PoseExtent extent;
  extent.fill({kFar, -kFar});
  for (const std::size_t k : mode.nodes) {
    const Pose& pose = nodes[k].pose;
    const std::array<double, 3> at{pose.x, pose.y, about.heading + nearest_angle(pose.heading - about.heading)};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto axis = static_cast<Eigen::Index>(i);
      const double slack = kTouchSigmas * std::sqrt(nodes[k].covariance(axis, axis));
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
