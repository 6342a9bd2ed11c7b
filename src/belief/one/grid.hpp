#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <memory_resource>
#include <optional>
#include <span>
#include <vector>

#include "belief/one/roll_filter.hpp"
#include "belief/posterior.hpp"
#include "rollfix/belief.hpp"
#include "rollfix/turning_function.hpp"

namespace rollfix::belief {

/// What a first contact on trial is worth, the prior included; see RollFilter.
struct Score {
  double cost = 0;
  double log_volume = 0;
  double slope = 0;  // of the logarithm of the likelihood, by w
  double information = 0;
  double steepness = 0;

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
  FilterRun first_run(GridPoint& point, const Nodes& nodes) const;
  /// After another one; false: the point is scored.
  bool next_run(FilterRun& run, const Nodes& nodes, const PendingNodes& pending);
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

// A grid does not grow beyond this; what is not resolved by then counts as rest.
inline constexpr std::size_t kMostPoints = 400000;
inline constexpr std::size_t kMostPointsToWeigh = 50000;  // one explanation among many

/// Gives a point back to where its memory came from.
struct GiveBack {
  std::pmr::memory_resource* memory = nullptr;
  void operator()(GridPoint* point) const { std::pmr::polymorphic_allocator<>(memory).delete_object(point); }
};
/// They are large, and others come between them.
using GridPointer = std::unique_ptr<GridPoint, GiveBack>;
using GridPoints = std::pmr::vector<GridPointer>;

/// One that is not on the grid any more; nullptr: it is again.
struct SparePoint {
  double w;
  GridPointer point;
};

/// What lies between two neighbouring points.
struct GridCell {
  std::size_t arc = 0;    // of its points
  std::size_t first = 0;  // the point at its lower end
  double lo = 0;          // in w
  double hi = 0;
  Interval s;              // unwrapped
  double share = 0;        // of the posterior's mass
  double log_density = 0;  // of it, by w, on average and up to a constant; ...
  double rise = 0;         // ... from the lower end to the upper one it changes by this
  double steps = 0;        // in standard deviations, what the distance changes by at most
  bool fine = false;       // resolved; else Grid::rest() bounds its mass, or no first contact can be in it
  std::size_t fold = 0;    // so many of the boundary's folds further on than its points

  /// Up to which share of its width, from the lower end on, it holds this share of its mass.
  double quantile(double share_of_mass) const;
  /// Where, likewise, the mean of its mass is.
  double mean() const { return 0.5 + 0.5 * std::tanh(rise / 6); }
};

/// The boundary by its turning, tilted by a disk's curvature; without by what makes lengths and angles, as uncertain as
/// they are, count alike.
TiltedBoundary tilted(const Part& part, const ErrorModel& errors, double curvature);

/// As many nodes of a roll as the boundary turns, to and fro, more than once around.
std::size_t most_nodes(const Part& part);
/// How many times as much as around a circle a boundary turns, to and fro, corners apart.
double turns_either_way(const Part& part);

/// The first points that a grid on this boundary begins with, at most.
std::size_t most_first_points(const TiltedBoundary& boundary);

/// The posterior density of a roll's first contact over the whole boundary, on points that lie as close together as it
/// takes: where the samples' likelihood changes fast and is not negligible. Of a boundary that looks the same several
/// times one of them tells the others.
class Grid {
 public:
  /// `memory`: for all that it keeps and works with. `most_points`: it does not grow beyond.
  Grid(const TiltedBoundary& boundary, const ErrorModel& errors, const BeliefOptions& options, const Boundary& places,
       double corner_length, const CentreModel* centres, std::pmr::memory_resource* memory, std::size_t most_points);

  /// Brings all up to date with the samples.
  void settle(const Nodes& nodes);

  /// Whether all of it is negligible beside a rival, exp(-25), for all samples so far. Leaves no points.
  bool is_hopeless(const Nodes& nodes, const Rival& rival);

  const std::pmr::vector<GridCell>& cells() const { return cells_; }
  std::pmr::memory_resource* memory() const { return memory_; }
  std::size_t folds() const { return folds_; }
  /// The lower or the upper end of a cell, but for its folds, ...
  const GridPoint& point(const GridCell& cell, std::size_t end) const { return *points_[cell.arc][cell.first + end]; }
  /// ... and its filter where the cell is.
  RollFilter filter(const GridCell& cell, std::size_t end) const;
  /// How well the likeliest point fits. All probabilities are as with Fit::widened times the noise.
  const Fit& fit() const { return fit_; }
  Evidence evidence() const { return {best_, log_total_, gathered_}; }
  std::size_t points() const { return count_; }
  /// A bound on the share of the mass in the cells that are not resolved.
  double rest() const { return rest_; }

