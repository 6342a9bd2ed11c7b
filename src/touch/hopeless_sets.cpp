#include "hopeless_sets.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "roll_belief.hpp"

namespace rollfix::touch {
namespace {

// One in so many cells of a component is started from to see how well it fits at all; no fewer and no more than these.
constexpr std::size_t kCellsPerLook = 6;
constexpr std::size_t kLeastLooks = 4;
constexpr std::size_t kMostLooks = 40;
// Looks go around a component's cells by this share: none are alike.
constexpr double kNextLook = 0.6180339887498949;

/// A pose to start from with the first touch on this stretch; none where a roll's belief has nothing there.
std::optional<Pose> start_in(const PoseFit& fit, const PathTree::Node& node, double heading, std::size_t touch) {
  const auto stretch = static_cast<std::size_t>(node.stretch);
  const RollBelief* roll = fit.touches()[touch].roll;
  if (roll == nullptr) return fit.pose_at({touch, {stretch, node.u.middle()}}, heading);
  const auto [begin, end] = roll->nodes_in(stretch, node.u);
  if (begin == end) return std::nullopt;
  return roll->pose_at(roll->nodes()[begin + (end - begin) / 2]);
}

}  // namespace

std::vector<bool> hopeless_groups(PoseFit& fit, const CellSets& sets, std::size_t first_touch) {
  std::vector<std::vector<std::size_t>> cells(sets.components.size());
  for (std::size_t c = 0; c < cells.size(); ++c) {
    for (const std::size_t g : sets.components[c]) {
      cells[c].insert(cells[c].end(), sets.groups[g].begin(), sets.groups[g].end());
    }
  }
  std::vector<double> squares(cells.size(), std::numeric_limits<double>::infinity());
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t look = 0; look < kMostLooks; ++look) {
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const std::size_t looks = std::clamp(cells[c].size() / kCellsPerLook, kLeastLooks, kMostLooks);
      if (look >= std::min(cells[c].size(), looks) || (look > 0 && squares[c] <= least + kHopeless)) continue;
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

}  // namespace rollfix::touch
