#include "hold_fit.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "contact_look.hpp"
#include "hold_equations.hpp"
#include "outline/turn.hpp"
#include "rollfix/pulse.hpp"

// Notation, as in docs/two_fingers.md, "Three and more fingers":
//   z_i, e_i        first contact of finger i, and the stretch of its lengths: `unknowns`
//   s = z + L / (1 + e)   where the contact is at a row: `place_of`
//   (A, phi)        the part at a row: world(p) = A + R(phi) (p - m): `Placed`; m: `middle_`
//   d, r            residuals q - world(p(s)) and tau - phi - Theta(s): ContactResidual
//   C               their covariance: position, the orientation by its lever w, and the contact's error n, which moves
//                   the normal by (kappa + kappa_finger) n and nothing else
//   P, B, M         blocks of the normal matrix: of a row's pose, of pose and unknowns, of the unknowns; M - B^T P^-1 B
//                   is what is left: `Reduced`
// Follows K. Levenberg (1944), with a pose of its own for each row eliminated (Schur's complement).
namespace rollfix::hold {
namespace {

constexpr int kMostFitRounds = 40;
constexpr double kMostFitDamping = 1e10;
constexpr double kFitSettled = 1e-9;  // a step that gains no more than this share, and this much, is the last
constexpr int kPoseRounds = 12;       // of one row's pose alone
constexpr double kPoseSettled = 1e-8;
constexpr double kLeastShare = 1e-3;  // of a step of it
constexpr int kWorstRounds = 25;      // of weighting up what is worst (Lawson's method)

}  // namespace

HoldFit::HoldFit(const Part& part, const HeldRows& rows) : part_(part), rows_(rows) {
  const bool any_stretch =
      std::any_of(rows.errors.begin(), rows.errors.end(), [](const HeldErrors& errors) { return errors.stretch > 0; });
  const auto count = static_cast<Eigen::Index>(rows.fingers());
  size_ = rows.has_noise && any_stretch ? 2 * count : count;
  constexpr int kPoints = 64;
  for (int k = 0; k < kPoints; ++k) middle_ += part.point(part.perimeter() * (k + 0.5) / kPoints) / kPoints;
}

double HoldFit::prior_precision(std::size_t finger) const {
  const double sd = rows_.errors[finger].stretch;
  return sd > 0 ? 1 / (sd * sd) : 1e12;
}

double HoldFit::place_of(const HeldState& state, std::size_t row, std::size_t finger) const {
  const auto k = static_cast<Eigen::Index>(finger);
  const double stretch =
      size_ > static_cast<Eigen::Index>(fingers()) ? state.unknowns(static_cast<Eigen::Index>(fingers()) + k) : 0;
  return state.unknowns(k) + rows_.rows[row].contacts[finger].travelled / (1 + stretch);
}

/// A pose that suits the contacts about: by the longest chord between them, or else by their normals.
void HoldFit::guess(HeldState& state, std::size_t row) const {
  const HeldRow& now = rows_.rows[row];
  Placed& placed = state.placed[row];
  Vec2 sum = Vec2::Zero();
  std::vector<Vec2> points;
  for (std::size_t k = 0; k < fingers(); ++k) {
    const double blur = std::max(rows_.errors[k].travel, kLeastBlur * part_.perimeter());
    const BlurredPlace at = blurred(part_, place_of(state, row, k), blur, pivot_length(now.contacts[k]));
    points.push_back(at.point);
    const double heading = now.contacts[k].tangent - at.angle;
    const double sd = std::hypot(rows_.errors[k].angle, blur * now.contacts[k].finger_curvature);
    sum += Vec2(std::cos(heading), std::sin(heading)) / (sd * sd + at.variance);
  }
  placed.heading = std::atan2(sum.y(), sum.x());
  double longest = 0;
  for (std::size_t i = 0; i < fingers(); ++i) {
    for (std::size_t j = i + 1; j < fingers(); ++j) {
      const Vec2 chord = now.contacts[j].at - now.contacts[i].at;
      if (!rows_.errors[i].has_place || !rows_.errors[j].has_place || chord.norm() <= longest) continue;
      longest = chord.norm();
      placed.heading = angle_between(points[j] - points[i], chord);
    }
  }
  const Pose turn{0, 0, placed.heading};
  double count = 0;
  placed.middle = Vec2::Zero();
  for (std::size_t k = 0; k < fingers(); ++k) {
    if (!rows_.errors[k].has_place) continue;
    placed.middle += now.contacts[k].at - turn.turned(points[k] - middle_);
    count += 1;
  }
  if (count > 0) placed.middle /= count;
  placed.is_known = true;
}

/// Puts the part where a finger's centre is that is no evidence.
void HoldFit::refer(HeldState& state, std::size_t row) const {
  const Pose turn{0, 0, state.placed[row].heading};
  const Boundary boundary = part_.boundary();
  const double s = place_of(state, row, *rows_.reference);
  const Vec2 point = part_.point(boundary.closed ? s : std::clamp(s, 0.0, boundary.perimeter));
  state.placed[row].middle = rows_.rows[row].contacts[*rows_.reference].at - turn.turned(point - middle_);
}

/// The best pose of one row for the unknowns, from where it is: Newton's steps, shorter where they go too far.
HoldFit::RowEquations HoldFit::settled(HeldState& state, std::size_t row) const {
  RowEquations now = equations(state, row, false);
  double share = 1;
  for (int round = 0; round < kPoseRounds; ++round) {
    const Eigen::Vector3d step = share * now.pose.ldlt().solve(now.slope);
    if (!step.allFinite()) break;
    const Placed before = state.placed[row];
    state.placed[row].middle += step.head<2>();
    state.placed[row].heading += step(2);
    const RowEquations next = equations(state, row, false);
    if (next.square > now.square) {
      state.placed[row] = before;
      share *= 0.25;
      if (share < kLeastShare) break;
      continue;
    }
    const bool is_last = now.square - next.square <= kPoseSettled * (1 + next.square);
    now = next;
    share = 1;
    if (is_last) break;
  }
  return now;
}

/// The best poses for the unknowns, from where they are.
void HoldFit::settle(HeldState& state) const {
  state.square = state.cost = 0;
  for (std::size_t row = 0; row < rows_.rows.size(); ++row) {
    if (!state.placed[row].is_known) guess(state, row);
    const RowEquations now = settled(state, row);
    state.square += now.square;
    state.cost += now.square + now.blur_size;
    if (rows_.reference) refer(state, row);
  }
  if (size_ == static_cast<Eigen::Index>(fingers())) return;
  for (std::size_t k = 0; k < fingers(); ++k) {
    const double stretch = state.unknowns(static_cast<Eigen::Index>(fingers() + k));
    state.square += stretch * stretch * prior_precision(k);
    state.cost += stretch * stretch * prior_precision(k);
  }
}

HeldState HoldFit::at(const std::vector<double>& first_contacts) const {
  Unknowns unknowns = Unknowns::Zero(size_);
  for (std::size_t k = 0; k < fingers(); ++k) unknowns(static_cast<Eigen::Index>(k)) = first_contacts[k];
  return at(unknowns, std::vector<Placed>(rows_.rows.size()));
}

HeldState HoldFit::at(const Unknowns& unknowns, const std::vector<Placed>& near) const {
  HeldState state;
  state.unknowns = unknowns;
  state.placed = near;
  settle(state);
  return state;
}

Reduced HoldFit::reduced(const HeldState& state) const {
  Reduced sum;
  sum.matrix = UnknownsMatrix::Zero(size_, size_);
  sum.slope = Unknowns::Zero(size_);
  for (std::size_t row = 0; row < rows_.rows.size(); ++row) {
    const RowEquations one = equations(state, row, true);
    const Eigen::LDLT<Eigen::Matrix3d> pose(one.pose);
    const RowBlock share = pose.solve(one.mixed);
    sum.matrix += one.own - UnknownsMatrix(one.mixed.transpose() * share);
    sum.slope += one.own_slope - Unknowns(share.transpose() * one.slope);
    sum.log_volume -= 0.5 * (one.log_size + pose.vectorD().array().abs().log().sum());
  }
  for (auto k = static_cast<Eigen::Index>(fingers()); k < size_; ++k) {
    const double precision = prior_precision(static_cast<std::size_t>(k) - fingers());
    sum.matrix(k, k) += precision;
    sum.slope(k) -= precision * state.unknowns(k);
  }
  return sum;
}

HeldState HoldFit::fit(HeldState state, std::optional<Eigen::Index> held) const {
  double damping = 1e-4;
  for (int round = 0; round < kMostFitRounds; ++round) {
    beat();
    Reduced now = reduced(state);
    if (held) {
      now.matrix.row(*held).setZero();
      now.matrix.col(*held).setZero();
      now.matrix(*held, *held) = 1;
      now.slope(*held) = 0;
    }
    const double trace = now.matrix.diagonal().maxCoeff();
    bool is_better = false;
    double gain = 0;
    while (damping < kMostFitDamping && !is_better) {
      UnknownsMatrix damped = now.matrix;
      damped.diagonal() += damping * now.matrix.diagonal() +
                           Unknowns::Constant(size_, 1e-14 * trace + std::numeric_limits<double>::min());
      const Unknowns step = damped.ldlt().solve(now.slope);
      if (!step.allFinite()) break;
      HeldState next = at(Unknowns(state.unknowns + step), state.placed);
      gain = state.cost - next.cost;
      is_better = gain >= 0;
      if (is_better) {
        state = std::move(next);
        damping = std::max(damping * 0.1, 1e-12);
      } else {
        damping *= 10;
      }
    }
    if (!is_better || gain <= kFitSettled * (1 + std::abs(state.cost))) break;
  }
  return state;
}

double HoldFit::worst(const HeldState& state) const {
  double most = 0;
  for (std::size_t row = 0; row < rows_.rows.size(); ++row) {
    for (std::size_t k = 0; k < fingers(); ++k) {
      const ContactResidual off = residual(state, row, k);
      if (rows_.errors[k].has_place) most = std::max(most, off.place.norm() / rows_.errors[k].place);
      most = std::max(most, std::abs(off.turn) / rows_.errors[k].angle);
    }
  }
  return most;
}

HeldState HoldFit::best_worst(HeldState from) {
  HeldState best = fit(std::move(from));
  double least = worst(best);
  weights_.assign(rows_.rows.size() * fingers(), 1.0);
  HeldState state = best;
  for (int round = 0; round < kWorstRounds && least > 1; ++round) {
    const double most = worst(state);
    double sum = 0;
    for (std::size_t row = 0; row < rows_.rows.size(); ++row) {
      for (std::size_t k = 0; k < fingers(); ++k) {
        const ContactResidual off = residual(state, row, k);
        const double place = rows_.errors[k].has_place ? off.place.norm() / rows_.errors[k].place : 0;
        const double turn = std::abs(off.turn) / rows_.errors[k].angle;
        double& weight = weights_[row * fingers() + k];
        weight *= 1e-6 + std::max(place, turn) / most;
        sum += weight;
      }
    }
    for (double& weight : weights_) weight *= static_cast<double>(weights_.size()) / sum;
    settle(state);
    state = fit(std::move(state));
    if (worst(state) >= least) continue;
    least = worst(state);
    best = state;
  }
  weights_.clear();
  settle(best);
  return best;
}

PoseAtRow HoldFit::pose_at(const HeldState& state, std::size_t row) const {
  const RowEquations one = equations(state, row, true);
  const Eigen::Matrix3d covariance = one.pose.inverse();
  const Placed& placed = state.placed[row];
  PoseAtRow result;
  result.pose = {0, 0, placed.heading};
  const Vec2 arm = result.pose.turned(middle_);
  result.pose.x = placed.middle.x() - arm.x();
  result.pose.y = placed.middle.y() - arm.y();
  // From the middle to the origin of the part's frame.
  Eigen::Matrix3d to_origin = Eigen::Matrix3d::Identity();
  to_origin.topRightCorner<2, 1>() = Vec2(arm.y(), -arm.x());
  result.covariance = to_origin * covariance * to_origin.transpose();
  result.by_unknowns = -to_origin * covariance * one.mixed;
  return result;
}

}  // namespace rollfix::hold
