#include "steps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "outline/turn.hpp"
#include "work/pulse.hpp"

// Notation:
//   u               unknowns: first contacts z_i and stretches: HeldState::unknowns
//   H               their information with all poses eliminated: Reduced::matrix
//   a               the axis: the first contact that is known worst; the ridge is u(a), the best u with z_a held
//   log p(a)        -chi^2 / 2 + log volume - log det(H without a) / 2: HoldNode::log_density
//   D               scale of each unknown: its set's width / sqrt(12), its standard deviation where no measurement
//                   determines it
// Follows docs/two_fingers.md, "Three and more fingers".
// Idea: what noise leaves is mostly a curve thickened by normal distributions. Where two first contacts and more are
// free it is a cloud: hold_cloud.cpp.
namespace rollfix::hold {
namespace {

constexpr double kRidgeEnd = 12.5;       // below the peak by this much, the ridge ends: five standard deviations
constexpr double kRidgeStep = 0.5;       // standard deviations
constexpr double kMostOfSet = 1.0 / 24;  // of its set a step is at most this share
constexpr double kSteep = 1.2;           // a step over which log p changes more is too long, ...
constexpr double kFlat = 0.15;           // ... and one over which it changes less may be longer
constexpr double kRising = 0.4;          // behind a valley log p rises by this much
constexpr std::size_t kMostNodes = 160;  // to one side
constexpr double kApart = 2;             // standard deviations of both headings: poses that noise tells apart
constexpr std::size_t kWayLooks = 5;     // at nodes, for the ways the part may lie
constexpr double kOneMode = 0.05;        // a valley no deeper than this share of the lower peak
constexpr double kSamePlace = 1e-9;      // of the perimeter
constexpr double kSameOptimum = 0.05;    // of a standard deviation
constexpr double kFreeShare = 0.01;      // of the perimeter: a set that is wider can be a continuum
constexpr double kStillFree = 0.25;      // of the variance in its set: a first contact that is known no better
constexpr double kNeighbours = 10;       // near a cloud's node, in standard deviations of what it stands for, ...
constexpr double kOnCloud = 2;           // ... and of the rest

/// A place that is as likely anywhere on its set has this standard deviation; other unknowns the one they had before
/// the roll.
Scale scales_in(const HoldFit& fit, const HeldSet& set) {
  Scale scale(fit.size());
  for (Eigen::Index k = 0; k < fit.size(); ++k) {
    const auto finger = static_cast<std::size_t>(k);
    scale(k) = finger < fit.fingers()
                   ? std::max(set.extent[finger].width(), fit.rows().errors[finger].travel) / std::sqrt(12.0)
                   : fit.scale_of(k);
  }
  return scale;
}

/// The posterior about one peak. Along a ridge: nodes to both sides, each with the best unknowns for its place on the
/// axis. Or over a cloud.
class RidgeWalk {
 public:
  /// Chooses what is held, and the peak's node. `start`: a minimum of the cost, in `set`.
  RidgeWalk(const HoldFit& fit, const Part& part, const HeldSet& set, const Optimum& start)
      : fit_(fit), boundary_(part.boundary()), scale_(scales_in(fit, set)) {
    const Inverse whole = inverse_within(fit.reduced(start.state).matrix, scale_);
    // On a set that is short no direction is called free.
    double widest = 0;
    for (const Interval& extent : set.extent) widest = std::max(widest, extent.width());
    is_free_ = whole.free > 0 && widest > kFreeShare * boundary_.perimeter;
    held_ = worst_known(whole.covariance, is_free_ ? whole.free : 1);
    sd_ = std::sqrt(whole.covariance(axis(), axis()));
    most_step_ = std::max(scale_(axis()) * std::sqrt(12.0) * kMostOfSet, 0.1 * sd_);
    peak_ = node_at(fit_, start.state, held_, scale_);
  }

