#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <vector>

#include "belief/error_model.hpp"
#include "belief/nodes.hpp"
#include "belief/posterior.hpp"
#include "belief/tilted_boundary.hpp"
#include "belief/two/pair_passings.hpp"
#include "rollfix/turning_function.hpp"

namespace rollfix::belief {

/// What a contact's normal, as it is measured, tells of the tangent's angle where it was felt: the place is known no
/// better than to a standard deviation, and with the place the measured normal is off.
struct Felt {
  double angle = 0;     // its mean, radians, unwrapped
  double slope = 0;     // of that by the place, radians per length
  double variance = 0;  // radians^2
  double pivot = 0;     // of that, what neighbouring rows are off alike: how far the finger has pivoted at a corner
};

/// Theta(s + n) + n / r with n ~ N(0, sd): mean and variance, as a table. Where Theta is smooth they are Theta and
/// ((kappa + 1/r) sd)^2. At a convex corner a finger stays while it pivots, so that a contact which is felt near it is
/// likely to be at it, pointing anywhere in between.
class FeltTurning {
 public:
  /// `sd`: of a place, length, above 0. `corner_length`: how far a finger's centre goes per radian that it pivots.
  /// `normal_turn`: 1/r, by how much a place that is off turns the measured normal; 0 where normals are not measured by
  /// places. `accuracy`: of the angle, radians.
  FeltTurning(const TurningFunction& turning, double sd, double corner_length, double normal_turn, double accuracy);

  /// Any s on a closed outline; beyond an open one's ends the tangent goes on as it is there.
  Felt at(double s) const;

  bool has_corners() const { return !corners_.empty(); }
  /// The corner whose pivots are felt at s, by its unwrapped s; nothing where none is.
  std::optional<double> corner_at(double s) const;

 private:
  struct Knot {
    double s = 0;
    Felt felt;
  };

  /// By integration.
  Felt integrated(double s) const;
  void add_knots(double spacing, double accuracy);

  const TurningFunction* turning_;
  double sd_;
  double corner_length_;
  double normal_turn_;
  double lo_ = 0;
  double hi_ = 0;
  std::vector<double> corners_;  // s of the convex ones, in order
  std::vector<Knot> knots_;
  Buckets buckets_;
};

/// Two first contacts on trial, each by its tilted turning: at a convex corner that tells how far it has pivoted.
struct PairStart {
  std::array<const TiltedArc*, 2> arc{};
  std::array<double, 2> w{};
};

/// What it is worth: minus twice the logarithm of the likelihood is cost + log_volume, up to what is the same
/// everywhere.
struct PairScore {
  double cost = 0;
  double direct_cost = 0;  // with the errors about which it was linearised: more than the cost, unless that served
                           // badly
  double log_volume = 0;
  double log_gathered = 0;  // see RollFilter
  std::array<Whiteness, 3> whiteness;
  double right_rows = 0;                                  // robust: that are no outliers, ...
  double right_cost = 0;                                  // ... and their part of the cost
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();        // of the log-likelihood by (w_a, w_b), the volume's left out
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();  // expected, by them
  PairShared errors = PairShared::Zero();
  PairSharedCovariance covariance = PairSharedCovariance::Zero();
  Eigen::Matrix<double, 5, 2> errors_by_start = Eigen::Matrix<double, 5, 2>::Zero();

