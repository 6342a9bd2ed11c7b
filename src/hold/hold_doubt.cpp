#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "belief/posterior.hpp"
#include "hold_fit.hpp"
#include "outline/turn.hpp"

// Notation as in hold_fit.cpp:
//   q, d            a measurement's square and how many numbers it is; C: their covariance
//   eps, U          share of outliers; how dense they are, being anything
//   w               probability that a measurement is none: it counts w q in the normal equations
//   A, W, r         a measurement's derivatives by its row's pose, C^-1 and residual; P = sum of A^T W A over the row
//   e               how far contacts move in some way along the boundary; g, H: slope and matrix of unknowns u and e
// A measurement is one finger's at one row: p = (1 - eps) N(q; C) + eps U, so that -2 log p replaces q. The slope of
// that is w dq: weights by what is seen, computed anew in each round (Beaton and Tukey 1974). Priors are squares like
// others.
// Idea: one bad measurement, a wrong radius or a slip is lost in the sum of all squares. Each is looked at by what the
// squares would lose if it were free (Rao's score test): a measurement by (W r)^T (W - W A P^-1 A^T W)^-1 (W r),
// contacts that move by g_e^2 / (H_ee - H_eu H_uu^-1 H_ue), and the best of these by a fit. The best of n is n times as
// probable by chance (Bonferroni).
namespace rollfix::hold {
namespace {

// Where corners are in reach by this share of an angle's variance, it is off rarely and far: no normal number.
constexpr double kCornerShare = 1e-3;
// A measurement of which the rest of its row leaves less than this share of the information can't be tested.
constexpr double kTold = 1e-6;
// Where a normal error is four standard deviations off its square is 10.6 of its own: (10.6 / 4)^2 times its variance,
// of which one is counted already.
constexpr double kArmTail = 6;
// Rows, evenly spread, before which each finger may have slipped.
constexpr std::size_t kSlipPlaces = 16;

/// Squares that rounding made less than 0 are 0.
double p_of(double square, double freedom) { return belief::p_of_chi_square(std::max(0.0, square), freedom); }

}  // namespace

HoldFit::Counted HoldFit::counted(const Look& look, double square) const {
  if (rows_.outlier_share <= 0) return {square, 1};
  constexpr double kAround = 2 * std::numbers::pi;
  const bool has_place = look.information(0, 0) > 0;
  const double numbers = has_place ? 3 : 1;
  const double perimeter = part_.perimeter();
  // U: an angle anywhere in a full turn, a place anywhere in a square of the perimeter's side.
  const double uniform = (has_place ? 1 / (perimeter * perimeter) : 1) / kAround;
  // log of e U / ((1 - e) N(0; C)).
  const double stray = std::log(rows_.outlier_share / (1 - rows_.outlier_share) * uniform) +
                       0.5 * (numbers * std::log(kAround) + look.log_size);
  // log(e^(-q / 2) + e^stray) without overflow.
  const double more = std::max(stray, -0.5 * square);
  const double sum = more + std::log(std::exp(stray - more) + std::exp(-0.5 * square - more));
  // For small q about q; for large q it stays at -2 stray: an outlier costs no more, however far off it is.
  return {-2 * sum, std::exp(-0.5 * square - sum)};
}

/// The row's best pose of those reached from each finger's own measurement. One reached from all measurements may lie
/// between right ones and outliers. `all`: the equations at the state's pose, which stays if none is better.
HoldFit::RowEquations HoldFit::settled_by_fewer(HeldState& state, std::size_t row, const RowEquations& all) const {
  RowEquations best = all;
  Placed kept = state.placed[row];
  // Each finger in turn is taken to be right: its normal gives the heading, its place the position.
  for (std::size_t k = 0; k < fingers(); ++k) {
    const HeldContact& contact = rows_.rows[row].contacts[k];
    const double blur = std::max(rows_.errors[k].travel, kLeastBlur * part_.perimeter());
    const double s = place_of(state, row, k);
    const BlurredPlace at = blurred(part_, s, blur, pivot_length(contact));
    Placed& placed = state.placed[row];
    placed = kept;
    placed.heading = contact.tangent - at.angle;
    if (rows_.errors[k].has_place) {
      placed.middle = contact.at - Pose{0, 0, placed.heading}.turned(point_about(part_, s) - middle_);
    }
    const RowEquations own = settled(state, row);
    // `square` holds the robust costs, so that a pose that suits more measurements wins.
    if (!(own.square < best.square)) continue;
    best = own;
    kept = placed;
  }
  state.placed[row] = kept;
  return best;
}

/// How far the first finger's first contact is from where it was said to be, the shorter way round, length.
double HoldFit::prior_offset(const HeldState& state) const {
  return part_.boundary().offset(rows_.prior->s, state.unknowns(0));
}

/// Adds what was known of the first row's pose. Its x and y count only where the fingers' are evidence.
void HoldFit::add_pose_prior(const Placed& placed, RowEquations& sum) const {
  const PosePrior& prior = *rows_.pose;
  const Vec2 arm = Pose{0, 0, placed.heading}.turned(middle_);
  Eigen::Vector3d off;
  // By the origin of the part's frame, A - R(phi) m, and the heading.
  off << placed.middle - arm - Vec2(prior.mean.x, prior.mean.y), nearest_angle(placed.heading - prior.mean.heading);
  Eigen::Matrix3d by_pose = Eigen::Matrix3d::Identity();
  // d(-R m) / dphi = -J R m.
  by_pose.topRightCorner<2, 1>() = Vec2(arm.y(), -arm.x());
  // Without x and y the position is not determined by anything else.
  const bool has_place = rows_.any_place && std::isfinite(prior.place_sd);
  const double place = has_place ? 1 / (prior.place_sd * prior.place_sd) : 0;
  const Eigen::Vector3d precision(place, place, 1 / (prior.heading_sd * prior.heading_sd));
  const Eigen::Matrix3d weighed = by_pose.transpose() * precision.asDiagonal();
  const double square = off.dot(precision.cwiseProduct(off));
  sum.pose += weighed * by_pose;
  sum.slope -= weighed * off;
  sum.square += square;
  sum.prior_square += square;
}

/// Probability of a measurement as far off as this from where all others of its row have it: the score test of
/// freeing it. 1 where corners or a lack of other measurements leave nothing to test.
double HoldFit::p_of_measurement(const HeldState& state, std::size_t row, std::size_t finger,
                                 const Eigen::Matrix3d& pose_covariance) const {
  const Look one = look(state, row, finger);
  if (one.blur_size > kCornerShare) return 1;
  const Eigen::Matrix3d shared = one.information * one.by_pose;
  // W - W A P^-1 A^T W is the covariance of `pull` = W r, the pose being fitted with this measurement.
  Eigen::Matrix3d left = one.information - shared * pose_covariance * shared.transpose();
  // What the arm is short of, n^2 / (2 r), is the square of a normal error.
  const HeldContact& contact = rows_.rows[row].contacts[finger];
  const double shorter = one.error * one.error * contact.finger_curvature;
  const Eigen::Vector3d arm =
      one.information.leftCols<2>() * Vec2(-std::sin(contact.tangent), std::cos(contact.tangent)) * shorter;
  left += 0.5 * kArmTail * arm * arm.transpose();
  const Eigen::Vector3d pull = one.information * one.residual;
  if (!rows_.errors[finger].has_place) {
    const bool is_told = left(2, 2) > kTold * one.information(2, 2);
    return is_told ? p_of(pull(2) * pull(2) / left(2, 2), 1) : 1;
  }
  const bool is_told = left.determinant() > kTold * one.information.determinant();
  return is_told ? p_of(pull.dot(left.inverse() * pull), 3) : 1;
}

double HoldFit::p_of_worst_measurement(const HeldState& state) const {
  double least = 1;
  for (std::size_t row = 0; row < rows_.rows.size(); ++row) {
    const Eigen::Matrix3d pose_covariance = equations(state, row, sights_at(state, row), false).pose.inverse();
    for (std::size_t k = 0; k < fingers(); ++k) {
      least = std::min(least, p_of_measurement(state, row, k, pose_covariance));
    }
  }
  // Bonferroni: the least of n probabilities, times n.
  return std::min(1.0, least * static_cast<double>(rows_.rows.size() * fingers()));
}

/// Of each row M - B^T P^-1 B and its slope, as in `reduced`, but not summed.
std::vector<HoldFit::RowShare> HoldFit::row_shares(const HeldState& state) const {
  std::vector<RowShare> shares;
  for (std::size_t row = 0; row < rows_.rows.size(); ++row) {
    const RowEquations one = equations(state, row, sights_at(state, row), true);
    const RowBlock by_pose = one.pose.ldlt().solve(one.mixed);
    shares.push_back({one.own - UnknownsMatrix(one.mixed.transpose() * by_pose),
                      one.own_slope - Unknowns(by_pose.transpose() * one.slope)});
  }
  return shares;
}

/// The way of moving contacts that would lower the squares most, by the normal equations: gain g^2 / (H_ee - H_eu
/// H_uu^-1 H_ue), by = g / the same. Ways that the unknowns can make up for are left out.
HoldFit::Moved HoldFit::best_moved(const std::vector<Way>& ways, const HeldState& state) const {
  const std::vector<RowShare> shares = row_shares(state);
  const Eigen::LDLT<UnknownsMatrix> all(reduced(state).matrix);
  Moved best;
  double most = 0;
  for (const Way& way : ways) {
    double slope = 0, matrix = 0;
    Unknowns mixed = Unknowns::Zero(size_);
    for (std::size_t row = 0; row < shares.size(); ++row) {
      Unknowns by = Unknowns::Zero(size_);
      // A move of the contact acts as a change of its first contact at this row alone.
      for (std::size_t k = 0; k < fingers(); ++k) by(static_cast<Eigen::Index>(k)) = way(row, k);
      const Unknowns share = shares[row].matrix * by;
      slope += by.dot(shares[row].slope);
      matrix += by.dot(share);
      mixed += share;
    }
    // What the first contacts and stretches can't make up for.
    const double left = matrix - mixed.dot(all.solve(mixed));
    if (!(left > kTold * matrix) || slope * slope <= most * left) continue;
    most = slope * slope / left;
    best = {&way, slope / left};
  }
  return best;
}

/// Probability of a gain as large as that of the best way. The gain is that of a new fit, not of the normal equations:
/// where a place is known badly the squares are far from quadratic. One more number is fitted: chi-square of one.
double HoldFit::p_of_moved(const std::vector<Way>& ways, const HeldState& state) const {
  const Moved moved = best_moved(ways, state);
  if (moved.way == nullptr) return 1;
  HeldRows rows = rows_;
  for (std::size_t row = 0; row < rows.rows.size(); ++row) {
    for (std::size_t k = 0; k < fingers(); ++k) rows.rows[row].contacts[k].travelled += moved.by * (*moved.way)(row, k);
  }
  // The same rows with contacts moved by the estimate, fitted anew from the state.
  const HeldState without = HoldFit(part_, rows, wheels_).fit(state);
  // By the cost: where contacts move towards a corner, angles weigh less and the squares fall for nothing.
  return std::min(1.0, p_of(state.cost - without.cost, 1) * static_cast<double>(ways.size()));
}

/// Lengths of all fingers, or of one, off by one factor: contacts move by shares of what they travelled.
double HoldFit::p_of_lengths(const HeldState& state) const {
  const auto travelled = [&](std::size_t row, std::size_t k) { return rows_.rows[row].contacts[k].travelled; };
  std::vector<Way> ways{travelled};
  for (std::size_t k = 0; k < fingers(); ++k) {
    ways.emplace_back([&, k](std::size_t row, std::size_t other) { return other == k ? travelled(row, k) : 0; });
  }
  return p_of_moved(ways, state);
}

/// One finger's contact off by one length from some row on.
double HoldFit::p_of_slip(const HeldState& state) const {
  std::vector<Way> ways;
  for (std::size_t k = 0; k < fingers(); ++k) {
    for (std::size_t j = 1; j <= kSlipPlaces; ++j) {
      const std::size_t from = j * rows_.rows.size() / (kSlipPlaces + 1);
      ways.emplace_back([k, from](std::size_t row, std::size_t other) { return other == k && row >= from ? 1 : 0; });
    }
  }
  return p_of_moved(ways, state);
}

/// The least of the three. Each is already multiplied by how many like it were tested.
double HoldFit::p_of_oddest(const HeldState& state) const {
  if (rows_.outlier_share > 0 || wheels() > 0) return 1;
  return std::min({p_of_worst_measurement(state), p_of_lengths(state), p_of_slip(state)});
}

}  // namespace rollfix::hold
