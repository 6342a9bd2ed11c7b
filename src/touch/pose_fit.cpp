#include "pose_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "outline/turn.hpp"
#include "roll_belief.hpp"
#include "work/pulse.hpp"

// Notation:
//   (X, phi)        the pose of the part: `Pose`, moved by steps about `about_`
//   q_i, tau_i      a touch's measured centre, and tangent where a normal was measured: `Measured`
//   c(u), theta(u)  centre and tangent's angle at a contact's place u_i: CentrePoint
//   r_i             residuals (q - X - R(phi) c(u)) / `place_unit` and (tau - theta(u) - phi) / `angle_unit`
//   J, v            derivatives of r_i by the pose and by u_i; J^T v, v^T v: `Mixed`
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
// It keeps the matrix regular; it has no slope, so that it moves no pose.
constexpr double kAnyHeading = std::numbers::pi;

}  // namespace

/// J^T v and v^T v of one contact, for residuals in their units. Along the path the centre moves by dc/du, with a turn
/// of the pose by left(c - about) dphi; of a normal the two are bend du and dphi. All three have the same sign.
Mixed mixed_at(const PartFrame& frame, const InPart& touch, const CentrePoint& point) {
  Mixed mixed;
  if (touch.has_place) {
    const double share = 1 / (touch.place_unit * touch.place_unit);
    const Vec2 along = frame.in_world(point.along);
    const double turn = turned_left(point.centre - frame.about).dot(point.along);
    mixed.by_pose = share * Eigen::Vector3d(along.x(), along.y(), turn);
    mixed.weight = share * point.along.squaredNorm();
  }
  if (!touch.tangent) return mixed;
  const double share = 1 / (touch.angle_unit * touch.angle_unit);
  mixed.by_pose(2) += share * point.bend;
  mixed.weight += share * point.bend * point.bend;
  return mixed;
}

/// J^T J and -J^T r with the contact held at `point`. A step is (dx, dy, dphi) of what lies at `about`.
Normals normals_at(const PartFrame& frame, const InPart& touch, const CentrePoint& point) {
  Normals normals;
  if (touch.has_place) {
    const double share = 1 / (touch.place_unit * touch.place_unit);
    // d(R c)/dphi, in the part's frame and in the world.
    const Vec2 left = turned_left(point.centre - frame.about);
    const Vec2 turn = frame.in_world(left);
    const Vec2 off = touch.at - point.centre;
    const Vec2 pull = frame.in_world(off);
    // J is -(identity, turn), so that J^T J has |turn|^2 = |left|^2 in its corner.
    normals.matrix << 1, 0, turn.x(), 0, 1, turn.y(), turn.x(), turn.y(), left.squaredNorm();
    normals.matrix *= share;
    normals.slope = share * Eigen::Vector3d(pull.x(), pull.y(), left.dot(off));
  }
  if (!touch.tangent) return normals;
  const double share = 1 / (touch.angle_unit * touch.angle_unit);
  normals.matrix(2, 2) += share;
  normals.slope(2) += share * nearest_angle(*touch.tangent - point.angle);
  return normals;
}

/// A pose, where each contact is then, and the sum of squares.
// Between two steps `contacts` are the nearest places in `pose`, and `square` is of these and of the prior.
struct PoseFit::State {
  Pose pose;
  PartFrame frame;
  std::vector<OnPath> contacts;
  double square = 0;
};

/// `touches` outlive this. `about_` is the mean of the measured centres, which makes x, y and heading nearly
/// independent. Without any place: the origin.
PoseFit::PoseFit(const std::vector<Measured>& touches, const std::optional<PosePrior>& prior)
    : touches_(touches), prior_(prior) {
  double places = 0;
  for (const Measured& touch : touches) places += touch.has_place ? 1 : 0;
  for (const Measured& touch : touches) {
    if (touch.has_place) about_ += touch.at / places;
  }
}

