#include "steps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "belief/posterior.hpp"
#include "locate/remaining.hpp"
#include "outline/turn.hpp"
#include "posterior.hpp"

// Notation, of one touch and what is known of the pose beforehand:
//   q, t         the measured centre and the direction of the part's tangent there, with standard deviations sd, sd_t
//   X0, phi0     the part's place and heading as they are known beforehand, with sd_0 and sd_phi
//   o(u), a(u)   the finger's centre and the tangent's angle in the part's frame, at place u of the path
//   (X, phi)     the pose: given u and phi, X is about X0 and about q - R(phi) o(u), so normal about their mean
// The density of the pose and of the contact's place is a sum over a grid of u and phi, with X in closed form.
// Of more contacts posterior.cpp has the density. Of either, with log w of each node, `log_weight`:
//   Z            the sum of all w: `log_evidence`; a mode's share of it is its probability
//   chi^2, nu    sum of squares of the best pose and its degrees of freedom, p = Q(nu / 2, chi^2 / 2): TouchFit
// Follows docs/touch.md, "How it works".
namespace rollfix::touch {
namespace {

// The grid's steps, and how far it goes, in standard deviations of what is known of the two.
constexpr double kGridStep = 0.4;
constexpr double kGridEnd = 6;
// Where the density by u is less than this share of its largest, one set of poses ends.
constexpr double kLogBetweenSets = -7;

double squared(double value) { return value * value; }

/// The nodes of one place on the path, the largest density of which is so.
struct AtPlace {
  std::size_t begin = 0;
  std::size_t end = 0;
  double log_density = 0;
};

/// Touches at one place: along the normal, where they tell something, their mean.
/// As a function of the centre, the product of their normal densities is that of the mean weighted by 1 / sd^2, up to a
/// factor; informations 1 / sd^2 add up.
Measured as_one(const std::vector<Measured>& touches) {
  Measured one = touches.front();
  double information = 0;
  Vec2 sum = Vec2::Zero();
  for (const Measured& touch : touches) {
    information += 1 / squared(touch.place_unit);
    sum += touch.at / squared(touch.place_unit);
  }
  one.at = sum / information;
  one.place_unit = 1 / std::sqrt(information);
  return one;
}

/// log of what the other touches' places on the boundary add up to, as each is anywhere by itself.
/// Each touch by itself adds its sd sqrt(2 pi) along the boundary, the mean takes one such factor away again.
double log_of_others(const std::vector<Measured>& touches) {
  double sum = -std::log(as_one(touches).place_unit * std::sqrt(2 * std::numbers::pi));
  for (const Measured& touch : touches) sum += std::log(touch.place_unit * std::sqrt(2 * std::numbers::pi));
  return sum;
}

/// Nodes of the posterior over (u, phi), of one place and what is known of the pose beforehand.
class Grid {
 public:
  /// REQUIRES a prior with a finite `place_sd`.
  explicit Grid(const Asked& asked)
      : touch_(as_one(asked.fit.touches())),
        path_(asked.fit.path(0)),
        prior_(*asked.problem.pose),
        place_sd_(std::hypot(touch_.place_unit, prior_.place_sd)) {
    for (std::size_t k = 0; k < path_.stretches().size(); ++k) add_stretch(k);
    const double log_weight = log_of_others(asked.fit.touches());
    for (PosteriorNode& node : nodes_) node.log_weight += log_weight;
  }

  /// Those of one set, whose places hang together, are of one group.
  /// A set ends where the density falls below exp(kLogBetweenSets) of its largest; across the start of a closed path
  /// the last set goes on in the first.
  std::vector<PosteriorNode> nodes() && {
    double most = -std::numeric_limits<double>::infinity();
    for (const AtPlace& one : places_) most = std::max(most, one.log_density);
    const auto is_low = [&](const AtPlace& one) { return one.log_density < most + kLogBetweenSets; };
    std::size_t set = 0;
    for (std::size_t k = 0; k < places_.size(); ++k) {
      if (k > 0 && is_low(places_[k - 1]) && !is_low(places_[k])) ++set;
      for (std::size_t node = places_[k].begin; node < places_[k].end; ++node) nodes_[node].group = set;
    }
    const bool goes_round =
        path_.period() > 0 && !places_.empty() && !is_low(places_.front()) && !is_low(places_.back());
    for (PosteriorNode& node : nodes_) node.group = goes_round && node.group == set ? 0 : node.group;
    return std::move(nodes_);
  }

