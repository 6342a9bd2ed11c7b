#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "belief/error_model.hpp"
#include "belief/felt_turning.hpp"
#include "belief/nodes.hpp"
#include "belief/tilted_boundary.hpp"

namespace rollfix::belief {

/// Two first contacts on trial, each by its tilted turning: at a convex corner that tells how far it has pivoted.
struct PairStart {
  std::array<const TiltedArc*, 2> arc{};
  std::array<double, 2> w{};
};

/// What it is worth: minus twice the logarithm of the likelihood is cost + log_volume, up to what is the same
/// everywhere.
struct PairScore {
  double cost = 0;
  double direct_cost =
      0;  // with the errors about which it was linearised: more than the cost, unless that served badly
  double log_volume = 0;
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();        // of the log-likelihood by (w_a, w_b), the volume's left out
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();  // expected, by them
  PairShared errors = PairShared::Zero();
  PairSharedCovariance covariance = PairSharedCovariance::Zero();
  Eigen::Matrix<double, 5, 2> errors_by_start = Eigen::Matrix<double, 5, 2>::Zero();

  double log_likelihood() const { return -0.5 * (cost + log_volume); }
};

/// Outliers as a share of rows whose turn is anything.
struct PairOutliers {
  double share = 0;
};

/// What all hypotheses have in common.
struct PairModel {
  const PairErrors* errors = nullptr;
  std::array<const TiltedBoundary*, 2> boundary{};
  std::array<const FeltTurning*, 2> felt{};
  PairOutliers outliers;
  std::optional<Prior> prior;  // of finger a's first contact
  bool closed = true;

  double perimeter() const { return errors->perimeter(); }
};

/// The likelihood of two first contacts: a Kalman filter of the errors that the whole roll shares, linearised about
/// what they come out as (an iterated one: Gauss-Newton), or where they drift about its own estimate as it goes.
/// `guess`: of the shared errors; passes go on until it agrees with what comes out, at most `most_passes`.
PairScore score_of(const PairModel& model, const PairStart& start, const std::vector<PairNode>& nodes,
                   const PairShared& guess, int most_passes);

}  // namespace rollfix::belief
