#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include "posterior.hpp"
#include "roll_belief.hpp"
#include "work/union_find.hpp"

// Notation:
//   group          cells that hang together and have one place of the first touch: docs/touch.md, "How it works"
//   density        of a group the largest of its nodes; links lead to groups of neighbouring places
//   valley         on the way from one peak to another the least density: of two modes it is kValley below the lower
//                  one
//   r^2            of a component of groups the least sum of squares that was found: hopeless where it is kHopeless
//                  more than the least of all
// Idea: groups from the densest to the thinnest join what they are linked to (persistence of peaks by union and find).
// Before, components that fit badly in some of their cells are looked at in more of them, and then left out.
namespace rollfix::touch {
namespace {

// One in so many cells of a component is started from to see how well it fits at all; no fewer and no more than these.
constexpr std::size_t kCellsPerLook = 6;
constexpr std::size_t kLeastLooks = 4;
constexpr std::size_t kMostLooks = 40;
// Looks go around a component's cells by this share: none are alike.
constexpr double kNextLook = 0.6180339887498949;

/// A pose to start from with the first touch on this stretch; none where a roll's belief has nothing there.
/// Of a touch at the middle of the stretch, with this heading; of a roll the middle one of its nodes there.
std::optional<Pose> start_in(const PoseFit& fit, const PathTree::Node& node, double heading, std::size_t touch) {
  const auto stretch = static_cast<std::size_t>(node.stretch);
  const RollBelief* roll = fit.touches()[touch].roll;
  if (roll == nullptr) return fit.pose_at({touch, {stretch, node.u.middle()}}, heading);
  const auto [begin, end] = roll->nodes_in(stretch, node.u);
  if (begin == end) return std::nullopt;
  return roll->pose_at(roll->nodes()[begin + (end - begin) / 2]);
}

// Between two modes the density falls to less than exp(-6) of the lower peak.
constexpr double kValley = 6;
// A normal distribution is within this many standard deviations, and a quantile is found to this share of all of them.
constexpr double kAllOfTerm = 9;
constexpr double kQuantileShare = 1e-11;
constexpr std::uintmax_t kMostIterations = 200;
constexpr double kNever = -std::numeric_limits<double>::infinity();

// Of each group the groups that it is linked to.
using Links = std::vector<std::vector<std::size_t>>;

/// The largest density of each group; kNever where it has no node.
std::vector<double> densities_of(const Posterior& posterior) {
  std::vector<double> density(posterior.owner.size(), kNever);
  for (const PosteriorNode& node : posterior.nodes) {
    density[node.group] = std::max(density[node.group], node.log_density);
  }
  return density;
}

/// Groups that have no nodes of their own and hang together, and their neighbours that have: for a point, a corner.
struct Bridge {
  // Linked with each other; none of them has a node or an owner.
  std::vector<std::size_t> groups;
  // Groups with nodes beside them; empty where there is none.
  std::vector<std::size_t> ends;
};

/// Without them a point's pose on one side of a corner and that on the other side would not hang together: at the
/// corner the boundary has no length, so no node.
std::vector<Bridge> bridges_of(const CellSets& sets, const Posterior& posterior, const std::vector<double>& density) {
  // A group whose fits all ended in another group's pose is no bridge: it has an owner.
  const auto is_bridge = [&](std::size_t g) { return density[g] == kNever && posterior.owner[g] == Posterior::kNone; };
  UnionFind joined(density.size());
  for (const auto& [one, other] : sets.links) {
    if (is_bridge(one) && is_bridge(other)) joined.join(one, other);
  }
  std::vector<Bridge> bridges(density.size());
  for (std::size_t g = 0; g < density.size(); ++g) {
    if (is_bridge(g)) bridges[joined.find(g)].groups.push_back(g);
  }
  for (const auto& [one, other] : sets.links) {
    if (is_bridge(one) && density[other] != kNever) bridges[joined.find(one)].ends.push_back(other);
    if (is_bridge(other) && density[one] != kNever) bridges[joined.find(other)].ends.push_back(one);
  }
  // Bridges stand at the index of their root: the others are empty.
  std::erase_if(bridges, [](const Bridge& bridge) { return bridge.groups.empty(); });
  return bridges;
}

/// Neighbours of each group; what lies at the ends of a bridge is linked.
/// The ends of one bridge are linked in a chain.
Links linked_groups(const CellSets& sets, const std::vector<Bridge>& bridges) {
  Links linked(sets.groups.size());
  const auto link = [&](std::size_t one, std::size_t other) {
    linked[one].push_back(other);
    linked[other].push_back(one);
  };
  for (const auto& [one, other] : sets.links) link(one, other);
  for (const Bridge& bridge : bridges) {
    for (std::size_t k = 1; k < bridge.ends.size(); ++k) link(bridge.ends[k - 1], bridge.ends[k]);
  }
  return linked;
}

/// Groups from the densest on: each joins its neighbours, where the way from one peak to the other is not too low.
/// At each turn `seen` are the groups that are at least as dense as g. Two sets that meet at g are one mode if
/// the log density at g is less than kValley below the lower of their peaks.
void merge_neighbours(const Links& linked, const std::vector<double>& density, UnionFind& merged) {
  std::vector<double> peak = density;  // of a set at its root
  std::vector<std::size_t> order(linked.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return density[a] > density[b]; });
  const auto denser = [&](std::size_t a, std::size_t b) { return peak[a] > peak[b]; };
  std::vector<bool> seen(linked.size(), false);
  for (const std::size_t g : order) {
    // From here on no group has nodes.
    if (density[g] == kNever) break;
    seen[g] = true;
    std::vector<std::size_t> roots;
    for (const std::size_t next : linked[g]) {
      if (seen[next]) roots.push_back(merged.find(next));
    }
    // The denser neighbour first: g belongs to the higher peak.
    std::sort(roots.begin(), roots.end(), denser);
    for (const std::size_t root : roots) {
      const std::size_t own = merged.find(g);
      const std::size_t other = merged.find(root);
      if (own == other || !(std::min(peak[own], peak[other]) - density[g] < kValley)) continue;
      // The root of the joined set is that of the higher peak, so `peak` stays right.
      merged.join(denser(own, other) ? own : other, denser(own, other) ? other : own);
    }
  }
}

/// Groups with nodes by `merge_neighbours`; a group without goes with its owner, or with the densest end of its bridge.
std::vector<std::vector<std::size_t>> merged_groups(const CellSets& sets, const Posterior& posterior) {
  const std::vector<double> density = densities_of(posterior);
  const std::vector<Bridge> bridges = bridges_of(sets, posterior, density);
  UnionFind merged(density.size());
  merge_neighbours(linked_groups(sets, bridges), density, merged);
  for (std::size_t g = 0; g < density.size(); ++g) {
    if (density[g] == kNever && posterior.owner[g] != Posterior::kNone) merged.join(posterior.owner[g], g);
  }
  for (const Bridge& bridge : bridges) {
    if (bridge.ends.empty()) continue;
    // A bridge belongs to the denser side; between two modes it must go to one of them.
    const std::size_t densest = *std::max_element(
        bridge.ends.begin(), bridge.ends.end(), [&](std::size_t a, std::size_t b) { return density[a] < density[b]; });
    for (const std::size_t g : bridge.groups) merged.join(densest, g);
  }
  return merged.sets();
}

/// The modes by their probabilities. `mode_of`: of each group.
/// Shares of the sum of all weights; modes without nodes go.
std::vector<PoseMode> with_nodes(std::vector<PoseMode> modes, const std::vector<std::size_t>& mode_of,
                                 const std::vector<PosteriorNode>& nodes) {
  // Weights as shares of the largest, so that exp does not underflow.
  double most = kNever;
  for (const PosteriorNode& node : nodes) most = std::max(most, node.log_weight);
  double total = 0;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    PoseMode& mode = modes[mode_of[nodes[k].group]];
    const double weight = std::exp(nodes[k].log_weight - most);
    mode.nodes.push_back(k);
    mode.probability += weight;
    total += weight;
  }
  std::erase_if(modes, [](const PoseMode& mode) { return mode.nodes.empty(); });
  for (PoseMode& mode : modes) mode.probability /= total;
  std::stable_sort(modes.begin(), modes.end(),
                   [](const PoseMode& a, const PoseMode& b) { return a.probability > b.probability; });
  return modes;
}

}  // namespace