 private:
  /// Steps by u as fine as the density is wide, which a bend makes narrower where the normal is known.
  void add_stretch(std::size_t k) {
    const Interval& all = path_.stretches()[k].u;
    const double length = length_per_u(path_, k);
    // A corner that a point touches.
    if (!(length > 0)) return;
    for (double u = all.lo; u < all.hi;) {
      const CentrePoint point = path_.at({k, u});
      // The centre moves by |dc/du| du, which the place and the prior know to place_sd_.
      double step = std::min(all.hi - u, kGridStep * place_sd_ / point.along.norm());
      if (touch_.tangent && point.bend != 0) {
        // With a normal u moves the heading by bend du.
        const double turn_sd = std::hypot(touch_.angle_unit, prior_.heading_sd);
        step = std::min(step, kGridStep * turn_sd / std::abs(point.bend));
      }
      add_place(path_.at({k, u + 0.5 * step}), step, std::log(step * length));
      u += step;
    }
  }

  /// All headings at one place: those that prior and normal leave, in steps so fine that neither the heading nor the
  /// place, by its arm, moves by more than kGridStep of its sd.
  void add_place(const CentrePoint& point, double step, double log_length) {
    const double arm = point.centre.norm();
    const double known_arm = (touch_.at - Vec2(prior_.mean.x, prior_.mean.y)).norm();
    // q = X + R o, and X is near X0: a place whose |o| is not near |q - X0| fits in no heading.
    if (std::abs(arm - known_arm) > kGridEnd * place_sd_) return;  // in any heading
    double information = 1 / squared(prior_.heading_sd);
    double heading = prior_.mean.heading;
    double square = 0;
    // The heading is known from the prior and as t - a(u): the weighted mean, and by how much the two differ.
    if (touch_.tangent) {
      const double off = nearest_angle(*touch_.tangent - point.angle - heading);
      information += 1 / squared(touch_.angle_unit);
      heading += off / (squared(touch_.angle_unit) * information);
      square = squared(off) / (squared(touch_.angle_unit) + squared(prior_.heading_sd));
    }
    const double sd = 1 / std::sqrt(information);
    // No further than all headings.
    const double half = std::min(kGridEnd * sd, std::numbers::pi);
    const double most = kGridStep * std::min(sd, place_sd_ / std::max(arm, place_sd_));
    const int count = static_cast<int>(std::ceil(2 * half / most));
    const double turn = 2 * half / count;
    const std::size_t begin = nodes_.size();
    for (int k = 0; k < count; ++k) {
      const double off = (k + 0.5) * turn - half;
      add_node(point, heading + off, square + squared(off / sd), step, turn);
    }
    if (nodes_.size() == begin) return;
    AtPlace place{begin, nodes_.size(), -std::numeric_limits<double>::infinity()};
    for (std::size_t k = begin; k < nodes_.size(); ++k) {
      nodes_[k].log_weight = nodes_[k].log_density + log_length;
      place.log_density = std::max(place.log_density, nodes_[k].log_density);
    }
    places_.push_back(place);
  }