  /// Fills `nodes`, in the order of the axis, and `beyond`.
  void run() {
    if (is_cloud()) {
      HoldCloud cloud = cloud_about(fit_, boundary_, peak_.state, held_, scale_);
      nodes = std::move(cloud.nodes);
      box_ = std::move(cloud.box);
      return;
    }
    // Half around to each side: places are not visited twice.
    const double room = boundary_.closed ? 0.5 * boundary_.perimeter : boundary_.perimeter;
    std::vector<HoldNode> behind = walk(-1, room);
    std::reverse(behind.begin(), behind.end());
    nodes = std::move(behind);
    nodes.push_back(peak_);
    for (HoldNode& node : walk(1, room)) nodes.push_back(std::move(node));
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      // Widths of the trapezoid rule. A node alone stands for a normal peak, whose integral is sd sqrt(2 pi).
      const double lo = k > 0 ? place(nodes[k]) - place(nodes[k - 1]) : 0;
      const double hi = k + 1 < nodes.size() ? place(nodes[k + 1]) - place(nodes[k]) : 0;
      nodes[k].width = nodes.size() == 1 ? sd_ * std::sqrt(2 * std::numbers::pi) : 0.5 * (lo + hi);
      // The axis is held at a node; over the width that it stands for it is uniform.
      nodes[k].covariance(axis(), axis()) += nodes[k].width * nodes[k].width / 12;
    }
  }

  /// Whether another optimum lies on the ridge.
  bool passes(const HeldState& other) const {
    if (is_cloud()) return is_in_box(other) && (held_.size() == fit_.fingers() || is_in_cloud(other));
    for (std::size_t k = 0; k + 1 < nodes.size(); ++k) {
      // On the lap of the node.
      const double at = place(nodes[k]) + offset(nodes[k].state, other, axis());
      if (at < place(nodes[k]) || at > place(nodes[k + 1])) continue;
      const double share = (at - place(nodes[k])) / std::max(place(nodes[k + 1]) - place(nodes[k]), 1e-300);
      bool is_on = true;
      for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(fit_.fingers()) && is_on; ++i) {
        if (i == axis()) continue;
        // The ridge between two nodes is a straight line; within a standard deviation of it counts as on it.
        const double mean = share * (nodes[k + 1].state.unknowns(i) - nodes[k].state.unknowns(i));
        is_on = std::abs(offset(nodes[k].state, other, i) - mean) <= std::sqrt(nodes[k].covariance(i, i));
      }
      if (is_on) return true;
    }
    return false;
  }

