#include "weighed_poses.hpp"

#include <algorithm>
#include <array>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <limits>
#include <utility>

#include "answer_poses.hpp"
#include "outline/turn.hpp"
#include "tilted_touch.hpp"
#include "touch_and_prior.hpp"

namespace rollfix::touch {
namespace {

// Sets of poses that are as improbable as this are not even looked at.
constexpr double kNegligible = 1e-8;
// Nodes that are looked at for one that leaves the clear paths free.
constexpr std::size_t kLooksForFree = 200;
// Probabilities nearer than this share of them are one but for rounding.
constexpr double kAsProbable = 1e-6;
// Weighing poses with the first touch at one place takes as long as this many comparisons.
constexpr std::size_t kPlaceCost = 2000;

/// log(exp(a) + exp(b) + ...) of the nodes' weights.
double log_total(const std::vector<PosteriorNode>& nodes) {
  double most = -std::numeric_limits<double>::infinity();
  for (const PosteriorNode& node : nodes) most = std::max(most, node.log_weight);
  if (!std::isfinite(most)) return most;
  double sum = 0;
  for (const PosteriorNode& node : nodes) sum += std::exp(node.log_weight - most);
  return most + std::log(sum);
}

/// The node nearest to the middle of a continuum, in the sizes of its intervals: all along it poses fit about alike.
std::size_t middle_of(const TouchPose& pose, const PoseMode& mode, const std::vector<PosteriorNode>& nodes) {
  const auto off = [&](std::size_t k) {
    const std::array<double, 3> at{nodes[k].best.x, nodes[k].best.y, nodes[k].best.heading};
    double square = 0;
    for (std::size_t i = 0; i < (pose.any_heading ? 2 : 3); ++i) {
      const Interval& interval = pose.interval[i];
      const double away = at[i] - interval.middle();
      square += std::pow((i == 2 ? nearest_angle(away) : away) / std::max(interval.width(), 1e-12), 2);
    }
    return square;
  };
  return *std::min_element(mode.nodes.begin(), mode.nodes.end(),
                           [&](std::size_t a, std::size_t b) { return off(a) < off(b); });
}

/// How well a pose fits. Each touch has a place on the boundary that is unknown, unless a corner pins it; where the
/// part is free to slide the pose has one unknown less.
TouchFit fit_of(const Asked& asked, const FittedPose& fitted, bool is_continuum) {
  TouchFit result;
  result.chi_square = fitted.square;
  result.freedom = is_continuum ? -2 : -3;
  const std::vector<Measured>& contacts = asked.fit.touches();
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    // How dense a roll's belief is counts as a measurement of its place.
    if (contacts[k].roll != nullptr) result.freedom += contacts[k].has_place ? 3 : 1;
    if (contacts[k].roll != nullptr) continue;
    result.freedom += (contacts[k].has_place && !is_reference(contacts[k]) ? 2 : 0) + (contacts[k].tangent ? 1 : 0) - 1;
    result.freedom += asked.fit.is_pinned(fitted.pose, k, fitted.places[k]) ? 1 : 0;
  }
  if (asked.problem.pose) result.freedom += std::isfinite(asked.problem.pose->place_sd) ? 3 : 1;
  result.freedom = std::max(result.freedom, 0);
  if (result.freedom > 0) result.p = boost::math::gamma_q(0.5 * result.freedom, 0.5 * result.chi_square);
  return result;
}

bool fits_better(const TouchFit& one, const TouchFit& other) {
  return one.p > other.p || (one.p == other.p && one.freedom > other.freedom);
}

/// The most probable node that leaves all clear paths free; nullptr if none does.
const PosteriorNode* likeliest_free(const Asked& asked, const PoseMode& mode, const std::vector<PosteriorNode>& nodes) {
  std::vector<std::size_t> order = mode.nodes;
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return nodes[a].log_weight > nodes[b].log_weight; });
  if (order.size() > kLooksForFree) order.resize(kLooksForFree);
  const auto free =
      std::find_if(order.begin(), order.end(), [&](std::size_t k) { return !asked.free.is_blocked(nodes[k].pose); });
  return free == order.end() ? nullptr : &nodes[*free];
}