  /// X in closed form: normal about the mean of X0 and q - R o(u), weighted by their inverse variances. `square` grows
  /// by how far these two are apart; beyond kGridEnd the node is left out.
  void add_node(const CentrePoint& point, double heading, double square, double step, double turn) {
    const Pose turned{0, 0, heading};
    const Vec2 arm = turned.turned(point.centre);
    const Vec2 known(prior_.mean.x, prior_.mean.y);
    const Vec2 off = touch_.at - arm - known;
    square += off.squaredNorm() / squared(place_sd_);
    if (square > squared(kGridEnd)) return;
    const double share = squared(prior_.place_sd / place_sd_);  // of what was felt
    const double variance = share * squared(touch_.place_unit);
    PosteriorNode node;
    node.pose = {known.x() + share * off.x(), known.y() + share * off.y(), heading};
    node.best = node.pose;
    node.square = square;
    // What the node stands for, a step of u and one of phi, is uniform: variance step^2 / 12 each.
    const Vec2 by_u = -share * step * turned.turned(point.along);
    const Vec2 by_turn = -share * turn * turned_left(arm);
    const Eigen::Vector3d along(by_u.x(), by_u.y(), 0);
    const Eigen::Vector3d across(by_turn.x(), by_turn.y(), turn);
    node.covariance.topLeftCorner<2, 2>() = variance * Eigen::Matrix2d::Identity();
    node.covariance += (along * along.transpose() + across * across.transpose()) / 12;
    // In the units of the others, without the normal distribution's (2 pi)^(3/2).
    node.log_density = -0.5 * square + std::log(variance * turn / std::sqrt(2 * std::numbers::pi));
    nodes_.push_back(node);
  }

  // The one touch, or all at one place as one.
  Measured touch_;
  const CentrePath& path_;
  const PosePrior& prior_;
  // Of q - X0: sqrt(sd^2 + sd_0^2).
  double place_sd_;
  std::vector<PosteriorNode> nodes_;
  // In order along the path; of each its nodes.
  std::vector<AtPlace> places_;
};

// Sets of poses that are as improbable as this are not even looked at.
constexpr double kNegligible = 1e-8;
// Nodes that are looked at for one that leaves the clear paths free.
constexpr std::size_t kLooksForFree = 200;
// Probabilities nearer than this share of them are one but for rounding.
constexpr double kAsProbable = 1e-6;
// Weighing poses with the first touch at one place takes as long as this many comparisons.
constexpr std::size_t kPlaceCost = 2000;

/// log(exp(a) + exp(b) + ...) of the nodes' weights.
/// Minus infinity where there is no weight at all.
double log_total(const std::vector<PosteriorNode>& nodes) {
  double most = -std::numeric_limits<double>::infinity();
  for (const PosteriorNode& node : nodes) most = std::max(most, node.log_weight);
  if (!std::isfinite(most)) return most;
  double sum = 0;
  for (const PosteriorNode& node : nodes) sum += std::exp(node.log_weight - most);
  return most + std::log(sum);
}

/// The node nearest to the middle of a continuum, in the sizes of its intervals: all along it poses fit about alike.
/// REQUIRES a mode with nodes. Of any heading only x and y count.
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
/// nu = residuals - unknowns: 3 of the pose and 1 of each contact's place. chi^2 is that of the fitted pose.
TouchFit fit_of(const Asked& asked, const FittedPose& fitted, bool is_continuum) {
  TouchFit result;
  result.chi_square = fitted.square;
  result.freedom = is_continuum ? -2 : -3;
  const std::vector<Measured>& contacts = asked.fit.touches();
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    // How dense a roll's belief is counts as a measurement of its place.
    if (contacts[k].roll != nullptr) result.freedom += contacts[k].has_place ? 3 : 1;
    if (contacts[k].roll != nullptr) continue;
    // A touch: two of its place, one of its normal, less its own unknown u, which a corner or an end takes away.
    result.freedom += (contacts[k].has_place && !is_reference(contacts[k]) ? 2 : 0) + (contacts[k].tangent ? 1 : 0) - 1;
    result.freedom += asked.fit.is_pinned(fitted.pose, k, fitted.places[k]) ? 1 : 0;
  }
  // What is known beforehand is three measurements, or one of the heading.
  if (asked.problem.pose) result.freedom += std::isfinite(asked.problem.pose->place_sd) ? 3 : 1;
  result.freedom = std::max(result.freedom, 0);
  if (result.freedom > 0) result.p = belief::p_of_chi_square(result.chi_square, result.freedom);
  return result;
}

/// By p; of equal p, the one with more degrees of freedom.
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
  // The best fit may be anywhere along a continuum, at an end as well: its middle says more.
  if (pose.continuum) {
    TouchPose middle = with(asked.fit.fit(nodes[middle_of(pose, set.mode, nodes)].best));
    if (middle.worst <= 1) pose = std::move(middle);
  }
  if (!asked.free.is_blocked(pose.pose)) return pose;
  // A pose of the set that leaves the paths free, or the blocked one if none of the nodes looked at does.
  const PosteriorNode* const free = likeliest_free(asked, set.mode, nodes);
  return free == nullptr ? pose : with(asked.fit.at(free->pose));
}