 private:
  bool is_outgrown(const Nodes& nodes) const;
  void lay_out(const Nodes& nodes);
  void refresh_all(const Nodes& nodes);
  bool split(std::size_t arc, std::span<const double> added, const Nodes& nodes);
  /// Takes the points away, but keeps what they have taken, for those that come again.
  void keep_points(const Nodes& nodes);
  /// One that was kept, or a new one.
  GridPointer point_at(std::size_t arc, double w);
  /// What the point costs, or as much as is known of one that stopped early.
  Score at_least(Score score, const GridPoint& point) const;
  /// The same without what a narrow prior adds.
  Score of_rows(const GridPoint& point) const;
  /// No more than this can be in a cell: the distance of the rows can't fall faster than it changes at the ends, and
  /// what a narrow prior costs is known.
  struct Bound {
    double rate = 0;         // of the distance, by w
    double log_density = 0;  // but for the boundary's own
  };
  Bound bound_of(const GridPoint& lo, const GridPoint& hi, const GridCell& cell) const;
  /// How fast the distance d changes between two points, per w.
  double rate_of(const Score& lo, const Score& hi, double h) const;
  bool is_even(const GridPoint& lo, const GridPoint& hi, double length) const;
  bool refine(const Nodes& nodes);
  void weigh();
  struct Error {
    double mean = 0;
    double sd = 0;
  };
  /// Of one that the roll shares, whatever the place: another start asks for another one.
  Error shared_error(int which) const;
  void measure_scale();
  /// Adds the cells that look like those with points.
  void unfold();
  void measure_fit(const Nodes& nodes);
  /// How far the finger rolls from one node to the next; 0 where neighbours can't be said to be alike.
  double step_between(const Nodes& nodes) const;
  /// Halves cells until all that matter are resolved.
  void resolve(const Nodes& nodes);
  const GridPoint& best_point(const Nodes& nodes) const;
  /// Whether it is not known that the first contact is not in there; unwrapped.
  bool can_start_in(const Interval& s) const;
  bool holds_something(const Nodes& nodes, const Rival& rival) const;
  /// About the logarithm of the mass around a point.
  double log_mass(const GridPoint& point) const;
  /// Of the density by w, between two places that far apart, over this width.
  double log_prior(double length, double h, double width = 1) const;

  std::pmr::memory_resource* memory_;
  std::size_t most_points_;
  const TiltedBoundary* boundary_;
  BeliefOptions options_;
  Boundary places_;
  PointScorer scorer_;
  double corner_length_;
  bool can_be_alike_;
  Fit fit_;
  Trend trend_;                   // of the likeliest point, ...
  std::optional<Traced> traced_;  // ... and what is kept to go on from
  double rest_ = 0;
  std::size_t folds_;  // of the boundary look the same to all that is known: points lie on the first one ...
  std::pmr::vector<Interval> ranges_;  // ... alone, on each of its arcs between these, in w
  double length_ = 0;                  // of the whole boundary, in w
  double best_ = 0;                    // the largest log-likelihood of a point
  double farthest_ = 0;                // a cost that can matter
  double gathered_ = 0;                // see Evidence: at that point
  double log_total_ = 0;               // of the density's integral, as a share of the best point's
  double best_mass_ = 0;               // about the logarithm of the mass around it
  std::size_t laid_out_at_ = 0;
  std::size_t generation_ = 0;                            // of the nodes that were laid out for
  std::size_t count_ = 0;                                 // of points
  std::pmr::vector<GridPoints> points_;                   // of each arc, by w
  std::pmr::vector<std::pmr::vector<SparePoint>> spare_;  // likewise: those of the layout before
  std::pmr::vector<GridCell> cells_;
};

/// What the modes are asked about, beyond the grid.
struct ModeQuestion {
  const TiltedBoundary* boundary = nullptr;
  Row last;           // the last sample
  RowCovariance own;  // its own errors
  Boundary places;
};

/// The stretches of the boundary that hold the mass, the most probable first: two peaks of the density are two modes
/// where it falls far enough between them.
std::pmr::vector<Mode> modes_of(const Grid& grid, const ModeQuestion& question);

/// The cells that hold the mass, in order, with the part's pose where the rows tell it.
std::vector<MassPiece> pieces_of(const Grid& grid, const TiltedBoundary& boundary);

/// The same with the poses at their ends. REQUIRES that the finger's first contact is known.
std::vector<PosePiece> pose_pieces_of(const Grid& grid, const TiltedBoundary& boundary);

/// The same as intervals, in order of s.
Density density_of(const Grid& grid, const Boundary& places);

/// The length of the boundary that holds 95 % of the mass, as short as can be.
double credible_length(const Grid& grid);

}  // namespace rollfix::belief
