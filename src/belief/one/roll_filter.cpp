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
//                   scale and bias, the first centre's x and y, the first offset of turn) and their covariance: `x_`,
//                   `p_`; dx/dw is `dx_`
//   e, H            a row's equations and their derivative by x: `Equations::miss`, `by_errors`
//   R, G            variance of the row on its own: `own`; what has gathered on the way: `walk_`, by x
//   cost, volume    e^T S^-1 e and det S / det S_w of all rows, S = S_w + H P0 H^T, S_w = R + G: -2 log likelihood is
//                   their sum, with the logarithm of the second
// Follows docs/belief.md, as named above; the centre's two equations are its "Centres as evidence".
// Idea: for one w the rows measure x, so that an extended Kalman filter of x gives their likelihood and its slope by w.
// Later passes (`again`) take the rows' lines about what all rows together have found.
namespace rollfix::belief {

namespace {

/// The rotation by an angle, counter-clockwise; radians.
Eigen::Matrix2d rotation(double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return (Eigen::Matrix2d() << c, -s, s, c).finished();
}
/// A quarter turn counter-clockwise: the derivative of a rotated vector by the angle.
Vec2 turned_left(const Vec2& vector) { return {-vector.y(), vector.x()}; }

/// As a covariance matrix of (length, turn).
Eigen::Matrix2d matrix_of(const Gathered& gathered) {
  return Eigen::Vector2d(gathered.length, gathered.turn).asDiagonal();
}

}  // namespace

/// Before any row: x = 0 with the covariance P0 = `start`, for a first contact at w.
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
      first_turn_(start(1, 1)),
      p_(start) {}

/// The next pass of Gauss-Newton: the filter begins anew, and keeps what this one found as its point of linearisation.
RollFilter RollFilter::again(const SharedCovariance& start, std::pmr::memory_resource* memory) const {
  RollFilter fresh(*arc_, tilt_, w_, start, centres_);
  fresh.found_ =
      std::allocate_shared<Found>(std::pmr::polymorphic_allocator<Found>(memory),
                                  Found{x_.head<kRolling>(), p_.topLeftCorner<kRolling, kRolling>(), on_the_way_});
  return fresh;
}

/// The shared errors about which a row of this length is linearised, and what of them is open. In a first pass this is
/// the estimate so far. In a later pass it is the estimate of the pass before, by all rows, widened by what gathers
/// from here to the end of the roll. Where the rows so far leave the row's length less open than that, the errors of
/// length come from them.
RollFilter::LinearisedAt RollFilter::linearised_at(double length) const {
  LinearisedAt about{x_, p_};
  if (!found_) return about;
  // What the pass before found. The errors of the first contact (5 to 7) stay as this pass has them, with no covariance
  // with the others.
  about.errors.head<kRolling>() = found_->errors;
  about.open.topRows<kRolling>().setZero();
  about.open.leftCols<kRolling>().setZero();
  about.open.topLeftCorner<kRolling, kRolling>() = found_->covariance;
  // The offsets at the end are not those at this row: between them lies what gathers from here on.
  about.open(0, 0) += std::max(0.0, found_->gathered.length - on_the_way_.length);
  about.open(1, 1) += std::max(0.0, found_->gathered.turn - on_the_way_.turn);
  // Variance of this row's length by offset and scale: (1, L) P (1, L)^T.
  const auto of_length = [&](const SharedCovariance& p) { return p(0, 0) + length * (2 * p(0, 2) + length * p(2, 2)); };
  if (of_length(p_) >= of_length(about.open)) return about;
  // Offset (0) and scale (2) of lengths from this pass, without covariance with the errors of the pass before.
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

/// A row as three equations: e = 0, and the centre's two coordinates in the world. They are linear in the shared errors
/// x and in w, about the point of linearisation.
struct RollFilter::Equations {
  Eigen::Vector3d miss;                         // value at the filter's own estimate x: three lengths
  Eigen::Matrix<double, 3, kShared> by_errors;  // H
  Eigen::Matrix<double, 3, 2> by_own;           // of a row's length and turn
  Eigen::Vector3d by_w;                         // by the first contact's w, x kept
  Eigen::Matrix3d own_variance;                 // R: of the row on its own
  double beyond = 0;                            // an end of the arc: SpreadPlace::beyond, and by w
  double beyond_by_w = 0;
};

/// A row's equations with s(w) replaced by its line about `w`, which is known to `w_variance`. The true L and theta
/// lead from the first contact to the row's: e = s(w + theta + c L) - s(w) - L = 0. With m = ds/dw the derivatives are
/// de/dtheta = m and de/dL = c m - 1. On a straight line m = 1 / c: there e does not depend on L. At a corner m = 0:
/// there e does not depend on theta.
RollFilter::Equations RollFilter::equations_at(double w, const LinearisedAt& about, double w_variance,
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
  rows.beyond = end.beyond;
  rows.beyond_by_w = end.beyond_by_w;
  add_centre(end, w, about, node, rows);
  // From the point of linearisation to the filter's estimate. What is of the first contact enters as it is in
  // add_centre.
  rows.miss += rows.by_errors.leftCols<kRolling>() * (x_ - about.errors).head<kRolling>();
  rows.own_variance += rows.by_own * matrix_of(node.own) * rows.by_own.transpose();
  return rows;
}

/// The two equations of the finger's centre: docs/belief.md, "Centres as evidence". In the part's frame the centre is
/// at q(s) = p(s) - R(Theta + pi/2) arm. In the world it moves from where it was at the first contact by R(heading)
/// (q(s) - q(s0)). The first contact's normal tells the heading: N + psi - pi/2 - Theta(s0).
void RollFilter::add_centre(const SpreadPlace& end, double w, const LinearisedAt& about, const Node& node,
                            Equations& rows) const {
  constexpr double kQuarter = std::numbers::pi / 2;
  const Shared& errors = about.errors;
  const Corrected roll = corrected(node, errors);
  const double per_scale = 1 / (1 + errors[2]);
  const double smaller = 1 / (1 + centres_->radius_share * errors[2]);  // the finger, where its radius is wrong
  // Theta = w - c s, at the row's contact and at the first one; d Theta / dw = 1 - c m.
  const double angle = w - tilt_ * end.s;
  const double angle_first = w_ - tilt_ * place_.s;
  const double turn_by_w = 1 - tilt_ * end.slope;
  const double turn_by_w_first = 1 - tilt_ * place_.slope;
  // The first offset of turn is the error of the first normal, sign reversed (ErrorModel): it corrects the heading.
  const double heading = centres_->normal + errors[7] - kQuarter - angle_first;
  const Eigen::Matrix2d to_world = rotation(heading);
  const Eigen::Matrix2d of_arm = rotation(heading + angle + kQuarter);
  const Eigen::Matrix2d of_first_arm = rotation(heading + angle_first + kQuarter);
  const Vec2 arm = of_arm * (smaller * node.felt.arm.at);
  const Vec2 first_arm = of_first_arm * (smaller * centres_->first.arm.at - errors[0] * centres_->first.arm.per_length);
  // dq/dw in the world: the contact moves by m along the tangent, and the arm turns with Theta. Column 1 of R(Theta +
  // pi/2) points against the tangent.
  const Vec2 by_w = end.slope * of_arm.col(1) * -1 - turn_by_w * turned_left(arm);
  const Vec2 by_w_first = place_.slope * of_first_arm.col(1) * -1 - turn_by_w_first * turned_left(first_arm);
  // From the first centre to the row's, as the place s and the first contact's normal predict it.
  const Vec2 way = to_world * (centres_->path->at(end.s) - centres_->path->at(place_.s)) - arm + first_arm;
  const Vec2 centre_off(x_[5], x_[6]);

  // As in e: the line through the place at `w` is taken to where the measured roll leads.
  const double beyond = w_ + roll.turn + tilt_ * roll.length - w;
  rows.miss.tail<2>() = way + by_w * beyond + centre_off - (node.felt.centre - centres_->first.centre);
  auto by_errors = rows.by_errors.bottomRows<2>();
  // Offset of length, offset of turn, scale of lengths, a gyroscope's scale and bias, then the first centre's own
  // error, and the first normal's.
  by_errors.col(0) = -tilt_ * per_scale * by_w - of_first_arm * centres_->first.arm.per_length;
  by_errors.col(1) = -by_w;
  by_errors.col(2) = -tilt_ * roll.length * per_scale * by_w + centres_->radius_share * (arm - first_arm);
  by_errors.col(3) = -roll.sensed * by_w;
  by_errors.col(4) = -roll.seconds * by_w;
  by_errors.middleCols<2>(5).setIdentity();
  by_errors.col(7) = turned_left(way);
  rows.by_own.bottomRows<2>().col(0) = tilt_ * by_w + of_arm * node.felt.arm.per_length;
  rows.by_own.bottomRows<2>().col(1) = by_w;
  // At another w both contacts move. As Theta(s0) turns, the heading turns back by as much.
  rows.by_w.tail<2>() = by_w - by_w_first - turn_by_w_first * turned_left(way);
  // The mean of rows on a bend is beside it.
  const double bend = 0.5 * node.spread * std::abs(turn_by_w) * (by_w.norm() + 2 * tilt_ * end.slope);
  const double variance = centres_->variance / node.worth + bend * bend;
  rows.own_variance.bottomRightCorner<2, 2>().diagonal().array() += variance;
}

/// One step of the filter: predict (what gathers on the way), correct (`absorb`), and keep the scales and the bias
/// within bounds.
void RollFilter::update(const Node& node, const Outliers& outliers) {
  const auto gather = [&](double share) {
    p_.topLeftCorner<2, 2>() += share * matrix_of(node.gathered);
    walk_ += share * matrix_of(node.gathered);
    on_the_way_.length += share * node.gathered.length;
    on_the_way_.turn += share * node.gathered.turn;
  };
  // A node is the mean of its rows: that share of what gathers among them is in it, the rest comes after it.
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

/// docs/belief.md, "What is known, and what is not": the volume is det S / det S_w. With outliers a row is a mixture.
/// Then the volume is the square of a ratio: the mixture's highest density with S_w over the one with S.
RowShare share_of(int equations, double squared, double noise, double all, const Outliers& outliers) {
  if (outliers.share <= 0) return {1, squared, all / noise};
  // An outlier is even over the range of each equation.
  const double range = std::pow(outliers.range, equations);
  const double stray = outliers.share / range;
  // peak_of() has one factor 1 / sqrt(2 pi); of n equations n - 1 factors are missing.
  const double flat = std::pow(2 * std::numbers::pi, 0.5 * (equations - 1));
  const Mixture mixture = mixture_of(outliers.share, stray, peak_of(1 / all) / flat, squared);
  const double most = (1 - outliers.share) * peak_of(1 / noise) / flat + stray;
  return {mixture.weight, mixture.cost, square(most / mixture.density)};
}

/// The correction by one node, with its three equations: cost, volume, x, P, and their derivatives by w.
void RollFilter::absorb(const Node& node, const Outliers& outliers) {
  const LinearisedAt about = linearised_at(node.length);
  const Corrected roll = corrected(node, about.errors);
  // Where the contact would be by the measured roll alone, with the variance of that.
  const double measured = w_ + roll.turn + tilt_ * roll.length;
  const double w_variance = variance_of_roll(roll, about, node.own);
  Equations rows = equations_at(measured, about, w_variance, node);
  Eigen::Matrix<double, kShared, 3> of_errors;
  Eigen::Matrix3d inverse;
  const Eigen::Matrix2d averaged = node.share_averaged() * matrix_of(node.gathered);
  Eigen::Matrix3d own;
  const auto weigh = [&] {
    of_errors = p_ * rows.by_errors.transpose();
    // Among the joined rows a part of what gathers averages out: it is in P, and is taken off here.
    own = rows.own_variance - rows.by_errors.leftCols<2>() * averaged * rows.by_errors.leftCols<2>().transpose();
    inverse = (rows.by_errors * of_errors + own).inverse();
  };
  weigh();
  // Where the contact is likely to be, given the equations as well. A slope taken where the turn was measured would go
  // with that turn's own error, and what many rows say would be taken for more than it is.
  const Eigen::Vector2d tilted(tilt_, 1);
  const Eigen::Matrix<double, kShared, 3> of_open = about.open * rows.by_errors.transpose();
  const Eigen::Matrix3d open_inverse = found_ ? (rows.by_errors * of_open + own).inverse() : inverse;
  // The equations at the point of linearisation itself, as `open` is about that.
  const Eigen::Vector3d miss = rows.miss - rows.by_errors * (x_ - about.errors);
  // Covariance of the contact's w with the equations; `shift` is the mean of that w's error, given the equations.
  const Eigen::Vector3d with_roll =
      of_open.topRows<kRolling>().transpose() * by_rolling(roll, about.errors).transpose() * tilted +
      rows.by_own * matrix_of(node.own) * tilted;
  const double shift = with_roll.dot(open_inverse * miss);
  if (std::abs(shift) > kSameLine) {
    // The variance of w that the equations leave.
    const double left = std::max(0.0, w_variance - with_roll.dot(open_inverse * with_roll));
    rows = equations_at(measured - shift, about, left, node);
    weigh();
  }

  const Eigen::Vector3d innovation = -rows.miss;
  // d innovation / dw, with the estimate x moving along: dx/dw = `dx_`.
  const Eigen::Vector3d by_w = -rows.by_w - rows.by_errors * dx_;
  const double squared = innovation.dot(inverse * innovation) + square(rows.beyond);
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
  // Kalman's gain. An outlier's weight below 1 scales the step and what it takes off P. The slope of log L is
  // -(innovation, d innovation / dw) in the metric S^-1, the information is the square of the latter.
  const Eigen::Matrix<double, kShared, 3> gain = weight * of_errors * inverse;
  slope_ += weight * (innovation.dot(inverse * by_w) + rows.beyond * rows.beyond_by_w);
  const double steep = by_w.dot(inverse * by_w) + square(rows.beyond_by_w);
  information_ += weight * steep;
  steepness_ += steep;
  x_ += gain * innovation;
  dx_ += gain * by_w;
  p_ -= gain * of_errors.transpose();
  // The same filter with G in place of P, which gives det S_w.
  walk_ -= weight * of_walk * noise.inverse() * of_walk.transpose();
}

/// L and theta less the shared errors, as all rows together have estimated them.
TiltedPlace RollFilter::after(const Row& measured, double further) const {
  const Corrected roll = corrected(measured, x_);
  return arc_->at(w_ + further + roll.turn + tilt_ * roll.length);
}

/// All that the filter has learned stays true on a fold of the boundary: only w, s and the arc differ.
RollFilter RollFilter::moved(const TiltedArc& arc, const Shift& shift) const {
  RollFilter there = *this;
  there.arc_ = &arc;
  there.w_ += shift.w;
  there.place_.s += shift.s;
  return there;
}

/// docs/rolling.md, "Where the part is": beta = phi + Theta + pi/2 and q = X + R(phi) p(s) at the first contact, with
/// what all rows say of its errors. The covariance is J P J^T; `by_w` is the derivative of (x, y, heading).
PoseSpread RollFilter::pose(Eigen::Vector3d* by_w) const {
  const double angle = w_ - tilt_ * place_.s;
  // The first normal's error: where centres tell it, on its own. Else of the offset at the end, which is that error and
  // all that has gathered since, independent of each other, its share by their variances.
  const bool is_told = centres_->variance > 0;
  const double gathered = is_told ? 0 : on_the_way_.turn;
  const double share = gathered > 0 ? first_turn_ / (first_turn_ + gathered) : 1;
  const Eigen::Index which = is_told ? 7 : 1;
  const double normal = centres_->normal + share * x_[which];
  PoseSpread spread;
  spread.mean.heading = normal - std::numbers::pi / 2 - angle;
  const Arm& first = centres_->first.arm;
  // From the centre to the contact, in the world, corrected for a wrong radius and a place felt elsewhere.
  const Vec2 arm = rotation(normal) * (1 / (1 + centres_->radius_share * x_[2]) * first.at - x_[0] * first.per_length);
  const Vec2 on_part = spread.mean.turned(centres_->part->point(place_.s));
  const Vec2 origin = centres_->first.centre + Vec2(x_[5], x_[6]) + arm - on_part;
  spread.mean.x = origin.x();
  spread.mean.y = origin.y();
  Eigen::Matrix<double, 3, kShared> by_errors = Eigen::Matrix<double, 3, kShared>::Zero();
  by_errors.topRows<2>().col(0) = -(rotation(normal) * first.per_length);
  Eigen::Vector3d by_normal(0, 0, 1);
  by_normal.head<2>() = turned_left(arm - on_part);
  by_errors.col(which) = share * by_normal;
  by_errors.topRows<2>().col(2) = -centres_->radius_share * arm;
  by_errors.block<2, 2>(0, 5).setIdentity();
  spread.covariance = by_errors * p_ * by_errors.transpose() + share * gathered * by_normal * by_normal.transpose();
  if (by_w != nullptr) {
    // Along the boundary the point p(s) moves by m along the tangent, and the heading turns back by dTheta.
    const double turn_by_w = 1 - tilt_ * place_.slope;
    const Vec2 tangent = -rotation(normal).col(1) * place_.slope;
    *by_w = by_errors * dx_;
    by_w->head<2>() += turn_by_w * turned_left(on_part) - tangent;
    (*by_w)[2] -= turn_by_w;
  }
  return spread;
}

/// d(L, theta)/dx of L = (L_measured - x_0) / (1 + x_2) and theta = theta_measured - x_1 - x_3 sensed - x_4 t.
Eigen::Matrix<double, 2, kRolling> RollFilter::by_rolling(const Corrected& roll, const Shared& errors) {
  const double per_scale = 1 / (1 + errors[2]);
  Eigen::Matrix<double, 2, kRolling> by_errors;
  by_errors << -per_scale, 0, -roll.length * per_scale, 0, 0,  //
      0, -1, 0, -roll.sensed, -roll.seconds;
  return by_errors;
}

/// (c, 1) C (c, 1)^T with C the covariance of (L, theta); rounding below 0 counts as 0. Radians^2.
double RollFilter::variance_of_roll(const Corrected& roll, const LinearisedAt& about, const RowCovariance& own) const {
  const Eigen::Matrix<double, kRolling, 1> h = by_rolling(roll, about.errors).transpose() * Eigen::Vector2d(tilt_, 1);
  const double variance = h.dot(about.open.topLeftCorner<kRolling, kRolling>() * h) + tilt_ * tilt_ * own.length +
                          2 * tilt_ * own.both + own.turn;
  return std::max(0.0, variance);
}

/// By the line through s over what is open of w, and what that misses: at a corner m = 0, but the contact may be beside
/// it. Length^2.
double RollFilter::variance_after(const Row& measured, const RowCovariance& own) const {
  const Corrected roll = corrected(measured, x_);
  const double open = variance_of_roll(roll, {x_, p_}, own);
  const SpreadPlace end = arc_->about(w_ + roll.turn + tilt_ * roll.length, open, 0);
  return end.slope * end.slope * open + end.variance;
}

}  // namespace rollfix::belief
