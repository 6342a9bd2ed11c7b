#pragma once

#include <cstddef>
#include <limits>
#include <memory_resource>
#include <optional>
#include <span>
#include <vector>

#include "belief/one/roll_filter.hpp"
#include "belief/one/side_by_side.hpp"
#include "rollfix/belief.hpp"
#include "rollfix/turning_function.hpp"

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
  RollFilter filter;    // has taken `taken` complete nodes
  double deviance = 0;  // of it
  std::size_t taken = 0;
  std::size_t generation = 0;
  std::size_t rows = 0;  // of the roll, when it was scored
  RollFilter now;        // and what is pending
  Score score;
};

/// A first contact's filter that keeps its innovations.
struct Traced {
  RollFilter filter;  // has taken `taken` complete nodes
  std::size_t taken = 0;
  std::size_t generation = 0;
  Innovations innovations;
};

/// Lets first contacts on trial take the samples, and says what each is worth, the prior included.
class PointScorer {
 public:
  PointScorer(const TiltedBoundary& boundary, const ErrorModel& errors, const BeliefOptions& options,
              const Boundary& places, const CentreModel* centres, std::pmr::memory_resource* memory);

  GridPoint make(const TiltedArc& arc, double w) const;
  /// Lets each of the points take the nodes that it has not. Beyond the limit of what can matter it takes no more: it
  /// stays stale, and what it has cost by then is a bound.
  void refresh(std::span<GridPoint* const> points, const Nodes& nodes);
  /// The same, those that some of the nodes speak for first: then the others reach the limit early.
  void refresh_likely_first(std::span<GridPoint* const> points, const Nodes& nodes);
  static bool is_stale(const GridPoint& point, const Nodes& nodes) { return point.rows != nodes.rows(); }

  /// How a point's innovations run in the long term; `traced`: what was kept when that was asked before.
  Trend trend(const GridPoint& point, const Nodes& nodes, std::optional<Traced>& traced) const;

  /// Of a deviance that can matter: it comes down with each better point, until all is new.
  double limit() const { return limit_; }
  void forget_limit() { limit_ = std::numeric_limits<double>::infinity(); }

  /// What a narrow prior adds to a cost anywhere on a stretch, at least; and what it added to a point's score. None of
  /// a wide one.
  double least_narrow_cost(const Interval& s) const;
  Score narrow_prior(const GridPoint& point) const;
  /// How far off the priors a point is, in standard deviations.
  double prior_sigmas(const GridPoint& point) const;

  double for_large_slip() const { return errors_.for_large_slip(); }

 private:
  RollFilter fresh_filter(const TiltedArc& arc, double w) const;
  Errand first_errand(GridPoint& point, const Nodes& nodes) const;
  /// After another one; false: the point is scored.
  bool next_errand(Errand& errand, const Nodes& nodes, const std::optional<Node>& pending);
  void score(GridPoint& point, const Nodes& nodes);
  bool has_narrow_prior() const;
  /// The prior is one sample more: what it adds.
  Score prior_at(const TiltedPlace& place) const;
  void lower_limit(double deviance, const Nodes& nodes);
  RowEquations equations() const {
    return {centres_ != nullptr && centres_->path != nullptr, errors_.has_gyroscope_scale(), errors_.has_bias()};
  }

  double tilt_;
  const CentreModel* centres_;  // nullptr: they are not looked at
  ErrorModel errors_;
  BeliefOptions options_;
  Outliers outliers_;
  std::pmr::memory_resource* memory_;
  Boundary places_;
  double limit_ = std::numeric_limits<double>::infinity();
};

}  // namespace rollfix::belief
