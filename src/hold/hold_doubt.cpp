#include <algorithm>
#include <cmath>
#include <numbers>

#include "contact_look.hpp"
#include "hold_equations.hpp"
#include "outline/turn.hpp"

// Notation as in hold_fit.cpp:
//   q, d            a measurement's square and how many numbers it is; C: their covariance
//   e, U            share of outliers; how dense they are, being anything
//   w               probability that a measurement is none: it counts w q in the normal equations
// A measurement is one finger's at one row: p = (1 - e) N(q; C) + e U, so that -2 log p replaces q. The slope of that
// is w dq: weights by what is seen, computed anew in each round (Beaton and Tukey 1974). Priors are squares like
// others.
namespace rollfix::hold {

HoldFit::Counted HoldFit::counted(const Look& look, double square) const {
  if (rows_.outlier_share <= 0) return {square, 1};
  constexpr double kAround = 2 * std::numbers::pi;
  const bool has_place = look.information(0, 0) > 0;
  const double numbers = has_place ? 3 : 1;
  const double perimeter = part_.perimeter();
  const double uniform = (has_place ? 1 / (perimeter * perimeter) : 1) / kAround;
  // log of e U / ((1 - e) N(0; C)).
  const double stray = std::log(rows_.outlier_share / (1 - rows_.outlier_share) * uniform) +
                       0.5 * (numbers * std::log(kAround) + look.log_size);
  const double more = std::max(stray, -0.5 * square);
  const double sum = more + std::log(std::exp(stray - more) + std::exp(-0.5 * square - more));
  return {-2 * sum, std::exp(-0.5 * square - sum)};
}

/// A pose that all measurements of a row agree on may be by outliers: the best one from each finger's own.
HoldFit::RowEquations HoldFit::settled_by_fewer(HeldState& state, std::size_t row, const RowEquations& all) const {
  RowEquations best = all;
  Placed kept = state.placed[row];
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
    if (!(own.square < best.square)) continue;
    best = own;
    kept = placed;
  }
  state.placed[row] = kept;
  return best;
}

/// Of the first finger's first contact from where it was said to be.
double HoldFit::prior_offset(const HeldState& state) const {
  return part_.boundary().offset(rows_.prior->s, state.unknowns(0));
}

/// Of x and y only where they are evidence.
void HoldFit::add_pose_prior(const Placed& placed, RowEquations& sum) const {
  const PosePrior& prior = *rows_.pose;
  const Vec2 arm = Pose{0, 0, placed.heading}.turned(middle_);
  Eigen::Vector3d off;
  off << placed.middle - arm - Vec2(prior.mean.x, prior.mean.y), nearest_angle(placed.heading - prior.mean.heading);
  Eigen::Matrix3d by_pose = Eigen::Matrix3d::Identity();
  by_pose.topRightCorner<2, 1>() = Vec2(arm.y(), -arm.x());
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

}  // namespace rollfix::hold