/// X = q - R(phi) c(u). Of a roll with noise the node's own mean pose, whatever `heading` is.
Pose PoseFit::pose_at(const Held& held, double heading) const {
  if (const RollBelief* roll = touches_[held.touch].roll) return roll->pose_at(roll->at(held.place));
  Pose pose{0, 0, heading};
  const Vec2 place = touches_[held.touch].at - pose.turned(path(held.touch).at(held.place).centre);
  return {place.x(), place.y(), heading};
}

PartFrame PoseFit::frame(const Pose& pose) const {
  PartFrame frame{{std::cos(pose.heading), std::sin(pose.heading)}};
  // In the part's frame a turn about `about` is a turn about R(-phi)(about - X).
  frame.about = frame.in_part(about_ - Vec2(pose.x, pose.y));
  return frame;
}

/// R(-phi)(q - X) and tau - phi.
InPart PoseFit::in_part(const Pose& pose, const PartFrame& frame, std::size_t touch) const {
  const Measured& one = touches_[touch];
  InPart result;
  result.at = frame.in_part(one.at - Vec2(pose.x, pose.y));
  if (one.tangent) result.tangent = *one.tangent - pose.heading;
  result.has_place = one.has_place;
  result.place_unit = one.place_unit;
  result.angle_unit = one.angle_unit;
  return result;
}

InPart PoseFit::in_part(const Pose& pose, std::size_t touch) const { return in_part(pose, frame(pose), touch); }

/// A contact at the end of a stretch with a slope left is held there by a corner, by the end of an open outline or of
/// the reach. Weight 0: moving along the path changes nothing, so there is nothing to eliminate.
bool PoseFit::is_pinned_at(const PathPlace& place, std::size_t touch, const Distance& distance) const {
  if (distance.weight == 0) return true;
  const CentreStretch& stretch = path(touch).stretches()[place.stretch];
  const bool is_end = place.u <= stretch.u.lo || place.u >= stretch.u.hi;
  // Past the end it would go on: a place in the middle of a smooth boundary has no slope.
  return is_end && std::abs(distance.slope) > kNoSlope * std::sqrt(distance.weight);
}

/// A roll with noise slides within its node, so it is never pinned.
bool PoseFit::is_pinned(const Pose& pose, std::size_t touch, const PathPlace& place) const {
  if (touches_[touch].roll != nullptr) return false;
  return is_pinned_at(place, touch, distance_at(path(touch).at(place), in_part(pose, touch)));
}

/// Of a roll the point is not looked at.
OnPath PoseFit::on_path(const PathPlace& place, std::size_t touch) const {
  if (touches_[touch].roll != nullptr) return {place, {}};
  return {place, path(touch).at(place)};
}

/// The best of all places, of a roll the best of all nodes.
OnPath PoseFit::nearest_to(const Pose& pose, std::size_t touch) const {
  const RollBelief* roll = touches_[touch].roll;
  if (roll != nullptr) return {roll->nearest(pose).place, {}};
  return nearest_place(tree(touch), in_part(pose, touch));
}

PathPlace PoseFit::downhill_from(const PathPlace& place, const Pose& pose, std::size_t touch) const {
  const RollBelief* roll = touches_[touch].roll;
  return roll != nullptr ? roll->downhill(pose, roll->at(place)).place
                         : downhill(path(touch), in_part(pose, touch), on_path(place, touch)).place;
}

/// A touch is at its place either way; a roll may slide within its node unless it is held.
double PoseFit::square_at(const Pose& pose, std::size_t touch, const PathPlace& place, bool is_held) const {
  if (const RollBelief* roll = touches_[touch].roll) return roll->square(pose, roll->at(place), !is_held);
  return distance_at(path(touch).at(place), in_part(pose, touch)).square;
}

Normals PoseFit::held_normals(const Pose& pose, std::size_t touch, const PathPlace& place) const {
  if (const RollBelief* roll = touches_[touch].roll) return roll->normals(pose, roll->at(place), about_, false);
  const PartFrame by = frame(pose);
  return normals_at(by, in_part(pose, by, touch), path(touch).at(place));
}