  double log_likelihood() const { return -0.5 * (cost + log_volume); }
};

/// How much time an answer is worth.
enum class Effort {
  whole,
  trial,    // of one of many explanations, or where rows fit badly: what they say may be widened without end
  hopeless  // nothing fits, and no place is listed
};

/// What all hypotheses have in common.
struct PairModel {
  const PairErrors* errors = nullptr;
  std::array<const TiltedBoundary*, 2> boundary{};
  std::array<const FeltTurning*, 2> felt{};
  std::array<const FeltTurning*, 2>
      slipping{};                             // the same where a place is off by what has slipped as well, or nullptr
  std::array<const Passings*, 2> passings{};  // of the nodes, where the part has corners or ends
  const BoundaryPath* path = nullptr;         // where centres are looked at
  PairShared gathered = PairShared::Zero();   // variances of what gathers over the whole roll
  double outlier_share = 0;                   // of rows whose turn is anything
  std::optional<Prior> prior;                 // of finger a's first contact
  std::optional<PosePrior> pose;              // of the part at the first contacts, ...
  std::array<MeasuredContact, 2> first{};     // ... as they were felt
  const Part* part = nullptr;
  Boundary places;
  Effort effort = Effort::whole;
  Innovations* kept = nullptr;  // where the last pass's go, if they are asked for

  double perimeter() const { return places.perimeter; }
};

/// The likelihood of two first contacts: a Kalman filter of the errors that the whole roll shares, linearised about
/// what they come out as (an iterated one: Gauss-Newton), or where they drift about its own estimate as it goes.
/// `guess`: of the shared errors; passes go on until it agrees with what comes out, at most `most_passes`.
PairScore score_of(const PairModel& model, const PairStart& start, const std::vector<PairNode>& nodes,
                   const PairShared& guess, int most_passes);

/// The angle nearest to 0 that is the same: std::remainder, but for rounding, and faster.
inline double nearest_to_zero(double angle) {
  constexpr double kTurn = 2 * std::numbers::pi;
  return angle - kTurn * std::floor(angle / kTurn + 0.5);
}

/// By how many nodes each finger's pivot is shared, see pivots_of.
using Alike = std::array<double, 2>;

/// A row as N equations f = 0, linear in the shared errors x and the start w about the point of linearisation: of the
/// turn, and with the centres of their distance and direction as well.
template <int N>
struct PairEquations {
  Eigen::Matrix<double, N, 1> f = Eigen::Matrix<double, N, 1>::Zero();
  Eigen::Matrix<double, N, 5> by_errors = Eigen::Matrix<double, N, 5>::Zero();
  Eigen::Matrix<double, N, 2> by_start = Eigen::Matrix<double, N, 2>::Zero();
  Eigen::Matrix<double, N, N> variance = Eigen::Matrix<double, N, N>::Zero();  // of the row on its own
  Eigen::Matrix<double, N, N> pivots = Eigen::Matrix<double, N, N>::Zero();    // of that, of fingers at corners
  // How far each contact is past an open outline's ends, in standard deviations; and that by w.
  Eigen::Vector2d past = Eigen::Vector2d::Zero();
  Eigen::Vector2d past_by_start = Eigen::Vector2d::Zero();
};

/// Where the first contacts are.
struct StartPlaces {
  std::array<TiltedPlace, 2> place;
  std::array<double, 2> angle{};     // of the tangents
  std::array<double, 2> by_start{};  // of them by w
};

StartPlaces places_of(const PairModel& model, const PairStart& start);

/// What the first contacts say of how the fingers face. N = 3: with their centres.
template <int N>
PairEquations<N> facing_equations(const PairModel& model, const StartPlaces& at, const PairNode& node,
                                  const PairShared& x);

/// What a later row says. N = 3: with the fingers' centres. `open`: of x, as far as it is known, where slip leaves the
/// places open; nullptr: linearised at x itself.
template <int N>
PairEquations<N> row_equations(const PairModel& model, const StartPlaces& at, const PairNode& node, const PairShared& x,
                               const PairSharedCovariance* open, const Alike& alike);

/// A finger that may be at one corner in several nodes in a row has pivoted there by one unknown angle, and they are
/// off alike, by their c_k times it. For each of them: what the others' c come to beside its own, S / c_k with S = sum
/// c_k. As (sum c_k e_k)^2 <= S sum c_k e_k^2, rows that are off on their own by c_k S are off by no less than that.
std::vector<Alike> pivots_of(const PairModel& model, const StartPlaces& at, const std::vector<PairNode>& nodes,
                             const PairShared& x);

}  // namespace rollfix::belief
