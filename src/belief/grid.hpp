#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "belief/error_model.hpp"
#include "belief/nodes.hpp"
#include "belief/posterior.hpp"
#include "belief/tilted_boundary.hpp"
#include "rollfix/belief/belief.hpp"

namespace rollfix::belief {

/// How outliers are taken: as a share of rows whose place says nothing, spread over `range`. Share 0: there are none.
struct Outliers {
  double share = 0;
  double range = 1;  // length
};

// A contact that is this much of a radian off where it was measured is looked at there as well as anywhere.
inline constexpr double kSameLine = 0.02;

/// What a row adds to a filter. Minus twice the logarithm of its likelihood is cost + log(volume).
struct RowShare {
  double weight;  // probability that it is not stray
  double cost;
  double volume;
};

/// Of so many equations: by how much they miss, squared, in standard deviations; and the determinants of their own
/// covariance and of that with what the rows share.
RowShare share_of(int equations, double squared, double own, double all, const Outliers& outliers);

/// One first contact on trial: an extended Kalman filter of the errors that the whole roll shares, which gives the
/// samples' likelihood along the way, and how that changes with the place.
class RollFilter {
 public:
  /// `centres`: nullptr where they are not looked at.
  RollFilter(const TiltedArc& arc, double tilt, double w, const SharedCovariance& start, const CentreModel* centres);
  /// The same again, with what the rows were found to share: rows are linearised about that offset of turn, from the
  /// first one on.
  RollFilter again(const SharedCovariance& start) const;

  /// Takes a row with its centre, as three equations; see side_by_side.hpp for rows without.
  void update(const Node& node, const Outliers& outliers);
  /// The rows were taken about nearly the offset of turn that they were found to share.
  bool is_settled(double accuracy) const { return guess_ && std::abs(x_[1] - *guess_) <= accuracy; }

  const TiltedArc* arc() const { return arc_; }
  double w() const { return w_; }
  const TiltedPlace& place() const { return place_; }
  /// Minus twice the logarithm of the likelihood, up to what is the same everywhere: the cost is a squared distance.
  /// Both only grow with every node.
  double cost() const { return cost_; }
  double log_volume() const { return log_volume_ + std::log(volume_); }
  double deviance() const { return cost_ + log_volume(); }
  /// The deviance is above that: may find out a little late, and takes no logarithm.
  bool is_beyond(double limit) const { return cost_ + log_volume_ > limit; }
  /// Its derivative by w, and the (expected) information on w: the square of the distance's rate of change.
  double slope() const { return -slope_; }
  double information() const { return information_; }
  /// Of each equation's innovations.
  const std::array<Whiteness, 3>& whiteness() const { return whiteness_; }
  /// Of the rows that are not stray: as many, and their part of the cost.
  double right_rows() const { return right_rows_; }
  double right_cost() const { return right_cost_; }
  const Shared& errors() const { return x_; }
  const SharedCovariance& covariance() const { return p_; }

  /// Where the contact is after a roll that is measured as this.
  TiltedPlace after(const Reading& measured) const;
  /// The same at a first contact that looks like this one.
  RollFilter moved(const TiltedArc& arc, const Shift& shift) const;
  /// Where the part is, as far as the rows tell it for this first contact, and how that changes with w. REQUIRES that
  /// the finger's first contact is known; x and y mean something where has_place().
  PoseSpread pose(Eigen::Vector3d* by_w = nullptr) const;
  bool has_place() const { return centres_ != nullptr && centres_->has_place; }
  /// The variance of that place from the shared errors and the row's own.
  double variance_after(const Reading& measured, const RowCovariance& own) const;

 private:
  friend class SideBySide;
  struct Corrected {
    double length;
    double turn;
  };
  struct Equations;
  Equations equations_at(double w, const Corrected& roll, double w_variance, const Node& node) const;
  void add_centre(const SpreadPlace& end, double w, const Corrected& roll, const Node& node, Equations& rows) const;
  void absorb(const Node& node, const Outliers& outliers);
  /// What the shared errors are when a row is looked at: the guess of the turn's, else as they are estimated so far.
  Shared about() const {
    Shared errors = x_;
    if (guess_) errors[1] = *guess_;
    return errors;
  }
  Corrected corrected(double length, double turn, const Shared& errors) const {
    return {(length - errors[0]) / (1 + errors[2]), turn - errors[1]};
  }

  /// The variance of theta + c L, from the shared errors and a row's own.
  double variance_of_roll(double length, const RowCovariance& own) const;

  const TiltedArc* arc_;
  const CentreModel* centres_;
  double tilt_;
  double w_;
  TiltedPlace place_;
  double most_scale_;
  Shared x_ = Shared::Zero();
  SharedCovariance p_;
  Shared dx_ = Shared::Zero();  // of x by w
  double cost_ = 0;
  double log_volume_ = 0;  // but for the logarithm of ...
  double volume_ = 1;      // ... this
  double slope_ = 0;
  double information_ = 0;
  std::array<Whiteness, 3> whiteness_;
  double right_rows_ = 0;
  double right_cost_ = 0;
  std::optional<double> guess_;  // of the offset of turn
};

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

/// They are large, and others come between them.
using GridPoints = std::vector<std::unique_ptr<GridPoint>>;

/// One that is not on the grid any more; nullptr: it is again.
struct SparePoint {
  double w;
  std::unique_ptr<GridPoint> point;
};

struct Errand;

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
  bool fine = false;       // resolved; else it is known to hold next to nothing
  std::size_t fold = 0;    // so many of the boundary's folds further on than its points

  /// Up to which share of its width, from the lower end on, it holds this share of its mass.
  double quantile(double share_of_mass) const;
  /// Where, likewise, the mean of its mass is.
  double mean() const { return 0.5 + 0.5 * std::tanh(rise / 6); }
};