  /// Whether it is the ridge's own peak.
  bool is_peak(const HeldState& state) const {
    for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(fit_.fingers()); ++i) {
      const double sd = std::sqrt(peak_.covariance(i, i)) + kSamePlace * boundary_.perimeter;
      if (std::abs(offset(peak_.state, state, i)) > kSameOptimum * sd) return false;
    }
    return true;
  }

  std::vector<HoldNode> nodes;
  /// A peak behind a valley, and log p in the valley.
  struct Beyond {
    HeldState state;
    double valley = 0;
  };
  std::vector<Beyond> beyond;
  const HoldNode& peak() const { return peak_; }
  bool is_free() const { return is_free_; }
  bool is_cloud() const { return held_.size() > 1; }

 private:
  double offset(const HeldState& from, const HeldState& to, Eigen::Index unknown) const {
    return boundary_.offset(from.unknowns(unknown), to.unknowns(unknown));
  }

  Eigen::Index axis() const { return held_.front(); }

  /// First contacts that are known worst, the worst of all first, then of those that are left the worst with these
  /// held; no more than `most`, and beyond the first none that is known.
  Held worst_known(UnknownsMatrix covariance, int most) const {
    Held held;
    while (static_cast<int>(held.size()) < most) {
      Eigen::Index worst = 0;
      const double variance = covariance.diagonal().head(static_cast<Eigen::Index>(fit_.fingers())).maxCoeff(&worst);
      if (!held.empty() && !(variance > kStillFree * scale_(worst) * scale_(worst))) break;
      held.push_back(worst);
      // Schur's complement: the covariance of the others with this one held.
      covariance -= UnknownsMatrix(covariance.col(worst) * covariance.row(worst)) / variance;
    }
    return held;
  }

  bool is_in_box(const HeldState& other) const {
    for (std::size_t j = 0; j < held_.size(); ++j) {
      const double at = place(peak_, held_[j]) + offset(peak_.state, other, held_[j]);
      if (at < box_[j].lo || at > box_[j].hi) return false;
    }
    return true;
  }

  /// Among the cloud's nodes: those near by what is held have the rest on both sides, or on it.
  bool is_in_cloud(const HeldState& other) const {
    const auto fingers = static_cast<Eigen::Index>(fit_.fingers());
    const auto is_held = [&](Eigen::Index i) { return std::ranges::find(held_, i) != held_.end(); };
    std::vector<Interval> around(fit_.fingers(),
                                 {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()});
    for (const HoldNode& node : nodes) {
      const auto sds = [&](Eigen::Index i) { return offset(other, node.state, i) / std::sqrt(node.covariance(i, i)); };
      if (std::ranges::any_of(held_, [&](Eigen::Index i) { return std::abs(sds(i)) > kNeighbours; })) continue;
      for (Eigen::Index i = 0; i < fingers; ++i) {
        Interval& range = around[static_cast<std::size_t>(i)];
        const double far = is_held(i) ? std::numeric_limits<double>::infinity() : kOnCloud;
        range = {std::min(range.lo, sds(i) - far), std::max(range.hi, sds(i) + far)};
      }
    }
    return std::ranges::all_of(around, [](const Interval& range) { return range.lo <= 0 && range.hi >= 0; });
  }

  static double place(const HoldNode& node, Eigen::Index unknown) { return node.state.unknowns(unknown); }
  double place(const HoldNode& node) const { return place(node, axis()); }

  /// The node a step along the axis further. The fit starts on the straight line through the last two nodes.
  HoldNode next_to(const HoldNode& from, const HoldNode* before, double step) const {
    Unknowns unknowns = from.state.unknowns;
    if (before != nullptr && place(from) != place(*before)) {
      const double share = step / (place(from) - place(*before));
      unknowns += std::clamp(share, -2.0, 2.0) * (from.state.unknowns - before->state.unknowns);
    }
    unknowns(axis()) = place(from) + step;
    return node_at(fit_, fit_.fit(fit_.at(unknowns, from.state), held_), held_, scale_);
  }

  /// Nodes on one side of the peak. `direction`: 1 or -1 along the axis; `room`: length at most.
  std::vector<HoldNode> walk(int direction, double room) {
    std::vector<HoldNode> found;
    double step = std::min(kRidgeStep * sd_, most_step_);
    const double least_step = step / 64;
    // The least density so far, to notice a valley.
    double lowest = peak_.log_density;
    std::size_t lowest_at = 0;  // nodes up to it
    while (found.size() < kMostNodes) {
      beat();
      const HoldNode& from = found.empty() ? peak_ : found.back();
      const HoldNode* before = found.empty() ? nullptr : found.size() == 1 ? &peak_ : &found[found.size() - 2];
      const double gone = std::abs(place(from) - place(peak_));
      if (gone >= room * (1 - 1e-9)) break;
      double now = std::min(step, room - gone);
      HoldNode next = next_to(from, before, direction * now);
      // Where the density changes fast, steps are halved, down to a 64th of the first.
      while (std::abs(next.log_density - from.log_density) > kSteep && now > least_step &&
             from.log_density > peak_.log_density - kRidgeEnd) {
        now *= 0.5;
        next = next_to(from, before, direction * now);
      }
      step = now;
      // Where it is flat they grow again.
      if (std::abs(next.log_density - from.log_density) < kFlat) step = std::min(1.6 * now, most_step_);
      if (!std::isfinite(next.log_density)) break;
      found.push_back(std::move(next));
      const double log_density = found.back().log_density;
      // Beyond five standard deviations: what is left does not count.
      if (log_density < peak_.log_density - kRidgeEnd) break;
      if (log_density < lowest) {
        lowest = log_density;
        lowest_at = found.size();
      } else if (log_density > lowest + kRising) {
        // It rises again: another peak. Nodes end in the valley, and the peak has a ridge of its own.
        beyond.push_back({fit_.fit(found.back().state), lowest});
        found.resize(lowest_at);
        break;
      }
    }
    return found;
  }

  const HoldFit& fit_;
  Boundary boundary_;
  Scale scale_;
  Held held_;                  // the axis; of a cloud as many as there are free directions
  std::vector<Interval> box_;  // of a cloud, of each of them
  double sd_ = 0;
  double most_step_ = 0;
  bool is_free_ = false;
  HoldNode peak_;
};