/// A touch's share of the normal equations, held where it is, or free to move.
/// M of the file's notation. At a pinned place J^T J alone, since u_i can't follow the pose.
Normals PoseFit::share_of(std::size_t touch, const State& state, bool is_held) const {
  const OnPath& at = state.contacts[touch];
  if (const RollBelief* roll = touches_[touch].roll) {
    return roll->normals(state.pose, roll->at(at.place), about_, !is_held);
  }
  const InPart one = in_part(state.pose, state.frame, touch);
  Normals normals = normals_at(state.frame, one, at.point);
  if (is_held || is_pinned_at(at.place, touch, distance_at(at.point, one))) return normals;
  // Free to move: v eliminated, by the Schur complement.
  const Mixed mixed = mixed_at(state.frame, one, at.point);
  // The slope stays: at the nearest place v^T r = 0.
  normals.matrix -= mixed.by_pose * mixed.by_pose.transpose() / mixed.weight;
  return normals;
}

/// At the best pose for each u the gradient stays zero: M dpose + J^T v du = 0, so dpose/du = -M^-1 J^T v. The
/// information of u is the Schur complement v^T v - v^T J M^-1 J^T v, not below 0.
ByPlace PoseFit::by_place(const FittedPose& fitted, const Held& held) const {
  const PartFrame by = frame(fitted.pose);
  const Mixed mixed = mixed_at(by, in_part(fitted.pose, by, held.touch), path(held.touch).at(held.place));
  ByPlace result;
  result.pose = -fitted.information.ldlt().solve(mixed.by_pose);
  result.own_information = mixed.weight;
  result.information = std::max(0.0, mixed.weight + mixed.by_pose.dot(result.pose));
  return result;
}

/// `step`: of what lies at `about`. Place and normal of each touch count by themselves.
double PoseFit::touches_moved(const Eigen::Vector3d& step) const {
  double most = 0;
  for (const Measured& touch : touches_) {
    if (touch.has_place) {
      const Vec2 moved = step.head<2>() + step(2) * turned_left(touch.at - about_);
      most = std::max(most, moved.norm() / touch.place_unit);
    }
    if (touch.tangent) most = std::max(most, std::abs(step(2)) / touch.angle_unit);
  }
  return most;
}

/// The prior by `kAnyHeading` is in the matrix alone. A prior of the heading alone has an infinite `place_sd`.
Normals PoseFit::prior_normals(const Pose& pose) const {
  Normals normals;
  normals.matrix(2, 2) = 1 / (kAnyHeading * kAnyHeading);
  if (!prior_) return normals;
  const double heading = 1 / (prior_->heading_sd * prior_->heading_sd);
  normals.matrix(2, 2) += heading;
  normals.slope(2) = heading * nearest_angle(prior_->mean.heading - pose.heading);
  // The place is that of the part's origin, which a turn about `about` moves as well.
  if (!std::isfinite(prior_->place_sd)) return normals;
  Eigen::Matrix<double, 2, 3> by_pose;
  by_pose << Eigen::Matrix2d::Identity(), turned_left(Vec2(pose.x, pose.y) - about_);
  const Vec2 off(prior_->mean.x - pose.x, prior_->mean.y - pose.y);
  const double place = 1 / (prior_->place_sd * prior_->place_sd);
  normals.matrix += place * by_pose.transpose() * by_pose;
  normals.slope += place * by_pose.transpose() * off;
  return normals;
}

/// Of an infinite `place_sd` the place adds 0.
double PoseFit::prior_square(const Pose& pose) const {
  if (!prior_) return 0;
  const double heading = nearest_angle(prior_->mean.heading - pose.heading) / prior_->heading_sd;
  const double place = std::hypot(prior_->mean.x - pose.x, prior_->mean.y - pose.y) / prior_->place_sd;
  return heading * heading + place * place;
}

