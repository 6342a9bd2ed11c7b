#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "locate/remaining.hpp"
#include "outline/turn.hpp"
#include "pose_fit.hpp"
#include "posterior.hpp"
#include "problem.hpp"
#include "steps.hpp"

// Notation:
//   delta, eps     tolerances of a touch's place and of its normal: `place_most`, `angle_most`
//   leaf           how fine cells are: discs have a radius of no more than leaf x delta, tangents turn by no more than
//                  leaf x eps; CellSearch::kLeaf is the finest, the coarsest has discs of kFirstDisc of the part's
//                  diagonal
//   level          cells of one leaf: LevelCells, and what hangs together of them: LevelSets
//   enough         so many cells show a continuum, which is cut no finer
// Follows docs/touch.md, "How it works".
// Idea: a pose that is held has few cells however fine they are, a continuum ever more. So cells are cut level by
// level, and only sets with few of them go on to the next one.
namespace rollfix::touch {
namespace {

// Of the least standard deviation, or tolerance, of a place: two poses that differ by less are one.
constexpr double kSame = 0.2;

// Discs of the first level, as a share of the part's diagonal, and how much finer each next one is.
constexpr double kFirstDisc = 0.02;
constexpr double kFinerLevel = 0.125;
// A set with more than this share of the cells that are enough is a continuum.
// A pose that is held has some ten or a hundred of them, however fine.
constexpr double kContinuumShare = 0.1;
// More cells than so many times what is enough are a continuum: coarser ones will do.
constexpr std::size_t kFarTooMany = CellSearch::kMostCells / kEnoughCells;

/// The leaf of the next level, no finer than what tolerances ask for.
double finer(double leaf) { return std::max(CellSearch::kLeaf, kFinerLevel * leaf); }

/// The leaf of the first level, in tolerances: discs of kFirstDisc of the diagonal, tangents of kFirstDisc radians. No
/// finer than kLeaf, where tolerances are as wide as that.
double coarsest_leaf(const std::vector<Measured>& contacts, const TouchPair& pair) {
  const double disc = kFirstDisc * contacts[pair.first].tree->path().diagonal();
  double leaf = CellSearch::kLeaf;
  for (const std::size_t k : {pair.first, pair.second}) {
    if (contacts[k].has_place) leaf = std::max(leaf, disc / contacts[k].place_most);
    if (contacts[k].tangent) leaf = std::max(leaf, kFirstDisc / contacts[k].angle_most);
  }
  return leaf;
}

/// Of a component: cells of all its groups.
std::size_t count_cells(const CellSets& sets, const std::vector<std::size_t>& groups) {
  std::size_t count = 0;
  for (const std::size_t g : groups) count += sets.groups[g].size();
  return count;
}

void add(const std::vector<Cell>& more, std::vector<Cell>& to) { to.insert(to.end(), more.begin(), more.end()); }

}  // namespace

/// All cells of these groups, in the groups' order.
std::vector<Cell> cells_of(const CellSets& sets, const std::vector<std::size_t>& groups) {
  std::vector<Cell> cells;
  for (const std::size_t g : groups) {
    for (const std::size_t k : sets.groups[g]) cells.push_back(sets.cells[k]);
  }
  return cells;
}

/// Infinite where no contact has a place.
double least_difference(const std::vector<Measured>& contacts) {
  double least = std::numeric_limits<double>::infinity();
  for (const Measured& one : contacts) {
    if (one.has_place) least = std::min(least, one.place_unit);
  }
  return kSame * least;
}

void add_set(const Asked& asked, PoseSet set, std::vector<PoseSet>& to) {
  const double least = least_difference(asked.fit.touches());
  // A set joins the first one with about its pose; the better fit of the two stays.
  for (PoseSet& known : to) {
    // Where nothing tells the place, answers are of where the contacts are.
    if (asked.place != PlaceKnown::measured) break;
    if (asked.fit.distance(known.fitted.pose, set.fitted.pose) > least) continue;
    if (set.fitted.square < known.fitted.square) known.fitted = std::move(set.fitted);
    known.cells.insert(known.cells.end(), set.cells.begin(), set.cells.end());
    known.mode.nodes.insert(known.mode.nodes.end(), set.mode.nodes.begin(), set.mode.nodes.end());
    known.mode.probability += set.mode.probability;
    return;
  }
  to.push_back(std::move(set));
}

/// `search` starts anew where the first one is abandoned, so that its own comparisons begin at 0.
LevelCells search_levels(std::optional<CellSearch>& search, const AllContacts& contacts, const TouchPair& pair,
                         std::size_t budget, std::size_t enough) {
  LevelCells level;
  // Of a search that meets so many cells, the finest leaf is too fine for a continuum.
  const std::size_t most = kFarTooMany * enough;
  search.emplace(contacts.each, pair, budget, most);
  // Of touches alone the finest leaf is tried first: mostly it has few cells.
  if (contacts.rolls.empty()) {
    level.cells = search->search();
    if (level.cells.undecided.empty()) return level;
    level.abandoned = search->comparisons();
    search.emplace(contacts.each, pair, budget, most);
  }
  // From coarse to fine: each level cuts the cells of the last one, until there are enough to show a continuum.
  level.leaf = coarsest_leaf(contacts.each, pair);
  level.cells = search->search(level.leaf);
  while (level.leaf > CellSearch::kLeaf && level.cells.fit.size() < enough && level.cells.undecided.empty()) {
    level.leaf = finer(level.leaf);
    level.cells = search->search(level.cells.fit, level.leaf);
  }
  return level;
}

/// Each turn: `cells` are all of one leaf that no set of a coarser level holds. Blocked ones go, sets of few cells are
/// cut to the next leaf, sets of many stay as they are.
std::vector<LevelSets> cut_sets(const Asked& asked, CellSearch& search, LevelCells from, std::size_t enough) {
  const PathTree& first = asked.fit.tree(asked.pair.first);
  const PathTree& second = asked.fit.tree(asked.pair.second);
  const auto of_continuum = static_cast<std::size_t>(kContinuumShare * static_cast<double>(enough));
  std::vector<LevelSets> levels;
  std::vector<Cell> cells = std::move(from.cells.fit);
  for (double leaf = from.leaf;; leaf = finer(leaf)) {
    asked.free.drop_blocked(cells, first, asked.fit.touches()[asked.pair.first]);
    CellSets sets = sets_of(first, second, std::move(cells));
    // The finest level takes all that is left.
    if (leaf <= CellSearch::kLeaf) {
      levels.push_back({std::move(sets), leaf});
      return levels;
    }
    std::vector<Cell> few;
    std::vector<Cell> kept;
    for (const std::vector<std::size_t>& component : sets.components) {
      add(cells_of(sets, component), count_cells(sets, component) < of_continuum ? few : kept);
    }
    // Where the budget ends while cutting, the sets stay at this leaf: a coarser cover, but still a cover.
    Cells cut = search.search(few, finer(leaf));
    const bool is_last = few.empty() || !cut.undecided.empty();
    if (is_last) add(few, kept);
    // Components do not change: cells that were apart at this leaf stay apart.
    if (!kept.empty()) levels.push_back({sets_of(first, second, std::move(kept)), leaf});
    if (is_last) return levels;
    cells = std::move(cut.fit);
  }
}

/// Indices of cells and of groups are moved on by those of the levels before. Sets of different levels have no links:
/// they were different components at the coarser one.
CellSets together(std::vector<LevelSets> levels) {
  CellSets all;
  for (LevelSets& level : levels) {
    CellSets& sets = level.sets;
    const std::size_t cells = all.cells.size();
    const std::size_t groups = all.groups.size();
    all.cells.insert(all.cells.end(), sets.cells.begin(), sets.cells.end());
    for (std::vector<std::size_t>& group : sets.groups) {
      for (std::size_t& cell : group) cell += cells;
      all.groups.push_back(std::move(group));
    }
    for (const auto& [one, other] : sets.links) all.links.emplace_back(one + groups, other + groups);
    for (std::vector<std::size_t>& component : sets.components) {
      for (std::size_t& group : component) group += groups;
      all.components.push_back(std::move(component));
    }
  }
  return all;
}

// ---- mixtures of sets
// Notation:
//   S, w(S)   a set of outliers and its weight, docs/touch.md, "Outliers": `outliers`, `log_weights_`
//   p         a pose's probability among those of its set: `probability`, in the end times w(S) / sum of all w
//   m, C      mean and covariance of a pose (x, y, heading): `spread`; d is what two means differ by: `apart`
//   a, b      shares of two poses that are one; their moments are those of the mixture, a m_1 + b m_2 and
//             a C_1 + b C_2 + a b d d^T: `absorb`
// Poses by different sets are one where d^T (C_1 + C_2)^-1 d is small, continua where their intervals overlap.

namespace {

// Poses by different touches are one where they are no further apart than this, in standard deviations of both.
constexpr double kSameBySets = 3;

/// From `one` to `other`; the heading on the shorter way round. NaN in x and y where nothing tells the place.
Eigen::Vector3d apart(const TouchPose& one, const TouchPose& other) {
  const Pose& a = one.spread.mean;
  const Pose& b = other.spread.mean;
  return {b.x - a.x, b.y - a.y, nearest_angle(b.heading - a.heading)};
}

/// Closed intervals.
bool overlap(const Interval& one, const Interval& other) { return one.lo <= other.hi && other.lo <= one.hi; }

/// Whether two continua have poses in common, as far as their intervals say.
bool overlap(const TouchPose& one, const TouchPose& other) {
  const double lap = apart(one, other).z() - (other.spread.mean.heading - one.spread.mean.heading);
  const Interval headings{other.interval[2].lo + lap, other.interval[2].hi + lap};
  // Without a place the headings alone decide.
  const bool by_place = std::isnan(one.interval[0].lo) ||
                        (overlap(one.interval[0], other.interval[0]) && overlap(one.interval[1], other.interval[1]));
  return by_place && overlap(one.interval[2], headings);
}

/// A continuum is never one with a pose that is held.
bool is_same(const TouchPose& one, const TouchPose& other) {
  if (one.continuum != other.continuum || one.any_heading != other.any_heading) return false;
  if (one.outliers == other.outliers) return false;  // two of one answer
  if (one.continuum) return overlap(one, other);
  const Eigen::Vector3d off = apart(one, other);
  const Eigen::Matrix3d covariance = one.spread.covariance + other.spread.covariance;
  // The heading alone.
  if (std::isnan(off.x())) return off.z() * off.z() <= kSameBySets * kSameBySets * covariance(2, 2);
  return off.dot(covariance.ldlt().solve(off)) <= kSameBySets * kSameBySets;
}

/// Takes another set's pose into one: moments, densities and extents of both. REQUIRES that it is the same.
void absorb(TouchPose& pose, TouchPose other) {
  const Eigen::Vector3d off = apart(pose, other);
  const double lap = off.z() - (other.spread.mean.heading - pose.spread.mean.heading);
  const double total = pose.probability + other.probability;
  // b of the notation; a = 1 - b.
  const double share = other.probability / total;
  Pose& mean = pose.spread.mean;
  mean = {mean.x + share * off.x(), mean.y + share * off.y(), mean.heading + share * off.z()};
  // a C_1 + b C_2 + a b d d^T.
  pose.spread.covariance = (1 - share) * pose.spread.covariance + share * other.spread.covariance +
                           share * (1 - share) * off * off.transpose();
  for (std::size_t i = 0; i < 3; ++i) {
    // Terms of both densities, weighted; headings of the other on the lap of this one.
    for (MixtureTerm& term : pose.density[i]) term.weight *= 1 - share;
    for (MixtureTerm term : other.density[i]) {
      pose.density[i].push_back({share * term.weight, term.mean + (i == 2 ? lap : 0), term.sd});
    }
    const double shift = i == 2 ? lap : 0;
    pose.extent[i].lo = std::min(pose.extent[i].lo, other.extent[i].lo + shift);
    pose.extent[i].hi = std::max(pose.extent[i].hi, other.extent[i].hi + shift);
  }
  pose.probability = total;
}

/// One contact for each roll and each touch, of outliers where they are nearest.
/// `outliers` ascend, so that each stands at its own number when it is inserted. `rolls`: their contacts come first.
void add_contacts_of_outliers(const PoseFit& fit, std::size_t rolls, TouchPose& pose) {
  for (const std::size_t k : pose.outliers) {
    pose.contacts.insert(pose.contacts.begin() + static_cast<std::ptrdiff_t>(rolls + k),
                         nearest_contact(fit, pose.pose, k));
  }
}

}  // namespace

void PoseMixture::add(std::vector<TouchPose> poses, const std::vector<std::size_t>& outliers, double log_weight) {
  for (TouchPose& pose : poses) {
    pose.outliers = outliers;
    poses_.push_back(std::move(pose));
    log_weights_.push_back(log_weight);
  }
}

/// From the most probable on, each pose joins the first one that it is the same as. Intervals of mixed poses are
/// computed anew; of the others they stay.
void PoseMixture::finish(const TouchProblem& problem, double log_total, TouchAnswer& answer) {
  for (std::size_t k = 0; k < poses_.size(); ++k) poses_[k].probability *= std::exp(log_weights_[k] - log_total);
  std::stable_sort(poses_.begin(), poses_.end(),
                   [](const TouchPose& a, const TouchPose& b) { return a.probability > b.probability; });
  std::vector<TouchPose> merged;
  std::vector<bool> is_mixed;
  for (TouchPose& pose : poses_) {
    const auto home =
        std::find_if(merged.begin(), merged.end(), [&](const TouchPose& one) { return is_same(one, pose); });
    if (home == merged.end()) {
      merged.push_back(std::move(pose));
      is_mixed.push_back(false);
    } else {
      is_mixed[static_cast<std::size_t>(home - merged.begin())] = true;
      absorb(*home, std::move(pose));
    }
  }
  TouchProblem of_touches = problem;
  // Numbers of outliers are those of touches, without rolls.
  of_touches.rolls.clear();
  const AllContacts contacts(of_touches, answer.radius);
  const PoseFit fit(contacts.each, {});
  // What is listed is taken off below.
  answer.rest = 1;
  for (std::size_t k = 0; k < merged.size(); ++k) {
    TouchPose& pose = merged[k];
    if (!(pose.probability >= kLeastListed)) {
      ++answer.improbable;
      continue;
    }
    answer.rest -= pose.probability;
    for (std::size_t i = 0; is_mixed[k] && i < 3; ++i) {
      if (!std::isnan(pose.interval[i].lo)) pose.interval[i] = middle_share(pose.density[i], 0.95);
    }
    add_contacts_of_outliers(fit, problem.rolls.size(), pose);
    answer.poses.push_back(std::move(pose));
  }
  answer.rest = std::max(0.0, answer.rest);
  put_in_order(answer.poses);
}

}  // namespace rollfix::touch
