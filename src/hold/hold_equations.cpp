#include "hold_fit.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "outline/turn.hpp"
#include "part/turning_range.hpp"

// Notation as in hold_fit.cpp:
//   J, c            a corner's turn and its place; rho: `pivot`, the finger's radius
//   d = (s - c)/sd  how far s is past it, in standard deviations: `d`; Phi(d): `behind`, its density phi(d): `bell`
//   Phi(-d), Phi(d), (rho J / sd) phi(d)   how likely a contact that was felt at s is before, behind and at the corner:
//                   a finger whose centre goes evenly stays at it for rho J; `at` is the last
//   r, t            residuals of the contact's place in the world and of its tangent: `Look::residual`
//   C               their covariance: position, the orientation by its lever l (Q l is l turned by a right angle), and
//   the
//                   contact's error n, which turns the normal by (kappa + kappa_finger) n and nothing else; at a corner
//                   see `pivot`, where docs/two_fingers.md has w for `share`
//   P, B, M         blocks of a row's normal equations: of its pose, mixed, of the unknowns: RowEquations
// Idea: before a corner Theta is lower by J than behind, and at it anything between alike. Elsewhere Theta is straight
// over so short a way. docs/two_fingers.md, "The errors".
namespace rollfix::hold {
namespace {

constexpr double kBlurReach = 5;  // standard deviations: beyond, a corner is not seen
constexpr double kFitsSide = 8;   // chi-square of one angle: more fits no side

/// The place of an open boundary that is nearest to s; of a closed one s itself, on any lap.
double on_boundary(const Boundary& boundary, double s) {
  return boundary.closed ? s : std::clamp(s, 0.0, boundary.perimeter);
}

/// Theta and its slope at the place alone: no blur, no range.
BlurredPlace plain(const Part& part, double s) {
  const Turning turning = part.turning().at(on_boundary(part.boundary(), s));
  BlurredPlace place;
  place.side = place.angle = turning.angle;
  place.curvature = place.bend = turning.curvature;
  return place;
}

constexpr double kRidge = 1e-12;  // keeps what nothing determines where it is
// The normal is looked at as far as so many standard deviations of the contact's error; within this share of the
// angle's own it turns evenly.
constexpr double kErrorReach = 2;
constexpr double kUneven = 0.2;
constexpr int kErrorRounds = 6;
constexpr double kErrorSettled = 1e-6;  // of a chi-square

/// Within two standard deviations of n the normal turns otherwise than kappa there says, as beside a small rounding.
/// Corners are not meant: they are blurred.
bool is_uneven(const Part& part, const BlurredPlace& at, double s, const HeldErrors& errors) {
  if (at.has_corner || errors.angle <= 0 || errors.travel <= 0) return false;
  const double reach = kErrorReach * errors.travel;
  const auto off = [&](double m) { return std::abs(turn_from(part, s, m) - m * at.curvature); };
  return std::max(off(reach), off(-reach)) > kUneven * errors.angle;
}

}  // namespace

Vec2 point_about(const Part& part, double s) {
  const double at = on_boundary(part.boundary(), s);
  if (at == s) return part.point(s);
  const double angle = part.turning().angle(at);
  return part.point(at) + (s - at) * Vec2(std::cos(angle), std::sin(angle));
}

/// docs/two_fingers.md, "The errors". Several corners within reach add up, each as if it were alone.
BlurredPlace blurred(const Part& part, double s, double sd, double pivot) {
  BlurredPlace place = plain(part, s);
  const Boundary boundary = part.boundary();
  const double base = boundary.on_first_lap(s);
  double nearest = 0;
  for (const Corner& corner : part.corners()) {
    // How far s is past the corner, the shorter way round.
    double past = base - corner.s;
    if (boundary.closed && std::abs(past) > 0.5 * boundary.perimeter) {
      past -= std::copysign(boundary.perimeter, past);
    }
    if (std::abs(past) > kBlurReach * sd) continue;
    if (!place.has_corner || std::abs(past) < nearest) {
      nearest = std::abs(past);
      place.other = place.side + (past >= 0 ? -corner.turn : corner.turn);
    }
    place.has_corner = true;
    const double d = past / sd;
    const double bell = std::exp(-0.5 * d * d) / std::sqrt(2 * std::numbers::pi);
    const double behind = 0.5 * std::erfc(-d / std::numbers::sqrt2);
    const double at = std::max(0.0, corner.turn) * pivot / sd * bell;
    // Before and behind have the weights Phi(-d) + Phi(d) = 1, to which `at` comes: shares are over this sum.
    const double all = 1 + at;
    // Of Theta, as a share of J above the side before: 0 before, 1 behind, 1/2 on average at the corner.
    const double mean = (behind + 0.5 * at) / all;
    // Theta(s) itself holds all of J from the corner on.
    place.angle += corner.turn * (mean - (past >= 0 ? 1 : 0));
    // d mean / ds, with d phi / dd = -d phi.
    place.bend += corner.turn * (bell - 0.5 * d * at + mean * d * at) / (all * sd);
    // At the corner Theta is uniform over J: its mean square is J^2 / 3.
    place.variance += corner.turn * corner.turn * ((behind + at / 3) / all - mean * mean);
    // A concave corner has no pivot: `at` is 0.
    if (at / all > place.pivoting) {
      place.pivoting = at / all;
      place.past = past;
    }
  }
  return place;
}

double turn_from(const Part& part, double s, double m) {
  const Boundary boundary = part.boundary();
  return part.turning().angle(on_boundary(boundary, s + m)) - part.turning().angle(on_boundary(boundary, s));
}

double curvature_at(const Part& part, double s) { return part.turning().curvature(on_boundary(part.boundary(), s)); }

/// The range holds the pivots of all corners on the arc. `angle` is its middle, `half_turn` half its width.
BlurredPlace ranged(const Part& part, double s, double reach) {
  BlurredPlace place = plain(part, s);
  const Boundary boundary = part.boundary();
  Interval arc{s - reach, s + reach};
  if (!boundary.closed)
    arc = {std::clamp(arc.lo, 0.0, boundary.perimeter), std::clamp(arc.hi, 0.0, boundary.perimeter)};
  const Interval angles = angles_over(part.turning(), arc);
  place.angle = angles.middle();
  place.half_turn = 0.5 * angles.width();
  return place;
}

/// 1 / kappa_finger, of a disk its radius; no more than that of a circle with the part's perimeter, so that a flat
/// finger has one.
double HoldFit::pivot_length(const HeldContact& contact) const {
  return 1 / std::max(contact.finger_curvature, 2 * std::numbers::pi / part_.perimeter());
}

HoldFit::Sight HoldFit::sight(double s, double stretch, std::size_t row, std::size_t finger) const {
  const HeldContact& contact = rows_.rows[row].contacts[finger];
  const HeldErrors& errors = rows_.errors[finger];
  // A blur of 0 would leave corners without a slope.
  const double blur = std::max(errors.travel, kLeastBlur * part_.perimeter());
  Sight sight;
  sight.at = rows_.has_noise ? blurred(part_, s, blur, pivot_length(contact)) : ranged(part_, s, errors.travel);
  sight.s = s;
  sight.stretch = stretch;
  if (errors.has_place) sight.point = point_about(part_, s);
  if (rows_.has_noise) {
    weigh(sight, contact, errors, rows_.rows[row].weight);
  } else {
    // Lawson's weights, of best_worst, times the rows that this one is the mean of.
    weigh_exactly(sight, errors, weight(row, finger) * rows_.rows[row].weight);
  }
  return sight;
}

/// Without noise: the tolerances in place of standard deviations. `times`: how often it counts.
void HoldFit::weigh_exactly(Sight& sight, const HeldErrors& errors, double times) const {
  if (errors.has_place) sight.information(0, 0) = sight.information(1, 1) = times / (errors.place * errors.place);
  // An angle that is exact beside places that are not would only cost digits.
  const double angle = std::max(errors.angle, wheels() == 0 ? 0 : errors.place / part_.perimeter());
  sight.information(2, 2) = times / (angle * angle);
}

/// With noise: C of a row that is the mean of `rows`.
void HoldFit::weigh(Sight& sight, const HeldContact& contact, const HeldErrors& errors, double rows) const {
  // Standard deviation of the normal by the contact's error: part and finger both turn under it.
  const double bend = (sight.at.curvature + contact.finger_curvature) * errors.travel;
  const double angle = errors.angle * errors.angle;
  // Means like this one that may share one pivot.
  const double alike = std::max(1.0, contact.rows_alike / rows);
  // Variance of t without corners, ...
  const double plain = (angle + bend * bend) / rows;
  // ... and by corners: n rows that share one unknown are off by no more than independent ones with n times the
  // variance each (Cauchy-Schwarz).
  const double corner = sight.at.variance * alike;
  sight.turn_variance = angle + sight.at.variance;
  // 1 without corners; 1 / alike where the pivot is all that the angle says.
  sight.angles = (1 + corner / (plain * alike)) / (1 + corner / plain);
  sight.plain = plain;
  sight.blur_size = std::log1p(corner / plain) / alike;
  sight.error = errors.travel / std::sqrt(rows);
  // Where the normal turns unevenly, t is linear in n, and n is eliminated by C itself.
  const bool is_bent = is_uneven(part_, sight.at, sight.s, errors);
  if (errors.has_place) {
    weigh_place(sight, contact, errors, {rows, bend, corner, is_bent});
    return;
  }
  if (is_bent) {
    // Without x and y the orientation alone is left of C.
    sight.bare_information = Eigen::Matrix3d::Zero();
    (*sight.bare_information)(2, 2) = rows / angle;
    sight.bare_log_size = std::log(angle / rows);
  }
  // det C counts the corner by its share only, C itself in full.
  sight.information(2, 2) = 1 / (plain + corner);
  sight.plain_information(2, 2) = 1 / plain;
  sight.log_size = std::log(plain) + sight.blur_size;
}

/// C of a contact whose place in the world is measured as well.
void HoldFit::weigh_place(Sight& sight, const HeldContact& contact, const HeldErrors& errors, const TurnErrors& turn) {
  // An error a of the orientation moves the contact by a Q l and turns the tangent by a.
  const Eigen::Vector3d lever(-contact.lever.y(), contact.lever.x(), 1);
  Eigen::Matrix3d covariance = errors.angle * errors.angle * lever * lever.transpose();
  covariance(0, 0) += errors.place * errors.place;
  covariance(1, 1) += errors.place * errors.place;
  // n^2 / (2 rho) along the normal, rho being the finger's radius, whose mean is in `at`: its variance is half the
  // square of n's over rho.
  const Vec2 normal(-std::sin(contact.tangent), std::cos(contact.tangent));
  const double shorter = errors.travel * errors.travel * contact.finger_curvature;
  covariance.topLeftCorner<2, 2>() += 0.5 * shorter * shorter * normal * normal.transpose();
  if (turn.is_bent) {
    const Eigen::Matrix3d bare = covariance / turn.rows;
    sight.bare_information = bare.inverse();
    sight.bare_log_size = std::log(bare.determinant());
  }
  // n adds to the variance of t alone: it moves the contact and L alike, so that on the part it stays where it is.
  covariance(2, 2) += turn.bend * turn.bend;
  covariance /= turn.rows;
  sight.log_size = std::log(covariance.determinant()) + sight.blur_size;
  sight.plain_information = covariance.inverse();
  covariance(2, 2) += turn.corner;
  sight.information = covariance.inverse();
}

/// Of all fingers at a row. They depend on the first contacts and stretches alone, so that one set serves all poses
/// tried.
std::vector<HoldFit::Sight> HoldFit::sights_at(const HeldState& state, std::size_t row) const {
  std::vector<Sight> sights;
  sights.reserve(fingers());
  for (std::size_t k = 0; k < fingers(); ++k) {
    sights.push_back(sight(place_of(state, row, k), stretch_of(state, k), row, k));
  }
  return sights;
}

/// Eliminates n where the normal turns unevenly over it: t is taken as linear about the n that is most probable beside
/// the row's other measurements (errors in variables, docs/two_fingers.md, "How three fingers are searched").
void HoldFit::bend(Look& look, double finger_curvature) const {
  const Eigen::Matrix3d& bare = *look.bare_information;
  // What is left of the residuals if the contact is n ahead of s: the sign is opposite to that of the error in
  // contact_error.
  const auto left = [&](double n) {
    Eigen::Vector3d residual = look.residual;
    residual(2) -= turn_from(part_, look.s, n) + finger_curvature * n;
    return residual;
  };
  // Minus twice the logarithm of the probability of n beside the row's other measurements, but for a constant.
  const auto cost = [&](double n) {
    const Eigen::Vector3d residual = left(n);
    return residual.dot(bare * residual) + n * n / (look.error * look.error);
  };
  // Start from the best of seven values: the cost may have several minima where the boundary bends.
  double n = 0;
  double least = cost(0);
  for (const double times : {-3, -2, -1, 1, 2, 3}) {
    const double now = cost(times * look.error);
    if (now >= least) continue;
    least = now;
    n = times * look.error;
  }
  // Gauss-Newton steps, shortened while they lead uphill. `least` is the cost at n.
  for (int round = 0; round < kErrorRounds; ++round) {
    const double rate = curvature_at(part_, look.s + n) + finger_curvature;
    const double slope = rate * bare.row(2).dot(left(n)) - n / (look.error * look.error);
    double step = slope / (rate * rate * bare(2, 2) + 1 / (look.error * look.error));
    double now = cost(n + step);
    for (int shorter = 0; shorter < kErrorRounds && now > least; ++shorter) {
      step *= 0.3;
      now = cost(n + step);
    }
    if (now > least) break;
    const bool is_last = least - now < kErrorSettled;
    least = now;
    n += step;
    if (is_last) break;
  }
  // The tangent line of the turn at this n, taken back to n = 0: t stays linear in the place.
  const double curvature = curvature_at(part_, look.s + n);
  look.residual(2) -= turn_from(part_, look.s, n) - curvature * n;
  look.by_place(2) = -curvature;
  look.at.curvature = curvature;
  // C gains turn^2 at its last element; its inverse by Sherman and Morrison's formula.
  const double turn = (curvature + finger_curvature) * look.error;
  const double size = 1 + turn * turn * bare(2, 2);
  look.information = bare - turn * turn / size * bare.col(2) * bare.row(2);
  // det C is by the variance of the turn over all n, not by the turn at this n: else places would be likelier at which
  // n comes out on a flat side. The variance is by Gauss and Hermite's rule of three: n = 0 and +-sqrt(3) sd, with
  // weights 2/3, 1/6, 1/6.
  const double aside = std::numbers::sqrt3 * look.error;
  const double ahead = turn_from(part_, look.s, aside) + finger_curvature * aside;
  const double back = turn_from(part_, look.s, -aside) - finger_curvature * aside;
  const double variance = (ahead * ahead + back * back) / 6 - std::pow((ahead + back) / 6, 2);
  look.log_size = look.bare_log_size + std::log1p(variance * bare(2, 2));
}

/// A finger that pivots touches the corner, and is felt past it by n: along the finger, not along the side as p(s) is.
/// Both by how probable they are; what that leaves open is in C.
void HoldFit::pivot(Look& look, double finger_tangent, double side_tangent) {
  const Vec2 side(std::cos(side_tangent), std::sin(side_tangent));
  Eigen::Vector3d apart = Eigen::Vector3d::Zero();
  apart.head<2>() = Vec2(std::cos(finger_tangent), std::sin(finger_tangent)) - side;
  const double share = look.at.pivoting;
  look.residual -= share * look.at.past * apart;
  look.by_place -= share * apart;
  look.by_pose.topRightCorner<2, 1>() += share * look.at.past * Vec2(-side.y(), side.x());
  const double open = share * (1 - share) * look.at.past * look.at.past;
  // Sherman and Morrison's formula, and that of the determinant.
  const Eigen::Vector3d pull = look.information * apart;
  const double size = 1 + open * apart.dot(pull);
  look.information -= open / size * pull * pull.transpose();
  look.log_size += std::log(size);
}

/// An angle of little weight adds little to the square. It is charged what it would cost on the side that it fits, so
/// that no place is likelier because its rows say less; where it fits neither, what an angle costs on average.
void HoldFit::charge(Look& look, double off) {
  if (!look.at.has_corner) return;
  const double turned = off + look.at.angle;
  const double side = std::pow(turned - look.at.side, 2) / look.plain;
  const double other = std::pow(turned - look.at.other, 2) / look.plain;
  const double square = std::min(side, other);
  const double charged = (1 - look.angles) * (1 + (square - 1) * std::exp(-std::pow(square / kFitsSide, 2)));
  look.blur_size += charged;
  look.log_size += charged;
}

HoldFit::Look HoldFit::look(const HeldState& state, std::size_t row, std::size_t finger) const {
  const Sight seen = sight(place_of(state, row, finger), stretch_of(state, finger), row, finger);
  return look(seen, state.placed[row], row, finger);
}

/// r and t of one contact in this pose, with their derivatives by A, phi and s.
HoldFit::Look HoldFit::look(const Sight& sight, const Placed& placed, std::size_t row, std::size_t finger) const {
  const HeldContact& contact = rows_.rows[row].contacts[finger];
  Look look{sight};
  const double off = nearest_angle(contact.tangent - placed.heading - sight.at.angle);
  // Of a range of Theta only what is beyond it is a residual; inside it is 0 and has no slope.
  const double beyond = std::max(0.0, std::abs(off) - sight.at.half_turn);
  look.residual(2) = std::copysign(beyond, off);
  charge(look, off);
  if (beyond > 0 || sight.at.half_turn == 0) {
    look.by_pose(2, 2) = -1;
    look.by_place(2) = -sight.at.bend;
  }
  if (rows_.errors[finger].has_place) {
    const Pose turn{0, 0, placed.heading};
    const Vec2 arm = turn.turned(sight.point - middle_);
    // d = q - A - R(phi) (p - m), q with the arm that the radius has then.
    look.residual.head<2>() = contact.at + sight.stretch * by_stretch(row, finger) - placed.middle - arm;
    look.by_pose.topLeftCorner<2, 2>() = -Eigen::Matrix2d::Identity();
    look.by_pose.topRightCorner<2, 1>() = Vec2(arm.y(), -arm.x());
    look.by_place.head<2>() = -turn.turned(Vec2(std::cos(sight.at.side), std::sin(sight.at.side)));
  }
  // Where the normal turns unevenly over n.
  if (sight.bare_information) bend(look, contact.finger_curvature);
  if (sight.at.pivoting > 0 && rows_.errors[finger].has_place) {
    pivot(look, contact.tangent, placed.heading + sight.at.side);
  }
  // ds / de = -L at e = 0, of s = z + L / (1 + e).
  look.by_stretch = -contact.travelled * look.by_place;
  if (rows_.errors[finger].has_place) look.by_stretch.head<2>() += by_stretch(row, finger);
  return look;
}

/// The normal equations of one row, P first. `with_unknowns`: B and M as well.
HoldFit::RowEquations HoldFit::equations(const HeldState& state, std::size_t row, const std::vector<Sight>& sights,
                                         bool with_unknowns) const {
  RowEquations sum;
  const auto count = static_cast<Eigen::Index>(fingers());
  if (with_unknowns) {
    sum.mixed = RowBlock::Zero(3, size_);
    sum.own = UnknownsMatrix::Zero(size_, size_);
    sum.own_slope = Unknowns::Zero(size_);
  }
  for (std::size_t finger = 0; finger < fingers(); ++finger) {
    Look one = look(sights[finger], state.placed[row], row, finger);
    // In units of the errors: W = C^-1.
    const double square = one.residual.dot(one.information * one.residual);
    const Counted how = counted(one, square);
    // Robust: a measurement counts by the probability that it is no outlier.
    one.information *= how.right;
    const Eigen::Matrix3d weighed = one.by_pose.transpose() * one.information;
    sum.pose += weighed * one.by_pose;
    const bool is_blurred = rows_.has_noise && one.at.has_corner;
    sum.plain += is_blurred ? Eigen::Matrix3d(one.by_pose.transpose() * how.right * one.plain_information * one.by_pose)
                            : Eigen::Matrix3d(weighed * one.by_pose);
    sum.slope -= weighed * one.residual;
    sum.square += how.cost;
    sum.right_square += how.right * square;
    sum.strays += 1 - how.right;
    sum.log_size += one.log_size;
    sum.blur_size += one.blur_size;
    if (!with_unknowns) continue;
    const auto k = static_cast<Eigen::Index>(finger);
    // An unknown by the derivatives of the measurement by it.
    const auto add = [&](Eigen::Index unknown, const Eigen::Vector3d& by) {
      sum.mixed.col(unknown) += weighed * by;
      sum.own(unknown, unknown) += by.dot(one.information * by);
      sum.own_slope(unknown) -= by.dot(one.information * one.residual);
    };
    add(k, one.by_place);
    if (!has_stretches_) continue;
    add(count + k, one.by_stretch);
    const double both = one.by_place.dot(one.information * one.by_stretch);
    sum.own(k, count + k) += both;
    sum.own(count + k, k) += both;
  }
  const Eigen::Matrix3d of_fingers = sum.pose;
  for (std::size_t wheel = 0; wheel < wheels(); ++wheel) add_pin(state, row, wheel, with_unknowns, sum);
  if (row == 0 && rows_.pose) add_pose_prior(state.placed[row], sum);
  if (rows_.outlier_share > 0) {
    // Where all measurements of a row are outliers, P would be singular. The precision of a perimeter and a radian
    // shortens steps and moves no minimum.
    const double near = 1 / (part_.perimeter() * part_.perimeter());
    sum.pose.diagonal() += Eigen::Vector3d(near, near, 1);
  }
  // Without x and y the part's position is not determined: it stays where it is.
  if (!rows_.any_place) sum.pose(0, 0) = sum.pose(1, 1) = 1;
  // P stays invertible where the heading is not determined either.
  sum.pose(2, 2) += kRidge * sum.pose(2, 2) + 1e-30;
  sum.plain += sum.pose - of_fingers;
  return sum;
}

/// r in length, without x and y 0; t in radians.
ContactResidual HoldFit::residual(const HeldState& state, std::size_t row, std::size_t finger) const {
  const Look one = look(state, row, finger);
  return {one.residual.head<2>(), one.residual(2)};
}

/// n given t, both normal with mean 0: the conditional mean cov(n, t) t / var(t) and what is left of the variance.
/// Where kappa + kappa_finger = 0, t says nothing of n.
HoldFit::ContactError HoldFit::contact_error(const HeldState& state, std::size_t row, std::size_t finger) const {
  const Look one = look(state, row, finger);
  const HeldContact& contact = rows_.rows[row].contacts[finger];
  const double variance = rows_.errors[finger].travel * rows_.errors[finger].travel;
  const double bend = one.at.curvature + contact.finger_curvature;
  // t = a - (kappa + kappa_finger) n.
  const double total = one.turn_variance + bend * bend * variance;
  ContactError error;
  error.by_turn = -bend * variance / total;
  error.mean = error.by_turn * one.residual(2);
  error.variance = variance * one.turn_variance / total;
  const double right = counted(one, one.residual.dot(one.information * one.residual)).right;
  if (right < 1 && bend != 0) {
    // In an outlier the contact is wrong, n = -t / bend, or the orientation, n = 0. Both count as equally likely.
    const double half = 0.5 * one.residual(2) / bend;
    error.mean = right * error.mean - (1 - right) * half;
    error.variance += (1 - right) * half * half;
    error.by_turn *= right;
  }
  error.curvature = one.at.curvature;
  return error;
}

/// Degrees of freedom of chi-square. A squeeze counts as one number over all rows; a row's pose takes 3, without x
/// and y 1.
double HoldFit::freedom(const HeldState& state) const {
  double numbers = 0;
  for (std::size_t row = 0; row < rows_.rows.size(); ++row) {
    double of_row = 0;
    for (std::size_t k = 0; k < fingers(); ++k) {
      const Look one = look(state, row, k);
      const double right = counted(one, one.residual.dot(one.information * one.residual)).right;
      of_row += right * (one.angles + (rows_.errors[k].has_place ? 2 : 0));
    }
    for (const HeldWheel& wheel : rows_.wheels) {
      // Together over all rows 1: each is weighed with n times the variance.
      const double of_line = wheel.line ? rows_.rows[row].weight / wheel.line_alike : 0;
      of_row += 1 + (wheel.spin ? 1 : 0) + of_line;
    }
    of_row -= rows_.any_place ? 3 : 1;
    // A row of outliers can't take more than it has.
    numbers += rows_.outlier_share > 0 ? std::max(0.0, of_row) : of_row;
  }
  for (const HeldWheel& wheel : rows_.wheels) numbers -= wheel.spin ? 1 : 0;
  return numbers - static_cast<double>(fingers());
}

}  // namespace rollfix::hold