/// log of the integral of p over the axis, without overflow.
double log_sum(const std::vector<HoldNode>& nodes) {
  double most = -std::numeric_limits<double>::infinity();
  for (const HoldNode& node : nodes) most = std::max(most, node.log_density);
  double sum = 0;
  for (const HoldNode& node : nodes) sum += node.width * std::exp(node.log_density - most);
  return most + std::log(sum);
}

/// The weight and the best of its nodes.
void sum_up(HoldMode& mode) {
  mode.log_weight = log_sum(mode.nodes);
  mode.best = std::ranges::min_element(mode.nodes, {}, [](const HoldNode& one) { return one.state.cost; })->state;
}

/// Ridges about all optima, and which of them are one mode.
class Humps {
 public:
  Humps(const HoldFit& fit, const Part& part, const std::vector<HeldSet>& sets) : fit_(fit), part_(part), sets_(sets) {}

  /// A ridge from each optimum, the best first, that lies on none before it. Peaks found behind valleys become optima
  /// too.
  std::vector<HoldMode> run(std::vector<Optimum> optima) {
    std::stable_sort(optima.begin(), optima.end(),
                     [](const Optimum& a, const Optimum& b) { return a.state.cost < b.state.cost; });
    // Clouds first: what lies on one is a part of it.
    std::stable_partition(optima.begin(), optima.end(),
                          [&](const Optimum& one) { return RidgeWalk(fit_, part_, sets_[one.set], one).is_cloud(); });
    for (std::size_t next = 0; next < optima.size(); ++next) {
      const Optimum one = optima[next];  // more may be added
      if (known(one.state)) continue;
      RidgeWalk walk(fit_, part_, sets_[one.set], one);
      walk.run();
      // Where a cloud overlaps another they are counted once.
      for (HoldNode& node : walk.nodes) {
        if (walk.is_cloud() && known(node.state)) node.width = 0;
      }
      ridges_.push_back({std::move(walk), one.set, ridges_.size()});
      for (const RidgeWalk::Beyond& other : ridges_.back().walk.beyond) {
        links_.push_back({ridges_.size() - 1, other.state, other.valley});
        optima.push_back({other.state, one.set});
      }
    }
    join();
    return modes();
  }

 private:
  struct Ridge {
    RidgeWalk walk;
    std::size_t set = 0;
    std::size_t head = 0;  // the first of those that are one mode with it
  };
  /// From a ridge over a valley to another peak.
  struct Link {
    std::size_t from = 0;
    HeldState to;
    double valley = 0;  // log density
  };

  /// The head of a ridge's mode.
  std::size_t head_of(std::size_t k) const {
    while (ridges_[k].head != k) k = ridges_[k].head;
    return k;
  }

  /// The ridge that an optimum lies on.
  std::optional<std::size_t> known(const HeldState& state) const {
    for (std::size_t k = 0; k < ridges_.size(); ++k) {
      const RidgeWalk& walk = ridges_[k].walk;
      if (walk.passes(state) || walk.is_peak(state)) return k;
    }
    return std::nullopt;
  }

  /// Two ridges are one mode if the valley between their peaks is not below 5 % of the lower peak.
  void join() {
    for (const Link& link : links_) {
      const std::optional<std::size_t> to = known(link.to);
      if (!to) continue;
      const double one = ridges_[link.from].walk.peak().log_density;
      const double other = ridges_[*to].walk.peak().log_density;
      if (link.valley < std::min(one, other) + std::log(kOneMode)) continue;
      ridges_[std::max(head_of(*to), head_of(link.from))].head = std::min(head_of(*to), head_of(link.from));
    }
  }

  /// Of each head its own nodes and those of all ridges that joined it.
  std::vector<HoldMode> modes() const {
    std::vector<HoldMode> modes;
    for (std::size_t top = 0; top < ridges_.size(); ++top) {
      if (head_of(top) != top) continue;
      HoldMode mode;
      mode.best = ridges_[top].walk.peak().state;
      mode.set = ridges_[top].set;
      for (std::size_t k = top; k < ridges_.size(); ++k) {
        if (head_of(k) != top) continue;
        const RidgeWalk& walk = ridges_[k].walk;
        if (walk.peak().state.cost < mode.best.cost) mode.best = walk.peak().state;
        mode.continuum = mode.continuum || walk.is_free();
        mode.nodes.insert(mode.nodes.end(), walk.nodes.begin(), walk.nodes.end());
      }
      mode.log_weight = log_sum(mode.nodes);
      modes.push_back(std::move(mode));
    }
    return modes;
  }

