#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "box_search.hpp"
#include "held_rows.hpp"

namespace rollfix::hold {

/// First contacts of all fingers, and with noise how much longer each finger's lengths are than measured.
using Unknowns = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 2 * kMostFingers, 1>;
using UnknownsMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 2 * kMostFingers, 2 * kMostFingers>;

/// The part at one instant: where a point in its middle is in the world, and how it is turned.
struct Placed {
  Vec2 middle = Vec2::Zero();
  double heading = 0;  // radians
  bool is_known = false;
};

/// First contacts with the poses that suit them best.
struct HeldState {
  Unknowns unknowns;           // places of the first contacts, unwrapped, then stretches
  std::vector<Placed> placed;  // at each row
  double square = 0;           // of all residuals, in their units
  double cost = 0;             // that, and with noise what corners add to the logarithm of the errors' size
};

/// The pose at one row by the unknowns: mean, its change with them, and what is unknown besides.
struct PoseAtRow {
  Pose pose;
  Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 2 * kMostFingers> by_unknowns;  // of x, y, heading
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();                          // with the unknowns given
};

/// The normal equations of the unknowns, with all poses eliminated.
struct Reduced {
  UnknownsMatrix matrix;
  Unknowns slope;
  double log_volume = 0;  // of the poses and of the errors: what the density has besides the squares
};

/// What was measured of one contact less what it would be, and its derivatives.
struct ContactResidual {
  Vec2 place = Vec2::Zero();  // in the world
  double turn = 0;            // radians
};

/// Least squares over first contacts, with a pose of its own at each row: Levenberg's method on what is left when the
/// poses are eliminated.
class HoldFit {
 public:
  HoldFit(const Part& part, const HeldRows& rows);

  const HeldRows& rows() const { return rows_; }
  std::size_t fingers() const { return rows_.fingers(); }
  Eigen::Index size() const { return size_; }

  /// The state with these first contacts, and the best poses for them.
  HeldState at(const std::vector<double>& first_contacts) const;
  HeldState at(const Unknowns& unknowns, const std::vector<Placed>& near) const;
  /// Downhill. `held`: this unknown stays. `weights`: of each contact of each row, see `best_worst`.
  HeldState fit(HeldState state, std::optional<Eigen::Index> held = {}) const;
  /// Without noise: downhill to where the largest residual is as small as can be.
  HeldState best_worst(HeldState from);

  Reduced reduced(const HeldState& state) const;
  PoseAtRow pose_at(const HeldState& state, std::size_t row) const;
  ContactResidual residual(const HeldState& state, std::size_t row, std::size_t finger) const;
  /// The largest residual as a share of what it may be: without noise at most 1 fits.
  double worst(const HeldState& state) const;
  double place_of(const HeldState& state, std::size_t row, std::size_t finger) const;
  /// With noise: how far off the place of the first (or of another) row's contact was measured, by its normal: mean,
  /// its change with place and heading, and the variance left.
  struct ContactError {
    double mean = 0;
    double by_turn = 0;  // of the residual of its normal
    double variance = 0;
    double curvature = 0;  // of the part there
  };
  ContactError contact_error(const HeldState& state, std::size_t row, std::size_t finger) const;
  /// Numbers that the rows say, less those that each row's pose takes; angles of pivots count as one for each corner.
  double freedom(const HeldState& state) const;

 private:
  struct Look;
  Look look(const Placed& placed, double s, std::size_t row, std::size_t finger) const;
  struct RowEquations;
  RowEquations equations(const HeldState& state, std::size_t row, bool with_unknowns) const;
  double weight(std::size_t row, std::size_t finger) const {
    return weights_.empty() ? 1 : weights_[row * rows_.fingers() + finger];
  }
  RowEquations settled(HeldState& state, std::size_t row) const;
  void settle(HeldState& state) const;
  void guess(HeldState& state, std::size_t row) const;
  void refer(HeldState& state, std::size_t row) const;
  double pivot_length(const HeldContact& contact) const;
  double prior_precision(std::size_t finger) const;

  const Part& part_;
  const HeldRows& rows_;
  Eigen::Index size_ = 0;
  Vec2 middle_ = Vec2::Zero();
  std::vector<double> weights_;
};

}  // namespace rollfix::hold
