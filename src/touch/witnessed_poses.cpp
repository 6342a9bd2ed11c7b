#include "steps.hpp"

#include <algorithm>
#include <boost/container/small_vector.hpp>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "cell_search.hpp"
#include "outline/turn.hpp"
#include "pose_fit.hpp"

// Notation:
//   t_j, w_j        residuals in tolerances, and weights, of all together 1: a residual's unit is its tolerance /
//                   sqrt(w_j)
//   w . t^2         the sum of squares that is least at the fitted pose: `FittedPose::square`
//   (X, phi)        a pose: a box is its `middle`, turned by up to `turn` about the touches' middle, then moved by up
//                   to `place` in x and in y
//   q_i, c(u)       a touch in the part's frame, and the finger's centre on the path: `in_part`, PathTree
//   delta, eps      tolerances of place and of angle: `place_most`, `angle_most`
//   slack           how far a touch moves in the part's frame over the box, at most
// Follows C. L. Lawson, "Contributions to the theory of linear least maximum approximation" (1961), and docs/touch.md,
// "How it works".
// Idea: residuals that are large are given more weight, round by round, which makes the largest smaller. The weights
// tell as well when to give up: as max t^2 >= w . t^2, no pose nearby is within its tolerances where the least sum of
// squares is more than 1. That is no proof, but boxes of poses are one: in one pose the touches have nothing to do with
// each other. So a box goes when some touch is further from the path than tolerance and slack, a pose in which all are
// within the tolerance is a witness, and the rest is halved.
namespace rollfix::touch {
namespace {

// Starts on a set of cells, and rounds of weighting.
constexpr std::size_t kMostWitnesses = 8;
constexpr int kLawsonRounds = 30;
// A weight is made smaller in one round by no more than this factor: a residual of nothing can grow again.
constexpr double kLeastFactor = 1e-6;

/// The residuals of a touch in a fitted pose, as shares of their tolerances.
struct Shares {
  double place = 0;
  double angle = 0;
};

/// Lawson's rounds over PoseFit: from a start to the pose nearby whose largest residual, as a share of its tolerance,
/// is least.
class LeastWorst {
 public:
  explicit LeastWorst(const PoseFit& fit) : fit_(fit), touches_(fit.touches()), weighed_(touches_, {}) {}
  LeastWorst(const LeastWorst&) = delete;
  LeastWorst& operator=(const LeastWorst&) = delete;

  /// Ends once a pose is within all tolerances (max t <= 1), or the weighted mean of t^2 exceeds 1, when none nearby
  /// is, or the rounds are over. The best pose met so far is returned, with its squares in the touches' own units.
  FittedPose from(const Pose& start) {
    reset();
    FittedPose fitted = weighed_.fit(start);
    FittedPose best = fitted;
    double least = worst_of(fit_, fitted);
    for (int round = 0; round < kLawsonRounds && least > 1 && fitted.square <= 1; ++round) {
      weigh(fitted);
      fitted = weighed_.fit(fitted);
      const double worst = worst_of(fit_, fitted);
      if (worst >= least) continue;
      least = worst;
      best = fitted;
    }
    return fit_.at(best.pose, best.places);
  }

 private:
  /// All residuals alike.
  void reset() {
    std::size_t count = 0;
    for (const Measured& touch : touches_) count += (touch.has_place ? 1 : 0) + (touch.tangent ? 1 : 0);
    weights_.assign(touches_.size(), {1.0 / static_cast<double>(count), 1.0 / static_cast<double>(count)});
    set_units();
  }

  /// With unit = tolerance / sqrt(w) the sum of squares of PoseFit is the sum of w t^2.
  void set_units() {
    for (std::size_t k = 0; k < touches_.size(); ++k) {
      touches_[k].place_unit = touches_[k].place_most / std::sqrt(weights_[k].place);
      touches_[k].angle_unit = touches_[k].angle_most / std::sqrt(weights_[k].angle);
    }
  }

