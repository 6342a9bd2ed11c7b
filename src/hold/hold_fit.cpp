#include "hold_fit.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "outline/turn.hpp"
#include "work/pulse.hpp"

// Notation, as in docs/two_fingers.md, "Three and more fingers":
//   z_i, e_i        first contact of finger i, and the stretch of its lengths: `unknowns`
//   s = z + L / (1 + e)   where the contact is at a row: `place_of`
//   (A, phi)        the part at a row: world(p) = A + R(phi) (p - m): `Placed`; m: `middle_`
//   r, t            residuals q - world(p(s)) and tau - phi - Theta(s): ContactResidual
//                   wheels add theirs, see wheel_pins.cpp
//   C               their covariance: position, the orientation by its lever l, and the contact's error n, which moves
//                   the normal by (kappa + kappa_finger) n and nothing else
//   P, B, M         blocks of the normal matrix: of a row's pose, of pose and unknowns, of the unknowns; M - B^T P^-1 B
//                   is what is left: `Reduced`
// Follows K. Levenberg (1944), with a pose of its own for each row eliminated (Schur's complement).
namespace rollfix::hold {
namespace {

constexpr int kMostFitRounds = 40;
constexpr double kMostFitDamping = 1e10;
constexpr double kFitSettled = 1e-9;     // of first contacts
constexpr double kExactSettled = 1e-16;  // without noise, beside wheels: their tolerance is far above what is exact
constexpr int kPoseRounds = 12;          // of one row's pose alone
constexpr double kPoseSettled = 10;      // as much more is the last of one row's pose
constexpr double kLeastShare = 1e-3;     // of a step of it
constexpr double kAnyStray = 0.5;        // measurements: then a row's pose may be by the wrong ones
constexpr int kWorstRounds = 25;         // of weighting up what is worst (Lawson's method)
constexpr int kNoGain = 6;               // so many of them without a gain of this share, ...
constexpr double kBetter = 0.01;
constexpr double kFarOff = 2;  // ... still so many tolerances off, are the last

}  // namespace

/// Counts the unknowns: first contacts; with noise a stretch for each finger if any has one; each wheel's radius and
/// encoder's zero. m is the mean of 64 points of the boundary.
HoldFit::HoldFit(const Part& part, const HeldRows& rows, const WheelPaths& wheels)
    : part_(part), rows_(rows), wheels_(wheels), feet_(rows.rows.size() * rows.wheels.size()) {
  const bool any_stretch =
      std::any_of(rows.errors.begin(), rows.errors.end(), [](const HeldErrors& errors) { return errors.stretch > 0; });
  const auto count = static_cast<Eigen::Index>(rows.fingers());
  settled_ = rows.has_noise || rows.wheels.empty() ? kFitSettled : kExactSettled;
  has_stretches_ = rows.has_noise && any_stretch;
  size_ = has_stretches_ ? 2 * count : count;
  for (const auto& wheel : rows.wheels) size_ += (wheel.radius > 0 ? 1 : 0) + (wheel.spin ? 1 : 0);
  constexpr int kPoints = 64;
  for (int k = 0; k < kPoints; ++k) middle_ += part.point(part.perimeter() * (k + 0.5) / kPoints) / kPoints;
}

/// Behind first contacts and stretches come the wheels', each with its radius and its encoder's zero where it has them.
std::optional<Eigen::Index> HoldFit::radius_unknown(std::size_t wheel) const {
  if (!(rows_.wheels[wheel].radius > 0)) return std::nullopt;
  auto at = static_cast<Eigen::Index>(has_stretches_ ? 2 * fingers() : fingers());
  for (std::size_t k = 0; k < wheel; ++k) at += 1 + (rows_.wheels[k].spin ? 1 : 0);
  return at;
}

/// A finger's stretch or a wheel's radius.
std::optional<Eigen::Index> HoldFit::scale_unknown(std::size_t contact) const {
  if (contact >= fingers()) return radius_unknown(contact - fingers());
  return has_stretches_ ? std::optional(static_cast<Eigen::Index>(fingers() + contact)) : std::nullopt;
}

/// Of a wheel its radius over the stated one: its unknown is a length.
std::pair<double, double> HoldFit::scale_of_lengths(std::size_t contact, double value, double sd) const {
  if (contact < fingers()) return {1 / (1 + value), sd / ((1 + value) * (1 + value))};
  const double radius = wheels_[contact - fingers()]->radius();
  return {1 + value / radius, sd / radius};
}

/// Behind the wheel's radius. The radius is of the noise: all wheels have an unknown of it, or none has.
std::optional<Eigen::Index> HoldFit::spin_unknown(std::size_t wheel) const {
  if (!rows_.wheels[wheel].spin) return std::nullopt;
  if (const auto radius = radius_unknown(wheel)) return *radius + 1;
  return static_cast<Eigen::Index>((has_stretches_ ? 2 * fingers() : fingers()) + wheel) -
         std::count_if(rows_.wheels.begin(), rows_.wheels.begin() + static_cast<std::ptrdiff_t>(wheel),
                       [](const HeldWheel& one) { return !one.spin; });
}

/// Its standard deviation beforehand. Of an encoder's zero, of which nothing is known, half a turn.
double HoldFit::scale_of(Eigen::Index unknown) const {
  const double precision = prior_precision(unknown);
  return precision > 0 ? std::max(1 / std::sqrt(precision), 1e-6) : std::numbers::pi;
}

/// 1 / variance before the roll, about 0. 0: nothing is known beforehand, as of a first contact and an encoder's zero.
double HoldFit::prior_precision(Eigen::Index unknown) const {
  const auto count = static_cast<Eigen::Index>(fingers());
  if (unknown < count) return 0;
  if (has_stretches_ && unknown < 2 * count) {
    const double sd = rows_.errors[static_cast<std::size_t>(unknown - count)].stretch;
    // A finger without an error of its lengths beside others with one: its stretch stays 0.
    return sd > 0 ? 1 / (sd * sd) : 1e12;
  }
  for (std::size_t wheel = 0; wheel < wheels(); ++wheel) {
    if (radius_unknown(wheel) == unknown) return 1 / (rows_.wheels[wheel].radius * rows_.wheels[wheel].radius);
  }
  return 0;
}

/// s = z + L / (1 + e), unwrapped.
double HoldFit::place_of(const HeldState& state, std::size_t row, std::size_t finger) const {
  const auto k = static_cast<Eigen::Index>(finger);
  return state.unknowns(k) + rows_.rows[row].contacts[finger].travelled / (1 + stretch_of(state, finger));
}

/// A pose from which a row's fit can start: its heading by the longest chord between contacts with places, else by
/// their normals; beside wheels on a corner by the wheels.
void HoldFit::guess(HeldState& state, std::size_t row) const {
  const HeldRow& now = rows_.rows[row];
  Placed& placed = state.placed[row];
  Vec2 sum = Vec2::Zero();
  std::vector<Vec2> points;
  for (std::size_t k = 0; k < fingers(); ++k) {
    const double blur = std::max(rows_.errors[k].travel, kLeastBlur * part_.perimeter());
    const double s = place_of(state, row, k);
    const BlurredPlace at = blurred(part_, s, blur, pivot_length(now.contacts[k]));
    points.push_back(rows_.errors[k].has_place ? point_about(part_, s) : Vec2::Zero());
    const double heading = now.contacts[k].tangent - at.angle;
    const double sd = std::hypot(rows_.errors[k].angle, blur * now.contacts[k].finger_curvature);
    // Each normal gives a heading; their mean direction, weighed by 1 / variance, corners included.
    sum += Vec2(std::cos(heading), std::sin(heading)) / (sd * sd + at.variance);
  }
  placed.heading = std::atan2(sum.y(), sum.x());
  double longest = 0;
  for (std::size_t i = 0; i < fingers(); ++i) {
    for (std::size_t j = i + 1; j < fingers(); ++j) {
      const Vec2 chord = now.contacts[j].at - now.contacts[i].at;
      if (!rows_.errors[i].has_place || !rows_.errors[j].has_place || chord.norm() <= longest) continue;
      longest = chord.norm();
      // A chord between two known places gives the heading better, the longer it is.
      placed.heading = angle_between(points[j] - points[i], chord);
    }
  }
  const Pose turn{0, 0, placed.heading};
  double count = 0;
  placed.middle = Vec2::Zero();
  for (std::size_t k = 0; k < fingers(); ++k) {
    if (!rows_.errors[k].has_place) continue;
    // A = q - R(phi) (p - m), on average over the fingers that have a place.
    placed.middle += now.contacts[k].at - turn.turned(points[k] - middle_);
    count += 1;
  }
  if (count > 0) placed.middle /= count;
  if (fingers() == 1 && wheels() > 0) face_wheels(state, row);
}

/// Puts the part where the reference finger's centre was: x and y without a stated error place the part, and say
/// nothing else.
void HoldFit::refer(HeldState& state, std::size_t row) const {
  const Pose turn{0, 0, state.placed[row].heading};
  const Boundary boundary = part_.boundary();
  const double s = place_of(state, row, *rows_.reference);
  const Vec2 point = part_.point(boundary.closed ? s : std::clamp(s, 0.0, boundary.perimeter));
  state.placed[row].middle = rows_.rows[row].contacts[*rows_.reference].at - turn.turned(point - middle_);
}

/// The best pose of one row for the unknowns, from where it is: Gauss-Newton steps, shortened where they go too far. A
/// local minimum. Returns the row's equations there.
HoldFit::RowEquations HoldFit::settled(HeldState& state, std::size_t row) const {
  const std::vector<Sight> sights = sights_at(state, row);
  RowEquations now = equations(state, row, sights, false);
  double share = 1;
  for (int round = 0; round < kPoseRounds; ++round) {
    // P dx = slope: the minimum if residuals were linear in the pose.
    const Eigen::Vector3d step = share * now.pose.ldlt().solve(now.slope);
    if (!step.allFinite()) break;
    const Placed before = state.placed[row];
    state.placed[row].middle += step.head<2>();
    state.placed[row].heading += step(2);
    const RowEquations next = equations(state, row, sights, false);
    // Too far: back, and a shorter step. `now` is always of the pose that the state has.
    if (next.square > now.square) {
      state.placed[row] = before;
      share *= 0.25;
      if (share < kLeastShare) break;
      continue;
    }
    const bool is_last = now.square - next.square <= kPoseSettled * settled_ * (1 + next.square);
    now = next;
    share = 1;
    if (is_last) break;
  }
  // For hold_paths.cpp.
  if (wheels() > 0) state.placed[row].heading_sd = std::sqrt(now.pose.inverse()(2, 2));
  return now;
}

/// The best poses for the unknowns, from where they are, and what all rows and priors come to.
void HoldFit::settle(HeldState& state) const {
  state.square = state.cost = state.right_square = state.prior_square = state.strays = 0;
  for (std::size_t row = 0; row < rows_.rows.size(); ++row) {
    RowEquations now = settled(state, row);
    // A pose by outliers is a local minimum: look for a better one.
    if (now.strays > kAnyStray) now = settled_by_fewer(state, row, now);
    state.square += now.square;
    state.cost += now.square + now.blur_size;
    state.right_square += now.right_square;
    state.prior_square += now.prior_square;
    state.strays += now.strays;
    if (rows_.reference) refer(state, row);
  }
  // Stretches and radii are 0 up to their standard deviations. An encoder's zero has the precision 0.
  for (auto k = static_cast<Eigen::Index>(fingers()); k < size_; ++k) {
    const double square = state.unknowns(k) * state.unknowns(k) * prior_precision(k);
    state.square += square;
    state.cost += square;
    state.right_square += square;
  }
  state.square += state.steps;
  state.cost += state.steps;
  if (!rows_.prior) return;
  const double square = std::pow(prior_offset(state) / rows_.prior->sd, 2);
  state.square += square;
  state.cost += square;
  state.prior_square += square;
}

/// First poses for these unknowns, row by row; nothing is fitted yet.
HeldState HoldFit::guessed(const Unknowns& unknowns) const {
  HeldState state;
  state.unknowns = unknowns;
  state.placed = std::vector<Placed>(rows_.rows.size());
  for (std::size_t row = 0; row < rows_.rows.size(); ++row) guess(state, row);
  zero_spins(state, rows_.rows.size());
  return state;
}

/// Stretches and radii are 0; encoders' zeros by all rows.
HeldState HoldFit::at(const std::vector<double>& first_contacts) const {
  Unknowns unknowns = Unknowns::Zero(size_);
  for (std::size_t k = 0; k < fingers(); ++k) unknowns(static_cast<Eigen::Index>(k)) = first_contacts[k];
  HeldState state = guessed(unknowns);
  settle(state);
  return state;
}

/// With poses fitted from those of `near`, and its steps between poses.
HeldState HoldFit::at(const Unknowns& unknowns, const HeldState& near) const {
  HeldState state;
  state.unknowns = unknowns;
  state.placed = near.placed;
  state.steps = near.steps;
  settle(state);
  return state;
}

/// Sum over the rows of M - B^T P^-1 B: rows share the unknowns alone, so that each pose is eliminated in its own
/// row. Linear in the number of rows.
Reduced HoldFit::reduced(const HeldState& state) const {
  Reduced sum;
  sum.matrix = UnknownsMatrix::Zero(size_, size_);
  sum.slope = Unknowns::Zero(size_);
  for (std::size_t row = 0; row < rows_.rows.size(); ++row) {
    const RowEquations one = equations(state, row, sights_at(state, row), true);
    const Eigen::LDLT<Eigen::Matrix3d> pose(one.pose);
    // P^-1 B.
    const RowBlock share = pose.solve(one.mixed);
    sum.matrix += one.own - UnknownsMatrix(one.mixed.transpose() * share);
    sum.slope += one.own_slope - Unknowns(share.transpose() * one.slope);
    // Where a wheel is at a row, the robot made: there is no density of it that a narrow row could be likelier by, and
    // rows are weighed by how well they fit alone.
    // log det C + log det P: integrated over the pose, a row's density has the factor (det C det P)^(-1/2).
    // Both without corners, which `charge` counts: a row that pivots has no more room for its pose than others.
    const Eigen::LDLT<Eigen::Matrix3d> plain(one.plain);
    const double volume = one.log_size + plain.vectorD().array().abs().log().sum();
    sum.log_volume -= 0.5 * (wheels() > 0 ? one.blur_size : volume);
  }
  for (auto k = static_cast<Eigen::Index>(fingers()); k < size_; ++k) {
    const double precision = prior_precision(k);
    sum.matrix(k, k) += precision;
    sum.slope(k) -= precision * state.unknowns(k);
  }
  // Of the first finger's first contact, unknown 0.
  if (rows_.prior) {
    const double precision = 1 / (rows_.prior->sd * rows_.prior->sd);
    sum.matrix(0, 0) += precision;
    sum.slope(0) -= precision * prior_offset(state);
  }
  return sum;
}

/// Levenberg's method. The cost never grows from round to round. Steps are by the squares alone; what corners add to
/// the cost only decides whether a step is taken.
HeldState HoldFit::fit(HeldState state, const Held& held) const {
  double damping = 1e-4;
  for (int round = 0; round < kMostFitRounds; ++round) {
    beat();
    Reduced now = reduced(state);
    // Row and column of what is held become those of the unit matrix: its step is 0.
    for (const Eigen::Index k : held) {
      now.matrix.row(k).setZero();
      now.matrix.col(k).setZero();
      now.matrix(k, k) = 1;
      now.slope(k) = 0;
    }
    const double trace = now.matrix.diagonal().maxCoeff();
    bool is_better = false;
    double gain = 0;
    while (damping < kMostFitDamping && !is_better) {
      UnknownsMatrix damped = now.matrix;
      // Relative damping, and a very small absolute one for directions that nothing determines.
      damped.diagonal() += damping * now.matrix.diagonal() +
                           Unknowns::Constant(size_, 1e-14 * trace + std::numeric_limits<double>::min());
      const Unknowns step = damped.ldlt().solve(now.slope);
      if (!step.allFinite()) break;
      HeldState next = at(Unknowns(state.unknowns + step), state);
      gain = state.cost - next.cost;
      is_better = gain >= 0;
      if (is_better) {
        state = std::move(next);
        damping = std::max(damping * 0.1, 1e-12);
      } else {
        damping *= 10;
      }
    }
    // No step helps, or the last one gained too little.
    if (!is_better || gain <= settled_ * (1 + std::abs(state.cost))) break;
  }
  return state;
}

/// The largest residual of one finger at a row, or behind all of them of a wheel, over its tolerance.
double HoldFit::worst_of(const HeldState& state, std::size_t row, std::size_t contact) const {
  if (contact >= fingers()) return worst_of_wheel(state, row, contact - fingers());
  const ContactResidual off = residual(state, row, contact);
  const HeldErrors& errors = rows_.errors[contact];
  const double place = errors.has_place ? off.place.norm() / errors.place : 0;
  return std::max(place, std::abs(off.turn) / errors.angle);
}

/// The largest residual of all rows over its tolerance.
double HoldFit::worst(const HeldState& state) const {
  double most = 0;
  for (std::size_t row = 0; row < rows_.rows.size(); ++row) {
    for (std::size_t k = 0; k < fingers() + wheels(); ++k) most = std::max(most, worst_of(state, row, k));
  }
  return most;
}

/// Minimises the largest residual by weighted least squares: after each fit every weight is multiplied by its
/// residual's share of the largest. Returns the best state seen, with its squares unweighted.
HeldState HoldFit::best_worst(HeldState from) {
  HeldState best = fit(std::move(from));
  double least = worst(best);
  weights_.assign(rows_.rows.size() * (fingers() + wheels()), 1.0);
  HeldState state = best;
  const double exact = std::exchange(settled_, kFitSettled);  // only the last fit must be exact
  int since = 0;                                              // it got better
  for (int round = 0; round < kWorstRounds && least > 1; ++round) {
    // Far from fitting, and no longer getting better: given up.
    if (least > kFarOff && since == kNoGain) break;
    const double most = worst(state);
    double sum = 0;
    for (std::size_t row = 0; row < rows_.rows.size(); ++row) {
      for (std::size_t k = 0; k < fingers() + wheels(); ++k) {
        // The small term keeps a weight of a residual that is 0 just now.
        double& weight = weights_[row * (fingers() + wheels()) + k];
        weight *= 1e-6 + worst_of(state, row, k) / most;
        sum += weight;
      }
    }
    // Weights are 1 on average.
    for (double& weight : weights_) weight *= static_cast<double>(weights_.size()) / sum;
    settle(state);
    // `settle` has brought the state's cost to the new weights; `fit` compares with it.
    state = fit(std::move(state));
    const double now = worst(state);
    since = now < (1 - kBetter) * least ? 0 : since + 1;
    if (now >= least) continue;
    least = now;
    best = state;
  }
  weights_.clear();
  settled_ = exact;
  settle(best);
  return best;
}

/// Mean and covariance of x, y and heading, P^-1, moved from m to the origin of the part's frame. By the unknowns the
/// pose changes by -P^-1 B.
PoseAtRow HoldFit::pose_at(const HeldState& state, std::size_t row) const {
  const RowEquations one = equations(state, row, sights_at(state, row), true);
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