/// In rounds, one look in each component: so the least square of all is known early, and only components that still
/// seem hopeless are looked at again. Of large components at most kMostLooks looks are taken.
std::vector<bool> hopeless_groups(PoseFit& fit, const CellSets& sets, std::size_t first_touch) {
  // Of each component all its cells.
  std::vector<std::vector<std::size_t>> cells(sets.components.size());
  for (std::size_t c = 0; c < cells.size(); ++c) {
    for (const std::size_t g : sets.components[c]) {
      cells[c].insert(cells[c].end(), sets.groups[g].begin(), sets.groups[g].end());
    }
  }
  // Of each component the least found so far; infinite: not looked at, or a roll has nothing there.
  std::vector<double> squares(cells.size(), std::numeric_limits<double>::infinity());
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t look = 0; look < kMostLooks; ++look) {
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const std::size_t looks = std::clamp(cells[c].size() / kCellsPerLook, kLeastLooks, kMostLooks);
      // Looked at often enough, or known to have hope.
      if (look >= std::min(cells[c].size(), looks) || (look > 0 && squares[c] <= least + kHopeless)) continue;
      // The first look is in the middle.
      const double share = 0.5 + static_cast<double>(look) * kNextLook;
      const auto which = static_cast<std::size_t>((share - std::floor(share)) * static_cast<double>(cells[c].size()));
      const Cell& cell = sets.cells[cells[c][which]];
      const PathTree::Node& node = fit.tree(first_touch).node(cell.first);
      const std::optional<Pose> start = start_in(fit, node, cell.heading.middle, first_touch);
      if (start) squares[c] = std::min(squares[c], fit.fit(*start).square);
      least = std::min(least, squares[c]);
    }
  }
  std::vector<bool> hopeless(sets.groups.size(), false);
  for (std::size_t c = 0; c < squares.size(); ++c) {
    for (const std::size_t g : sets.components[c]) hopeless[g] = squares[c] > least + kHopeless;
  }
  return hopeless;
}