/// A set as a pose of the answer; of a continuum the one in its middle, unless the part is in the way of a path there.
TouchPose weighed_pose(const Asked& asked, const PoseSet& set, const std::vector<PosteriorNode>& nodes) {
  const auto with = [&](const FittedPose& fitted) {
    TouchPose pose = described(asked.fit, fitted, set.cells, asked.pair);
    if (set.cells.empty()) pose.extent = extent_of(set.mode, nodes, fitted.pose);
    add_posterior(pose, set.mode, nodes);
    return pose;
  };
  TouchPose pose = with(set.fitted);
  if (pose.continuum) {
    TouchPose middle = with(asked.fit.fit(nodes[middle_of(pose, set.mode, nodes)].best));
    if (middle.worst <= 1) pose = std::move(middle);
  }
  if (!asked.free.is_blocked(pose.pose)) return pose;
  const PosteriorNode* const free = likeliest_free(asked, set.mode, nodes);
  return free == nullptr ? pose : with(asked.fit.at(free->pose));
}

void leave_out(const PoseMode& mode, WeighedPoses& result) {
  ++result.improbable;
  result.rest += mode.probability;
}

/// Modes, each with the pose that fits best.
std::vector<PoseSet> sets_to_list(const Asked& asked, const CellSets& sets, std::vector<PoseMode> modes,
                                  const std::vector<PosteriorNode>& nodes, WeighedPoses& result) {
  const auto by_square = [&](std::size_t a, std::size_t b) { return nodes[a].square < nodes[b].square; };
  std::vector<PoseSet> found;
  for (PoseMode& mode : modes) {
    if (mode.probability < kNegligible) {
      leave_out(mode, result);
      continue;
    }
    const std::size_t best = *std::min_element(mode.nodes.begin(), mode.nodes.end(), by_square);
    add_set(asked, {asked.fit.fit(nodes[best].best), cells_of(sets, mode.groups), std::move(mode)}, found);
  }
  return found;
}

/// Lists modes, and what all of them weigh.
void add_modes(const Asked& asked, const CellSets& sets, std::vector<PoseMode> modes,
               const std::vector<PosteriorNode>& nodes, WeighedPoses& result) {
  result.log_evidence = log_total(nodes);
  for (const PoseSet& set : sets_to_list(asked, sets, std::move(modes), nodes, result)) {
    const bool is_listed = set.mode.probability >= kLeastProbability && worst_of(asked.fit, set.fitted) <= 1;
    if (!is_listed) {
      leave_out(set.mode, result);
      continue;
    }
    TouchPose pose = weighed_pose(asked, set, nodes);
    const TouchFit one = fit_of(asked, set.fitted, pose.continuum);
    if (!result.fit || fits_better(one, *result.fit)) result.fit = one;
    result.poses.push_back(std::move(pose));
  }
  put_in_order(result.poses);
}

}  // namespace

void put_in_order(std::vector<TouchPose>& poses) {
  std::stable_sort(poses.begin(), poses.end(),
                   [](const TouchPose& a, const TouchPose& b) { return a.probability > b.probability; });
  for (auto first = poses.begin(); first != poses.end();) {
    const double least = (1 - kAsProbable) * first->probability;
    const auto end = std::find_if(first, poses.end(), [&](const TouchPose& one) { return one.probability < least; });
    std::stable_sort(first, end,
                     [](const TouchPose& a, const TouchPose& b) { return a.pose.heading < b.pose.heading; });
    first = end;
  }
}

double length_in_reach(const CentrePath& path) {
  double length = 0;
  for (std::size_t k = 0; k < path.stretches().size(); ++k) {
    length += path.stretches()[k].u.width() * length_per_u(path, k);
  }
  return length;
}

WeighedPoses weighed_by_prior(const Asked& asked) {
  std::vector<PosteriorNode> nodes = nodes_by_prior(asked);
  asked.free.weigh(nodes);
  WeighedPoses result;
  add_modes(asked, {}, modes_of(nodes), nodes, result);
  return result;
}

WeighedPoses weighed_poses(const Asked& asked, const CellSets& sets, std::size_t budget) {
  WeighedPoses result;
  const std::size_t first = asked.pair.first;
  Posterior posterior = posterior_of(asked.fit, sets, first, budget / kPlaceCost);
  result.is_too_long = posterior.is_too_long;
  if (result.is_too_long) return result;
  asked.free.weigh(posterior.nodes);
  result.improbable = posterior.hopeless;
  add_modes(asked, sets, modes_of(sets, posterior), posterior.nodes, result);
  return result;
}

}  // namespace rollfix::touch
