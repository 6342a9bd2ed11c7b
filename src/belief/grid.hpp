#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "belief/error_model.hpp"
#include "belief/nodes.hpp"
#include "belief/roll_filter.hpp"
#include "belief/tilted_boundary.hpp"
#include "rollfix/belief/belief.hpp"

namespace rollfix::belief {

/// What a first contact on trial is worth, the prior included; see RollFilter.
struct Score {
  double cost = 0;
  double log_volume = 0;
  double slope = 0;  // of the logarithm of the likelihood, by w
  double information = 0;

  double log_likelihood() const { return -0.5 * (cost + log_volume); }
};

/// A first contact on trial.
struct GridPoint {
  RollFilter filter;  // has taken `taken` complete nodes
  std::size_t taken = 0;
  std::size_t generation = 0;
  std::size_t rows = 0;  // of the roll, when it was scored
  RollFilter now;        // and what is pending
  Score score;
};

/// What lies between two neighbouring points.
struct GridCell {
  std::size_t arc = 0;
  std::size_t first = 0;  // the point at its lower end
  double lo = 0;          // in w
  double hi = 0;
  TiltedPlace middle;
  double share = 0;        // of the posterior's mass
  double log_density = 0;  // of it, by w, up to a constant
  bool fine = false;       // resolved; else it is known to hold next to nothing
};

/// The posterior density of a roll's first contact over the whole boundary, on points that lie as close together as it
/// takes: where the samples' likelihood changes fast and is not negligible.
class Grid {
 public:
  Grid(const TiltedBoundary& boundary, const ErrorModel& errors, const BeliefOptions& options, const Boundary& places,
       double corner_length);

  /// Brings all up to date with the samples.
  void settle(const Nodes& nodes);

  const std::vector<GridCell>& cells() const { return cells_; }
  const GridPoint& point(std::size_t arc, std::size_t index) const { return points_[arc][index]; }
  /// By how much the samples are off more than the noise allows, as a factor of standard deviations; 1 where they are
  /// not. All probabilities are as with that much more noise.
  double excess() const { return excess_; }
  /// The likeliest point. Not before settle().
  const GridPoint& best() const;
  std::size_t points() const;
  /// A bound on the share of the mass in the cells that are not resolved.
  double rest() const { return rest_; }

 private:
  void lay_out(const Nodes& nodes);
  GridPoint make(const TiltedArc& arc, double w) const;
  /// Lets the point take the nodes that it has not. Beyond the limit of what can matter it takes no more: it stays
  /// stale, and what it has cost by then is a bound.
  void refresh(GridPoint& point, const Nodes& nodes);
  bool is_stale(const GridPoint& point, const Nodes& nodes) const { return point.rows != nodes.rows(); }
  bool refine(const Nodes& nodes);
  void weigh();
  void measure_excess(const Nodes& nodes);
  void lower_limit(double deviance, const Nodes& nodes);
  double log_prior(const TiltedPlace& middle) const;

  const TiltedBoundary* boundary_;
  ErrorModel errors_;
  BeliefOptions options_;
  Outliers outliers_;
  Boundary places_;
  double corner_length_;
  double excess_ = 1;
  std::size_t best_arc_ = 0;
  std::size_t best_index_ = 0;
  double rest_ = 0;
  double length_ = 0;     // of the whole boundary, in w
  double best_ = 0;       // the largest log-likelihood of a point
  double limit_ = 0;      // of a deviance that can matter
  double best_mass_ = 0;  // about the logarithm of the mass around it
  std::size_t laid_out_at_ = 0;
  std::size_t generation_ = 0;                  // of the nodes that were laid out for
  std::vector<std::vector<GridPoint>> points_;  // of each arc, by w
  std::vector<GridCell> cells_;
};

}  // namespace rollfix::belief