/// The posterior density of a roll's first contact over the whole boundary, on points that lie as close together as it
/// takes: where the samples' likelihood changes fast and is not negligible. Of a boundary that looks the same several
/// times one of them tells the others.
class Grid {
 public:
  Grid(const TiltedBoundary& boundary, const ErrorModel& errors, const BeliefOptions& options, const Boundary& places,
       double corner_length, const CentreModel* centres);

  /// Brings all up to date with the samples.
  void settle(const Nodes& nodes);

  /// Whether all of it holds next to nothing beside a rival, for all samples so far. Leaves no points.
  bool is_hopeless(const Nodes& nodes, const Rival& rival);

  const std::vector<GridCell>& cells() const { return cells_; }
  std::size_t folds() const { return folds_; }
  /// The lower or the upper end of a cell, but for its folds, ...
  const GridPoint& point(const GridCell& cell, std::size_t end) const { return *points_[cell.arc][cell.first + end]; }
  /// ... and its filter where the cell is.
  RollFilter filter(const GridCell& cell, std::size_t end) const;
  /// How well the likeliest point fits. All probabilities are as with Fit::widened times the noise.
  const Fit& fit() const { return fit_; }
  Evidence evidence() const { return {best_, log_total_}; }
  std::size_t points() const { return count_; }
  /// A bound on the share of the mass in the cells that are not resolved.
  double rest() const { return rest_; }

 private:
  void lay_out(const Nodes& nodes);
  void refresh_all(const Nodes& nodes);
  bool split(std::size_t arc, const std::vector<double>& added, const Nodes& nodes);
  /// Takes the points away, but keeps what they have taken, for those that come again.
  void keep_points(const Nodes& nodes);
  RollFilter fresh_filter(const TiltedArc& arc, double w) const;
  GridPoint make(const TiltedArc& arc, double w) const;
  /// One that was kept, or a new one.
  std::unique_ptr<GridPoint> point_at(std::size_t arc, double w);
  /// Lets each of the points take the nodes that it has not. Beyond the limit of what can matter it takes no more: it
  /// stays stale, and what it has cost by then is a bound.
  void refresh(const std::vector<GridPoint*>& points, const Nodes& nodes);
  Errand first_errand(GridPoint& point, const Nodes& nodes) const;
  /// After another one; false: the point is scored.
  bool next_errand(Errand& errand, const Nodes& nodes, const std::optional<Node>& pending);
  void score(GridPoint& point, const Nodes& nodes);
  bool has_centres() const { return centres_ != nullptr && centres_->path != nullptr; }
  bool is_stale(const GridPoint& point, const Nodes& nodes) const { return point.rows != nodes.rows(); }
  /// What the point costs, or as much as is known of one that stopped early.
  Score at_least(const GridPoint& point) const;
  bool is_even(const GridPoint& lo, const GridPoint& hi, double length) const;
  bool refine(const Nodes& nodes);
  void weigh();
  void measure_scale();
  /// Adds the cells that look like those with points.
  void unfold();
  void measure_fit(const Nodes& nodes);
  /// What a narrow prior adds to a cost anywhere on a stretch, at least.
  double least_prior_cost(const Interval& s) const;
  void add_pose_prior(GridPoint& point) const;
  void lower_limit(double deviance, const Nodes& nodes);
  /// Whether it is not known that the first contact is not in there; unwrapped.
  bool can_start_in(const Interval& s) const;
  bool holds_something(const Nodes& nodes, const Rival& rival) const;
  /// About the logarithm of the mass around a point.
  double log_mass(const GridPoint& point) const;
  /// Of the density by w, between two places that far apart, over this width.
  double log_prior(double length, double h, double width = 1) const;

  const TiltedBoundary* boundary_;
  const CentreModel* centres_;  // nullptr: they are not looked at
  ErrorModel errors_;
  BeliefOptions options_;
  Outliers outliers_;
  Boundary places_;
  double corner_length_;
  Fit fit_;
  double rest_ = 0;
  std::size_t folds_;             // of the boundary look the same to all that is known: points lie on the first one ...
  std::vector<Interval> ranges_;  // ... alone, on each of its arcs between these, in w
  double length_ = 0;             // of the whole boundary, in w
  double best_ = 0;               // the largest log-likelihood of a point
  double limit_ = 0;              // of a deviance that can matter, ...
  double farthest_ = 0;           // ... and of the cost in it
  double log_total_ = 0;          // of the density's integral, as a share of the best point's
  double best_mass_ = 0;          // about the logarithm of the mass around it
  std::size_t laid_out_at_ = 0;
  std::size_t generation_ = 0;                  // of the nodes that were laid out for
  std::size_t count_ = 0;                       // of points
  std::vector<GridPoints> points_;              // of each arc, by w
  std::vector<std::vector<SparePoint>> spare_;  // likewise: those of the layout before
  std::vector<GridCell> cells_;
};

/// What the modes are asked about, beyond the grid.
struct ModeQuestion {
  const TiltedBoundary* boundary = nullptr;
  Reading last;       // the last sample
  RowCovariance own;  // its own errors
  Boundary places;
};

/// The stretches of the boundary that hold the mass, the most probable first: two peaks of the density are two modes
/// where it falls far enough between them.
std::vector<Mode> modes_of(const Grid& grid, const ModeQuestion& question);

/// The cells that hold the mass, in order, with the part's pose where the rows tell it.
std::vector<Piece> pieces_of(const Grid& grid, const TiltedBoundary& boundary);

/// The same as intervals, in order of s.
Density density_of(const Grid& grid, const Boundary& places);

/// The length of the boundary that holds 95 % of the mass, as short as can be.
double credible_length(const Grid& grid);

}  // namespace rollfix::belief
