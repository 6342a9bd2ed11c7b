#include "pose_sets.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace rollfix::touch {
namespace {

constexpr double kSame = 0.2;

}  // namespace

std::vector<Cell> cells_of(const CellSets& sets, const std::vector<std::size_t>& groups) {
  std::vector<Cell> cells;
  for (const std::size_t g : groups) {
    for (const std::size_t k : sets.groups[g]) cells.push_back(sets.cells[k]);
  }
  return cells;
}

double least_difference(const std::vector<Measured>& contacts) {
  double least = std::numeric_limits<double>::infinity();
  for (const Measured& one : contacts) {
    if (one.has_place) least = std::min(least, one.place_unit);
  }
  return kSame * least;
}

void add_set(const Asked& asked, PoseSet set, std::vector<PoseSet>& to) {
  const double least = least_difference(asked.fit.touches());
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

}  // namespace rollfix::touch