std::vector<PoseMode> modes_of(const CellSets& sets, const Posterior& posterior) {
  const std::vector<PosteriorNode>& nodes = posterior.nodes;
  std::vector<PoseMode> modes;
  std::vector<std::size_t> mode_of(sets.groups.size());
  for (std::vector<std::size_t>& groups : merged_groups(sets, posterior)) {
    for (const std::size_t g : groups) mode_of[g] = modes.size();
    modes.push_back({std::move(groups), {}, 0});
  }
  return with_nodes(std::move(modes), mode_of, nodes);
}

/// By `group` alone: its numbers need not be without gaps.
std::vector<PoseMode> modes_of(const std::vector<PosteriorNode>& nodes) {
  std::vector<std::size_t> mode_of;
  for (const PosteriorNode& node : nodes) {
    while (mode_of.size() <= node.group) mode_of.push_back(mode_of.size());
  }
  return with_nodes(std::vector<PoseMode>(mode_of.size()), mode_of, nodes);
}

/// Quantiles of a mixture of normal distributions, by bracketing its distribution function; `terms` need not be
/// normalized. A term without spread is a step.
Interval middle_share(const std::vector<MixtureTerm>& terms, double share) {
  // All quantiles lie between these two.
  double total = 0, least = std::numeric_limits<double>::infinity(), most = -least;
  for (const MixtureTerm& term : terms) {
    total += term.weight;
    least = std::min(least, term.mean - kAllOfTerm * term.sd);
    most = std::max(most, term.mean + kAllOfTerm * term.sd);
  }
  // The share of the weight below a value.
  const auto below = [&](double value) {
    double sum = 0;
    for (const MixtureTerm& term : terms) {
      const double off = term.mean - value;
      if (std::abs(off) >= kAllOfTerm * term.sd) {
        sum += off < 0 ? term.weight : 0;
      } else {
        sum += term.weight * 0.5 * std::erfc(off / (term.sd * std::numbers::sqrt2));
      }
    }
    return sum / total;
  };
  const double close = kQuantileShare * (most - least);
  const auto is_close = [&](double lo, double hi) {
    const double middle = 0.5 * (lo + hi);
    return !(hi - lo > close && lo < middle && middle < hi);
  };
  const auto quantile = [&](double wanted) {
    // All terms at one value, with no spread.
    if (is_close(least, most)) return 0.5 * (least + most);
    std::uintmax_t iterations = kMostIterations;
    const auto off = [&](double value) { return below(value) - wanted; };
    const auto [lo, hi] =
        boost::math::tools::toms748_solve(off, least, most, -wanted, 1 - wanted, is_close, iterations);
    return 0.5 * (lo + hi);
  };
  return {quantile(0.5 - 0.5 * share), quantile(0.5 + 0.5 * share)};
}

}  // namespace rollfix::touch