  /// Each weight by its residual.
  void weigh(const FittedPose& fitted) {
    double sum = 0;
    for (std::size_t k = 0; k < touches_.size(); ++k) {
      const InPart at = fit_.in_part(fitted.pose, k);
      const CentrePoint point = fit_.path(k).at(fitted.places[k]);
      if (at.has_place) {
        weights_[k].place *= kLeastFactor + (at.at - point.centre).norm() / touches_[k].place_most;
        sum += weights_[k].place;
      }
      if (at.tangent) {
        weights_[k].angle *= kLeastFactor + std::abs(nearest_angle(*at.tangent - point.angle)) / touches_[k].angle_most;
        sum += weights_[k].angle;
      }
    }
    // All weights together are 1 again.
    for (Shares& weight : weights_) weight = {weight.place / sum, weight.angle / sum};
    set_units();
  }

  const PoseFit& fit_;
  std::vector<Measured> touches_;  // with units that follow the weights
  PoseFit weighed_;
  std::vector<Shares> weights_;
};

/// The fitted pose whose worst residual is least, as a share of its tolerance: from a few of the set's cells, until one
/// is within all tolerances.
FittedPose best_within(const PoseFit& fit, const std::vector<Cell>& cells, const TouchPair& pair) {
  LeastWorst least_worst(fit);
  FittedPose best;
  double least = std::numeric_limits<double>::infinity();
  const std::size_t starts = std::min(cells.size(), kMostWitnesses);
  for (std::size_t start = 0; start < starts && least > 1; ++start) {
    // Starts are spread evenly over the set's cells, in the middle of each share.
    const Cell& cell = cells[(2 * start + 1) * cells.size() / (2 * starts)];
    const PathTree::Node& node = fit.tree(pair.first).node(cell.first);
    const Held held{pair.first, {static_cast<std::size_t>(node.stretch), node.u.middle()}};
    FittedPose found = least_worst.from(fit.pose_at(held, cell.heading.middle));
    const double worst = worst_of(fit, found);
    if (worst >= least) continue;
    least = worst;
    best = std::move(found);
  }
  return best;
}

/// What boxes of poses came to.
struct BoxesFound {
  std::optional<FittedPose> witness;  // a pose with every residual within its tolerance
  bool refuted = false;               // there is none; neither: the budget ran out
};

// Places of a touch are looked at in pieces of this share of its tolerance; a box that is left is no larger than it.
constexpr double kFinest = 0.002;

// A box is moved only where it turns by no more, radians: what moves it turns with it.
constexpr double kLittleTurn = 0.3;

/// Poses: a middle, turned by up to so much about the touches' middle, and then moved by up to so much in x and in y.
struct PoseBox {
  Pose middle;
  double place = 0;  // half of its sides
  double turn = 0;
};

/// Whether an angle is within so much of another.
/// Modulo whole turns.
bool is_near(double one, double other, double most) { return std::abs(nearest_angle(one - other)) <= most; }

/// A place within these tolerances of a touch, or one that is not known to be outside them by more than a little.
/// Depth first over the tree. A node goes where its disc is further than `place`, or its tangents than `angle`. Surely:
/// a place counts if it is within the tolerances itself; else also a node so small that it is within kFinest of them.
std::optional<PathPlace> place_within(PathTree& tree, const InPart& touch, double place, double angle, bool surely) {
  boost::container::small_vector<std::int32_t, 64> waiting{tree.root()};
  while (!waiting.empty()) {
    const std::int32_t index = waiting.back();
    waiting.pop_back();
    const PathTree::Node& node = tree.node(index);
    const double off = touch.has_place ? (touch.at - node.middle).norm() : 0;
    if (touch.has_place && off - node.radius > place) continue;
    if (touch.tangent && !is_near(*touch.tangent, node.angle, angle + node.half_turn)) continue;
    if (node.is_single()) {
      const PathPlace middle{static_cast<std::size_t>(node.stretch), node.u.middle()};
      // The middle place of a node is one of the path.
      const bool is_inside =
          off <= place && (!touch.tangent || is_near(*touch.tangent, tree.path().at(middle).angle, angle));
      const bool is_small =
          (!touch.has_place || node.radius <= kFinest * place) && (!touch.tangent || node.half_turn <= kFinest * angle);
      if (is_inside || (is_small && !surely)) return middle;
      if (is_small) continue;
    }
    const auto [left, right] = tree.halves(index);
    if (left == right) continue;
    waiting.push_back(left);
    waiting.push_back(right);
  }
  return std::nullopt;
}

/// Boxes of poses, halved until one holds a witness or all are refuted.
class WitnessSearch {
 public:
  /// Only poses in `extent` count. `budget`: boxes.
  WitnessSearch(PoseFit& fit, const PoseExtent& extent, std::size_t budget)
      : fit_(fit), extent_(extent), budget_(budget) {
    finest_ = fit.touches().front().place_most;
    for (const Measured& touch : fit.touches()) finest_ = std::min(finest_, touch.place_most);
    finest_ *= kFinest;
    for (const Measured& touch : fit.touches()) reach_ = std::max(reach_, (touch.at - fit.about()).norm());
  }