/// Counts a mode that is not listed, and its probability.
void leave_out(const PoseMode& mode, WeighedPoses& result) {
  ++result.improbable;
  result.rest += mode.probability;
}

/// Modes, each with the pose that fits best.
/// Modes that least squares lead to one pose are joined by `add_set`. Modes of less than kNegligible are counted only.
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
/// A set is listed if it has kLeastListed and its best pose is within all tolerances.
void add_modes(const Asked& asked, const CellSets& sets, std::vector<PoseMode> modes,
               const std::vector<PosteriorNode>& nodes, WeighedPoses& result) {
  result.log_evidence = log_total(nodes);
  for (const PoseSet& set : sets_to_list(asked, sets, std::move(modes), nodes, result)) {
    const bool is_listed = set.mode.probability >= kLeastListed && worst_of(asked.fit, set.fitted) <= 1;
    if (!is_listed) {
      leave_out(set.mode, result);
      continue;
    }
    TouchPose pose = weighed_pose(asked, set, nodes);
    const TouchFit one = fit_of(asked, set.fitted, pose.continuum);
    // The answer's fit is that of the pose that fits best, not of the most probable one.
    if (!result.fit || fits_better(one, *result.fit)) result.fit = one;
    result.poses.push_back(std::move(pose));
  }
  put_in_order(result.poses);
}

}  // namespace

bool knows_place(const TouchProblem& problem) { return problem.pose && std::isfinite(problem.pose->place_sd); }

std::vector<PosteriorNode> nodes_by_prior(const Asked& asked) { return Grid(asked).nodes(); }

void put_in_order(std::vector<TouchPose>& poses) {
  std::stable_sort(poses.begin(), poses.end(),
                   [](const TouchPose& a, const TouchPose& b) { return a.probability > b.probability; });
  for (auto first = poses.begin(); first != poses.end();) {
    const double least = (1 - kAsProbable) * first->probability;
    // Poses from `first` to `end` are equally probable, but for rounding.
    const auto end = std::find_if(first, poses.end(), [&](const TouchPose& one) { return one.probability < least; });
    std::stable_sort(first, end,
                     [](const TouchPose& a, const TouchPose& b) { return a.pose.heading < b.pose.heading; });
    first = end;
  }
}

/// Of a point a corner adds nothing.
double length_in_reach(const CentrePath& path) {
  double length = 0;
  for (std::size_t k = 0; k < path.stretches().size(); ++k) {
    length += path.stretches()[k].u.width() * length_per_u(path, k);
  }
  return length;
}

/// REQUIRES `knows_place`. Without cells: the extents come from the nodes.
WeighedPoses weighed_by_prior(const Asked& asked) {
  std::vector<PosteriorNode> nodes = nodes_by_prior(asked);
  asked.free.weigh(nodes);
  WeighedPoses result;
  add_modes(asked, {}, modes_of(nodes), nodes, result);
  return result;
}

/// `budget`: comparisons; one place of the first touch costs kPlaceCost of them.
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