  const HoldFit& fit_;
  const Part& part_;
  const std::vector<HeldSet>& sets_;
  std::vector<Ridge> ridges_;
  std::vector<Link> links_;
};

/// How far the part is turned from one state to another at the first and at the last row.
Eigen::Vector2d turned_at_ends(const HeldState& one, const HeldState& other) {
  return {std::abs(nearest_angle(one.placed.front().heading - other.placed.front().heading)),
          std::abs(nearest_angle(one.placed.back().heading - other.placed.back().heading))};
}

/// Standard deviations of the heading at the first and at the last row.
Eigen::Vector2d heading_sds(const HoldFit& fit, const HeldState& state) {
  const std::size_t last = fit.rows().rows.size() - 1;
  return {std::sqrt(fit.pose_at(state, 0).covariance(2, 2)), std::sqrt(fit.pose_at(state, last).covariance(2, 2))};
}

/// The part lies differently at the first or at the last row, by more than kApart times the sum of both headings'
/// standard deviations.
bool are_apart(const HoldFit& fit, const HeldState& one, const HeldState& other) {
  const Eigen::Vector2d sds = heading_sds(fit, one) + heading_sds(fit, other);
  return (turned_at_ends(one, other).array() > kApart * sds.array()).any();
}

/// The ways the part may lie at the ends, of some of the mode's nodes where they are the most.
std::vector<HeldState> ways_to_lie(const HoldFit& fit, const HoldMode& mode) {
  std::vector<HeldState> most = fit.poses_at_ends(mode.best);
  for (std::size_t k = 0; k < kWayLooks; ++k) {
    // Spread evenly over the nodes.
    const HoldNode& node = mode.nodes[(2 * k + 1) * mode.nodes.size() / (2 * kWayLooks)];
    std::vector<HeldState> ways = fit.poses_at_ends(node.state);
    if (ways.size() > most.size()) most = std::move(ways);
  }
  return most;
}

}  // namespace

std::vector<HoldMode> split_by_poses(const HoldFit& fit, const HoldMode& mode) {
  if (fit.wheels() == 0 || fit.fingers() > 1) return {mode};
  const std::vector<HeldState> ways = ways_to_lie(fit, mode);
  if (ways.size() < 2) return {mode};
  std::vector<HoldMode> found;
  for (const HeldState& way : ways) {
    // Ways that differ by less than the noise leaves open go into one mode.
    auto own = std::ranges::find_if(found, [&](const HoldMode& one) { return !are_apart(fit, way, one.best); });
    if (own == found.end()) own = found.insert(found.end(), {way, {}, 0, mode.continuum, mode.set});
    for (const HoldNode& node : mode.nodes) {
      own->nodes.push_back(node);
      own->nodes.back().state = fit.at(node.state.unknowns, way);
      // The poses cost more or less; the volume about them is taken as the same.
      own->nodes.back().log_density -= 0.5 * (own->nodes.back().state.square - node.state.square);
    }
  }
  for (HoldMode& one : found) sum_up(one);
  return found;
}

bool is_within(const HeldSet& set, const HeldState& state, const Boundary& boundary, double slack) {
  for (std::size_t k = 0; k < set.extent.size(); ++k) {
    if (!boundary.contains(set.extent[k], state.unknowns(static_cast<Eigen::Index>(k)), slack)) return false;
  }
  return true;
}

bool keep_nodes(HoldMode& mode, const std::function<bool(const HoldNode&)>& is_possible) {
  const std::size_t before = mode.nodes.size();
  std::erase_if(mode.nodes, [&](const HoldNode& node) { return !is_possible(node); });
  if (mode.nodes.empty()) return false;
  if (mode.nodes.size() == before) return true;
  sum_up(mode);
  return true;
}

std::vector<HoldMode> modes_about(const HoldFit& fit, const Part& part, std::vector<Optimum> optima,
                                  const std::vector<HeldSet>& sets) {
  return Humps(fit, part, sets).run(std::move(optima));
}

}  // namespace rollfix::hold