  /// Depth first. A box goes where it is outside of the extent, or where some touch has no place in any of its poses;
  /// its middle is tried as a witness. A box at the finest size that is neither leaves the question open.
  BoxesFound search(const PoseBox& all) {
    std::vector<PoseBox> waiting{all};
    bool decided = true;
    for (std::size_t count = 0; !waiting.empty(); ++count) {
      if (count >= budget_) return {};
      const PoseBox box = waiting.back();
      waiting.pop_back();
      if (is_outside(box) || !may_fit(box)) continue;
      if (std::optional<FittedPose> witness = fits(box.middle)) return {std::move(witness), false};
      if (std::max(box.place, reach_ * box.turn) <= finest_) {
        decided = false;
        continue;
      }
      split(box, waiting);
    }
    return {std::nullopt, decided};
  }

 private:
  /// The touch that ruled out the box before is asked first: mostly it does again.
  bool may_fit(const PoseBox& box) {
    const std::size_t count = fit_.touches().size();
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t touch = (last_ + k) % count;
      if (may_fit(box, touch)) continue;
      last_ = touch;
      return false;
    }
    return true;
  }

  /// The touch moves in the part's frame by up to sqrt(2) * place, and with the turn by the arm from the middle of the
  /// touches; tolerances are wider by that.
  bool may_fit(const PoseBox& box, std::size_t which) {
    const Measured& touch = fit_.touches()[which];
    const double moved = std::numbers::sqrt2 * box.place;
    const double slack = moved + box.turn * (moved + (touch.at - fit_.about()).norm());
    return place_within(fit_.tree(which), fit_.in_part(box.middle, which), touch.place_most + slack,
                        touch.angle_most + box.turn, false)
        .has_value();
  }

  /// Whether no pose of the box is in the extent.
  /// The part's origin moves with the box, and with the turn about the touches' middle.
  bool is_outside(const PoseBox& box) const {
    const double swing = std::hypot(box.middle.x - fit_.about().x(), box.middle.y - fit_.about().y()) * box.turn;
    const double place = std::numbers::sqrt2 * box.place * (1 + box.turn) + swing;
    return !holds(extent_, box.middle, place, box.turn);
  }

  /// A pose with a place for each touch that is surely within its tolerances, and in the extent.
  std::optional<FittedPose> fits(const Pose& pose) {
    if (!holds(extent_, pose)) return std::nullopt;
    std::vector<PathPlace> places;
    for (std::size_t k = 0; k < fit_.touches().size(); ++k) {
      const Measured& touch = fit_.touches()[k];
      const auto place = place_within(fit_.tree(k), fit_.in_part(pose, k), touch.place_most, touch.angle_most, true);
      if (!place) return std::nullopt;
      places.push_back(*place);
    }
    return fit_.at(pose, std::move(places));
  }

