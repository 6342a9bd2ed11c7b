#include "witnessed_poses.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "answer_poses.hpp"
#include "least_worst.hpp"
#include "pose_boxes.hpp"

namespace rollfix::touch {
namespace {

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

  WitnessedPoses result() {
    for (const PoseSet& set : found_) {
      result_.poses.push_back(described(asked_.fit, set.fitted, set.cells, asked_.pair));
    }
    std::sort(result_.poses.begin(), result_.poses.end(),
              [](const TouchPose& a, const TouchPose& b) { return a.pose.heading < b.pose.heading; });
    return std::move(result_);
  }

 private:
  void look_finer(const std::vector<Cell>& cells, double leaf, int round) {
    const PathTree& first = asked_.fit.tree(asked_.pair.first);
    Cells finer = search_.search(cells, leaf);
    asked_.free.drop_blocked(finer.fit, first, asked_.fit.touches()[asked_.pair.first]);
    result_.undecided.insert(result_.undecided.end(), finer.undecided.begin(), finer.undecided.end());
    look_at(sets_of(first, asked_.fit.tree(asked_.pair.second), std::move(finer.fit)), leaf, round);
  }

  const Asked& asked_;
  CellSearch& search_;
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
