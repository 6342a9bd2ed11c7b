#include "pose_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "outline/turn.hpp"
#include "roll_belief.hpp"
#include "rollfix/pulse.hpp"

// Notation:
//   (X, phi)        the pose of the part: `Pose`, moved by steps about `about_`
//   q_i, tau_i      a touch's measured centre, and tangent where a normal was measured: `Measured`
//   c(u), theta(u)  centre and tangent's angle at a contact's place u_i: CentrePoint
//   r_i             residuals (q - X - R(phi) c(u)) / `place_unit` and (tau - theta(u) - phi) / `angle_unit`
//   J, v            derivatives of r_i by the pose and by u_i: `by_pose`, `by_place`
//   M               J^T J - J^T v v^T J / v^T v, a touch's share of the normal matrix with u_i eliminated; where u_i
//                   can't move, held or at a corner or an end (`is_pinned`), J^T J alone
// Follows docs/touch.md, "How it works"; K. Levenberg, "A method for the solution of certain non-linear problems in
// least squares" (1944).
// Idea: least squares over three unknowns only, because each contact is kept at its nearest place. Downhill steps of
// places can stop at a wrong one: after each descent every touch looks whether it is nearer elsewhere (`jump_nearer`).
namespace rollfix::touch {
namespace {

constexpr int kMostRounds = 60;        // of Levenberg's method
constexpr double kMostDamping = 1e12;  // beyond, no step helps
// A step that makes the squares smaller by no more than this share, and this much, is the last.
constexpr double kSettled = 1e-8;
// How often a touch may turn out to be nearer elsewhere.
constexpr int kMostJumps = 4;
// Where a nearest place is free to move, the slope there is less, in standard deviations.
constexpr double kNoSlope = 1e-4;
// A heading is somewhere on the circle, even where no touch tells where: this many radians, as a standard deviation.
constexpr double kAnyHeading = std::numbers::pi;

/// What the residuals of a held place are by the pose and by u: columns of a 3 by 4 matrix.
struct Rows {
  Eigen::Matrix3d by_pose = Eigen::Matrix3d::Zero();
  Eigen::Vector3d by_place = Eigen::Vector3d::Zero();
  Eigen::Vector3d residual = Eigen::Vector3d::Zero();
};

}  // namespace

struct PoseFit::State {
  Pose pose;
  std::vector<PathPlace> places;
  double square = 0;
};

PoseFit::PoseFit(const std::vector<Measured>& touches, const std::optional<PosePrior>& prior)
    : touches_(touches), prior_(prior) {
  double places = 0;
  for (const Measured& touch : touches) places += touch.has_place ? 1 : 0;
  for (const Measured& touch : touches) {
    if (touch.has_place) about_ += touch.at / places;
  }
}

Pose PoseFit::pose_at(const Held& held, double heading) const {
  if (const RollBelief* roll = touches_[held.touch].roll) return roll->pose_at(roll->at(held.place));
  Pose pose{0, 0, heading};
  const Vec2 place = touches_[held.touch].at - pose.turned(path(held.touch).at(held.place).centre);
  return {place.x(), place.y(), heading};
}

InPart PoseFit::in_part(const Pose& pose, std::size_t touch) const {
  const Measured& one = touches_[touch];
  const Pose back{0, 0, -pose.heading};
  InPart result;
  result.at = back.turned(one.at - Vec2(pose.x, pose.y));
  if (one.tangent) result.tangent = *one.tangent - pose.heading;
  result.has_place = one.has_place;
  result.place_unit = one.place_unit;
  result.angle_unit = one.angle_unit;
  return result;
}

namespace {

Rows rows_of(const Measured& touch, const Pose& pose, const CentrePoint& point, const Vec2& about) {
  const Vec2 centre = Vec2(pose.x, pose.y) + pose.turned(point.centre);
  Rows rows;
  if (touch.has_place) {
    rows.residual.head<2>() = (touch.at - centre) / touch.place_unit;
    rows.by_pose.topLeftCorner<2, 2>() = -Eigen::Matrix2d::Identity() / touch.place_unit;
    rows.by_pose.topRightCorner<2, 1>() = -turned_left(centre - about) / touch.place_unit;
    rows.by_place.head<2>() = -pose.turned(point.along) / touch.place_unit;
  }
  if (!touch.tangent) return rows;
  rows.residual(2) = nearest_angle(*touch.tangent - point.angle - pose.heading) / touch.angle_unit;
  rows.by_pose(2, 2) = -1 / touch.angle_unit;
  rows.by_place(2) = -point.bend / touch.angle_unit;
  return rows;
}

}  // namespace

bool PoseFit::is_pinned(const Pose& pose, std::size_t touch, const PathPlace& place) const {
  if (touches_[touch].roll != nullptr) return false;
  const CentreStretch& stretch = path(touch).stretches()[place.stretch];
  const Distance distance = distance_at(path(touch).at(place), in_part(pose, touch));
  if (distance.weight == 0) return true;
  const bool is_end = place.u <= stretch.u.lo || place.u >= stretch.u.hi;
  // Past the end it would go on: a place in the middle of a smooth boundary has no slope.
  return is_end && std::abs(distance.slope) > kNoSlope * std::sqrt(distance.weight);
}

Normals PoseFit::normals_at(const Pose& pose, std::size_t touch, const CentrePoint& point) const {
  const Rows rows = rows_of(touches_[touch], pose, point, about_);
  Normals normals;
  normals.matrix = rows.by_pose.transpose() * rows.by_pose;
  normals.slope = -rows.by_pose.transpose() * rows.residual;
  return normals;
}

PathPlace PoseFit::nearest_to(const Pose& pose, std::size_t touch) const {
  const RollBelief* roll = touches_[touch].roll;
  return roll != nullptr ? roll->nearest(pose).place : nearest_place(tree(touch), in_part(pose, touch));
}

PathPlace PoseFit::downhill_from(const PathPlace& place, const Pose& pose, std::size_t touch) const {
  const RollBelief* roll = touches_[touch].roll;
  return roll != nullptr ? roll->downhill(pose, roll->at(place)).place
                         : downhill(path(touch), in_part(pose, touch), place);
}

double PoseFit::square_at(const Pose& pose, std::size_t touch, const PathPlace& place, bool is_held) const {
  if (const RollBelief* roll = touches_[touch].roll) return roll->square(pose, roll->at(place), !is_held);
  return distance_at(path(touch).at(place), in_part(pose, touch)).square;
}

Normals PoseFit::held_normals(const Pose& pose, std::size_t touch, const PathPlace& place) const {
  if (const RollBelief* roll = touches_[touch].roll) return roll->normals(pose, roll->at(place), about_, false);
  return normals_at(pose, touch, path(touch).at(place));
}

Normals PoseFit::free_normals(const Pose& pose, std::size_t touch, const PathPlace& place) const {
  if (const RollBelief* roll = touches_[touch].roll) return roll->normals(pose, roll->at(place), about_, true);
  if (is_pinned(pose, touch, place)) return held_normals(pose, touch, place);
  const Rows rows = rows_of(touches_[touch], pose, path(touch).at(place), about_);
  Normals normals;
  const Eigen::Vector3d mixed = rows.by_pose.transpose() * rows.by_place;
  normals.matrix = rows.by_pose.transpose() * rows.by_pose - mixed * mixed.transpose() / rows.by_place.squaredNorm();
  normals.slope = -rows.by_pose.transpose() * rows.residual;
  return normals;
}

Normals PoseFit::prior_normals(const Pose& pose) const {
  Normals normals;
  normals.matrix(2, 2) = 1 / (kAnyHeading * kAnyHeading);
  if (!prior_) return normals;
  const double heading = 1 / (prior_->heading_sd * prior_->heading_sd);
  normals.matrix(2, 2) += heading;
  normals.slope(2) = heading * nearest_angle(prior_->mean.heading - pose.heading);
  if (!std::isfinite(prior_->place_sd)) return normals;
  Eigen::Matrix<double, 2, 3> by_pose;
  by_pose << Eigen::Matrix2d::Identity(), turned_left(Vec2(pose.x, pose.y) - about_);
  const Vec2 off(prior_->mean.x - pose.x, prior_->mean.y - pose.y);
  const double place = 1 / (prior_->place_sd * prior_->place_sd);
  normals.matrix += place * by_pose.transpose() * by_pose;
  normals.slope += place * by_pose.transpose() * off;
  return normals;
}

double PoseFit::prior_square(const Pose& pose) const {
  if (!prior_) return 0;
  const double heading = nearest_angle(prior_->mean.heading - pose.heading) / prior_->heading_sd;
  const double place = std::hypot(prior_->mean.x - pose.x, prior_->mean.y - pose.y) / prior_->place_sd;
  return heading * heading + place * place;
}

Pose PoseFit::moved(const Pose& pose, const Eigen::Vector3d& step) const {
  const Pose turn{0, 0, step(2)};
  const Vec2 place = about_ + turn.turned(Vec2(pose.x, pose.y) - about_) + step.head<2>();
  return {place.x(), place.y(), pose.heading + step(2)};
}

double PoseFit::distance(const Pose& one, const Pose& other) const {
  const double turn = nearest_angle(one.heading - other.heading);
  const Pose turned = moved(other, {0, 0, turn});
  return std::hypot(one.x - turned.x, one.y - turned.y) + path(0).diagonal() * std::abs(turn);
}

Eigen::Matrix3d PoseFit::at_origin(const Pose& pose, const Eigen::Matrix3d& covariance) const {
  Eigen::Matrix3d by = Eigen::Matrix3d::Identity();
  by.topRightCorner<2, 1>() = turned_left(Vec2(pose.x, pose.y) - about_);
  return by * covariance * by.transpose();
}

double PoseFit::square_of(State& state, const std::optional<Held>& held, const std::vector<double>& weights) const {
  double sum = prior_square(state.pose);
  for (std::size_t k = 0; k < touches_.size(); ++k) {
    const bool is_held = held && held->touch == k;
    if (!is_held) state.places[k] = downhill_from(state.places[k], state.pose, k);
    sum += (weights.empty() ? 1 : weights[k]) * square_at(state.pose, k, state.places[k], is_held);
  }
  return sum;
}

Normals PoseFit::normals_of(const State& state, const std::optional<Held>& held,
                            const std::vector<double>& weights) const {
  Normals sum = prior_normals(state.pose);
  for (std::size_t k = 0; k < touches_.size(); ++k) {
    const bool is_held = held && held->touch == k;
    const Normals one =
        is_held ? held_normals(state.pose, k, state.places[k]) : free_normals(state.pose, k, state.places[k]);
    const double weight = weights.empty() ? 1 : weights[k];
    sum.matrix += weight * one.matrix;
    sum.slope += weight * one.slope;
  }
  return sum;
}

void PoseFit::descend(State& state, const std::optional<Held>& held, const std::vector<double>& weights) const {
  state.square = square_of(state, held, weights);
  double damping = 1e-6;
  for (int round = 0; round < kMostRounds && damping < kMostDamping; ++round) {
    const Normals normals = normals_of(state, held, weights);
    Eigen::Matrix3d matrix = normals.matrix;
    matrix.diagonal() *= 1 + damping;
    State next = state;
    next.pose = moved(state.pose, matrix.ldlt().solve(normals.slope));
    next.square = square_of(next, held, weights);
    if (!(next.square <= state.square)) {
      damping *= 10;
      continue;
    }
    const double gain = state.square - next.square;
    state = std::move(next);
    damping = std::max(0.1 * damping, 1e-12);
    if (gain <= kSettled * (1 + state.square)) break;
  }
}

/// Whether another touch is nearer to another place than where going downhill has led it.
bool PoseFit::jump_nearer(State& state, const std::optional<Held>& held) {
  bool jumped = false;
  for (std::size_t k = 0; k < touches_.size(); ++k) {
    if (held && held->touch == k) continue;
    const PathPlace place = nearest_to(state.pose, k);
    const double here = square_at(state.pose, k, state.places[k], false);
    if (square_at(state.pose, k, place, false) >= here - 1e-6 * (1 + here)) continue;
    state.places[k] = place;
    jumped = true;
  }
  return jumped;
}

FittedPose PoseFit::at(const Pose& pose, std::vector<PathPlace> places) const {
  State state{pose, std::move(places), prior_square(pose)};
  for (std::size_t k = 0; k < touches_.size(); ++k) {
    state.square += square_at(pose, k, state.places[k], false);
  }
  state.pose.heading = nearest_angle(pose.heading);
  return {state.pose, state.places, state.square, normals_of(state, {}, {}).matrix};
}

FittedPose PoseFit::fit(const Pose& from, const std::optional<Held>& held, const std::vector<double>& weights) {
  beat();
  State state{from, std::vector<PathPlace>(touches_.size()), 0};
  for (std::size_t k = 0; k < touches_.size(); ++k) {
    const bool is_held = held && held->touch == k;
    state.places[k] = is_held ? held->place : nearest_to(from, k);
  }
  for (int jump = 0; jump < kMostJumps; ++jump) {
    descend(state, held, weights);
    if (!jump_nearer(state, held)) break;
  }
  state.pose.heading = nearest_angle(state.pose.heading);
  return {state.pose, state.places, state.square, normals_of(state, held, weights).matrix};
}

}  // namespace rollfix::touch