  /// In four, or where the turn moves the touches further in two.
  void split(const PoseBox& box, std::vector<PoseBox>& waiting) const {
    if (reach_ * box.turn > box.place || box.turn > kLittleTurn) {
      for (const double side : {-0.5, 0.5}) {
        waiting.push_back({fit_.moved(box.middle, {0, 0, side * box.turn}), box.place, 0.5 * box.turn});
      }
      return;
    }
    // The new middle's own move turns with it.
    const double place = 0.5 * box.place * (1 + std::numbers::sqrt2 * box.turn);
    for (const double x : {-0.5, 0.5}) {
      for (const double y : {-0.5, 0.5}) {
        waiting.push_back({fit_.moved(box.middle, {x * box.place, y * box.place, 0}), place, box.turn});
      }
    }
  }

  PoseFit& fit_;
  PoseExtent extent_;
  std::size_t budget_;
  // Boxes no larger are not halved, length.
  double finest_ = 0;
  // Of the touches from their middle, length: a turn moves them by no more than that times it.
  double reach_ = 0;
  // The touch that ruled out the last box.
  std::size_t last_ = 0;
};

/// Around all poses of the cells.
/// The middle is that of the first cell. A cell's poses differ from its own middle pose by the disc of the first
/// contact, its tolerance and the swing of the headings.
PoseBox box_around(PoseFit& fit, const std::vector<Cell>& cells, const TouchPair& pair) {
  const Measured& first = fit.touches()[pair.first];
  const auto pose_of = [&](const Cell& cell) {
    const PathTree::Node& node = fit.tree(pair.first).node(cell.first);
    return fit.pose_at({pair.first, {static_cast<std::size_t>(node.stretch), node.u.middle()}}, cell.heading.middle);
  };
  PoseBox box{pose_of(cells.front()), 0, 0};
  for (const Cell& cell : cells) {
    const Pose pose = pose_of(cell);
    const double turn = nearest_angle(pose.heading - box.middle.heading);
    const Pose turned = fit.moved(box.middle, {0, 0, turn});
    const double swing = (first.at - fit.about()).norm() * cell.heading.half;
    const double slack = fit.tree(pair.first).node(cell.first).radius + first.place_most + swing;
    box.place = std::max(box.place, std::hypot(pose.x - turned.x, pose.y - turned.y) + slack);
    box.turn = std::max(box.turn, std::abs(turn) + cell.heading.half);
  }
  // More than all headings is all.
  box.turn = std::min(box.turn, std::numbers::pi);
  return box;
}

/// Whether some pose with its first two contacts on one of the cells fits all touches. In a single pose touches have
/// nothing to do with each other, so halving boxes of poses decides it, where pairs of places leave near misses.
BoxesFound search_boxes(PoseFit& fit, const std::vector<Cell>& cells, const TouchPair& pair, std::size_t budget) {
  return WitnessSearch(fit, extent_of(fit, cells, pair, {0, 0, cells.front().heading.middle}), budget)
      .search(box_around(fit, cells, pair));
}

// How often sets without a pose that is known to fit are looked at again, each time with a leaf so many times as fine.
constexpr int kRefinements = 2;
constexpr double kFiner = 0.25;
// Boxes of poses that are looked at for each such set.
constexpr std::size_t kBoxBudget = 200000;
// Cells of a set that are looked at for a pose that leaves the clear paths free.
constexpr std::size_t kFreeLooks = 64;

/// A pose from some cell that leaves the paths free and fits best, or else the one given.
FittedPose best_free(const Asked& asked, const std::vector<Cell>& cells, FittedPose given) {
  PoseFit& fit = asked.fit;
  const std::size_t first = asked.pair.first;
  std::optional<FittedPose> best;
  const std::size_t looks = std::min(cells.size(), kFreeLooks);
  for (std::size_t look = 0; look < looks; ++look) {
    const Cell& cell = cells[(2 * look + 1) * cells.size() / (2 * looks)];
    const PathTree::Node& node = fit.tree(first).node(cell.first);
    // The first contact stays on the cell, so that the pose is one of the set.
    const Held held{first, {static_cast<std::size_t>(node.stretch), node.u.middle()}};
    FittedPose fitted = fit.fit(fit.pose_at(held, cell.heading.middle), held);
    if (asked.free.is_blocked(fitted.pose) || (best && worst_of(fit, *best) <= worst_of(fit, fitted))) continue;
    best = std::move(fitted);
  }
  return best ? std::move(*best) : std::move(given);
}

/// What is known of a set.
struct Looked {
  std::optional<FittedPose> witness;
  bool refuted = false;  // proved: no pose of the set fits
};

/// Three steps, each only where the one before has not decided: least worst residual, boxes of poses, and, where a path
/// is in the way, other poses of the set.
Looked look_in(const Asked& asked, const std::vector<Cell>& cells) {
  PoseFit& fit = asked.fit;
  const PoseExtent extent = extent_of(fit, cells, asked.pair, {0, 0, cells.front().heading.middle});
  // Least squares may lead to a pose of another set.
  const auto is_one = [&](const FittedPose& pose) { return worst_of(fit, pose) <= 1 && holds(extent, pose.pose); };
  FittedPose fitted = best_within(fit, cells, asked.pair);
  BoxesFound boxes;
  if (!is_one(fitted)) boxes = search_boxes(fit, cells, asked.pair, kBoxBudget);
  if (boxes.refuted) return {{}, true};
  if (boxes.witness) fitted = std::move(*boxes.witness);
  if (asked.free.is_blocked(fitted.pose)) fitted = best_free(asked, cells, std::move(fitted));
  if (!is_one(fitted) || asked.free.is_blocked(fitted.pose)) return {};
  return {std::move(fitted)};
}

/// Looks in sets of cells, and again in finer ones.
class Witnesses {
 public:
  Witnesses(const Asked& asked, CellSearch& search) : asked_(asked), search_(search) {}

