#include "weigh_holds.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <limits>
#include <tuple>

#include "outline/turn.hpp"
#include "touch/posterior.hpp"

// Notation:
//   n               error of a contact along the boundary: s = z + L / (1 + e) - n; its row's normal tells of it
//   u, C            unknowns and their covariance at a node: HoldNode::covariance; g: change of a number with u
//   w_k             weight of node k: `weights_of`
// Follows docs/two_fingers.md, "How three fingers are searched", step 3.
// Idea: at each node every number is normal, with variance g^T C g and what is left with u given. Over a mode it is a
// mixture of these: mean = sum of w_k m_k, second moment = sum of w_k (v_k + m_k^2).
namespace rollfix::hold {
namespace {

constexpr double kShareOfInterval = 0.95;

/// A number at one node: mean and variance.
struct AtNode {
  double mean = 0;
  double variance = 0;
};

/// Where a contact was at a row: s = z + L / (1 + e) - n, with n as the row's normal tells it.
AtNode place_at(const HoldFit& fit, const HoldNode& node, std::size_t row, std::size_t finger) {
  const auto count = static_cast<Eigen::Index>(fit.fingers());
  const auto k = static_cast<Eigen::Index>(finger);
  const PoseAtRow pose = fit.pose_at(node.state, row);
  const HoldFit::ContactError error = fit.contact_error(node.state, row, finger);
  // d s / du: 1 by the first contact, -L by the stretch.
  Unknowns by = Unknowns::Zero(fit.size());
  by(k) = 1;
  if (fit.has_stretches()) by(count + k) = -fit.rows().rows[row].contacts[finger].travelled;
  // d phi / du; r = tau - phi - Theta(s) changes by -(kappa ds + dphi), and the error n by by_turn times that.
  const Unknowns turned = pose.by_unknowns.row(2).transpose();
  const Unknowns all = by + error.by_turn * (error.curvature * by + turned);
  AtNode at;
  // The place less the error of its contact that the normal shows.
  at.mean = fit.place_of(node.state, row, finger) - error.mean;
  // By the unknowns; by the heading with these given; and what is left of n.
  at.variance = all.dot(node.covariance * all) + error.by_turn * error.by_turn * pose.covariance(2, 2) + error.variance;
  return at;
}

/// Where a wheel touched at a row: by the pose of the row, with and without the unknowns given.
AtNode wheel_place_at(const HoldFit& fit, const HoldNode& node, std::size_t row, std::size_t wheel) {
  const PoseAtRow pose = fit.pose_at(node.state, row);
  const HoldFit::WheelAt there = fit.wheel_at(node.state, row, wheel);
  const Eigen::Matrix3d covariance =
      pose.covariance + pose.by_unknowns * node.covariance * pose.by_unknowns.transpose();
  return {there.s, there.variance + there.by_pose.dot(covariance * there.by_pose.transpose())};
}

/// Weights of a mode's nodes, together 1.
std::vector<double> weights_of(const HoldMode& mode) {
  std::vector<double> weights;
  double sum = 0;
  for (const HoldNode& node : mode.nodes) {
    // The mode's own weight is only taken out against overflow: the sum is divided by below.
    weights.push_back(node.width * std::exp(node.log_density - mode.log_weight));
    sum += weights.back();
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

/// Mean and standard deviation of a finger's stretch or a wheel's radius over the nodes, as a factor. Nothing if it
/// is no unknown.
void add_length_scale(HoldContact& contact, const HoldFit& fit, const HoldMode& mode,
                      const std::vector<double>& weights, std::size_t contact_number) {
  const auto unknown = fit.scale_unknown(contact_number);
  if (!unknown) return;
  const Eigen::Index k = *unknown;
  double mean = 0, second = 0;
  for (std::size_t node = 0; node < weights.size(); ++node) {
    // Mixture of normals: second moments add.
    const double stretch = mode.nodes[node].state.unknowns(k);
    mean += weights[node] * stretch;
    second += weights[node] * (stretch * stretch + mode.nodes[node].covariance(k, k));
  }
  std::tie(contact.length_scale, contact.length_scale_sd) =
      fit.scale_of_lengths(contact_number, mean, std::sqrt(std::max(0.0, second - mean * mean)));
}

/// The part's pose at a row over all nodes: mean and covariance, about a pose so that headings don't wrap.
PoseSpread spread_of(const HoldFit& fit, const HoldMode& mode, const std::vector<double>& weights, std::size_t row,
                     const Pose& about) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (std::size_t k = 0; k < weights.size(); ++k) {
    const PoseAtRow at = fit.pose_at(mode.nodes[k].state, row);
    const Eigen::Vector3d off(at.pose.x - about.x, at.pose.y - about.y, nearest_angle(at.pose.heading - about.heading));
    const Eigen::Matrix3d covariance =
        at.covariance + at.by_unknowns * mode.nodes[k].covariance * at.by_unknowns.transpose();
    mean += weights[k] * off;
    second += weights[k] * (covariance + off * off.transpose());
  }
  PoseSpread spread;
  spread.mean = {about.x + mean(0), about.y + mean(1), about.heading + mean(2)};
  spread.covariance = second - mean * mean.transpose();
  return spread;
}

/// A contact's place at a row: mean in [0, P), standard deviation and 95 % interval.
struct Summary {
  double mean = 0;
  double sd = 0;
  Interval interval;
};

/// `contact`: a finger's number, or fingers() and a wheel's number behind them.
Summary summary_of(const HoldFit& fit, const HoldMode& mode, const std::vector<double>& weights, std::size_t row,
                   std::size_t contact, const Boundary& boundary) {
  const bool is_wheel = contact >= fit.fingers();
  // Places are averaged as offsets from the best one, so that s = 0 is no seam.
  const double about =
      is_wheel ? fit.wheel_at(mode.best, row, contact - fit.fingers()).s : fit.place_of(mode.best, row, contact);
  std::vector<MixtureTerm> terms;
  double mean = 0, second = 0;
  for (std::size_t k = 0; k < weights.size(); ++k) {
    const AtNode at = is_wheel ? wheel_place_at(fit, mode.nodes[k], row, contact - fit.fingers())
                               : place_at(fit, mode.nodes[k], row, contact);
    const double off = boundary.offset(about, at.mean);
    terms.push_back({weights[k], about + off, std::sqrt(at.variance)});
    mean += weights[k] * off;
    second += weights[k] * (at.variance + off * off);
  }
  Summary summary;
  summary.mean = boundary.canonical(about + mean);
  summary.sd = std::sqrt(std::max(0.0, second - mean * mean));
  // Equal shares of probability are left out on both sides.
  const Interval range = touch::middle_share(terms, kShareOfInterval);
  summary.interval = boundary.closed ? boundary.arc(range.lo, range.hi)
                                     : Interval{std::clamp(range.lo, 0.0, boundary.perimeter),
                                                std::clamp(range.hi, 0.0, boundary.perimeter)};
  return summary;
}

/// Where a wheel touches in a state.
HoldContact described_wheel(const HoldFit& fit, const Part& part, const HeldState& state, std::size_t wheel,
                            const Interval& extent) {
  const std::size_t last = fit.rows().rows.size() - 1;
  const Boundary boundary = part.boundary();
  HoldContact contact;
  contact.start = boundary.canonical(fit.wheel_at(state, 0, wheel).s);
  contact.end = boundary.canonical(fit.wheel_at(state, last, wheel).s);
  contact.extent = extent;
  contact.point = part.point(contact.start);
  contact.tangent = part.tangent(contact.start);
  for (std::size_t row = 0; row <= last; ++row) {
    // Distance from the path of pins, and the encoder's angle.
    const ContactResidual off = fit.wheel_residual(state, row, wheel);
    contact.distance = std::max(contact.distance, off.place.norm());
    contact.turn = std::max(contact.turn, std::abs(off.turn));
  }
  return contact;
}

}  // namespace

/// With noise a contact is shown where its normal has it, z + L / (1 + e) - n; without noise where its length has it.
/// Residuals are the largest over the rows.
HoldPlacement described(const HoldFit& fit, const Part& part, const HeldState& state, const HeldSet& set) {
  HoldPlacement placement;
  const Boundary boundary = part.boundary();
  const std::size_t last = fit.rows().rows.size() - 1;
  for (std::size_t k = 0; k < fit.fingers(); ++k) {
    HoldContact contact;
    // Without noise contacts are known to their digits, and n is not estimated.
    const double first_error = fit.rows().has_noise ? fit.contact_error(state, 0, k).mean : 0;
    const double last_error = fit.rows().has_noise ? fit.contact_error(state, last, k).mean : 0;
    contact.start = boundary.canonical(fit.place_of(state, 0, k) - first_error);
    contact.end = boundary.canonical(fit.place_of(state, last, k) - last_error);
    contact.extent = set.extent[k];
    contact.point = part.point(contact.start);
    contact.tangent = part.tangent(contact.start);
    for (std::size_t row = 0; row <= last; ++row) {
      const ContactResidual off = fit.residual(state, row, k);
      if (fit.rows().errors[k].has_place) contact.distance = std::max(contact.distance, off.place.norm());
      contact.turn = std::max(contact.turn, std::abs(off.turn));
    }
    placement.residual.length = std::max(placement.residual.length, contact.distance);
    placement.residual.turn = std::max(placement.residual.turn, contact.turn);
    placement.contacts.push_back(contact);
  }
  for (std::size_t k = 0; k < fit.wheels(); ++k) {
    placement.contacts.push_back(described_wheel(fit, part, state, k, set.wheels[k]));
    placement.residual.length = std::max(placement.residual.length, placement.contacts.back().distance);
    placement.residual.turn = std::max(placement.residual.turn, placement.contacts.back().turn);
  }
  placement.first = fit.pose_at(state, 0).pose;
  placement.last = fit.pose_at(state, last).pose;
  // In (-pi, pi].
  placement.first.heading = nearest_angle(placement.first.heading);
  placement.last.heading = nearest_angle(placement.last.heading);
  // With noise chi-square says how well it fits.
  placement.worst = fit.rows().has_noise ? 0 : fit.worst(state);
  placement.chi_square = state.right_square;
  return placement;
}

/// Means, standard deviations and intervals at the first and at the last row, and the spreads of both poses.
void add_posterior(HoldPlacement& placement, const HoldFit& fit, const Part& part, const HoldMode& mode) {
  const std::vector<double> weights = weights_of(mode);
  const std::size_t last = fit.rows().rows.size() - 1;
  const Boundary boundary = part.boundary();
  for (std::size_t k = 0; k < fit.fingers() + fit.wheels(); ++k) {
    const Summary start = summary_of(fit, mode, weights, 0, k, boundary);
    const Summary end = summary_of(fit, mode, weights, last, k, boundary);
    HoldContact& contact = placement.contacts[k];
    contact.mean = start.mean;
    contact.sd = start.sd;
    contact.interval = start.interval;
    contact.end_mean = end.mean;
    contact.end_sd = end.sd;
    add_length_scale(contact, fit, mode, weights, k);
  }
  placement.first_spread = spread_of(fit, mode, weights, 0, placement.first);
  placement.last_spread = spread_of(fit, mode, weights, last, placement.last);
  placement.continuum = mode.continuum;
}

/// Chi-square without outliers, and without what was known of the first contact and the pose. Without freedom p stays
/// 1: nothing can contradict.
TouchFit fit_of(const HoldFit& fit, const HeldState& state) {
  TouchFit result;
  result.chi_square = state.right_square;
  const double freedom = fit.freedom(state);
  result.freedom = std::max(0, static_cast<int>(std::lround(freedom)));
  if (result.freedom > 0) result.p = boost::math::gamma_q(0.5 * result.freedom, 0.5 * result.chi_square);
  return result;
}

}  // namespace rollfix::hold
