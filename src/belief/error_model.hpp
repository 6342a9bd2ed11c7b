#pragma once

#include <Eigen/Core>

#include "rollfix/belief/belief.hpp"
#include "rollfix/contact/noise.hpp"

namespace rollfix::belief {

/// Errors that a whole roll shares: of a length and of a turn as measured, and of the scale of lengths.
using Shared = Eigen::Vector3d;
using SharedCovariance = Eigen::Matrix3d;

/// Errors of one row on its own, or of what a row adds to the rows before: variances of length and turn.
struct RowCovariance {
  double length = 0;
  double both = 0;
  double turn = 0;
};

/// How the sensors' noise enters the measured length and turn of a roll; docs/belief.md derives it. Measured are
///   L (1 + scale) + offset of length + the row's own,   theta + offset of turn + the row's own.
class ErrorModel {
 public:
  /// `finger_curvature`: of the finger where it first touched.
  ErrorModel(const BeliefOptions& options, LogKind kind, double finger_curvature, double perimeter);

  /// The same with lengths whose scale is off by this much (a standard deviation); and with lengths that are off by
  /// this much of every length rolled, each on its own.
  ErrorModel with_scale(double sd) const;
  ErrorModel with_slip(double per_length) const;

  /// Of the shared errors before the first row.
  const SharedCovariance& start() const { return start_; }
  /// Of a row on its own, with the finger's curvature where it touches.
  RowCovariance row(double finger_curvature) const;
  /// What the offsets gather over so many rows that travel over this length.
  RowCovariance gathered(double rows, double length) const;

 private:
  LogKind kind_;
  bool bare_;
  double contact_variance_;
  double angle_variance_;
  double perimeter_;
  double slip_ = 0;
  SharedCovariance start_ = SharedCovariance::Zero();
};

}  // namespace rollfix::belief