  /// Each component is witnessed, refuted or looked at again with finer cells, which may fall apart. After kRefinements
  /// rounds it is left without a witness.
  void look_at(const CellSets& sets, double leaf, int round = 0) {
    for (const std::vector<std::size_t>& component : sets.components) {
      std::vector<Cell> own = cells_of(sets, component);
      Looked looked = look_in(asked_, own);
      if (looked.refuted) continue;
      if (looked.witness) {
        add_set(asked_, {std::move(*looked.witness), std::move(own)}, found_);
      } else if (round == kRefinements) {
        result_.without.insert(result_.without.end(), own.begin(), own.end());
      } else {
        look_finer(own, kFiner * leaf, round + 1);
      }
    }
  }

  /// Ends the search: all found sets as poses.
  WitnessedPoses result() {
    for (const PoseSet& set : found_) {
      result_.poses.push_back(described(asked_.fit, set.fitted, set.cells, asked_.pair));
    }
    std::sort(result_.poses.begin(), result_.poses.end(),
              [](const TouchPose& a, const TouchPose& b) { return a.pose.heading < b.pose.heading; });
    return std::move(result_);
  }

 private:
  /// Undecided cells of the finer search are kept as such.
  void look_finer(const std::vector<Cell>& cells, double leaf, int round) {
    const PathTree& first = asked_.fit.tree(asked_.pair.first);
    Cells finer = search_.search(cells, leaf);
    asked_.free.drop_blocked(finer.fit, first, asked_.fit.touches()[asked_.pair.first]);
    result_.undecided.insert(result_.undecided.end(), finer.undecided.begin(), finer.undecided.end());
    look_at(sets_of(first, asked_.fit.tree(asked_.pair.second), std::move(finer.fit)), leaf, round);
  }

  const Asked& asked_;
  CellSearch& search_;
  // Sets with a witness, those of one pose joined.
  std::vector<PoseSet> found_;
  WitnessedPoses result_;
};

}  // namespace

WitnessedPoses witnessed_poses(const Asked& asked, CellSearch& search, const std::vector<LevelSets>& levels) {
  Witnesses witnesses(asked, search);
  for (const LevelSets& level : levels) witnesses.look_at(level.sets, level.leaf);
  return witnesses.result();
}

}  // namespace rollfix::touch
