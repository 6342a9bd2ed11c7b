#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "belief/one/roll_filter.hpp"
#include "belief/posterior.hpp"

// Notation, as in docs/belief.md, "The computation" and "What is known, and what is not":
//   w, c            tilted turning w = Theta + c s of the first contact: `w_`; c is `tilt_`
//   s(w), m         place on the boundary, m = ds/dw = 1 / (kappa + c): `TiltedPlace::s`, `slope`
//   L, theta        a row's length and turn less the shared errors: `Corrected`
//   x, P            errors that the roll shares (offset of length, offset of turn, scale of lengths, a gyroscope's
//                   scale and bias, the first centre's x and y) and their covariance: `x_`, `p_`; dx/dw is `dx_`
//   e, H            a row's equations and their derivative by x: `Equations::miss`, `by_errors`
//   R, K            variance of the row on its own: `own`; what has gathered on the way: `walk_`, by x
//   cost, volume    e^T S^-1 e and det S / det S_w of all rows, S = S_w + H P0 H^T, S_w = R + K: -2 log likelihood is
//                   their sum, with the logarithm of the second
// Follows docs/belief.md, as named above; the centre's two equations are its "Centres as evidence".
// Idea: for one w the rows measure x, so that an extended Kalman filter of x gives their likelihood and its slope by w.
// Later passes (`again`) take the rows' lines about what all rows together have found.
namespace rollfix::belief {

namespace {

Eigen::Matrix2d rotation(double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return (Eigen::Matrix2d() << c, -s, s, c).finished();
}
Vec2 turned_left(const Vec2& vector) { return {-vector.y(), vector.x()}; }

Eigen::Matrix2d matrix_of(const Gathered& gathered) {
  return Eigen::Vector2d(gathered.length, gathered.turn).asDiagonal();
}
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
      most_gyroscope_scale_(most_scale(start(3, 3))),
      most_bias_(kMostErrorSigmas * std::sqrt(start(4, 4))),
      p_(start) {}

RollFilter RollFilter::again(const SharedCovariance& start, std::pmr::memory_resource* memory) const {
  RollFilter fresh(*arc_, tilt_, w_, start, centres_);
  fresh.found_ =
      std::allocate_shared<Found>(std::pmr::polymorphic_allocator<Found>(memory),
                                  Found{x_.head<kRolling>(), p_.topLeftCorner<kRolling, kRolling>(), on_the_way_});
  return fresh;
}

// In a first pass as it is estimated so far. The end of a pass knows all rows, but for what gathers until then: where
// the rows so far leave less open of this row's length, what they say of lengths.
RollFilter::About RollFilter::about(double length) const {
  About about{x_, p_};
  if (!found_) return about;
  about.errors.head<kRolling>() = found_->errors;
  about.open.topRows<kRolling>().setZero();
  about.open.leftCols<kRolling>().setZero();
  about.open.topLeftCorner<kRolling, kRolling>() = found_->covariance;
  about.open(0, 0) += std::max(0.0, found_->gathered.length - on_the_way_.length);
  about.open(1, 1) += std::max(0.0, found_->gathered.turn - on_the_way_.turn);
  const auto of_length = [&](const SharedCovariance& p) { return p(0, 0) + length * (2 * p(0, 2) + length * p(2, 2)); };
  if (of_length(p_) >= of_length(about.open)) return about;
  constexpr std::array<Eigen::Index, 2> kOfLength = {0, 2};
  for (const Eigen::Index k : kOfLength) {
    about.errors[k] = x_[k];
    about.open.row(k).setZero();
    about.open.col(k).setZero();
  }
  for (const Eigen::Index k : kOfLength) {
    for (const Eigen::Index j : kOfLength) about.open(k, j) = p_(k, j);
  }
  return about;
}

/// A row as three equations, linear in the errors: e = 0, and the centre's two coordinates.
struct RollFilter::Equations {
  Eigen::Vector3d miss;
  Eigen::Matrix<double, 3, kShared> by_errors;
  Eigen::Matrix<double, 3, 2> by_own;  // of a row's length and turn
  Eigen::Vector3d by_w;
  Eigen::Matrix3d own_variance;
};

// The true L and theta lead from this place to another: e = s(w + theta + c L) - s(w) - L = 0, with ds/dw = m.
// With de/dtheta = m and de/dL = c m - 1, e tells of the errors of L and theta what can be told.
RollFilter::Equations RollFilter::equations_at(double w, const About& about, double w_variance,
                                               const Node& node) const {
  const Corrected roll = corrected(node, about.errors);
  const SpreadPlace end = arc_->about(w, w_variance, node.spread);
  const double by_turn = end.slope;
  const double by_length = tilt_ * end.slope - 1;
  Equations rows;
  rows.by_errors.setZero();
  rows.own_variance.setZero();
  // The line through the place at w, where the roll as it was measured leads.
  rows.miss[0] = end.s + end.slope * (w_ + roll.turn + tilt_ * roll.length - w) - place_.s - roll.length;
  rows.by_own.row(0) << by_length, by_turn;
  rows.by_errors.block<1, kRolling>(0, 0) = rows.by_own.row(0) * by_rolling(roll, about.errors);
  rows.by_w[0] = end.slope - place_.slope;
  rows.own_variance(0, 0) = end.variance;
  add_centre(end, w, about, node, rows);
  rows.miss += rows.by_errors.leftCols<kRolling>() * (x_ - about.errors).head<kRolling>();
  rows.own_variance += rows.by_own * matrix_of(node.own) * rows.by_own.transpose();
  return rows;
}

// The centre goes along q(s) = p(s) - R(Theta + pi/2) arm, as the part lies in the world: from where it was at the
// first contact by R(heading) (q(s) - q(s0)). The first contact's normal tells the heading: facing - pi/2 - Theta(s0).
void RollFilter::add_centre(const SpreadPlace& end, double w, const About& about, const Node& node,
                            Equations& rows) const {
  constexpr double kQuarter = std::numbers::pi / 2;
  const Shared& errors = about.errors;
  const Corrected roll = corrected(node, errors);
  const double per_scale = 1 / (1 + errors[2]);
  const double smaller = 1 / (1 + centres_->radius_share * errors[2]);  // the finger, where its radius is wrong
  const double angle = w - tilt_ * end.s;
  const double angle_first = w_ - tilt_ * place_.s;
  const double turn_by_w = 1 - tilt_ * end.slope;
  const double turn_by_w_first = 1 - tilt_ * place_.slope;
  const double heading = centres_->facing + errors[1] - kQuarter - angle_first;
  const Eigen::Matrix2d to_world = rotation(heading);
  const Eigen::Matrix2d of_arm = rotation(heading + angle + kQuarter);
  const Eigen::Matrix2d of_first_arm = rotation(heading + angle_first + kQuarter);
  const Vec2 arm = of_arm * (smaller * node.felt.arm.at);
  const Vec2 first_arm = of_first_arm * (smaller * centres_->first.arm.at - errors[0] * centres_->first.arm.per_length);
  const Vec2 by_w = end.slope * of_arm.col(1) * -1 - turn_by_w * turned_left(arm);
  const Vec2 by_w_first = place_.slope * of_first_arm.col(1) * -1 - turn_by_w_first * turned_left(first_arm);
  const Vec2 way = to_world * (centres_->path->at(end.s) - centres_->path->at(place_.s)) - arm + first_arm;
  const Vec2 centre_off(x_[5], x_[6]);

  const double beyond = w_ + roll.turn + tilt_ * roll.length - w;
  rows.miss.tail<2>() = way + by_w * beyond + centre_off - (node.felt.centre - centres_->first.centre);
  auto by_errors = rows.by_errors.bottomRows<2>();
  by_errors.col(0) = -tilt_ * per_scale * by_w - of_first_arm * centres_->first.arm.per_length;
  by_errors.col(1) = -by_w + turned_left(way);
  by_errors.col(2) = -tilt_ * roll.length * per_scale * by_w + centres_->radius_share * (arm - first_arm);
  by_errors.col(3) = -roll.sensed * by_w;
  by_errors.col(4) = -roll.seconds * by_w;
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
  const auto gather = [&](double share) {
    p_.topLeftCorner<2, 2>() += share * matrix_of(node.gathered);
    walk_ += share * matrix_of(node.gathered);
    on_the_way_.length += share * node.gathered.length;
    on_the_way_.turn += share * node.gathered.turn;
  };
  gather(node.share_in_mean());
  absorb(node, outliers);
  gather(1 - node.share_in_mean());
  // A place that does not fit asks for lengths that no slip explains: it is refused by its cost, not followed.
  const auto bound = [&](int k, double most) {
    if (std::abs(x_[k]) <= most) return;
    x_[k] = std::copysign(most, x_[k]);
    dx_[k] = 0;
  };
  bound(2, most_scale_);
  bound(3, most_gyroscope_scale_);
  bound(4, most_bias_);
}

RowShare share_of(int equations, double squared, double noise, double all, const Outliers& outliers) {
  if (outliers.share <= 0) return {1, squared, all / noise};
  const double range = std::pow(outliers.range, equations);
  const double stray = outliers.share / range;
  const double flat = std::pow(2 * std::numbers::pi, 0.5 * (equations - 1));
  const Mixture mixture = mixture_of(outliers.share, stray, peak_of(1 / all) / flat, squared);
  const double most = (1 - outliers.share) * peak_of(1 / noise) / flat + stray;
  return {mixture.weight, mixture.cost, square(most / mixture.density)};
}

void RollFilter::absorb(const Node& node, const Outliers& outliers) {
  const About about = this->about(node.length);
  const Corrected roll = corrected(node, about.errors);
  const double measured = w_ + roll.turn + tilt_ * roll.length;
  const double w_variance = variance_of_roll(roll, about, node.own);
  Equations rows = equations_at(measured, about, w_variance, node);
  Eigen::Matrix<double, kShared, 3> of_errors;
  Eigen::Matrix3d inverse;
  const Eigen::Matrix2d averaged = node.share_averaged() * matrix_of(node.gathered);
  Eigen::Matrix3d own;
  const auto weigh = [&] {
    of_errors = p_ * rows.by_errors.transpose();
    own = rows.own_variance - rows.by_errors.leftCols<2>() * averaged * rows.by_errors.leftCols<2>().transpose();
    inverse = (rows.by_errors * of_errors + own).inverse();
  };
  weigh();
  // Where the contact is likely to be, given the equations as well. A slope taken where the turn was measured would go
  // with that turn's own error, and what many rows say would be taken for more than it is.
  const Eigen::Vector2d tilted(tilt_, 1);
  const Eigen::Matrix<double, kShared, 3> of_open = about.open * rows.by_errors.transpose();
  const Eigen::Matrix3d open_inverse = found_ ? (rows.by_errors * of_open + own).inverse() : inverse;
  const Eigen::Vector3d miss = rows.miss - rows.by_errors * (x_ - about.errors);
  const Eigen::Vector3d with_roll =
      of_open.topRows<kRolling>().transpose() * by_rolling(roll, about.errors).transpose() * tilted +
      rows.by_own * matrix_of(node.own) * tilted;
  const double shift = with_roll.dot(open_inverse * miss);
  if (std::abs(shift) > kSameLine) {
    const double left = std::max(0.0, w_variance - with_roll.dot(open_inverse * with_roll));
    rows = equations_at(measured - shift, about, left, node);
    weigh();
  }

  const Eigen::Vector3d innovation = -rows.miss;
  const Eigen::Vector3d by_w = -rows.by_w - rows.by_errors * dx_;
  const double squared = innovation.dot(inverse * innovation);
  // Where along the roll the row was taken is not known beforehand, nor that it is more likely where the contact goes
  // slowly: only what the rows share has a volume.
  const Eigen::Matrix<double, 2, 3> of_walk = walk_ * rows.by_errors.leftCols<2>().transpose();
  const Eigen::Matrix3d noise = own + rows.by_errors.leftCols<2>() * of_walk;
  // e^T S^-1 e, and det S / det S_w.
  const RowShare share = share_of(3, squared, noise.determinant(), 1 / inverse.determinant(), outliers);
  const double weight = share.weight;
  cost_ += share.cost;
  log_volume_ += std::log(share.volume);
  log_gathered_ += std::log(noise.determinant() / rows.own_variance.determinant());
  right_rows_ += 3 * weight;
  right_cost_ += weight * squared;
  add_innovation<3>(inverse, std::sqrt(weight) * innovation, whiteness_);
  const Eigen::Matrix<double, kShared, 3> gain = weight * of_errors * inverse;
  slope_ += weight * innovation.dot(inverse * by_w);
  information_ += weight * by_w.dot(inverse * by_w);
  x_ += gain * innovation;
  dx_ += gain * by_w;
  p_ -= gain * of_errors.transpose();
  walk_ -= weight * of_walk * noise.inverse() * of_walk.transpose();
}

TiltedPlace RollFilter::after(const Row& measured, double further) const {
  const Corrected roll = corrected(measured, x_);
  return arc_->at(w_ + further + roll.turn + tilt_ * roll.length);
}

RollFilter RollFilter::moved(const TiltedArc& arc, const Shift& shift) const {
  RollFilter there = *this;
  there.arc_ = &arc;
  there.w_ += shift.w;
  there.place_.s += shift.s;
  return there;
}

PoseSpread RollFilter::pose(Eigen::Vector3d* by_w) const {
  const double angle = w_ - tilt_ * place_.s;
  const double facing = centres_->facing + x_[1];
  PoseSpread spread;
  spread.mean.heading = facing - std::numbers::pi / 2 - angle;
  const Arm& first = centres_->first.arm;
  const Vec2 arm = rotation(facing) * (1 / (1 + centres_->radius_share * x_[2]) * first.at - x_[0] * first.per_length);
  const Vec2 on_part = spread.mean.turned(centres_->part->point(place_.s));
  const Vec2 origin = centres_->first.centre + Vec2(x_[5], x_[6]) + arm - on_part;
  spread.mean.x = origin.x();
  spread.mean.y = origin.y();
  Eigen::Matrix<double, 3, kShared> by_errors = Eigen::Matrix<double, 3, kShared>::Zero();
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

Eigen::Matrix<double, 2, kRolling> RollFilter::by_rolling(const Corrected& roll, const Shared& errors) {
  const double per_scale = 1 / (1 + errors[2]);
  Eigen::Matrix<double, 2, kRolling> by_errors;
  by_errors << -per_scale, 0, -roll.length * per_scale, 0, 0,  //
      0, -1, 0, -roll.sensed, -roll.seconds;
  return by_errors;
}

double RollFilter::variance_of_roll(const Corrected& roll, const About& about, const RowCovariance& own) const {
  const Eigen::Matrix<double, kRolling, 1> h = by_rolling(roll, about.errors).transpose() * Eigen::Vector2d(tilt_, 1);
  const double variance = h.dot(about.open.topLeftCorner<kRolling, kRolling>() * h) + tilt_ * tilt_ * own.length +
                          2 * tilt_ * own.both + own.turn;
  return std::max(0.0, variance);
}

double RollFilter::variance_after(const Row& measured, const RowCovariance& own) const {
  const double m = after(measured).slope;
  const Corrected roll = corrected(measured, x_);
  return m * m * variance_of_roll(roll, {x_, p_}, own);
}

}  // namespace rollfix::belief
