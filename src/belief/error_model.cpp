#include "belief/error_model.hpp"

#include <algorithm>
#include <cmath>

#include "belief/square.hpp"

namespace rollfix::belief {

namespace {

// No sensor is better than this: a share of the perimeter, and radians. It keeps variances above what rounding does.
constexpr double kLeastContactShare = 1e-7;
constexpr double kLeastAngle = 1e-7;
// What a row of increments is off on its own: the part of an increment that is under way when it is read.
constexpr double kShareUnderWay = 0.25;

// A finger slips all along by the share that is given, and by this many times as much over a short stretch, such as
// where it starts to turn or where the part is oily; but not by more than all of it.
constexpr double kSlipHereAndThere = 5;
constexpr double kMostSlipHereAndThere = 1;
// Slip is one and the same over this share of the perimeter.
constexpr double kSlipPatch = 0.01;

}  // namespace

ErrorModel::ErrorModel(const BeliefOptions& options, LogKind kind, double finger_curvature, double perimeter)
    : kind_(kind),
      bare_(options.bare),
      contact_variance_(square(std::max(options.noise.contact, kLeastContactShare * perimeter))),
      angle_variance_(square(std::max(options.noise.angle, kLeastAngle))),
      perimeter_(perimeter) {
  if (kind_ == LogKind::contact) {
    // u0 and psi0 are measured once and taken off every row: offsets n0 of length and -(kappa n0 + a0) of turn.
    start_(0, 0) = contact_variance_;
    start_(0, 1) = start_(1, 0) = -finger_curvature * contact_variance_;
    start_(1, 1) = square(finger_curvature) * contact_variance_ + angle_variance_;
  } else if (kind_ == LogKind::travelled && !bare_) {
    start_(0, 0) = contact_variance_;
    start_(1, 1) = angle_variance_;
  }
  slip_ = std::min(kSlipHereAndThere * options.noise.slip, kMostSlipHereAndThere);
  // A radius that is off by a share has every length off by it.
  start_(2, 2) = square(options.noise.slip) + square(options.noise.radius * finger_curvature);
}

RowCovariance ErrorModel::row(double finger_curvature) const {
  if (kind_ == LogKind::contact) {
    return {contact_variance_, -finger_curvature * contact_variance_,
            square(finger_curvature) * contact_variance_ + angle_variance_};
  }
  const double share = kind_ == LogKind::increments ? kShareUnderWay : 1;
  return {share * contact_variance_, 0, share * angle_variance_};
}

ErrorModel ErrorModel::with_scale(double sd) const {
  ErrorModel other = *this;
  other.start_(2, 2) = square(sd);
  return other;
}

ErrorModel ErrorModel::with_slip(double per_length) const {
  ErrorModel other = *this;
  other.slip_ = per_length;
  return other;
}

RowCovariance ErrorModel::gathered(double rows, double length) const {
  RowCovariance sum;
  // What slips at one place has nothing to do with what slips a hundredth of the boundary further on.
  sum.length = square(slip_) * std::abs(length) * kSlipPatch * perimeter_;
  if (kind_ == LogKind::increments) {
    sum.length += rows * contact_variance_;
    sum.turn += rows * angle_variance_;
  }
  // An integrated gyroscope drifts: over a whole perimeter as much as one row is off.
  if (kind_ == LogKind::travelled && !bare_) sum.turn += angle_variance_ * std::abs(length) / perimeter_;
  return sum;
}

}  // namespace rollfix::belief