/// The part turned by step(2) about `about`, then moved.
Pose PoseFit::moved(const Pose& pose, const Eigen::Vector3d& step) const {
  const Pose turn{0, 0, step(2)};
  const Vec2 place = about_ + turn.turned(Vec2(pose.x, pose.y) - about_) + step.head<2>();
  return {place.x(), place.y(), pose.heading + step(2)};
}

/// A length: how far the origins are apart once `other` has been turned into the heading of `one`, and the turn times
/// the part's diagonal.
double PoseFit::distance(const Pose& one, const Pose& other) const {
  const double turn = nearest_angle(one.heading - other.heading);
  const Pose turned = moved(other, {0, 0, turn});
  return std::hypot(one.x - turned.x, one.y - turned.y) + path(0).diagonal() * std::abs(turn);
}

/// (X, Y, phi) of the part's origin: X moves by the arm from `about` to it times dphi.
Eigen::Matrix3d PoseFit::at_origin(const Pose& pose, const Eigen::Matrix3d& covariance) const {
  Eigen::Matrix3d by = Eigen::Matrix3d::Identity();
  by.topRightCorner<2, 1>() = turned_left(Vec2(pose.x, pose.y) - about_);
  return by * covariance * by.transpose();
}

/// Each contact to its nearest place in the state's pose, and the squares there; not all of them where they exceed
/// `most`.
void PoseFit::go_downhill(State& state, const std::optional<Held>& held, double most) const {
  state.frame = frame(state.pose);
  state.square = prior_square(state.pose);
  for (std::size_t k = 0; k < touches_.size() && state.square <= most; ++k) {
    const bool is_held = held && held->touch == k;
    OnPath& at = state.contacts[k];
    if (const RollBelief* roll = touches_[k].roll) {
      if (!is_held) at.place = roll->downhill(state.pose, roll->at(at.place)).place;
      state.square += roll->square(state.pose, roll->at(at.place), !is_held);
      continue;
    }
    const InPart touch = in_part(state.pose, state.frame, k);
    if (!is_held) at = downhill(path(k), touch, at);
    state.square += distance_at(at.point, touch).square;
  }
}

/// The matrix and the right side of the step (J^T J) step = -J^T r, prior and all contacts.
Normals PoseFit::normals_of(const State& state, const std::optional<Held>& held) const {
  Normals sum = prior_normals(state.pose);
  for (std::size_t k = 0; k < touches_.size(); ++k) {
    const Normals one = share_of(k, state, held && held->touch == k);
    sum.matrix += one.matrix;
    sum.slope += one.slope;
  }
  return sum;
}

/// false: it ends at a pose that is known to lead to nothing new.
/// Levenberg's method: a step that makes the squares larger is tried again with ten times the damping, after a good one
/// damping falls to a tenth. Each trial takes the contacts to their nearest places first. `is_known` is asked after
/// each step that counts.
bool PoseFit::descend(State& state, const std::optional<Held>& held, const IsKnown& is_known) const {
  go_downhill(state, held);
  State next;
  // Small at first: near the best pose Gauss-Newton's steps are good.
  double damping = 1e-6;
  Normals normals = normals_of(state, held);
  for (int round = 0; round < kMostRounds && damping < kMostDamping; ++round) {
    Eigen::Matrix3d matrix = normals.matrix;
    matrix.diagonal() *= 1 + damping;
    next = state;
    const Eigen::Vector3d step = matrix.ldlt().solve(normals.slope);
    // What the model says that a whole step gains: if it is that little, this step is the last one.
    const bool is_last = step.dot(normals.slope) <= kSettled * (1 + state.square);  // but for rounding, and bends
    next.pose = moved(state.pose, step);
    // It may stop early, with a sum that is already larger: the step is refused then anyway.
    go_downhill(next, held, state.square);
    // Negated, so that a NaN counts as worse.
    if (!(next.square <= state.square)) {
      if (is_last) break;
      damping *= 10;
      continue;
    }
    const double gain = state.square - next.square;
    std::swap(state, next);
    damping = std::max(0.1 * damping, 1e-12);
    if (is_last || gain <= kSettled * (1 + state.square)) break;
    // Another descent has ended where this one goes.
    if (is_known && is_known(state.pose, state.square)) return false;
    normals = normals_of(state, held);
  }
  return true;
}

