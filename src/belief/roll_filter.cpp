#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "belief/grid.hpp"
#include "belief/posterior.hpp"

namespace rollfix::belief {

namespace {

// A contact that is this much of a radian off where it was measured is looked at there as well as anywhere.
constexpr double kSameLine = 0.02;
// Volumes are multiplied up to here before a logarithm is taken.
constexpr double kLargeVolume = 1000;

Eigen::Matrix2d rotation(double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return (Eigen::Matrix2d() << c, -s, s, c).finished();
}
Vec2 turned_left(const Vec2& vector) { return {-vector.y(), vector.x()}; }

Eigen::Matrix2d matrix_of(const RowCovariance& own) {
  return (Eigen::Matrix2d() << own.length, own.both, own.both, own.turn).finished();
}

}  // namespace

RollFilter::RollFilter(const TiltedArc& arc, double tilt, double w, const SharedCovariance& start,
                       const CentreModel* centres)
    : arc_(&arc),
      centres_(centres),
      tilt_(tilt),
      w_(w),
      place_(arc.at(w)),
      most_scale_(most_scale(start(2, 2))),
      p_(start) {}

RollFilter RollFilter::again(const SharedCovariance& start) const {
  RollFilter fresh(*arc_, tilt_, w_, start, centres_);
  fresh.guess_ = x_[1];
  return fresh;
}

/// A row as one equation e = 0, linear in the errors.
struct RollFilter::Line {
  double miss;
  double slope;         // m = ds/dw where it was taken
  double rest;          // 1 - c m
  double own_variance;  // with what the straight line leaves
  double variance;      // and of what the rows share
};

/// The same with the centre's two coordinates: three equations.
struct RollFilter::CentreEquations {
  Eigen::Vector3d miss;
  Eigen::Matrix<double, 3, 5> by_errors;
  Eigen::Matrix<double, 3, 2> by_own;  // of a row's length and turn
  Eigen::Vector3d by_w;
  Eigen::Matrix3d own_variance;
};

// The true L and theta lead from this place to another: e = s(w + theta + c L) - s(w) - L = 0, with ds/dw = m.
// With de/dtheta = m and de/dL = c m - 1, e tells of the errors of L and theta what can be told.
RollFilter::CentreEquations RollFilter::equations_at(double w, const Corrected& roll, double w_variance,
                                                     const Node& node) const {
  const SpreadPlace end = arc_->about(w, w_variance, node.spread);
  const double per_scale = 1 / (1 + x_[2]);
  const double by_turn = end.slope;
  const double by_length = tilt_ * end.slope - 1;
  CentreEquations rows;
  rows.by_errors.setZero();
  rows.own_variance.setZero();
  // The line through the place at w, where the roll as it was measured leads.
  rows.miss[0] = end.s + end.slope * (w_ + roll.turn + tilt_ * roll.length - w) - place_.s - roll.length;
  rows.by_errors.block<1, kRolling>(0, 0) << -by_length * per_scale, -by_turn, -by_length * roll.length * per_scale;
  rows.by_own.row(0) << by_length, by_turn;
  rows.by_w[0] = end.slope - place_.slope;
  rows.own_variance(0, 0) = end.variance;
  add_centre(end, w, roll, node, rows);
  if (guess_) rows.miss += rows.by_errors.col(1) * (x_[1] - *guess_);
  rows.own_variance += rows.by_own * matrix_of(node.own) * rows.by_own.transpose();
  return rows;
}

// The centre goes along q(s) = p(s) - R(Theta + pi/2) arm, as the part lies in the world: from where it was at the
// first contact by R(heading) (q(s) - q(s0)). The first contact's normal tells the heading: facing - pi/2 - Theta(s0).
void RollFilter::add_centre(const SpreadPlace& end, double w, const Corrected& roll, const Node& node,
                            CentreEquations& rows) const {
  constexpr double kQuarter = std::numbers::pi / 2;
  const double per_scale = 1 / (1 + x_[2]);
  const double smaller = 1 / (1 + centres_->radius_share * x_[2]);  // the finger, where its radius is wrong
  const double angle = w - tilt_ * end.s;
  const double angle_first = w_ - tilt_ * place_.s;
  const double turn_by_w = 1 - tilt_ * end.slope;
  const double turn_by_w_first = 1 - tilt_ * place_.slope;
  const double heading = centres_->facing + about()[1] - kQuarter - angle_first;
  const Eigen::Matrix2d to_world = rotation(heading);
  const Eigen::Matrix2d of_arm = rotation(heading + angle + kQuarter);
  const Eigen::Matrix2d of_first_arm = rotation(heading + angle_first + kQuarter);
  const Vec2 arm = of_arm * (smaller * node.felt.arm.at);
  const Vec2 first_arm =
      of_first_arm * (smaller * centres_->first.arm.at - about()[0] * centres_->first.arm.per_length);
  const Vec2 by_w = end.slope * of_arm.col(1) * -1 - turn_by_w * turned_left(arm);
  const Vec2 by_w_first = place_.slope * of_first_arm.col(1) * -1 - turn_by_w_first * turned_left(first_arm);
  const Vec2 way = to_world * (centres_->path->at(end.s) - centres_->path->at(place_.s)) - arm + first_arm;
  const Vec2 centre_off(x_[3], x_[4]);

  const double beyond = w_ + roll.turn + tilt_ * roll.length - w;
  rows.miss.tail<2>() = way + by_w * beyond + centre_off - (node.felt.centre - centres_->first.centre);
  auto by_errors = rows.by_errors.bottomRows<2>();
  by_errors.col(0) = -tilt_ * per_scale * by_w - of_first_arm * centres_->first.arm.per_length;
  by_errors.col(1) = -by_w + turned_left(way);
  by_errors.col(2) = -tilt_ * roll.length * per_scale * by_w + centres_->radius_share * (arm - first_arm);
  by_errors.rightCols<2>().setIdentity();
  rows.by_own.bottomRows<2>().col(0) = tilt_ * by_w + of_arm * node.felt.arm.per_length;
  rows.by_own.bottomRows<2>().col(1) = by_w;
  rows.by_w.tail<2>() = by_w - by_w_first - turn_by_w_first * turned_left(way);
  // The mean of rows on a bend is beside it.
  const double bend = 0.5 * node.spread * std::abs(turn_by_w) * (by_w.norm() + 2 * tilt_ * end.slope);
  const double variance = centres_->variance / std::max(1.0, node.worth) + bend * bend;
  rows.own_variance.bottomRightCorner<2, 2>().diagonal().array() += variance;
}

void RollFilter::update(const Node& node, const Outliers& outliers) {
  p_(0, 0) += node.gathered.length;
  p_(0, 1) += node.gathered.both;
  p_(1, 0) += node.gathered.both;
  p_(1, 1) += node.gathered.turn;
  if (centres_ != nullptr && centres_->path != nullptr) {
    absorb_with_centre(node, outliers);
  } else {
    absorb(node, outliers);
  }
  // A place that does not fit asks for lengths that no slip explains: it is refused by its cost, not followed.
  if (std::abs(x_[2]) > most_scale_) {
    x_[2] = std::copysign(most_scale_, x_[2]);
    dx_[2] = 0;
  }
}

double RollFilter::count(int equations, double squared, double own, double all, const Outliers& outliers) {
  if (outliers.share <= 0) {
    cost_ += squared;
    volume_ *= all / own;
    if (volume_ > kLargeVolume) {
      log_volume_ += std::log(volume_);
      volume_ = 1;
    }
    return 1;
  }
  const double range = equations == 1 ? outliers.range : outliers.range * outliers.range * outliers.range;
  const double stray = outliers.share / range;
  const double flat = std::pow(2 * std::numbers::pi, 0.5 * (equations - 1));
  const Mixture mixture = mixture_of(outliers.share, stray, peak_of(1 / all) / flat, squared);
  const double most = (1 - outliers.share) * peak_of(1 / own) / flat + stray;
  cost_ += mixture.cost;
  log_volume_ += 2 * std::log(most / mixture.density);
  right_rows_ += mixture.weight * equations;
  right_cost_ += mixture.weight * squared;
  return mixture.weight;
}

// One equation, written out, for this is where a posterior's time goes. By the shared errors it is (1 - c m) g less
// m times the turn's, g = (1, 0, L) / (1 + scale): with their covariance times g it is quickly had for any slope m.
void RollFilter::absorb(const Node& node, const Outliers& outliers) {
  const double per_scale = 1 / (1 + x_[2]);
  const double length = (node.length - x_[0]) * per_scale;
  const double known_turn = guess_ ? *guess_ : x_[1];
  const double measured = w_ + (node.turn - known_turn) + tilt_ * length;
  const auto along = [&](int row) { return per_scale * (p_(row, 0) + length * p_(row, 2)); };
  const Eigen::Vector3d with_length(along(0), along(1), along(2));
  const double length_variance = per_scale * (with_length[0] + length * with_length[2]);
  const double w_variance =
      std::max(0.0, tilt_ * (tilt_ * (length_variance + node.own.length) + 2 * (with_length[1] + node.own.both)) +
                        p_(1, 1) + node.own.turn);
  const auto line_at = [&](double w, double variance) {
    const SpreadPlace end = arc_->about(w, variance, node.spread);
    const double m = end.slope;
    const double q = 1 - tilt_ * m;
    const double own = q * (q * node.own.length - 2 * m * node.own.both) + m * m * node.own.turn + end.variance;
    const double shared = q * (q * length_variance - 2 * m * with_length[1]) + m * m * p_(1, 1);
    const double miss = end.s + m * (measured - w - (x_[1] - known_turn)) - place_.s - length;
    return Line{miss, m, q, own, own + shared};
  };
  Line line = line_at(measured, w_variance);
  // Where the contact is likely to be, given the equation as well. A slope taken where the turn was measured would go
  // with that turn's own error, and what many rows say would be taken for more than it is.
  const double by_length = tilt_ * (length_variance + node.own.length) + with_length[1] + node.own.both;
  const double by_turn = tilt_ * (with_length[1] + node.own.both) + p_(1, 1) + node.own.turn;
  const double with_roll = line.slope * by_turn - line.rest * by_length;
  const double shift = with_roll * line.miss / line.variance;
  if (std::abs(shift) > kSameLine) {
    const double left = std::max(0.0, w_variance - with_roll * with_roll / line.variance);
    line = line_at(measured - shift, left);
  }

  // Where along the roll the row was taken is not known beforehand, nor that it is more likely where the contact goes
  // slowly: only what the rows share has a volume.
  const double inverse = 1 / line.variance;
  const double squared = line.miss * line.miss * inverse;
  const double weight = count(1, squared, line.own_variance, line.variance, outliers);
  const double trust = weight * inverse;
  whiteness_[0].add(-std::sqrt(trust) * line.miss);
  const double by_w =
      place_.slope - line.slope - line.rest * per_scale * (dx_[0] + length * dx_[2]) + line.slope * dx_[1];
  slope_ -= trust * line.miss * by_w;
  information_ += trust * by_w * by_w;
  const Eigen::Vector3d of_errors = line.rest * with_length - line.slope * p_.col(1).head<kRolling>();
  const Eigen::Vector3d gain = trust * of_errors;
  x_.head<kRolling>() -= line.miss * gain;
  dx_.head<kRolling>() += by_w * gain;
  p_.topLeftCorner<kRolling, kRolling>() -= gain * of_errors.transpose();
}

// The same with three equations, which tell of all errors.
void RollFilter::absorb_with_centre(const Node& node, const Outliers& outliers) {
  const Corrected roll = corrected(node.length, node.turn, about());
  const double measured = w_ + roll.turn + tilt_ * roll.length;
  const double w_variance = variance_of_roll(roll.length, node.own);
  CentreEquations rows = equations_at(measured, roll, w_variance, node);
  Eigen::Matrix<double, 5, 3> of_errors;
  Eigen::Matrix3d inverse;
  const auto weigh = [&] {
    of_errors = p_ * rows.by_errors.transpose();
    inverse = (rows.by_errors * of_errors + rows.own_variance).inverse();
  };
  weigh();
  const double per_scale = 1 / (1 + x_[2]);
  const Eigen::Vector3d roll_by_errors(-tilt_ * per_scale, -1, -tilt_ * roll.length * per_scale);
  const Eigen::Vector2d roll_by_own(tilt_, 1);
  const Eigen::Vector3d with_roll =
      of_errors.topRows<kRolling>().transpose() * roll_by_errors + rows.by_own * matrix_of(node.own) * roll_by_own;
  const double shift = with_roll.dot(inverse * rows.miss);
  if (std::abs(shift) > kSameLine) {
    const double left = std::max(0.0, w_variance - with_roll.dot(inverse * with_roll));
    rows = equations_at(measured - shift, roll, left, node);
    weigh();
  }

  const Eigen::Vector3d innovation = -rows.miss;
  const Eigen::Vector3d by_w = -rows.by_w - rows.by_errors * dx_;
  const double squared = innovation.dot(inverse * innovation);
  const double weight = count(3, squared, rows.own_variance.determinant(), 1 / inverse.determinant(), outliers);
  add_innovation<3>(inverse, std::sqrt(weight) * innovation, whiteness_);
  const Eigen::Matrix<double, 5, 3> gain = weight * of_errors * inverse;
  slope_ += weight * innovation.dot(inverse * by_w);
  information_ += weight * by_w.dot(inverse * by_w);
  x_ += gain * innovation;
  dx_ += gain * by_w;
  p_ -= gain * of_errors.transpose();
}

TiltedPlace RollFilter::after(const Reading& measured) const {
  const Corrected roll = corrected(measured.length[0], measured.turn, x_);
  return arc_->at(w_ + roll.turn + tilt_ * roll.length);
}

PoseSpread RollFilter::pose(Eigen::Vector3d* by_w) const {
  const double angle = w_ - tilt_ * place_.s;
  const double facing = centres_->facing + x_[1];
  PoseSpread spread;
  spread.mean.heading = facing - std::numbers::pi / 2 - angle;
  const Arm& first = centres_->first.arm;
  const Vec2 arm = rotation(facing) * (1 / (1 + centres_->radius_share * x_[2]) * first.at - x_[0] * first.per_length);
  const Vec2 on_part = spread.mean.turned(centres_->part->point(place_.s));
  const Vec2 origin = centres_->first.centre + Vec2(x_[3], x_[4]) + arm - on_part;
  spread.mean.x = origin.x();
  spread.mean.y = origin.y();
  Eigen::Matrix<double, 3, 5> by_errors = Eigen::Matrix<double, 3, 5>::Zero();
  by_errors.topRows<2>().col(0) = -(rotation(facing) * first.per_length);
  by_errors.topRows<2>().col(1) = turned_left(arm - on_part);
  by_errors.topRows<2>().col(2) = -centres_->radius_share * arm;
  by_errors.topRightCorner<2, 2>().setIdentity();
  by_errors(2, 1) = 1;
  spread.covariance = by_errors * p_ * by_errors.transpose();
  if (by_w != nullptr) {
    const double turn_by_w = 1 - tilt_ * place_.slope;
    const Vec2 tangent = -rotation(facing).col(1) * place_.slope;
    *by_w = by_errors * dx_;
    by_w->head<2>() += turn_by_w * turned_left(on_part) - tangent;
    (*by_w)[2] -= turn_by_w;
  }
  return spread;
}

double RollFilter::variance_of_roll(double length, const RowCovariance& own) const {
  const double per_scale = 1 / (1 + x_[2]);
  const Eigen::Vector3d h(-tilt_ * per_scale, -1, -tilt_ * length * per_scale);
  const double variance =
      h.dot(p_.topLeftCorner<kRolling, kRolling>() * h) + tilt_ * tilt_ * own.length + 2 * tilt_ * own.both + own.turn;
  return std::max(0.0, variance);
}

double RollFilter::variance_after(const Reading& measured, const RowCovariance& own) const {
  const double m = after(measured).slope;
  return m * m * variance_of_roll(corrected(measured.length[0], measured.turn, x_).length, own);
}

}  // namespace rollfix::belief
