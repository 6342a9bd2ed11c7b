#pragma once

#include "belief/error_model.hpp"
#include "belief/nodes.hpp"
#include "belief/tilted_boundary.hpp"

namespace rollfix::belief {

/// How outliers are taken: as a share of rows whose place says nothing, spread over `range`. Share 0: there are none.
struct Outliers {
  double share = 0;
  double range = 1;  // length
};

/// One first contact on trial: an extended Kalman filter of the errors that the whole roll shares, which gives the
/// samples' likelihood along the way, and how that changes with the place.
class RollFilter {
 public:
  RollFilter(const TiltedArc& arc, double tilt, double w, const SharedCovariance& start);

  void update(const Node& node, const Outliers& outliers);

  const TiltedArc* arc() const { return arc_; }
  double w() const { return w_; }
  const TiltedPlace& place() const { return place_; }
  /// Minus twice the logarithm of the likelihood, up to what is the same everywhere: the cost is a squared distance.
  /// Both only grow with every node.
  double cost() const { return cost_; }
  double log_volume() const { return log_volume_; }
  double deviance() const { return cost_ + log_volume_; }
  double log_likelihood() const { return -0.5 * (cost_ + log_volume_); }
  /// Its derivative by w, and the (expected) information on w: the square of the distance's rate of change.
  double slope() const { return -slope_; }
  double information() const { return information_; }
  const Shared& errors() const { return x_; }
  const SharedCovariance& covariance() const { return p_; }

  /// Where the contact is after a roll that is measured as this.
  TiltedPlace after(const Reading& measured) const;
  /// The variance of that place from the shared errors and the row's own.
  double variance_after(const Reading& measured, const RowCovariance& own) const;

 private:
  struct Corrected {
    double length;
    double turn;
  };
  Corrected corrected(double length, double turn) const { return {(length - x_[0]) / (1 + x_[2]), turn - x_[1]}; }

  /// The variance of theta + c L, from the shared errors and a row's own.
  double variance_of_roll(double length, const RowCovariance& own) const;

  const TiltedArc* arc_;
  double tilt_;
  double w_;
  TiltedPlace place_;
  double most_scale_;
  Shared x_ = Shared::Zero();
  SharedCovariance p_;
  Shared dx_ = Shared::Zero();  // of x by w
  double cost_ = 0;
  double log_volume_ = 0;
  double slope_ = 0;
  double information_ = 0;
};

}  // namespace rollfix::belief