/// Whether another touch is nearer to another place than where going downhill has led it.
/// It moves all of them that are, of a roll to its best node. The held one stays.
bool PoseFit::jump_nearer(State& state, const std::optional<Held>& held) const {
  bool jumped = false;
  for (std::size_t k = 0; k < touches_.size(); ++k) {
    if (held && held->touch == k) continue;
    OnPath& at = state.contacts[k];
    if (const RollBelief* roll = touches_[k].roll) {
      const RollNode& there = roll->nearest(state.pose);
      // Nearer by more than rounding, or the two would take turns.
      const double here = roll->square(state.pose, roll->at(at.place), true);
      if (roll->square(state.pose, there, true) >= here - 1e-6 * (1 + here)) continue;
      at.place = there.place;
      jumped = true;
      continue;
    }
    const std::optional<OnPath> nearer = nearer_place(tree(k), in_part(state.pose, k), at);
    if (!nearer) continue;
    at = *nearer;
    jumped = true;
  }
  return jumped;
}

/// Descents and jumps in turn, until no contact jumps, or kMostJumps times. None: `is_known` ended it.
std::optional<FittedPose> PoseFit::settled(State state, const std::optional<Held>& held,
                                           const IsKnown& is_known) const {
  beat();
  // Every jump makes the sum of squares smaller, so none leads back.
  for (int jump = 0; jump < kMostJumps; ++jump) {
    if (!descend(state, held, is_known)) return std::nullopt;
    if (!jump_nearer(state, held)) break;
  }
  state.pose.heading = nearest_angle(state.pose.heading);
  FittedPose fitted{state.pose, {}, state.square, normals_of(state, held).matrix};
  for (const OnPath& one : state.contacts) fitted.places.push_back(one.place);
  return fitted;
}

/// Nothing is fitted: squares and information as they are there.
FittedPose PoseFit::at(const Pose& pose, std::vector<PathPlace> places) const {
  State state{pose, frame(pose), {}, prior_square(pose)};
  for (std::size_t k = 0; k < touches_.size(); ++k) {
    state.contacts.push_back(on_path(places[k], k));
    state.square += square_at(pose, k, places[k], false);
  }
  state.pose.heading = nearest_angle(pose.heading);
  return {state.pose, std::move(places), state.square, normals_of(state, {}).matrix};
}

FittedPose PoseFit::at(const Pose& pose) const {
  std::vector<PathPlace> places;
  for (const OnPath& one : start(pose, {}).contacts) places.push_back(one.place);
  return at(pose, std::move(places));
}

/// Each contact at its nearest of all places, the held one where it is held. `square` and `frame` are not set yet.
PoseFit::State PoseFit::start(const Pose& from, const std::optional<Held>& held) const {
  State state{from, {}, {}, 0};
  for (std::size_t k = 0; k < touches_.size(); ++k) {
    const bool is_held = held && held->touch == k;
    state.contacts.push_back(is_held ? on_path(held->place, k) : nearest_to(from, k));
  }
  return state;
}

FittedPose PoseFit::fit(const Pose& from, const std::optional<Held>& held) {
  return *settled(start(from, held), held, {});
}

std::optional<FittedPose> PoseFit::fit_unless(const IsKnown& is_known, const Pose& from,
                                              const std::optional<Held>& held) {
  return settled(start(from, held), held, is_known);
}

/// Contacts start where `from` has them, which saves the search over the whole boundary.
FittedPose PoseFit::fit(const FittedPose& from, const std::optional<Held>& held) {
  State state{from.pose, {}, {}, 0};
  for (std::size_t k = 0; k < touches_.size(); ++k) {
    const bool is_held = held && held->touch == k;
    state.contacts.push_back(on_path(is_held ? held->place : from.places[k], k));
  }
  return *settled(std::move(state), held, {});
}

}  // namespace rollfix::touch
