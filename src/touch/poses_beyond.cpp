#include "poses_beyond.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "all_contacts.hpp"
#include "answer_poses.hpp"
#include "mirror_poses.hpp"
#include "requirements.hpp"
#include "witnessed_poses.hpp"

namespace rollfix::touch {
namespace {

// Of the least difference of two poses: rounding.
constexpr double kRounding = 1e-6;

/// Whether all of this box is in a pose's extent.
bool covers(const TouchPose& pose, const PoseExtent& box, double rounding) {
  PoseExtent inner = pose.extent;
  for (std::size_t k = 0; k < 3; ++k) {
    inner[k] = {inner[k].lo + 0.5 * box[k].width(), inner[k].hi - 0.5 * box[k].width()};
  }
  if (pose.any_heading) inner[2] = pose.extent[2];
  return holds(inner, {box[0].middle(), box[1].middle(), box[2].middle()}, rounding);
}

/// Cells all of whose poses are in a known extent go.
void drop_known(std::vector<Cell>& cells, const Asked& asked, const std::vector<TouchPose>& known) {
  const double rounding = kRounding * least_difference({asked.fit.touches()[asked.pair.first]});
  const auto is_known = [&](const Cell& cell) {
    const PoseExtent box = extent_of(asked.fit, {cell}, asked.pair, {});
    return std::any_of(known.begin(), known.end(), [&](const TouchPose& pose) { return covers(pose, box, rounding); });
  };
  cells.erase(std::remove_if(cells.begin(), cells.end(), is_known), cells.end());
}

/// Sets of which it is not known whether a pose of theirs fits: extents alone.
std::vector<TouchPose> bare_poses(const Asked& asked, std::vector<Cell> cells) {
  std::vector<TouchPose> bare;
  const CellSets sets = sets_of(asked.fit.tree(asked.pair.first), asked.fit.tree(asked.pair.second), std::move(cells));
  for (const std::vector<std::size_t>& component : sets.components) {
    const std::vector<Cell> own = cells_of(sets, component);
    bare.emplace_back();
    bare.back().extent = extent_of(asked.fit, own, asked.pair, {0, 0, own.front().heading.middle});
  }
  return bare;
}

void search_beyond(const TouchProblem& problem, const std::vector<TouchPose>& known, TouchAnswer& answer) {
  AllContacts contacts(problem, answer.radius);
  for (Measured& touch : contacts.each) {  // all that is within the tolerances counts
    touch.place_unit = touch.place_most;
    touch.angle_unit = touch.angle_most;
  }
  if (contacts.one_fits_nowhere()) return;
  const TouchPair pair = choose_pair(contacts.each);
  CellSearch search(contacts.each, pair, problem.budget.value_or(kTouchBudget));
  Cells cells = search.search();
  PoseFit fit(contacts.each, problem.pose);
  FreeSpace free(problem);
  const Asked asked{problem, fit, pair, free, answer.place};
  drop_known(cells.fit, asked, known);
  WitnessedPoses found = witnessed_poses(asked, search, CellSearch::kLeaf, std::move(cells.fit));
  answer.poses = std::move(found.poses);
  for (TouchPose& bare : bare_poses(asked, std::move(found.without))) answer.poses.push_back(std::move(bare));
  cells.undecided.insert(cells.undecided.end(), found.undecided.begin(), found.undecided.end());
  answer.unresolved_touch = pair.first;
  answer.unresolved = places_of(fit.tree(pair.first), cells.undecided);
}

}  // namespace

bool is_own(const TouchPose& pose) { return holds(pose.extent, pose.pose); }

TouchAnswer poses_beyond(const TouchProblem& problem, const std::vector<TouchPose>& known) {
  TouchAnswer answer{problem.part, problem.touches};
  answer.radius = radius_of(problem);
  answer.noise = problem.noise;
  answer.mirrored = problem.mirrored;
  std::copy_if(known.begin(), known.end(), std::back_inserter(answer.poses), is_own);
  if (problem.mirrored) out_of_mirror(answer);  // into it: once more leads back
  const std::vector<TouchPose> seen_known = std::exchange(answer.poses, {});
  const TouchProblem seen = problem.mirrored ? in_mirror(problem) : problem;
  search_beyond(seen, seen_known, answer);
  if (problem.mirrored) out_of_mirror(answer);
  return answer;
}

}  // namespace rollfix::touch
