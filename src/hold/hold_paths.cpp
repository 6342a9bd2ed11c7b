#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "hold_fit.hpp"

// Notation as in wheel_pins.cpp:
//   phi_k, sigma_k  the part's heading at row k in one of its poses, and its standard deviation there
//   F_k             what row k costs in it
//   h               how far the part turns from row to row, by the smallest steps between their poses; more, where they
//                   are few
//   w_ij            1 / (1 + (phi_j - phi_i)^2 / (h^2 + sigma_i^2 + sigma_j^2)), from pose i of a row to pose j of the
//                   next; -2 log of its share among all j is what that costs: nothing where there is one pose. Of the
//                   first row's poses all are as probable.
// The path is the one of least sum of both, by dynamic programming (R. Bellman, 1957).
// Idea: beside a wheel a row may fit in several poses, but a part that was in one of them a row ago is near it still.
// If each row took what fits best, places would fit the better the more poses they leave to choose from.
namespace rollfix::hold {
namespace {

constexpr double kFewSteps = 8;  // of so many the usual one may be twice as long, and of fewer much longer

/// Between two poses of the part, radians, in [0, pi].
double turned_between(const Placed& one, const Placed& other) {
  return std::abs(nearest_angle(other.heading - one.heading));
}

}  // namespace

/// One way in which the part may lie at a row, with the best path that leads to it.
struct HoldFit::PathPose {
  Placed placed;
  double cost = 0;       // of its row
  double sum = 0;        // of the best path to it: of all its rows and ...
  double steps = 0;      // ... from each to the next
  std::size_t from = 0;  // where that was a row before
};

/// What the step from a pose to each of the next row's costs: -2 log of its share of w_ij.
std::vector<double> HoldFit::step_costs(const Placed& from, const std::vector<PathPose>& to, double step) {
  std::vector<double> shares;
  double sum = 0;
  for (const PathPose& one : to) {
    // A heavy tail: a long step costs about 4 log of its length over the scale, so that a true jump is not excluded.
    const double scale = std::hypot(step, from.heading_sd, one.placed.heading_sd);
    const double turned = turned_between(from, one.placed) / std::max(scale, std::numeric_limits<double>::min());
    shares.push_back(1 / (1 + turned * turned));
    sum += shares.back();
  }
  // Shares sum to 1: with one pose to go to the step costs nothing.
  for (double& share : shares) share = -2 * std::log(share / sum);
  return shares;
}

/// The poses of each row, found row by row. The state's poses are changed.
HoldFit::PosesOfRows HoldFit::all_poses(HeldState& state) const {
  PosesOfRows rows;
  for (std::size_t row = 0; row < rows_.rows.size(); ++row) rows.push_back(poses_at(state, row));
  return rows;
}

/// h, radians: the mean of the smallest steps from row to row, times 1 + (8 / steps)^2 as few steps tell it badly.
/// REQUIRES two rows.
double HoldFit::step_of(const PosesOfRows& rows) {
  double sum = 0;
  for (std::size_t row = 1; row < rows.size(); ++row) {
    double least = std::numeric_limits<double>::infinity();
    for (const PathPose& one : rows[row - 1]) {
      for (const PathPose& other : rows[row]) least = std::min(least, turned_between(one.placed, other.placed));
    }
    sum += least;
  }
  const auto steps = static_cast<double>(rows.size() - 1);
  return sum / steps * (1 + std::pow(kFewSteps / steps, 2));
}

/// The poses that fit a row, each once: settled from where the wheels touch, and from the one the state has.
std::vector<HoldFit::PathPose> HoldFit::poses_at(HeldState& state, std::size_t row) const {
  // On exit the state's pose of this row is any of those tried: `take` sets it.
  std::vector<Placed> starts = touching(state, row);
  starts.push_back(state.placed[row]);
  std::vector<PathPose> found;
  double least = std::numeric_limits<double>::infinity();
  for (const Placed& start : starts) {
    state.placed[row] = start;
    const RowEquations there = settled(state, row);
    // Cost as in `settle`: the square and what corners add.
    const PathPose one{state.placed[row], there.square + there.blur_size};
    const bool is_known = std::ranges::any_of(found, [&](const PathPose& other) {
      return turned_between(one.placed, other.placed) < kSamePose * one.placed.heading_sd;
    });
    if (is_known) continue;
    least = std::min(least, one.cost);
    found.push_back(one);
  }
  // Poses that fit the row much worse than its best one are left out, which keeps rows short.
  std::erase_if(found, [&](const PathPose& one) { return one.cost > least + kFitsToo; });
  return found;
}

/// The best paths from one pose of the first row, or from any, to each of the last row's.
void HoldFit::follow(PosesOfRows& rows, std::optional<std::size_t> first) {
  constexpr double kNoPath = std::numeric_limits<double>::infinity();
  const double step = step_of(rows);
  // Each of the first row's poses has the share 1 / n.
  const double any = 2 * std::log(static_cast<double>(rows.front().size()));
  for (std::size_t k = 0; k < rows.front().size(); ++k) {
    PathPose& one = rows.front()[k];
    one.steps = !first || *first == k ? any : kNoPath;
    one.sum = one.cost + one.steps;
  }
  // At its start `sum` of the row before is the cost of the best path to each of its poses; rows times poses^2 steps.
  for (std::size_t row = 1; row < rows.size(); ++row) {
    for (PathPose& one : rows[row]) one.sum = kNoPath;
    for (std::size_t i = 0; i < rows[row - 1].size(); ++i) {
      const PathPose& before = rows[row - 1][i];
      if (before.sum == kNoPath) continue;
      const std::vector<double> costs = step_costs(before.placed, rows[row], step);
      for (std::size_t j = 0; j < rows[row].size(); ++j) {
        PathPose& one = rows[row][j];
        const double sum = before.sum + one.cost + costs[j];
        if (sum >= one.sum) continue;
        one.sum = sum;
        one.steps = before.steps + costs[j];
        one.from = i;
      }
    }
  }
}

/// The path that ends in one of the last row's poses.
void HoldFit::take(const PosesOfRows& rows, std::size_t last, HeldState& state) {
  // Back along `from`. `sum` held the rows' costs as well; the state keeps those of the steps.
  state.steps = rows.back()[last].steps;
  for (std::size_t row = rows.size(); row-- > 0;) {
    state.placed[row] = rows[row][last].placed;
    last = rows[row][last].from;
  }
}

/// Gives each row the pose of the best path of all.
void HoldFit::follow(HeldState& state) const {
  PosesOfRows rows = all_poses(state);
  follow(rows, std::nullopt);
  const auto best = std::ranges::min_element(rows.back(), {}, &PathPose::sum);
  take(rows, static_cast<std::size_t>(best - rows.back().begin()), state);
}

/// For each pose of the first and of the last row the best path between them, if it costs no more than kFitsToo above
/// the state; the best first.
std::vector<HeldState> HoldFit::paths(const HeldState& state) const {
  HeldState any = state;
  PosesOfRows rows = all_poses(any);
  std::vector<HeldState> found;
  for (std::size_t first = 0; first < rows.front().size(); ++first) {
    follow(rows, first);
    for (std::size_t last = 0; last < rows.back().size(); ++last) {
      if (rows.back()[last].sum > state.cost + kFitsToo) continue;
      take(rows, last, any);
      found.push_back(at(any.unknowns, any));
    }
  }
  std::ranges::stable_sort(found, {}, &HeldState::cost);
  return found;
}

/// As `at`, but with a path of poses where one finger with noise rolls beside wheels.
HeldState HoldFit::afresh(const Unknowns& unknowns) const {
  HeldState state = guessed(unknowns);
  const std::size_t count = rows_.rows.size();
  // No path to follow: one pose a row.
  if (!rows_.has_noise || fingers() > 1 || wheels() == 0 || count == 1) {
    settle(state);
    return state;
  }
  if (std::ranges::none_of(rows_.wheels, [](const HeldWheel& wheel) { return wheel.spin.has_value(); })) {
    follow(state);
    settle(state);
    return state;
  }
  // An encoder's zero is by one pose of the first row, whichever suits all rows best, and then by all of them.
  std::vector<Placed> firsts = touching(state, 0);
  if (firsts.empty()) firsts.push_back(state.placed.front());
  std::optional<HeldState> best;
  // A zero decides which poses fit the other rows, and poses decide the zero: each of the first row's poses gives one
  // to begin with.
  for (const Placed& first : firsts) {
    HeldState one = state;
    one.placed.front() = first;
    zero_spins(one, 1);
    follow(one);
    zero_spins(one, count);
    settle(one);
    if (!best || one.cost < best->cost) best = std::move(one);
  }
  // Once more with the zero of all rows.
  follow(*best);
  zero_spins(*best, count);
  settle(*best);
  return *best;
}

}  // namespace rollfix::hold
