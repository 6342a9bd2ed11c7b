// How well the rows fit the likeliest point of the grid, and what they tell of the errors that the roll shares.
#include <algorithm>
#include <cmath>

#include "belief/one/grid.hpp"
#include "belief/posterior.hpp"

namespace rollfix::belief {

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
  if (const std::optional<Node> pending = nodes.pending()) pass(*pending);
  return count > 0 ? travelled / count : 0;
}

void Grid::measure_fit(const Nodes& nodes) {
  const GridPoint* best = &best_point(nodes);
  best_ = best->score.log_likelihood();
  gathered_ = -0.5 * best->now.log_gathered();
  farthest_ = scorer_.limit() - best->score.log_volume;
  const double freedom = nodes.freedom();
  fit_ = options_.robust ? fit_of(best->now.right_cost(), best->now.right_rows(), best->now.whiteness())
                         : fit_of(best->now.cost(), freedom, best->now.whiteness());
  fit_.stray = options_.robust ? freedom - best->now.right_rows() : 0;
  add_trend(trend_, step_between(nodes), fit_);
  fit_.widened *= scorer_.for_large_slip();
  fit_.prior_sigmas = scorer_.prior_sigmas(*best);
  fit_.turn_gathered = nodes.turn_gathered();
  best_mass_ = log_mass(*best);
}

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

void Grid::measure_scale() {
  const Error of_lengths = shared_error(2);
  const Error of_turns = shared_error(3);
  fit_.length_scale = 1 / (1 + of_lengths.mean);
  fit_.length_scale_sd = of_lengths.sd;
  fit_.turn_scale = 1 - of_turns.mean;
  fit_.turn_scale_sd = of_turns.sd;
  const Error of_rate = shared_error(4);
  fit_.turn_bias = of_rate.mean;
  fit_.turn_bias_sd = of_rate.sd;
}

}  // namespace rollfix::belief
