#include <algorithm>
#include <cmath>
#include <optional>

#include "belief/one/grid.hpp"
#include "belief/posterior.hpp"

// How well the rows fit the likeliest point of the grid, and what they tell of the errors that the roll shares.
// Notation:
//   cost, volume    -2 log L = cost + log_volume at a point: Score
//   widened         by how much the rows are further off than the noise says: `fit_.widened`
//   eps, gamma, b   scales of lengths and of turns and a gyroscope's bias: `shared_error` 2, 3 and 4
// Follows docs/belief.md, "When the rows fit badly".
namespace rollfix::belief {

/// The likeliest of those that have taken all rows.
const GridPoint& Grid::best_point(const Nodes& nodes) const {
  const GridPoint* best = nullptr;
  for (const GridPoints& arc : points_) {
    for (const GridPointer& point : arc) {
      if (PointScorer::is_stale(*point, nodes)) continue;
      if (best != nullptr && point->score.log_likelihood() <= best->score.log_likelihood()) continue;
      best = point.get();
    }
  }
  return *best;
}

/// Rows of increments and rows with `correlation` are not looked at for being alike.
double Grid::step_between(const Nodes& nodes) const {
  if (!can_be_alike_) return 0;
  double travelled = 0;
  double last = 0;
  double count = 0;
  const auto pass = [&](const Node& node) {
    travelled += std::abs(node.length - last);
    last = node.length;
    count += 1;
  };
  for (const Node& node : nodes.complete()) pass(node);
  for (const Node& node : nodes.pending()) pass(node);
  return count > 0 ? travelled / count : 0;
}

/// The fit at the likeliest point, and with it what cells are compared by: `best_`, `farthest_`, `best_mass_`.
void Grid::measure_fit(const Nodes& nodes) {
  const GridPoint* best = &best_point(nodes);
  best_ = best->score.log_likelihood();
  gathered_ = -0.5 * best->now.log_gathered();
  farthest_ = scorer_.limit() - best->score.log_volume;
  const double freedom = nodes.freedom();
  // Of robust rows by those that are no outliers: their part of the cost, and their number.
  fit_ = options_.robust ? robust_fit_of(best->now.right_cost(), best->now.right_rows(), freedom, best->now.whiteness())
                         : fit_of(best->now.cost(), freedom, best->now.whiteness());
  add_trend(trend_, step_between(nodes), fit_);
  fit_.widened *= scorer_.for_large_slip();
  fit_.prior_sigmas = scorer_.prior_sigmas(*best);
  fit_.turn_gathered = nodes.turn_gathered();
  best_mass_ = log_mass(*best);
}

/// Mean and standard deviation over the whole posterior: the variance at one place, and that of the estimates between
/// places. Each cell counts as the mean of its ends.
Grid::Error Grid::shared_error(int which) const {
  double own = 0;  // for one place
  double mean = 0;
  double square_of = 0;
  for (const GridCell& cell : cells_) {
    if (!cell.fine) continue;
    for (const std::size_t end : {cell.first, cell.first + 1}) {
      const RollFilter& filter = points_[cell.arc][end]->now;
      const double error = filter.errors()[which];
      own += 0.5 * cell.share * filter.covariance()(which, which);
      mean += 0.5 * cell.share * error;
      square_of += 0.5 * cell.share * error * error;
    }
  }
  return {mean, std::sqrt(square(fit_.widened) * own + std::max(0.0, square_of - mean * mean))};
}

/// True lengths are the measured ones divided by 1 + x_2; true turns are the measured ones less x_3 times what a
/// gyroscope measured.
void Grid::measure_scale() {
  const Error of_lengths = shared_error(2);
  const Error of_turns = shared_error(3);
  fit_.length_scale = 1 / (1 + of_lengths.mean);
  fit_.length_scale_sd = of_lengths.sd;
  // Turns are taken off, lengths divided: see RollFilter::corrected.
  fit_.turn_scale = 1 - of_turns.mean;
  fit_.turn_scale_sd = of_turns.sd;
  const Error of_rate = shared_error(4);
  fit_.turn_bias = of_rate.mean;
  fit_.turn_bias_sd = of_rate.sd;
}

}  // namespace rollfix::belief
